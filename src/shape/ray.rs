//! The ray: the points o + t·d with t in a closed range.

use glam::Vec3;

use super::Affine;
use crate::vector::{Coordinates, Number, Scalar, Vector};

/// A ray: the points `origin + t · direction` with `t_min <= t <= t_max`.
///
/// The direction may have any length but zero; t counts in units of that length. The range is
/// closed and may be infinite on either side: (−∞, ∞) is a line. A zero direction, a NaN anywhere,
/// an infinite origin or direction, `t_min > t_max`: such a ray hits nothing.
///
/// ```
/// use isect::{Ray, glam::Vec3};
///
/// let ray = Ray::new(Vec3::ZERO, Vec3::new(0.0, 0.0, 2.0));
/// assert_eq!(ray.at(1.5), Vec3::new(0.0, 0.0, 3.0));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Ray<V: Coordinates = Vec3> {
    /// Where t is 0.
    pub origin: V,
    /// The step from t to t + 1, of any length but zero.
    pub direction: V,
    /// The least t that counts.
    pub t_min: V::Scalar,
    /// The greatest t that counts.
    pub t_max: V::Scalar,
}

impl<V: Vector> Ray<V> {
    /// The ray from `origin` along `direction`, t in [0, ∞].
    #[inline]
    #[must_use]
    pub const fn new(origin: V, direction: V) -> Self {
        let (t_min, t_max) = (V::Scalar::ZERO, V::Scalar::INFINITY);
        Self { origin, direction, t_min, t_max }
    }

    /// The segment between two points, t in [0, 1].
    ///
    /// The direction is the rounded difference of the points, so the far end is `to` within the
    /// rounding of one subtraction and one addition.
    #[inline]
    #[must_use]
    pub fn segment(from: V, to: V) -> Self {
        Self::new(from, to - from).with_range(V::Scalar::ZERO, V::Scalar::ONE)
    }

    /// The same ray with t in the closed range [t_min, t_max].
    ///
    /// In a closure that captures a ray write this and not `Ray { t_max, ..ray }`, over which rustc 1.95 breaks down
    /// ("broken MIR"): it captures the fields one by one, and does not see through their types.
    #[inline]
    #[must_use]
    pub const fn with_range(mut self, t_min: V::Scalar, t_max: V::Scalar) -> Self {
        self.t_min = t_min;
        self.t_max = t_max;
        self
    }

    /// The same ray with the range opened at its start: only hits with a t greater than `t` count.
    ///
    /// (The exact kernels, the defaults, compare the exact t. That of a hit is rounded, and the exact one
    /// may be greater still: to leave a surface, see [`crate::spawn`].)
    #[inline]
    #[must_use]
    pub fn after(mut self, t: V::Scalar) -> Self {
        self.t_min = t.next_up();
        self
    }

    /// The same ray with the range opened at its end: only hits with a t less than `t` count. (As with
    /// [`Self::after`], the exact t is compared, where the kernel is exact.)
    #[inline]
    #[must_use]
    pub fn before(mut self, t: V::Scalar) -> Self {
        self.t_max = t.next_down();
        self
    }

    /// The point `origin + t · direction`.
    #[inline]
    #[must_use]
    pub fn at(&self, t: V::Scalar) -> V {
        self.origin + self.direction * t
    }

    /// The image of the ray under an affine map. The direction is not normalised, so t keeps its
    /// meaning: `ray.transformed(&m).at(t)` is the image of `ray.at(t)`, within rounding.
    #[inline]
    #[must_use]
    pub fn transformed(&self, affine: &impl Affine<V>) -> Self {
        Self {
            origin: affine.point(self.origin),
            direction: affine.vector(self.direction),
            ..*self
        }
    }

    /// Whether origin and direction are finite and the direction is not zero.
    #[inline]
    pub(crate) fn is_valid(&self) -> bool {
        let longest = Coordinates::abs(self.direction).max_element();
        self.origin.is_finite() && self.direction.is_finite() && V::Scalar::ZERO.lt(longest)
    }

    /// The float nearest to t in the range, which is not empty, and among the finite ones.
    #[inline]
    pub(crate) fn nearest_in_range(&self, t: f64) -> V::Scalar {
        let largest = V::Scalar::MAX;
        let (first, last) = (self.t_min.max(-largest), self.t_max.min(largest));
        first.lit(t).max(first).min(last)
    }

    /// Whether the range holds a finite t.
    #[inline]
    pub(crate) fn has_range(&self) -> bool {
        self.t_min <= self.t_max
            && self.t_min < V::Scalar::INFINITY
            && -V::Scalar::INFINITY < self.t_max
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{Affine3, Affine3A, DAffine3, DMat4, DVec3, Mat4, Vec3A};

    #[test]
    fn ranges() {
        let ray = Ray::new(Vec3::ZERO, Vec3::X);
        assert_eq!((ray.t_min, ray.t_max), (0.0, f32::INFINITY));
        assert_eq!(
            Ray::segment(Vec3::ONE, Vec3::ZERO),
            Ray::new(Vec3::ONE, -Vec3::ONE).with_range(0.0, 1.0)
        );
        let open = ray.after(1.0).before(2.0);
        assert!(open.t_min > 1.0 && open.t_max < 2.0);
        assert_eq!(ray.after(-0.0).t_min, f32::from_bits(1));
    }

    #[test]
    fn every_affine_map_moves_a_ray_alike() {
        let map =
            Affine3A::from_scale(Vec3::new(1.0, 2.0, 4.0)) * Affine3A::from_translation(Vec3::X);
        let ray = Ray::new(Vec3A::ONE, Vec3A::new(1.0, 1.0, 0.0)).with_range(1.0, 3.0);
        let expected =
            Ray::new(Vec3A::new(2.0, 2.0, 4.0), Vec3A::new(1.0, 2.0, 0.0)).with_range(1.0, 3.0);
        assert_eq!(ray.transformed(&map), expected);
        assert_eq!(ray.transformed(&Mat4::from(map)), expected);
        assert_eq!(ray.transformed(&Affine3::from(map)), expected);
        let (ray, expected) = (Ray::<Vec3>::from(ray), Ray::<Vec3>::from(expected));
        assert_eq!(ray.transformed(&map), expected);
        let (ray, expected) = (Ray::<DVec3>::from(ray), Ray::<DVec3>::from(expected));
        let map =
            DAffine3::from_scale(DVec3::new(1.0, 2.0, 4.0)) * DAffine3::from_translation(DVec3::X);
        assert_eq!(ray.transformed(&map), expected);
        assert_eq!(ray.transformed(&DMat4::from(map)), expected);
    }
}
