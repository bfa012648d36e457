//! Ray against plane: t = (offset − n·o) / (n·d).
//!
//! [`intersect`] is fast; [`exact`] is certain.

pub mod exact;

use super::{Intersect, in_range};
use crate::shape::{Plane, Ray};
use crate::vector::{Coordinates, Number, Scalar, Vector};

/// How a ray meets a plane.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub enum PlaneHit<T> {
    /// The ray crosses the plane at this t.
    At(T),
    /// The ray lies in the plane: every t of its range is a hit.
    Contained,
}

impl<V: Vector> Intersect<V> for Plane<V> {
    type Hit = PlaneHit<V::Scalar>;
    #[inline]
    fn intersect(&self, ray: &Ray<V>) -> Option<Self::Hit> {
        intersect(ray, self)
    }
}

/// Where the ray meets the plane: `None`, at one t, or everywhere.
///
/// t = (offset − n·o) / (n·d). Where n·d is zero as computed the ray is parallel to the plane, and
/// contained in it if offset − n·o is zero as computed.
///
/// **Grade: fast.** With u = EPSILON/2, N = offset − n·o and D = n·d, the computed N is off by at
/// most 4u·(|offset| + |n|·|o|), D by at most 3u·|n|·|d| (here |n|·|o| stands for the sum of
/// the products' magnitudes), and the quotient adds u. Which of the three outcomes is reported is
/// certain beyond these errors.
///
/// A zero direction, a zero normal, a NaN or infinite field, an empty range: a miss. So is a t beyond
/// the largest float.
///
/// ```
/// use isect::{Plane, Ray, glam::Vec3, ray::plane::{self, PlaneHit}};
///
/// let floor = Plane::from_point_normal(Vec3::ZERO, Vec3::Y).expect("the normal is not zero");
/// let above = Vec3::new(0.0, 2.0, 0.0);
/// assert_eq!(plane::intersect(&Ray::new(above, -Vec3::Y), &floor), Some(PlaneHit::At(2.0)));
/// assert_eq!(plane::intersect(&Ray::new(above, Vec3::X), &floor), None);
/// assert_eq!(plane::intersect(&Ray::new(Vec3::ONE * 0.0, Vec3::X), &floor), Some(PlaneHit::Contained));
/// ```
#[inline]
#[must_use]
pub fn intersect<V: Vector>(ray: &Ray<V>, plane: &Plane<V>) -> Option<PlaneHit<V::Scalar>> {
    let (numerator, denominator) = fraction(ray, plane);
    if !denominator.is_mid_range() {
        return parallel_or_extreme(ray, plane);
    }
    let t = numerator / denominator;
    in_range(t, ray.t_min, ray.t_max).then_some(PlaneHit::At(t))
}

const TWO_TO_60: f64 = 1_152_921_504_606_846_976.0;

/// t as a fraction.
#[inline(always)]
fn fraction<V: Coordinates>(ray: &Ray<V>, plane: &Plane<V>) -> (V::Scalar, V::Scalar) {
    (plane.offset - plane.normal.dot(ray.origin), plane.normal.dot(ray.direction))
}

/// A denominator of zero, or one that has left the range of exponents in which products neither
/// over- nor underflow: decides again with a direction of about 2⁶⁰, which makes the products of its
/// small components large enough, and with a normal of moderate length, by powers of two.
#[cold]
fn parallel_or_extreme<V: Vector>(ray: &Ray<V>, plane: &Plane<V>) -> Option<PlaneHit<V::Scalar>> {
    if !(ray.is_valid() && plane.is_valid()) {
        return None;
    }
    let one = V::Scalar::ONE;
    let longest = Coordinates::abs(plane.normal).max_element();
    let scale = if (longest * longest).is_mid_range() { one } else { longest.normalizer() };
    let large = one.lit(TWO_TO_60);
    let t_scale = Coordinates::abs(ray.direction).max_element().normalizer();
    let plane = Plane { normal: plane.normal * scale, offset: plane.offset * scale };
    let long_ray = Ray { direction: ray.direction.times_powers(t_scale, large), ..*ray };
    let (numerator, denominator) = fraction(&long_ray, &plane);
    if denominator == V::Scalar::ZERO {
        let contained = numerator == V::Scalar::ZERO && ray.t_min <= ray.t_max;
        return contained.then_some(PlaneHit::Contained);
    }
    let t = numerator / denominator * large * t_scale;
    in_range(t, ray.t_min, ray.t_max).then_some(PlaneHit::At(t))
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    const FLOOR: Plane = Plane { normal: Vec3::new(0.0, 3.0, 0.0), offset: 6.0 };

    #[test]
    fn three_outcomes() {
        let from = |y: f32, direction: Vec3| Ray::new(Vec3::new(7.0, y, 0.0), direction);
        assert_eq!(intersect(&from(4.0, Vec3::NEG_Y * 0.5), &FLOOR), Some(PlaneHit::At(4.0)));
        assert_eq!(intersect(&from(4.0, Vec3::Y), &FLOOR), None, "behind");
        assert_eq!(intersect(&from(4.0, Vec3::X), &FLOOR), None, "parallel");
        assert_eq!(intersect(&from(2.0, Vec3::X), &FLOOR), Some(PlaneHit::Contained));
        assert_eq!(intersect(&from(2.0, Vec3::Y), &FLOOR), Some(PlaneHit::At(0.0)));
        let line = from(4.0, Vec3::Y).with_range(f32::NEG_INFINITY, f32::INFINITY);
        assert_eq!(intersect(&line, &FLOOR), Some(PlaneHit::At(-2.0)));
    }

    #[test]
    fn an_empty_range_contains_nothing() {
        let along = Ray::new(Vec3::new(0.0, 2.0, 0.0), Vec3::X);
        assert_eq!(intersect(&along.with_range(1.0, 0.0), &FLOOR), None);
        assert_eq!(intersect(&along.with_range(f32::NAN, 1.0), &FLOOR), None);
        assert_eq!(intersect(&along.with_range(1.0, 1.0), &FLOOR), Some(PlaneHit::Contained));
    }

    #[test]
    fn lengths_of_normal_and_direction_do_not_matter() {
        for (normal, direction) in [
            (1e-30, 1e-30),
            (1e30, 1e30),
            (1e-38, 1.0),
            (1.0, 1e-37),
            (1e25, 1e-30),
            (1e-38, 1e-37),
        ] {
            let plane = Plane::from_point_normal(Vec3::Y, Vec3::Y * normal).expect("not zero");
            let ray = Ray::new(Vec3::new(0.0, 1.5, 0.0), Vec3::NEG_Y * direction);
            let Some(PlaneHit::At(t)) = intersect(&ray, &plane) else {
                panic!("{normal} {direction}")
            };
            // A subnormal direction has few bits of its own.
            assert!((t * direction - 0.5).abs() < 1e-4, "{t} {normal} {direction}");
        }
    }
}
