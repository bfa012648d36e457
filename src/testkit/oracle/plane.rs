//! Ray against plane: one dot product above another.

use std::cmp::Ordering;

use super::integer::{Grid, Integer, Ratio, dot};
use super::{Frame, Query, Ray, decide, is_finite};

/// What a ray and a plane have in common.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum PlaneVerdict {
    /// No common point.
    Miss,
    /// One point.
    At,
    /// The whole ray.
    Contained,
}

/// A ray against the plane `normal · p = offset`; the normal has any length but zero.
#[must_use]
pub fn plane(ray: &Ray, normal: [f64; 3], offset: f64) -> PlaneVerdict {
    Case::new(ray, normal, offset).map_or(PlaneVerdict::Miss, |case| decide(&case))
}

/// Whether `normal · p` is less than the offset, equal or greater at the point of the line at a finite t.
#[must_use]
pub fn plane_side(ray: &Ray, normal: [f64; 3], offset: f64, t: f64) -> Option<Ordering> {
    Case::new(&ray.with_range(t, t), normal, offset).map(|case| decide(&Side(case)))
}

struct Case {
    normal: [f64; 3],
    offset: f64,
    frame: Frame,
    normals: Grid,
    offsets: Grid,
}

impl Case {
    fn new(ray: &Ray, normal: [f64; 3], offset: f64) -> Option<Self> {
        if !ray.is_valid() || !is_finite(&[normal]) || normal == [0.0; 3] || !offset.is_finite() {
            return None;
        }
        let mut frame = Frame::new(ray, []);
        let normals = Grid::through(&normal);
        // An offset is a normal times a point: where it is finer than their grids allow, the points give way.
        let own = Grid::through(&[offset]);
        if offset != 0.0 {
            frame.points = frame.points.refined(own.exponent - normals.exponent);
        }
        let exponent = frame.points.exponent + normals.exponent;
        let bits = if offset == 0.0 { 0 } else { own.refined(exponent).bits };
        Some(Self { normal, offset, frame, normals, offsets: Grid { exponent, bits } })
    }

    /// The offset's height above the origin, and how far a step of the direction climbs.
    fn height_and_slope<I: Integer>(&self) -> (I, I) {
        let normal = self.normals.vector::<I>(self.normal);
        let offset = self.offsets.integer::<I>(self.offset);
        let height = offset - dot(&normal, &self.frame.points.vector(self.frame.ray.origin));
        (height, dot(&normal, &self.frame.direction()))
    }
}

impl Query for Case {
    type Answer = PlaneVerdict;

    fn bits(&self) -> u32 {
        let (p, d) = (self.frame.points.bits, self.frame.directions.bits);
        let t = self.frame.range_bits();
        t + t.max(self.normals.bits + p.max(d) + 3).max(self.offsets.bits + 1)
    }

    fn answer<I: Integer>(&self) -> PlaneVerdict {
        let (height, slope) = self.height_and_slope::<I>();
        if slope.signum() == 0 {
            return if height.signum() == 0 { PlaneVerdict::Contained } else { PlaneVerdict::Miss };
        }
        if self.frame.range().contains(&Ratio::new(height, slope)) {
            PlaneVerdict::At
        } else {
            PlaneVerdict::Miss
        }
    }
}

/// The side of the plane on which the first t of the range lies.
struct Side(Case);

impl Query for Side {
    type Answer = Ordering;

    fn bits(&self) -> u32 {
        // Two terms of the length of those that the verdict compares.
        self.0.bits() + 1
    }

    fn answer<I: Integer>(&self) -> Ordering {
        let (height, slope) = self.0.height_and_slope::<I>();
        let t = self.0.frame.range::<I>().enter;
        (slope * &t.num).cmp(&(height * &t.den))
    }
}

#[cfg(test)]
mod tests {
    use super::super::{
        assert_limit_holds, assert_tiers_agree, extreme_point, lattice_point, on_lattices,
    };
    use super::*;

    const INF: f64 = f64::INFINITY;

    fn ray(origin: [f64; 3], direction: [f64; 3]) -> Ray {
        Ray { origin, direction, t_min: 0.0, t_max: INF }
    }

    #[test]
    fn a_ray_crosses_lies_in_or_misses_a_plane() {
        let down = ray([0.0, 0.0, 3.0], [0.1, 0.0, -2.0]);
        assert_eq!(plane(&down, [0.0, 0.0, 7.0], 0.0), PlaneVerdict::At);
        assert_eq!(plane(&down, [0.0, 0.0, 7.0], 28.0), PlaneVerdict::Miss);
        assert_eq!(plane(&down.with_range(1.5, 1.5), [0.0, 0.0, 1.0], 0.0), PlaneVerdict::At);
        assert_eq!(
            plane(&down.with_range(-INF, 1.5f64.next_down()), [0.0, 0.0, 1.0], 0.0),
            PlaneVerdict::Miss
        );
        let level = ray([0.0, 0.0, 3.0], [1.0, 5e-324, 0.0]);
        assert_eq!(plane(&level, [0.0, 0.0, 1.0], 3.0), PlaneVerdict::Contained);
        assert_eq!(plane(&level, [0.0, 0.0, 1.0], 3f64.next_up()), PlaneVerdict::Miss);
        assert_eq!(plane(&level, [0.0, 1e-300, 1.0], 3.0), PlaneVerdict::At);
        // The offset is finer than the product of the other grids.
        assert_eq!(
            plane(&ray([0.0; 3], [4.0, 0.0, 0.0]), [2.0, 0.0, 0.0], 5e-324),
            PlaneVerdict::At
        );
    }

    #[test]
    fn bad_input_misses_a_plane() {
        let good = ray([0.0; 3], [0.0, 0.0, 1.0]);
        assert_eq!(plane(&good, [0.0, -0.0, 0.0], 0.0), PlaneVerdict::Miss);
        assert_eq!(plane(&good, [0.0, INF, 0.0], 0.0), PlaneVerdict::Miss);
        assert_eq!(plane(&good, [0.0, 0.0, 1.0], f64::NAN), PlaneVerdict::Miss);
        assert_eq!(plane(&good.with_range(1.0, -1.0), [0.0, 0.0, 1.0], 0.0), PlaneVerdict::Miss);
        assert_eq!(
            plane(&good.with_range(f64::NAN, INF), [0.0, 1.0, 0.0], 0.0),
            PlaneVerdict::Miss
        );
        assert_eq!(plane(&good.with_range(INF, INF), [0.0, 1.0, 0.0], 0.0), PlaneVerdict::Miss);
        assert_eq!(plane(&ray([0.0; 3], [0.0; 3]), [0.0, 1.0, 0.0], 0.0), PlaneVerdict::Miss);
        assert_eq!(plane(&ray([f64::NAN; 3], [1.0; 3]), [0.0, 1.0, 0.0], 0.0), PlaneVerdict::Miss);
    }

    #[test]
    fn a_line_has_two_sides_of_a_plane() {
        let down = ray([0.0, 0.0, 3.0], [0.0, 0.1, -2.0]);
        let side = |t| plane_side(&down, [0.0, 0.0, 7.0], 7.0, t);
        assert_eq!(side(1.0), Some(Ordering::Equal));
        assert_eq!(side(1f64.next_down()), Some(Ordering::Greater));
        assert_eq!(side(1f64.next_up()), Some(Ordering::Less));
        assert_eq!(side(f64::NAN), None);
    }

    #[test]
    fn tiers_agree_and_powers_of_two_change_nothing() {
        on_lattices(1, 30_000, [3, 1 << 23], |rng, radius, ray| {
            let normal = lattice_point(rng, radius);
            let offset = f64::from(rng.i32(-9..=9)) / 4.0;
            let verdict = plane(&ray, normal, offset);
            if let Some(case) = Case::new(&ray, normal, offset) {
                assert_tiers_agree(&case);
            }
            // Between two sides, or on one, the plane is met.
            let at = |t| plane_side(&ray, normal, offset, t);
            if let (Some(a), Some(b)) = (at(ray.t_min), at(ray.t_max))
                && ray.t_min.is_finite()
                && ray.t_max.is_finite()
                && ray.t_min <= ray.t_max
            {
                assert_eq!(a == b && a.is_ne(), verdict == PlaneVerdict::Miss);
            }
            let scaled = Ray { origin: ray.origin.map(|x| x * 2f64.powi(70)), ..ray };
            let scaled = Ray { direction: ray.direction.map(|x| x * 2f64.powi(70)), ..scaled };
            assert_eq!(
                plane(&scaled, normal.map(|x| x * 2f64.powi(-90)), offset * 2f64.powi(-20)),
                verdict
            );
        });
    }

    #[test]
    fn the_fast_tier_holds_the_largest_numbers_it_admits() {
        for (points, directions, normals) in [(63, 60, 60), (57, 61, 62)] {
            assert_limit_holds(14, 3_000, |rng| {
                let mut extreme = |bits| extreme_point(rng, bits);
                let ray = ray(extreme(points), extreme(directions)).with_range(-INF, INF);
                Case::new(&ray, extreme(normals), 0.0).expect("valid")
            });
        }
    }
}
