//! Ray against plane: t = (offset − n·o) / (n·d).

use super::{Intersect, in_range};
use crate::shape::{Plane, Ray};
use crate::vector::{Coordinates, Number, Scalar, Vector};

/// How a ray meets a plane.
#[derive(Clone, Copy, Debug, PartialEq)]
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
    let t_scale = Coordinates::abs(ray.direction).max_element().normalizer() * large;
    let plane = Plane { normal: plane.normal * scale, offset: plane.offset * scale };
    let unit_ray = Ray { direction: ray.direction * t_scale, ..*ray };
    let (numerator, denominator) = fraction(&unit_ray, &plane);
    if denominator == V::Scalar::ZERO {
        let contained = numerator == V::Scalar::ZERO && ray.t_min <= ray.t_max;
        return contained.then_some(PlaneHit::Contained);
    }
    let t = numerator / denominator * t_scale;
    in_range(t, ray.t_min, ray.t_max).then_some(PlaneHit::At(t))
}
