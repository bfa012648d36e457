//! Ray against plane, decided exactly.

use core::cmp::Ordering;

use super::PlaneHit;
use crate::exact::grid::Grid;
use crate::exact::integer::{Capacity, Integer, Large, Narrow, Small, dot};
use crate::exact::interval::{Interval, Parameter};
use crate::exact::wide;
use crate::shape::{Plane, Ray};
use crate::vector::Vector;

/// How the ray meets the plane in its closed range, for every finite input, with t within an ulp, in `f64`;
/// it may be infinite or, rounded, beyond an end of the range. `None` for a miss and for bad input.
///
/// With N = offset − n·o and D = n·d: if D = 0, contained where N = 0; else at t = N/D, which is compared
/// with the range as a fraction.
pub(super) fn outcome<V: Vector>(ray: &Ray<V>, plane: &Plane<V>) -> Option<PlaneHit<f64>> {
    if !(ray.is_valid() && ray.has_range() && plane.is_valid()) {
        return None;
    }
    let problem = Problem {
        origin: wide(ray.origin).to_array(),
        direction: wide(ray.direction).to_array(),
        t_min: ray.t_min.into(),
        t_max: ray.t_max.into(),
        normal: wide(plane.normal).to_array(),
        offset: plane.offset.into(),
    };
    problem.outcome()
}

struct Problem {
    origin: [f64; 3],
    direction: [f64; 3],
    t_min: f64,
    t_max: f64,
    normal: [f64; 3],
    offset: f64,
}

/// What each group of numbers is counted on: heights are products of a normal and a point.
#[derive(Clone, Copy)]
struct Grids {
    points: Grid,
    directions: Grid,
    normals: Grid,
    heights: Grid,
}

impl Problem {
    fn outcome(&self) -> Option<PlaneHit<f64>> {
        let points = Grid::through(&self.origin);
        let directions = Grid::through(&self.direction);
        let normals = Grid::through(&self.normal);
        let heights = normals.product(points).joined(Grid::through(&[self.offset]));
        let grids = Grids { points, directions, normals, heights };
        // Three products and the offset; three products times a float.
        let bits = (heights.bits() + 3).max(normals.bits() + directions.bits() + 2 + 53);
        match Capacity::of(bits) {
            Capacity::Narrow => self.decide::<Narrow>(grids),
            Capacity::Small => self.decide::<Small>(grids),
            Capacity::Large => self.decide::<Large>(grids),
        }
    }

    fn decide<I: Integer>(&self, grids: Grids) -> Option<PlaneHit<f64>> {
        let Grids { points, directions, normals, heights } = grids;
        let normal = normals.vector::<I>(self.normal);
        let height = dot(&normal, &points.vector(self.origin));
        let finer = normals.exponent() + points.exponent() - heights.exponent();
        let height = heights.integer::<I>(self.offset).sub(&height.shl(finer.unsigned_abs()));
        let slope = dot(&normal, &directions.vector(self.direction));
        if slope.sign() == Ordering::Equal {
            return height.is_zero().then_some(PlaneHit::Contained);
        }
        let unit = heights.exponent() - normals.exponent() - directions.exponent();
        let range = Interval::new(self.t_min, self.t_max, unit);
        let t = Parameter::fraction(height, slope);
        range.contains(&t).then(|| PlaneHit::At(t.to_float(unit)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DVec3, Vec3};

    #[test]
    fn three_outcomes_up_to_the_ends_of_the_range() {
        let plane = Plane { normal: Vec3::new(0.0, 3.0, 0.0), offset: 1.0 };
        let down = Ray::new(Vec3::new(5.0, 1.0, 0.0), Vec3::NEG_Y);
        // t = 2/3 is no float.
        let near = 2.0_f32 / 3.0;
        assert_eq!(outcome(&down.with_range(near, near), &plane), None);
        let around = down.with_range(near.next_down(), near.next_up());
        let Some(PlaneHit::At(t)) = outcome(&around, &plane) else { panic!("it crosses") };
        // Within an ulp, 2⁻⁵³, of 2/3, which is as near to the literal.
        assert!((t - 2.0 / 3.0).abs() <= f64::EPSILON);
        assert_eq!(outcome(&Ray { direction: Vec3::X, ..down }, &plane), None);
        assert_eq!(outcome(&down.with_range(2.0, 1.0), &plane), None);
        assert_eq!(outcome(&down, &Plane { normal: Vec3::ZERO, offset: 0.0 }), None);
        // From a point at zero, without an offset.
        let through = Plane { normal: Vec3::new(1e-30, 0.0, 0.0), offset: 0.0 };
        let ray = Ray::new(Vec3::ZERO, Vec3::new(0.0, 1e30, 0.0));
        assert_eq!(outcome(&ray, &through), Some(PlaneHit::Contained));
    }

    /// The largest numbers and the smallest in one sum: the products do not fit in floats.
    #[test]
    fn the_ends_of_the_exponents() {
        let (large, small) = (f64::MAX, f64::from_bits(1));
        let normal = DVec3::new(large, small, -large);
        let along = |origin: DVec3| Ray::new(origin, DVec3::new(large, 0.0, large));
        let on_plane = |origin, offset| outcome(&along(origin), &Plane { normal, offset });
        assert_eq!(on_plane(DVec3::new(large, 0.0, large), 0.0), Some(PlaneHit::Contained));
        assert_eq!(on_plane(DVec3::new(large, small, large), 0.0), None);
        assert_eq!(on_plane(DVec3::new(large, 1.0, large), small), Some(PlaneHit::Contained));
        let down =
            Ray { direction: DVec3::NEG_Y * small, ..along(DVec3::new(large, small, large)) };
        let at = |t| outcome(&down.with_range(t, t), &Plane { normal, offset: 0.0 });
        assert_eq!((at(1.0), at(1.0_f64.next_down())), (Some(PlaneHit::At(1.0)), None));
    }
}
