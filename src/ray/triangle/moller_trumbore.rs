//! Ray against triangle by Cramer's rule.
//!
//! T. Möller, B. Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection", Journal of Graphics
//! Tools 2.1, 1997. Without its absolute epsilon on the determinant, which loses small triangles,
//! and without its early exits, which random rays mispredict.

use super::{Frame, Solution, TriangleHit, intersect_frame};
use crate::shape::{Ray, Triangle};
use crate::vector::{Coordinates, Number, Vector};

/// Where the ray meets the triangle, in the closed range of the ray.
///
/// Solves o + t·d = (1 − u − v)·v0 + u·v1 + v·v2 with e1 = v1 − v0, e2 = v2 − v0, s = o − v0:
/// det = e1·(d × e2), u = s·(d × e2)/det, v = d·(s × e1)/det, t = e2·(s × e1)/det.
///
/// **Grade: fast.** Each of the four triple products a·(b × c) is off by at most 10u times the sum
/// of the magnitudes of its six terms, u = EPSILON/2. So u is off by at most
/// 10u·(|s||d||e2| + |u||e1||d||e2|)/|det| to first order, with a norm that is at most √6 of the
/// Euclidean one; v and t alike. Within that distance of an edge the verdict may be wrong, and
/// two neighbours may both let a ray pass.
///
/// A triangle without area as computed, a zero direction, a NaN or infinite field: a miss.
///
/// ```
/// use isect::{Ray, Triangle, glam::Vec3A, ray::triangle::moller_trumbore};
///
/// let triangle = Triangle::new(Vec3A::ZERO, Vec3A::X, Vec3A::Y);
/// let ray = Ray::new(Vec3A::new(0.25, 0.5, 3.0), Vec3A::NEG_Z);
/// let hit = moller_trumbore::intersect(&ray, &triangle).expect("it is aimed at the inside");
/// assert_eq!((hit.t, hit.u, hit.v, hit.front), (3.0, 0.25, 0.5, true));
/// ```
#[inline]
#[must_use]
pub fn intersect<V: Vector>(
    ray: &Ray<V>,
    triangle: &Triangle<V>,
) -> Option<TriangleHit<V::Scalar>> {
    intersect_frame(ray, triangle, solve)
}

#[inline(always)]
fn solve<V: Coordinates>(frame: &Frame<V>) -> Solution<V::Scalar> {
    let Frame {
        direction,
        edge1,
        edge2,
        offset,
    } = *frame;
    let p = direction.cross(edge2);
    let q = offset.cross(edge1);
    let determinant = edge1.dot(p);
    let inverse = determinant.lit(1.0) / determinant;
    Solution {
        determinant,
        t: edge2.dot(q) * inverse,
        u: offset.dot(p) * inverse,
        v: direction.dot(q) * inverse,
    }
}
