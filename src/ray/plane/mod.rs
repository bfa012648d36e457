//! Ray against plane: t = (offset − n·o) / (n·d).

mod decide;

use super::Intersect;
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
/// t = N/D with N = offset − n·o and D = n·d. If D = 0 the ray is parallel to the plane, and contained
/// in it if N = 0.
///
/// **Grade: exact** for the outcome, for every finite input. With u = EPSILON/2, |n|·|o| the sum of the
/// products' magnitudes, and |n|·|d| likewise, t is off by at most
/// 4u·(|offset| + |n|·|o|)/|D| + |t|·(3u·|n|·|d|/|D| + u), to first order; in the range, and the largest
/// float where it is beyond that. Floats with an error bound decide; where they leave the outcome open,
/// integers of a fixed capacity do, and then t is within an ulp.
///
/// A zero direction, a zero normal, a NaN or infinite field, an empty range: a miss. (The formula is
/// older than its papers; there is none to cite.)
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
    let Certain { open, hit, t } = certain(ray, plane, V::Scalar::EPSILON, V::Scalar::MIN_POSITIVE);
    if open { undecided(ray, plane) } else { hit.then_some(PlaneHit::At(t)) }
}

/// What is certain, in one lane or several: where `open` holds, nothing.
pub(crate) struct Certain<N: Number> {
    pub(crate) open: N::Mask,
    pub(crate) hit: N::Mask,
    pub(crate) t: N,
}

/// The outcome if it is certain; it is not for a ray that is parallel to the plane. `epsilon` and `tiny` are
/// EPSILON and the smallest normal number.
///
/// Of N each product carries 4 roundings, of D 3; the bounds have 6 of each, to outweigh terms of second
/// order and their own rounding, and, as they are above the smallest normal number, what underflow loses, 3
/// times 2⁻²⁴ (`f64`: 2⁻⁵³) of that at the most. Then |N − t·D| ≤ δN + |t|·δD
/// for the exact numerator and denominator and the computed t, and where D's sign is certain t lies on
/// that side of an end of the range on which it seems to be if it is further off than that over |D|, and
/// than its own rounding.
#[inline(always)]
pub(crate) fn certain<V: Coordinates>(
    ray: &Ray<V>,
    plane: &Plane<V>,
    epsilon: V::Scalar,
    tiny: V::Scalar,
) -> Certain<V::Scalar> {
    let Plane { normal, offset } = *plane;
    let numerator = offset - normal.dot(ray.origin);
    let denominator = normal.dot(ray.direction);
    let t = numerator / denominator;

    let sizes = normal.abs();
    let roundings = epsilon * t.lit(3.0);
    let numerator_error = roundings * (offset.abs() + sizes.dot(ray.origin.abs()));
    let denominator_error = roundings * sizes.dot(ray.direction.abs());
    let steepness = denominator.abs();
    let error = numerator_error + t.abs() * (denominator_error + roundings * steepness);

    let within = (t - ray.t_min).min(ray.t_max - t);
    let is_certain = tiny.lt(numerator_error.min(denominator_error))
        & denominator_error.lt(steepness)
        & error.lt((within * steepness).abs())
        & ray.t_min.le(ray.t_max);
    Certain { open: !is_certain, hit: is_certain & t.lit(0.0).lt(within), t }
}

/// Which stage decides a case, for measurements: 0 are floats, 2 are integers.
#[doc(hidden)]
#[must_use]
pub fn stage<V: Vector>(ray: &Ray<V>, plane: &Plane<V>) -> usize {
    if certain(ray, plane, V::Scalar::EPSILON, V::Scalar::MIN_POSITIVE).open { 2 } else { 0 }
}

/// The outcome where floats leave it open, and for bad input.
#[cold]
#[inline(never)]
pub(crate) fn undecided<V: Vector>(ray: &Ray<V>, plane: &Plane<V>) -> Option<PlaneHit<V::Scalar>> {
    Some(match decide::outcome(ray, plane)? {
        PlaneHit::Contained => PlaneHit::Contained,
        PlaneHit::At(t) => PlaneHit::At(ray.nearest_in_range(t)),
    })
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

    /// The numerator, or a product in it, over- or underflows.
    #[test]
    fn products_beyond_the_exponents() {
        let along = |normal: f32, origin: f32, direction: f32| {
            let plane = Plane { normal: Vec3::X * normal, offset: 0.0 };
            intersect(&Ray::new(Vec3::X * origin, Vec3::X * direction), &plane)
        };
        let at = |t: f32| {
            let neighbours = [t.next_down(), t, t.next_up()];
            move |hit| neighbours.map(|t| Some(PlaneHit::At(t))).contains(&hit)
        };
        assert!(at(1e30)(along(1e20, -1e20, 1e-10)));
        assert_eq!(along(1e-30, 1e-20, 1e20), None);
        assert!(at(1e-40)(along(1e-30, -1e-20, 1e20)));
        let tiny = 2.0_f32.powi(-121);
        let line = Ray::new(Vec3::X * 2.0_f32.powi(-40), Vec3::NEG_X);
        let plane = Plane { normal: Vec3::X * tiny, offset: 0.0 };
        assert!(at(2.0_f32.powi(-40))(intersect(&line, &plane)));
        for normal in [1.0, 1e9, 1e-9, 1e38] {
            let plane = Plane { normal: Vec3::new(normal, -normal, 0.0), offset: 0.0 };
            let ray = Ray::new(Vec3::new(1e30, 1e30, 0.0), Vec3::new(1.0, 1.0, 0.0));
            assert_eq!(intersect(&ray, &plane), Some(PlaneHit::Contained), "{normal}");
        }
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
            (1e-20, 1e10),
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
