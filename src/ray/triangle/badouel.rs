//! Ray against triangle by its plane first, then in two dimensions.
//!
//! D. Badouel, "An Efficient Ray-Polygon Intersection", Graphics Gems, 1990. All that depends on the
//! triangle alone can be prepared. The lecture's triangle is open; this one is closed.

use super::{Solution, TriangleHit};
use crate::shape::{Ray, Triangle};
use crate::vector::{Coordinates, Number, Scalar, Vector};
use glam::Vec3;

/// Where the ray meets the triangle, in the closed range of the ray: [`Prepared::new`], then
/// [`Prepared::intersect`].
///
/// With n = e1 × e2, t = (v0 − o)·n / d·n; then u and v of the point o + t·d, by Cramer's rule in the
/// two axes that are not that of the largest component of n.
///
/// **Grade: fast**, with the bounds of [`Prepared::intersect`].
///
/// A triangle without area as computed, a zero direction, a NaN or infinite field: a miss.
///
/// ```
/// use isect::{Ray, Triangle, glam::Vec3, ray::triangle::badouel};
///
/// let triangle = Triangle::new(Vec3::ZERO, Vec3::X, Vec3::Y);
/// let ray = Ray::new(Vec3::new(0.25, 0.5, 3.0), Vec3::NEG_Z);
/// let hit = badouel::intersect(&ray, &triangle).expect("it is aimed at the inside");
/// assert_eq!((hit.t, hit.u, hit.v, hit.front), (3.0, 0.25, 0.5, true));
/// ```
#[inline]
#[must_use]
pub fn intersect<V: Vector>(
    ray: &Ray<V>,
    triangle: &Triangle<V>,
) -> Option<TriangleHit<V::Scalar>> {
    Prepared::new(triangle).intersect(ray)
}

/// A triangle prepared for many rays: its plane, and its edges projected along the dominant axis
/// of the normal and divided by their determinant.
///
/// With n = e1 × e2 and k the axis of its largest component, the point p of the plane has
/// u = (p − v0)·(e2 × k)/(n·k) and v = (p − v0)·(k × e1)/(n·k): Cramer's rule in the
/// two other axes, written with vectors that are zero on the dropped one.
///
/// ```
/// use isect::{Ray, Triangle, glam::Vec3, ray::triangle::badouel::Prepared};
///
/// let prepared = Prepared::new(&Triangle::new(Vec3::ZERO, Vec3::X, Vec3::Y));
/// let down = |x, y| Ray::new(Vec3::new(x, y, 1.0), Vec3::NEG_Z);
/// assert!(prepared.intersect(&down(0.5, 0.5)).is_some()); // on an edge
/// assert!(prepared.intersect(&down(0.5, 0.6)).is_none());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Prepared<V: Coordinates = Vec3> {
    v0: V,
    /// e1 × e2, of a length of about 2²⁰ for a well-shaped triangle of any size.
    normal: V,
    /// `(p − v0) · u_axis` is u.
    u_axis: V,
    /// `(p − v0) · v_axis` is v.
    v_axis: V,
}

/// The edges' length while they are multiplied: 2¹⁰ keeps the products of small components from
/// underflow, and those with far origins from overflow.
const LARGE: f64 = 1024.0;

impl<V: Vector> Prepared<V> {
    /// Prepares a triangle. One without area as computed, or with a NaN or infinite vertex, is
    /// never hit.
    #[inline]
    #[must_use]
    pub fn new(triangle: &Triangle<V>) -> Self {
        let edge1 = triangle.v1 - triangle.v0;
        let edge2 = triangle.v2 - triangle.v0;
        // Powers of two, so that products of edges neither over- nor underflow.
        let scale = edge1.abs().max(edge2.abs()).max_element().normalizer();
        let large = V::Scalar::ONE.lit(LARGE);
        let (edge1, edge2) = (edge1.times_powers(scale, large), edge2.times_powers(scale, large));
        let normal = edge1.cross(edge2);
        let (zero, one) = (V::Scalar::ZERO, V::Scalar::ONE);
        let [x, y, z] = [normal.x().abs(), normal.y().abs(), normal.z().abs()];
        let (axis, largest) = if x >= y && x >= z {
            (V::new(one, zero, zero), normal.x())
        } else if y >= z {
            (V::new(zero, one, zero), normal.y())
        } else {
            (V::new(zero, zero, one), normal.z())
        };
        let inverse = scale / largest * large;
        Self {
            v0: triangle.v0,
            normal,
            u_axis: edge2.cross(axis) * inverse,
            v_axis: axis.cross(edge1) * inverse,
        }
    }

    /// Where the ray meets the triangle, in the closed range of the ray.
    ///
    /// t = (v0 − o)·n / d·n; then p = o + t·d, and u and v of it.
    ///
    /// **Grade: fast.** Let P(a, b, c) be the sum of the magnitudes of the six terms of a·(b × c),
    /// s = o − v0 and u' = EPSILON/2. To first order t is off by at most
    /// δt = 9u'·(P(s, e1, e2) + |t|·P(d, e1, e2))/|d·n|; component i of p − v0 by
    /// δp_i = u'·(2|s_i| + 3|t·d_i|) + |d_i|·δt; and u by the sum over i of
    /// |a_i|·(δp_i + 10κu'·|p_i − v0_i|), with a = (e2 × k)/(n·k) and κ ≥ 1 the sum of the magnitudes of
    /// the two terms of n·k over |n·k|; v alike with (k × e1)/(n·k). Within that distance of an edge,
    /// or of an end of the range, the verdict may be wrong. (Components of an edge below 2⁻⁵⁰ of the
    /// longest count as zero.)
    ///
    /// A zero direction, a NaN or infinite field: a miss.
    ///
    /// ```
    /// use isect::{Ray, Triangle, glam::Vec3, ray::triangle::badouel::Prepared};
    ///
    /// let prepared = Prepared::new(&Triangle::new(Vec3::ZERO, Vec3::X, Vec3::Y));
    /// let hit = prepared.intersect(&Ray::new(Vec3::new(0.25, 0.5, 3.0), Vec3::NEG_Z));
    /// let hit = hit.expect("it is aimed at the inside");
    /// assert_eq!((hit.t, hit.u, hit.v, hit.front), (3.0, 0.25, 0.5, true));
    /// ```
    #[inline]
    #[must_use]
    pub fn intersect(&self, ray: &Ray<V>) -> Option<TriangleHit<V::Scalar>> {
        let solution = self.solve(ray);
        if !solution.is_trustworthy() {
            return self.extreme(ray);
        }
        solution.clipped(ray.t_min, ray.t_max).into_option()
    }

    #[inline(always)]
    fn solve(&self, ray: &Ray<V>) -> Solution<V::Scalar> {
        let offset = ray.origin - self.v0;
        let determinant = -self.normal.dot(ray.direction);
        let numerator = self.normal.dot(offset);
        let t = numerator / determinant;
        let point = offset + ray.direction * t;
        let (u, v) = (self.u_axis.dot(point), self.v_axis.dot(point));
        Solution { determinant, numerator, t, u, v }
    }

    /// Parallel to the plane, from a point of it, or with a direction of extreme length, which a power of
    /// two brings to about 1.
    #[cold]
    fn extreme(&self, ray: &Ray<V>) -> Option<TriangleHit<V::Scalar>> {
        if !(ray.is_valid() && self.v0.is_finite() && self.normal.is_finite()) {
            return None;
        }
        let t_scale = ray.direction.normalizer();
        let mut solution = self.solve(&Ray { direction: ray.direction * t_scale, ..*ray });
        solution.t = solution.t * t_scale;
        let parallel = solution.determinant == V::Scalar::ZERO;
        solution.clipped(ray.t_min, ray.t_max).into_option().filter(|_| !parallel)
    }
}
