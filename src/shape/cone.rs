//! The cone: a ray with a width.

use glam::Vec3;

use super::Ray;
use crate::vector::{Coordinates, Number, Scalar, Vector, tan};

/// A ray with a width (J. Amanatides, "Ray Tracing with Cones", SIGGRAPH 1984): the disks around
/// `ray.at(t)`, perpendicular to the direction, of radius `radius + spread · t`, with t ≥ 0 in the ray's
/// closed range.
///
/// With a radius of zero it is a cone with its apex in the origin, with a spread of zero a cylinder, else a
/// part of a cone whose apex lies behind the origin. The spread is a length per unit of t: for a direction
/// of length 1 the tangent of the half-angle. What the range says of negative t does not count.
///
/// A negative radius or spread, both zero (that is a ray), one infinite or NaN, a spread/|d| beyond the range of `f64`,
/// or a ray that hits nothing: such a cone touches nothing.
///
/// ```
/// use isect::{Cone, Ray, glam::Vec3};
///
/// let cone = Cone::new(Ray::new(Vec3::ZERO, Vec3::Z), 1.0, 0.5);
/// assert_eq!((cone.radius_at(0.0), cone.radius_at(4.0)), (1.0, 3.0));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Cone<V: Coordinates = Vec3> {
    /// The axis, and the range of t.
    pub ray: Ray<V>,
    /// The radius where t is 0, not negative.
    pub radius: V::Scalar,
    /// By how much the radius grows from t to t + 1, not negative.
    pub spread: V::Scalar,
}

impl<V: Vector> Cone<V> {
    /// The cone around `ray` of radius `radius + spread · t`.
    #[inline]
    #[must_use]
    pub const fn new(ray: Ray<V>, radius: V::Scalar, spread: V::Scalar) -> Self {
        Self { ray, radius, spread }
    }

    /// The cone with its apex in the ray's origin, and this angle between axis and surface, in radians.
    /// Angles that are not between 0 and π/2 make a cone that touches nothing.
    ///
    /// ```
    /// use isect::{Cone, Ray, glam::DVec3};
    ///
    /// let ray = Ray::new(DVec3::ZERO, DVec3::Z * 2.0);
    /// let cone = Cone::from_half_angle(ray, core::f64::consts::FRAC_PI_4);
    /// assert!((cone.spread - 2.0).abs() < 1e-15);
    /// ```
    #[inline]
    #[must_use]
    pub fn from_half_angle(ray: Ray<V>, half_angle: V::Scalar) -> Self {
        let angle: f64 = half_angle.into();
        let within = 0.0 < angle && angle < core::f64::consts::FRAC_PI_2;
        let tangent = if within { tan(angle) } else { f64::NAN };
        let spread = ray.direction.length() * V::Scalar::ONE.lit(tangent);
        Self::new(ray, V::Scalar::ZERO, spread)
    }

    /// The radius of the section at t.
    #[inline]
    #[must_use]
    pub fn radius_at(&self, t: V::Scalar) -> V::Scalar {
        self.radius + self.spread * t
    }

    /// The cone that goes on from the section at t in another direction, as behind a flat mirror: it is as
    /// wide there, and grows as fast with the distance.
    ///
    /// ```
    /// use isect::{Cone, Ray, glam::Vec3};
    ///
    /// let cone = Cone::new(Ray::new(Vec3::ZERO, Vec3::Z), 0.0, 0.25);
    /// let mirrored = cone.continued(4.0, Vec3::NEG_Z * 2.0);
    /// assert_eq!(mirrored.ray, Ray::new(Vec3::Z * 4.0, Vec3::NEG_Z * 2.0));
    /// assert_eq!((mirrored.radius, mirrored.spread), (1.0, 0.5));
    /// ```
    #[inline]
    #[must_use]
    pub fn continued(&self, t: V::Scalar, direction: V) -> Self {
        let ray = Ray::new(self.ray.at(t), direction);
        let spread = self.spread * (direction.length() / self.ray.direction.length());
        Self::new(ray, self.radius_at(t), spread)
    }

    /// Whether it can touch anything.
    #[inline]
    pub(crate) fn is_valid(&self) -> bool {
        let (zero, Self { ray, radius, spread }) = (V::Scalar::ZERO, *self);
        let in_front = Ray { t_min: ray.t_min.max(zero), ..ray };
        let slope: f64 = spread.into() / ray.direction.length().into();
        ray.is_valid()
            && ray.has_range()
            && in_front.has_range()
            && zero <= radius
            && zero <= spread
            && zero < radius.max(spread)
            && radius.is_finite()
            && slope < f64::INFINITY
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DVec3, Vec3A};

    #[test]
    fn what_can_touch_nothing() {
        let ray = Ray::new(Vec3::ZERO, Vec3::Z);
        assert!(Cone::new(ray, 1.0, 0.0).is_valid() && Cone::new(ray, 0.0, 1.0).is_valid());
        assert!(Cone::new(ray.with_range(f32::NEG_INFINITY, 0.0), 1.0, 0.0).is_valid());
        for bad in [
            Cone::new(ray, 0.0, 0.0),
            Cone::new(ray, -1.0, 1.0),
            Cone::new(ray, 1.0, -1.0),
            Cone::new(ray, f32::NAN, 1.0),
            Cone::new(ray, 1.0, f32::NAN),
            Cone::new(ray, f32::INFINITY, 1.0),
            Cone::new(ray, 1.0, f32::INFINITY),
            Cone::new(Ray::new(Vec3::ZERO, Vec3::ZERO), 1.0, 1.0),
            Cone::new(ray.with_range(-2.0, -1.0), 1.0, 1.0),
            Cone::new(ray.with_range(f32::NAN, 1.0), 1.0, 1.0),
            Cone::new(ray.with_range(0.0, f32::NAN), 1.0, 1.0),
            Cone::new(ray.with_range(f32::INFINITY, f32::INFINITY), 1.0, 1.0),
            Cone::from_half_angle(ray, 0.0),
            Cone::from_half_angle(ray, 1.6),
            Cone::from_half_angle(ray, f32::NAN),
        ] {
            assert!(!bad.is_valid(), "{bad:?}");
        }
    }

    #[test]
    fn conversions_lose_nothing() {
        let cone = Cone::new(Ray::new(Vec3::ONE, Vec3::Z).with_range(1.0, 2.0), 0.1, 0.2);
        let wide = Cone::<DVec3>::from(cone);
        assert_eq!((wide.radius, wide.ray.origin), (f64::from(0.1_f32), DVec3::ONE));
        assert_eq!(Cone::<Vec3>::from(Cone::<Vec3A>::from(cone)), cone);
    }
}
