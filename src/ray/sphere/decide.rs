//! Ray against sphere, decided exactly: by signs, without a root.

use core::cmp::Ordering;

use crate::exact::grid::{Grid, Parts};
use crate::exact::integer::{Capacity, Integer, Large, Narrow, Small, dot, sub};
use crate::exact::wide;
use crate::shape::{Ray, Sphere};
use crate::vector::Vector;

/// Where the near and the far root of the ray's line lie: before the range (`Less`), in it (`Equal`) or
/// after it. `None` where the line misses the sphere; the roots of a tangent are equal.
///
/// With f from the origin to the centre, the line misses where (f·d)² − d²·(f² − r²) is negative. The
/// sign of g(t) = |t·d − f|² − r² tells whether a t is between the roots; where it is not, the sign of
/// (t·d − f)·d tells on which side.
///
/// Also `None` for a zero direction, a negative radius, a NaN or infinite field, an empty range.
pub(super) fn classify<V: Vector>(ray: &Ray<V>, sphere: &Sphere<V>) -> Option<[Ordering; 2]> {
    if !(ray.is_valid() && ray.has_range() && sphere.is_valid()) {
        return None;
    }
    Problem::new(
        wide(ray.origin).to_array(),
        wide(ray.direction).to_array(),
        wide(sphere.center).to_array(),
        sphere.radius.into(),
    )
    .classify(ray.t_min.into(), ray.t_max.into())
}

/// A line and a sphere.
struct Problem {
    origin: [f64; 3],
    direction: [f64; 3],
    center: [f64; 3],
    radius: f64,
    /// Of origin, centre and radius.
    points: Grid,
    directions: Grid,
}

impl Problem {
    fn new(origin: [f64; 3], direction: [f64; 3], center: [f64; 3], radius: f64) -> Self {
        let points = [&origin[..], &center, &[radius]].map(Grid::through);
        let points = points[0].joined(points[1]).joined(points[2]);
        let directions = Grid::through(&direction);
        Self { origin, direction, center, radius, points, directions }
    }

    fn classify(&self, t_min: f64, t_max: f64) -> Option<[Ordering; 2]> {
        let (p, d) = (self.points.bits(), self.directions.bits());
        let is_hit = match Capacity::of(2 * p + 2 * d + 8) {
            Capacity::Narrow => self.line_hits::<Narrow>(),
            Capacity::Small => self.line_hits::<Small>(),
            Capacity::Large => self.line_hits::<Large>(),
        };
        if !is_hit {
            return None;
        }
        let (from_start, from_end) = (self.roots_from(t_min), self.roots_from(t_max));
        Some([0, 1].map(|root| match (from_start[root], from_end[root]) {
            (Ordering::Less, _) => Ordering::Less,
            (_, Ordering::Greater) => Ordering::Greater,
            _ => Ordering::Equal,
        }))
    }

    /// From the origin to the centre.
    fn offset<I: Integer>(&self) -> [I; 3] {
        sub(&self.points.vector(self.center), &self.points.vector(self.origin))
    }

    /// Whether the discriminant is not negative.
    fn line_hits<I: Integer>(&self) -> bool {
        let (f, d) = (self.offset::<I>(), self.directions.vector::<I>(self.direction));
        let radius = self.points.integer::<I>(self.radius);
        let (a, b) = (dot(&d, &d), dot(&f, &d));
        let c = dot(&f, &f).sub(&radius.mul(&radius));
        b.mul(&b).cmp(&a.mul(&c)) != Ordering::Less
    }

    /// How the roots compare with t, of a line that hits.
    fn roots_from(&self, t: f64) -> [Ordering; 2] {
        if t.is_infinite() {
            return [if t < 0.0 { Ordering::Greater } else { Ordering::Less }; 2];
        }
        let grid = Grid::through(&[t]).product(self.directions).joined(self.points);
        let (w, d) = (grid.bits() + 2, self.directions.bits());
        // A square, three of these and the radius'; the product with the direction.
        let (side, slope) = match Capacity::of((2 * w + 3).max(w + d + 2)) {
            Capacity::Narrow => self.side::<Narrow>(t, grid),
            Capacity::Small => self.side::<Small>(t, grid),
            Capacity::Large => self.side::<Large>(t, grid),
        };
        match side {
            Ordering::Less => [Ordering::Less, Ordering::Greater],
            // Outside, or at a root, which is the near one if g still falls.
            Ordering::Greater => [slope.reverse(); 2],
            Ordering::Equal => [
                if slope == Ordering::Greater { Ordering::Less } else { Ordering::Equal },
                if slope == Ordering::Less { Ordering::Greater } else { Ordering::Equal },
            ],
        }
    }

    /// The signs of g and of its derivative at t, on a grid that holds t·d and the points.
    fn side<I: Integer>(&self, t: f64, grid: Grid) -> (Ordering, Ordering) {
        let Parts { negative, mantissa, exponent } = Parts::new(t).reduced();
        let t: I = Integer::from_limb(mantissa, negative);
        let d = self.directions.vector::<I>(self.direction);
        // Each is zero, or on a grid that is no finer.
        let to_grid = |exponent: i32| (exponent - grid.exponent()).unsigned_abs();
        let way = to_grid(exponent + self.directions.exponent());
        let point = to_grid(self.points.exponent());
        let way = d.each_ref().map(|d| if t.is_zero() { I::ZERO } else { d.mul(&t).shl(way) });
        let w = sub(&way, &self.offset::<I>().map(|f| f.shl(point)));
        let radius = self.points.integer::<I>(self.radius).shl(point);
        (dot(&w, &w).cmp(&radius.mul(&radius)), dot(&w, &d).sign())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use Ordering::{Equal, Greater, Less};
    use glam::{DVec3, Vec3};

    #[test]
    fn roots_before_in_and_after_the_range() {
        let unit = Sphere::new(Vec3::ZERO, 1.0);
        let ray = Ray::new(Vec3::new(0.0, 0.0, -3.0), Vec3::Z * 2.0);
        let roots = |t_min, t_max| classify(&ray.with_range(t_min, t_max), &unit);
        assert_eq!(roots(f32::NEG_INFINITY, f32::INFINITY), Some([Equal, Equal]));
        assert_eq!(roots(1.0, 2.0), Some([Equal, Equal]));
        assert_eq!(roots(1.0_f32.next_up(), 2.0_f32.next_down()), Some([Less, Greater]));
        assert_eq!(roots(0.0, 1.0), Some([Equal, Greater]));
        assert_eq!(roots(2.0, 9.0), Some([Less, Equal]));
        assert_eq!((roots(2.5, 9.0), roots(-1.0, 0.5)), (Some([Less; 2]), Some([Greater; 2])));
        assert_eq!(roots(2.0, 1.0), None);
        assert_eq!(classify(&ray, &Sphere::new(Vec3::ZERO, -1.0)), None);
        let point = Sphere::new(Vec3::ZERO, 0.0);
        assert_eq!(classify(&ray, &point), Some([Equal, Equal]));
        assert_eq!(classify(&ray.after(1.5), &point), Some([Less, Less]));
        let from_it = Ray::new(Vec3::ZERO, Vec3::X);
        assert_eq!(classify(&from_it, &point), Some([Equal, Equal]));
    }

    /// The largest numbers and the smallest in one sum.
    #[test]
    fn the_ends_of_the_exponents() {
        let (large, small) = (f64::MAX, f64::from_bits(1));
        let sphere = Sphere::new(DVec3::new(large, 0.0, 0.0), large);
        let ray = |y: f64, t: f64| {
            Ray::new(DVec3::new(-large, y, 0.0), DVec3::new(large, 0.0, 0.0)).with_range(t, large)
        };
        assert_eq!(classify(&ray(0.0, 1.0), &sphere), Some([Equal, Equal]));
        assert_eq!(classify(&ray(small, 1.0), &sphere), Some([Equal, Equal]));
        assert_eq!(classify(&ray(0.0, 1.0_f64.next_up()), &sphere), Some([Less, Equal]));
        assert_eq!(classify(&ray(large, 0.0), &sphere), Some([Equal, Equal]), "a tangent");
        let beside = Sphere::new(DVec3::new(large, -small, 0.0), large);
        assert_eq!(classify(&ray(large, 0.0), &beside), None);
        assert_eq!(classify(&ray(large, 2.0_f64.next_up()), &sphere), Some([Less, Less]));
    }
}
