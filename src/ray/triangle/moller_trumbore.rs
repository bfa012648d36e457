//! Ray against triangle by Cramer's rule.
//!
//! T. Möller, B. Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection", Journal of Graphics
//! Tools 2.1, 1997. Without its absolute epsilon on the determinant, which loses small triangles,
//! and without its early exits, which random rays mispredict. The four triple products are grouped
//! around the triangle's normal and s × d, for the same number of operations: so a triangle with two
//! equal vertices, or with its vertices on a line of the lattice, has a determinant of exactly zero.

use super::{Frame, Solution, TriangleHit, intersect_frame};
use crate::shape::{Ray, Triangle};
use crate::vector::{Coordinates, Number, Vector};

/// Where the ray meets the triangle, in the closed range of the ray.
///
/// Solves o + t·d = (1 − u − v)·v0 + u·v1 + v·v2 with e1 = v1 − v0, e2 = v2 − v0, s = o − v0,
/// n = e1 × e2: det = −d·n, u = (s × d)·e2/det, v = −(s × d)·e1/det, t = s·n/det.
///
/// **Grade: fast.** Let P(a, b, c) be the sum of the magnitudes of the six terms of a·(b × c) and
/// u' = EPSILON/2. To first order u is off by at most 10u'·(P(s, d, e2) + |u|·P(d, e1, e2))/|det|, v by
/// 10u'·(P(s, d, e1) + |v|·P(d, e1, e2))/|det|, and t by 10u'·(P(s, e1, e2) + |t|·P(d, e1, e2))/|det|.
/// Within that distance of an edge, or of an end of the range, the verdict may be wrong, and two
/// neighbours may both let a ray pass.
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
pub(crate) fn solve<V: Coordinates>(frame: &Frame<V>) -> Solution<V::Scalar> {
    let Frame { direction, edge1, edge2, offset } = *frame;
    let normal = edge1.cross(edge2);
    let moment = offset.cross(direction);
    let determinant = -direction.dot(normal);
    let inverse = determinant.lit(1.0) / determinant;
    let numerator = offset.dot(normal);
    Solution {
        determinant,
        numerator,
        t: numerator * inverse,
        u: edge2.dot(moment) * inverse,
        v: -edge1.dot(moment) * inverse,
    }
}
