//! Ray against box, decided exactly.
//!
//! The slabs of [`super::slab`] (T. L. Kay, J. T. Kajiya, 1986) with an error bound; integers of a fixed
//! capacity decide what it leaves open.

use super::{AabbHit, BoxRay, slab};
use crate::exact::grid::Grid;
use crate::exact::integer::{Capacity, Integer, Large, Narrow, Small};
use crate::exact::interval::Interval;
use crate::exact::wide;
use crate::shape::Aabb;
use crate::vector::{Number, Scalar, Vector};

/// Whether the ray meets the box, in the closed range of the ray.
///
/// Per axis, t = (plane − o) / d; the last entry is compared with the first exit, in the end as
/// fractions: two fractions by two products. An axis to which the ray is parallel asks instead
/// whether o lies between the planes.
///
/// **Grade: exact**, for every finite ray and every box, whose bounds may be infinite.
///
/// An empty box, a box with a NaN, a zero direction, a NaN or infinite origin or direction, an empty
/// range: `false`.
///
/// ```
/// use isect::{Aabb, Ray, glam::Vec3, ray::aabb::{BoxRay, exact}};
///
/// let aabb = Aabb::new(Vec3::ZERO, Vec3::ONE);
/// let ray = Ray::new(Vec3::new(-1.0, 0.0, 0.5), Vec3::new(1.0, 1.0, 0.0));
/// assert!(exact::hits(&BoxRay::new(&ray), &aabb), "through an edge");
/// let steeper = Ray { direction: Vec3::new(1.0, 1.000_000_1, 0.0), ..ray };
/// assert!(!exact::hits(&BoxRay::new(&steeper), &aabb));
/// ```
#[inline]
#[must_use]
pub fn hits<V: Vector>(ray: &BoxRay<V>, aabb: &Aabb<V>) -> bool {
    certain(ray, aabb).unwrap_or_else(|| decide(ray, aabb))
}

/// The verdict if it is certain.
///
/// Each end is one of the range, exactly, or within 3.1u of the exact t, u = EPSILON/2, but for what
/// underflow loses. So their difference has the right sign if it is more than 2·3.1u times the lesser of
/// them, and a little: the greater one is then no further off. What is beyond the largest float counts as
/// that: two such are not told apart.
#[inline(always)]
fn certain<V: Vector>(ray: &BoxRay<V>, aabb: &Aabb<V>) -> Option<bool> {
    let (near, far) = slab::slabs(ray, aabb);
    let largest = V::Scalar::MAX;
    let t_enter = near.fold_max(ray.t_first).min(largest);
    let t_exit = far.fold_min(largest.min(ray.t_max)).max(-largest);
    let gap = t_exit - t_enter;
    let least = t_enter.abs().min(t_exit.abs());
    let bound = least * (V::Scalar::EPSILON * least.lit(4.0)) + V::Scalar::MIN_POSITIVE;
    (gap.abs() > bound).then_some(aabb.min.all_le(aabb.max) & V::Scalar::ZERO.lt(gap))
}

/// Which stage decides a case, for measurements: 0 are floats, 2 are integers.
#[doc(hidden)]
#[must_use]
pub fn stage<V: Vector>(ray: &BoxRay<V>, aabb: &Aabb<V>) -> usize {
    if certain(ray, aabb).is_some() { 0 } else { 2 }
}

/// Where the ray enters and leaves the box, and through which faces: [`slab::intersect`] with the verdict
/// of [`hits`].
///
/// **Grade: exact** for hit or miss; t_enter and t_exit are within 3.1u of the exact ones, u = EPSILON/2, or
/// an end of the range, and the faces are those of the entry and exit so computed. Where the exact ones
/// are closer than that and the computed ones are in the wrong order, they are reported as equal. A t
/// beyond the largest float is that.
///
/// What [`hits`] takes for a miss: `None`.
///
/// ```
/// use isect::{Aabb, Face, Ray, glam::Vec3, ray::aabb::{BoxRay, exact}};
///
/// let aabb = Aabb::new(Vec3::splat(-1.0), Vec3::splat(1.0));
/// let ray = BoxRay::new(&Ray::new(Vec3::new(-3.0, 0.0, 0.0), Vec3::X));
/// let hit = exact::intersect(&ray, &aabb).expect("it is aimed at the centre");
/// assert_eq!((hit.t_enter, hit.t_exit, hit.enter_face), (2.0, 4.0, Some(Face::NegX)));
/// ```
#[inline]
#[must_use]
pub fn intersect<V: Vector>(ray: &BoxRay<V>, aabb: &Aabb<V>) -> Option<AabbHit<V::Scalar>> {
    if !hits(ray, aabb) {
        return None;
    }
    let (_, mut hit) = slab::crossing(ray, aabb);
    if !(hit.t_enter.is_finite() && hit.t_exit.is_finite()) {
        hit = within_floats(ray, aabb, hit);
    }
    // The ends in the range, and in order.
    hit.t_enter = hit.t_enter.min(ray.t_max);
    hit.t_exit = hit.t_exit.max(hit.t_enter);
    Some(hit)
}

/// Brings an end that is infinite because it is beyond the largest float back to that, with the face of
/// the first axis on which the box is bounded there. Where it is on none the end is infinite.
#[cold]
fn within_floats<V: Vector>(
    ray: &BoxRay<V>,
    aabb: &Aabb<V>,
    hit: AabbHit<V::Scalar>,
) -> AabbHit<V::Scalar> {
    let largest = V::Scalar::MAX;
    let bounded = |far_side: u8| {
        (0..3).find_map(|axis| {
            let side = ray.entry_side[axis] ^ far_side;
            let plane = if side == 0 { aabb.min } else { aabb.max }.component(axis);
            let crosses = ray.direction.component(axis) != V::Scalar::ZERO && plane.is_finite();
            let face = slab::FACES[2 * axis + usize::from(side)];
            if crosses { face } else { None }
        })
    };
    let AabbHit { mut t_enter, mut t_exit, mut enter_face, mut exit_face } = hit;
    if let (false, Some(face)) = (t_enter.is_finite(), bounded(0)) {
        (t_enter, enter_face) = (t_enter.max(-largest).min(largest), Some(face));
    }
    if let (false, Some(face)) = (t_exit.is_finite(), bounded(1)) {
        (t_exit, exit_face) = (t_exit.max(-largest).min(largest), Some(face));
    }
    AabbHit { t_enter, t_exit, enter_face, exit_face }
}

/// Decides a case that the bound leaves open, or one with bad input.
#[cold]
#[inline(never)]
fn decide<V: Vector>(ray: &BoxRay<V>, aabb: &Aabb<V>) -> bool {
    let problem = Problem {
        origin: wide(-ray.negated_origin).to_array(),
        direction: wide(ray.direction).to_array(),
        t_min: ray.t_min.into(),
        t_max: ray.t_max.into(),
        min: wide(aabb.min).to_array(),
        max: wide(aabb.max).to_array(),
    };
    problem.hits()
}

struct Problem {
    origin: [f64; 3],
    direction: [f64; 3],
    t_min: f64,
    t_max: f64,
    min: [f64; 3],
    max: [f64; 3],
}

impl Problem {
    fn hits(&self) -> bool {
        // Bounds and ranges that lie at infinity hold nothing. (The range of a bad ray starts at a NaN.)
        let reaches =
            |low: f64, high: f64| low <= high && low < f64::INFINITY && f64::NEG_INFINITY < high;
        if !(reaches(self.t_min, self.t_max)
            && self.min.iter().zip(&self.max).all(|(&low, &high)| reaches(low, high)))
        {
            return false;
        }
        let mut points = Grid::through(&self.origin);
        for bound in self.min.iter().chain(&self.max).filter(|bound| bound.is_finite()) {
            points = points.joined(Grid::through(&[*bound]));
        }
        let directions = Grid::through(&self.direction);
        let (p, d) = (points.bits(), directions.bits());
        // A difference times a direction; a direction times a float.
        match Capacity::of((p + 1 + d).max(d + 53)) {
            Capacity::Narrow => self.intervals_overlap::<Narrow>(points, directions),
            Capacity::Small => self.intervals_overlap::<Small>(points, directions),
            Capacity::Large => self.intervals_overlap::<Large>(points, directions),
        }
    }

    fn intervals_overlap<I: Integer>(&self, points: Grid, directions: Grid) -> bool {
        let unit = points.exponent() - directions.exponent();
        let mut range = Interval::<I>::new(self.t_min, self.t_max, unit);
        for axis in 0..3 {
            let origin = points.integer::<I>(self.origin[axis]);
            let direction = directions.integer::<I>(self.direction[axis]);
            // o + t·d − min ≥ 0 and max − o − t·d ≥ 0
            if self.min[axis].is_finite() {
                range.clip(&origin.sub(&points.integer(self.min[axis])), &direction);
            }
            if self.max[axis].is_finite() {
                range.clip(&points.integer::<I>(self.max[axis]).sub(&origin), &direction.neg());
            }
        }
        !range.is_empty()
    }
}
