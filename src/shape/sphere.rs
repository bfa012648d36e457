//! The sphere |p − center| = radius.

use glam::Vec3;

use super::Aabb;
use crate::vector::{Coordinates, Number, Scalar, Vector};

/// The sphere of the points p with `|p − center| = radius`: the surface, not the ball.
///
/// A radius of zero is a point. A negative radius, or an infinite or NaN field, makes a sphere that
/// is never hit.
///
/// ```
/// use isect::{Sphere, glam::Vec3};
///
/// let sphere = Sphere::new(Vec3::Z, 2.0);
/// assert_eq!((sphere.normal_at(Vec3::Z * 3.0), sphere.aabb().max), (Vec3::Z, Vec3::new(2.0, 2.0, 3.0)));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Sphere<V: Coordinates = Vec3> {
    /// The centre.
    pub center: V,
    /// The radius, not negative.
    pub radius: V::Scalar,
}

impl<V: Vector> Sphere<V> {
    /// The sphere around `center`.
    #[inline]
    #[must_use]
    pub const fn new(center: V, radius: V::Scalar) -> Self {
        Self { center, radius }
    }

    /// The outward unit normal at the point of the sphere nearest to `point`; zero if `point` is
    /// the centre, NaN if it or the centre is not finite.
    #[inline]
    #[must_use]
    pub fn normal_at(&self, point: V) -> V {
        let mut outward = point - self.center;
        if !outward.is_finite() {
            let half = V::Scalar::ONE.lit(0.5);
            outward = point * half - self.center * half;
        }
        // The length of a difference may over- or underflow, and so may its reciprocal.
        let outward = outward * outward.normalizer();
        let length = outward.dot(outward).sqrt();
        if length == V::Scalar::ZERO { V::ZERO } else { outward.divided(V::splat(length)) }
    }

    /// The smallest box around the sphere, rounded outward; [`Aabb::EMPTY`] for a sphere that is
    /// never hit.
    #[inline]
    #[must_use]
    pub fn aabb(&self) -> Aabb<V> {
        if self.is_valid() {
            Aabb::from_center_half_extents(self.center, V::splat(self.radius))
        } else {
            Aabb::EMPTY
        }
    }

    /// Whether the fields are finite and the radius is not negative.
    #[inline]
    pub(crate) fn is_valid(&self) -> bool {
        self.center.is_finite() && self.radius.is_finite() && V::Scalar::ZERO.le(self.radius)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn normals_of_any_size() {
        for size in [1e-40, 1e-45, 1e-20, 1e20, 3e38] {
            let around = |point| Sphere::new(Vec3::ZERO, size).normal_at(point);
            assert_eq!(around(Vec3::NEG_Z * size), Vec3::NEG_Z, "{size}");
        }
        // The difference overflows.
        let far = Sphere::new(Vec3::X * -2e38, 4e37);
        assert_eq!(far.normal_at(Vec3::X * 2e38), Vec3::X);
    }

    #[test]
    fn normals_and_bounds() {
        let sphere = Sphere::new(Vec3::new(1.0, 0.0, 0.0), 2.0);
        assert_eq!(sphere.normal_at(Vec3::new(1.0, 5.0, 0.0)), Vec3::Y);
        assert_eq!(sphere.normal_at(sphere.center), Vec3::ZERO);
        assert!(sphere.normal_at(Vec3::NAN).x.is_nan());
        assert_eq!(sphere.aabb(), Aabb::new(Vec3::new(-1.0, -2.0, -2.0), Vec3::new(3.0, 2.0, 2.0)));
        assert!(Sphere::new(Vec3::ZERO, -1.0).aabb().is_empty());
        assert!(Sphere::new(Vec3::ZERO, f32::NAN).aabb().is_empty());
        // 1 + 2⁻³⁰ is not a float: the box is the next larger.
        let inexact = Sphere::new(Vec3::ONE, 2.0_f32.powi(-30)).aabb();
        assert_eq!((inexact.min.x, inexact.max.x), (1.0_f32.next_down(), 1.0_f32.next_up()));
    }
}
