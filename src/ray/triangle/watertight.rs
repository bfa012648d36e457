//! Ray against triangle without leaks.
//!
//! S. Woop, C. Benthin, I. Wald, "Watertight Ray/Triangle Intersection", Journal of Computer
//! Graphics Techniques 2.1, 2013. Space is sheared so that the ray becomes an axis; then a vertex
//! has the same two-dimensional coordinates for every triangle that it belongs to, and the side on
//! which the ray passes an edge is decided exactly on them.
//!
#![doc = include_str!("../../doc/shear.svg")]

use super::{Found, TriangleHit, in_range};
use crate::exact::difference_of_products;
use crate::shape::{Ray, Triangle};
use crate::vector::{Coordinates, Number, Scalar, Vector};
use glam::Vec3;

/// A ray with its shear, made once per ray.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct ShearedRay<V: Coordinates = Vec3> {
    pub(crate) origin: V,
    /// The axis of the direction's largest component: 0, 1 or 2.
    pub(crate) axis: u32,
    /// The direction's next two components, cyclically, over the largest.
    pub(crate) shear: [V::Scalar; 2],
    /// `z · inverse · t_scale` is t at depth z along the axis; `t_scale` is 1 but for directions of
    /// extreme length.
    pub(crate) inverse: V::Scalar,
    pub(crate) t_scale: V::Scalar,
    pub(crate) t_min: V::Scalar,
    /// The greatest t that counts, as in [`Ray::t_max`]; a traversal lowers it to the closest hit
    /// so far.
    pub t_max: V::Scalar,
}

impl<V: Vector> ShearedRay<V> {
    /// Prepares a ray. One that hits nothing (zero direction, NaN, …) stays so.
    #[inline]
    #[must_use]
    pub fn new(ray: &Ray<V>) -> Self {
        let one = V::Scalar::ONE;
        let d = ray.direction;
        let [x, y, z] = [d.x().abs(), d.y().abs(), d.z().abs()];
        let (axis, [dx, dy, dz]) = if x >= y && x >= z {
            (0, [d.y(), d.z(), d.x()])
        } else if y >= z {
            (1, [d.z(), d.x(), d.y()])
        } else {
            (2, [d.x(), d.y(), d.z()])
        };
        let t_scale = if dz.is_mid_range() { one } else { dz.normalizer() };
        Self {
            origin: ray.origin,
            axis,
            shear: [dx / dz, dy / dz],
            inverse: one / (dz * t_scale),
            t_scale,
            // A NaN that no comparison lets through.
            t_min: if ray.is_valid() { ray.t_min } else { V::Scalar::NAN },
            t_max: ray.t_max,
        }
    }
}

impl<V: Coordinates> ShearedRay<V> {
    /// The triangle in the sheared space with the origin at zero and the ray along z, as the x, y
    /// and z of its three vertices.
    #[inline(always)]
    pub(crate) fn sheared(&self, triangle: &Triangle<V>) -> Sheared<V> {
        let a = triangle.v0 - self.origin;
        let b = triangle.v1 - self.origin;
        let c = triangle.v2 - self.origin;
        let x = V::new(a.x(), b.x(), c.x());
        let y = V::new(a.y(), b.y(), c.y());
        let z = V::new(a.z(), b.z(), c.z());
        let (x, y, z) = match self.axis {
            0 => (y, z, x),
            1 => (z, x, y),
            _ => (x, y, z),
        };
        Sheared { x: x - z * self.shear[0], y: y - z * self.shear[1], z }
    }
}

/// Where the ray meets the triangle, in the closed range of the ray.
///
/// With (x_i, y_i) the sheared vertices, the weights are the three edge functions
/// x_(i+2)·y_(i+1) − y_(i+2)·x_(i+1) over their sum. Where one is zero as computed, the rounding
/// errors of its products decide, so that every edge's sign is exact on the sheared coordinates (but
/// where the products of small coordinates underflow).
///
/// **Grade: watertight.** No ray slips between two triangles that share an edge or a vertex
/// (the same floats in both): the ray hits at least one of the triangles around it. This holds
/// where no difference of coordinates overflows and the range's ends are away from the surface. The
/// verdict near an edge is not always that of exact arithmetic: it is the exact one for vertices
/// moved across the ray by at most 6u times the largest component of their distance from the origin,
/// u = EPSILON/2. So are u and v, with 3u of rounding added, and t, with 9u of the largest |t| of the
/// three vertices.
///
/// A hierarchy of tight boxes around the triangles may lose what the moved vertices gain: inflate the
/// boxes by 10u times the greatest distance from which rays come.
///
/// A triangle without area as seen along the ray, after rounding, a zero direction, a NaN or infinite
/// field: a miss.
///
/// ```
/// use isect::{Ray, Triangle, glam::Vec3, ray::triangle::watertight::{self, ShearedRay}};
///
/// // Down the common edge of two triangles.
/// let [a, b, c, d] = [Vec3::ZERO, Vec3::X, Vec3::ONE, Vec3::Y];
/// let ray = ShearedRay::new(&Ray::new(Vec3::new(0.3, 0.3, 2.0), Vec3::new(0.1, 0.1, -1.0)));
/// let hits = [[a, b, c], [a, c, d]].map(|t| watertight::intersect(&ray, &t.into()).is_some());
/// assert!(hits[0] || hits[1]);
/// ```
#[inline]
#[must_use]
pub fn intersect<V: Vector>(
    ray: &ShearedRay<V>,
    triangle: &Triangle<V>,
) -> Option<TriangleHit<V::Scalar>> {
    let sheared = ray.sheared(triangle);
    let weights = sheared.weights();
    let determinant = weights.x() + weights.y() + weights.z();
    if !determinant.is_mid_range() {
        return extreme(ray, &sheared);
    }
    sheared.found(ray, weights, determinant).into_option()
}

/// x, y and z of the three vertices.
pub(crate) struct Sheared<V> {
    x: V,
    y: V,
    z: V,
}

impl<V: Coordinates> Sheared<V> {
    /// The three edge functions as computed, each named after the vertex across: one that is not zero has the
    /// exact sign, as rounding keeps the order of the two products.
    #[inline(always)]
    pub(crate) fn rounded_weights(&self) -> V {
        self.y.cross(self.x)
    }

    /// What the weights and their sum say.
    #[inline(always)]
    pub(crate) fn found(
        &self,
        ray: &ShearedRay<V>,
        weights: V,
        determinant: V::Scalar,
    ) -> Found<V::Scalar> {
        let zero = determinant.lit(0.0);
        let inverse = determinant.lit(1.0) / determinant;
        let scaled = weights * inverse;
        let (w, u, v) = (scaled.x(), scaled.y(), scaled.z());
        let t = scaled.dot(self.z) * ray.inverse * ray.t_scale;
        let inside = zero.le(w) & zero.le(u) & zero.le(v);
        let hit = inside & in_range(t, ray.t_min, ray.t_max);
        // Looking along the axis, or against it, the vertices turn the other way.
        let (positive, along) = (zero.lt(determinant), zero.lt(ray.inverse));
        let front = (positive & along) | !(positive | along);
        Found { hit, t, u, v, front }
    }
}

impl<V: Vector> Sheared<V> {
    /// The three edge functions with exact signs.
    #[inline(always)]
    fn weights(&self) -> V {
        let weights = self.rounded_weights();
        let zero = V::Scalar::ZERO;
        if weights.x() == zero || weights.y() == zero || weights.z() == zero {
            return self.weights_of_zero();
        }
        weights
    }

    #[cold]
    fn weights_of_zero(&self) -> V {
        let Self { x, y, .. } = *self;
        V::new(
            difference_of_products(y.y(), x.z(), y.z(), x.y()),
            difference_of_products(y.z(), x.x(), y.x(), x.z()),
            difference_of_products(y.x(), x.y(), y.y(), x.x()),
        )
    }
}

/// The weights' sum has left the middle of the range of exponents, or is zero: once more with x and
/// y brought to about 1 by a power of two.
#[cold]
fn extreme<V: Vector>(ray: &ShearedRay<V>, sheared: &Sheared<V>) -> Option<TriangleHit<V::Scalar>> {
    let Sheared { x, y, z } = *sheared;
    if !(x.is_finite() && y.is_finite() && z.is_finite()) {
        return None;
    }
    let scale = x.abs().max(y.abs()).max_element().normalizer();
    let sheared = Sheared { x: x * scale, y: y * scale, z };
    let weights = sheared.weights();
    let determinant = weights.x() + weights.y() + weights.z();
    let found = sheared.found(ray, weights, determinant).into_option();
    found.filter(|_| determinant != V::Scalar::ZERO)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    /// The ray passes the edge p q at a distance of about EPSILON²: the products of the edge function
    /// round to the same number, and only their errors tell the side. Without them both triangles of
    /// the edge would be hit.
    #[test]
    fn the_side_of_an_edge_is_exact_where_its_products_round_alike() {
        fn check<V: Vector>() {
            let number = |x: f64| V::Scalar::ONE.lit(x);
            let (one, epsilon) = (V::Scalar::ONE, V::Scalar::EPSILON);
            for turn in 0..3 {
                let point = |x, y| {
                    let p = [x, y, one];
                    V::new(p[turn], p[(turn + 1) % 3], p[(turn + 2) % 3])
                };
                let (p, q) = (point(one + epsilon, one), point(-one, -(one - epsilon)));
                let direction = point(number(0.0), number(0.0)); // (0, 0, 1), turned
                let ray = ShearedRay::new(&Ray::new(V::ZERO, direction));
                let above = Triangle::new(p, q, point(-one, one));
                let below = Triangle::new(q, p, point(one, -one));
                let hits = [above, below].map(|t| intersect(&ray, &t).is_some());
                // p × q = EPSILON²: the origin is on the side of (1, −1).
                assert_eq!(hits, [false, true], "{}", core::any::type_name::<V>());
            }
        }
        check::<Vec3>();
        check::<glam::Vec3A>();
        check::<DVec3>();
    }
}
