//! Ray against box, decided exactly.
//!
//! The reciprocals of a [`BoxRay`] bound each t from both sides: bounds moved outward tell most
//! misses, as in [`super::conservative`], bounds moved inward most hits. Integers of a fixed capacity
//! decide the rest.

use super::{BoxRay, conservative};
use crate::exact::grid::Grid;
use crate::exact::integer::{LARGE, SMALL, is_small};
use crate::exact::interval::Interval;
use crate::shape::Aabb;
use crate::vector::{Number, Vector};

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
    conservative::hits(ray, aabb) && (certainly_hits(ray, aabb) || decide(ray, aabb))
}

/// Whether the last entry, moved towards later times, is still before the first exit moved towards
/// earlier ones.
///
/// With u = EPSILON/2: a computed difference is the exact one times a factor within 1 ∓ u, and so is the
/// reciprocal before its steps; `far_inverse` has made three steps up, each by at least the factor 1 + u,
/// `near_inverse` two down. As (1 − u)²·(1 + u)³ > 1 > (1 + u)²·(1 − u)², a difference's products with the
/// two, before their own rounding, enclose t, whatever its sign. Rounding keeps order: of two rounded
/// numbers one is less than the other only if it was so before. (Equal ones may have been in any order, so
/// that touching is not certain. A subnormal reciprocal is off by half a step, which the steps outweigh as well.)
#[inline]
fn certainly_hits<V: Vector>(ray: &BoxRay<V>, aabb: &Aabb<V>) -> bool {
    if ray.extreme {
        return false;
    }
    let (near, far) = ray.differences(aabb);
    let enter = near.scaled(ray.near_inverse).max(near.scaled(ray.far_inverse));
    let exit = far.scaled(ray.near_inverse).min(far.scaled(ray.far_inverse));
    // For a parallel ray in a plane of the box a bound is 0 · ∞, a NaN, which folding drops.
    enter.fold_max(ray.t_min).lt(exit.fold_min(ray.t_max))
}

/// A ray that is not refused by [`conservative::hits`], so that origin and direction are finite, and
/// a box that is not empty.
#[cold]
fn decide<V: Vector>(ray: &BoxRay<V>, aabb: &Aabb<V>) -> bool {
    let array = |v: V| [v.x().into(), v.y().into(), v.z().into()];
    let problem = Problem {
        origin: array(ray.origin),
        direction: array(ray.direction),
        t_min: ray.t_min.into(),
        t_max: ray.t_max.into(),
        min: array(aabb.min),
        max: array(aabb.max),
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
        // Bounds and ranges that lie at infinity hold nothing.
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
        if is_small((p + 1 + d).max(d + 53)) {
            self.intervals_overlap::<SMALL>(points, directions)
        } else {
            self.intervals_overlap::<LARGE>(points, directions)
        }
    }

    fn intervals_overlap<const L: usize>(&self, points: Grid, directions: Grid) -> bool {
        let unit = points.exponent() - directions.exponent();
        let mut range = Interval::<L>::new(self.t_min, self.t_max, unit);
        for axis in 0..3 {
            let origin = points.integer::<L>(self.origin[axis]);
            let direction = directions.integer::<L>(self.direction[axis]);
            // o + t·d − min ≥ 0 and max − o − t·d ≥ 0
            if self.min[axis].is_finite() {
                range.clip(&origin.sub(&points.integer(self.min[axis])), &direction);
            }
            if self.max[axis].is_finite() {
                range.clip(&points.integer(self.max[axis]).sub(&origin), &direction.neg());
            }
        }
        !range.is_empty()
    }
}
