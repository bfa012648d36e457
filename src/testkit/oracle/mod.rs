//! Exact answers to every intersection query, to hold the floating-point kernels against.
//!
//! A finite float is an integer times a power of two. The points of one case are counted on a common grid, the direction
//! on another; the verdict is then a matter of signs of integer polynomials, with no division and no root. `i128` does
//! where a bound on the bit lengths rules overflow out, big integers elsewhere: one generic body serves both.
//!
//! All sets are closed, and so is the range of t. Bad input (NaN, an infinite point or direction, a zero direction, an
//! empty range or box) is a miss. Single-precision values are passed as the doubles they equal.

mod aabb;
mod integer;
mod plane;
mod sphere;
mod triangle;
mod triangle_aabb;

pub use aabb::{aabb, aabb_enter_in, aabb_exit_in, aabb_if_moved};
pub use plane::{PlaneVerdict, plane, plane_side};
pub use sphere::{sphere, sphere_side};
pub use triangle::{
    TriangleVerdict, triangle, triangle_front, triangle_t_in, triangle_u_in, triangle_v_in,
};
pub use triangle_aabb::{triangle_aabb_apart, triangle_aabb_clip, triangle_aabb_sat};

use num_bigint::BigInt;

use integer::{Grid, I128_BITS, Integer, Interval, Vector, ratio_bits, sub};

/// The points `origin + t · direction` with t in the closed range from `t_min` to `t_max`, either of which may be infinite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// The point at t = 0.
    pub origin: [f64; 3],
    /// The way from t = 0 to t = 1, of any length but zero.
    pub direction: [f64; 3],
    /// The first t.
    pub t_min: f64,
    /// The last t.
    pub t_max: f64,
}

impl Ray {
    /// Whether origin and direction define a line.
    fn has_line(&self) -> bool {
        is_finite(&[self.origin, self.direction]) && self.direction != [0.0; 3]
    }

    /// Whether a finite t is in range.
    fn has_range(&self) -> bool {
        self.t_min <= self.t_max && self.t_min < f64::INFINITY && self.t_max > f64::NEG_INFINITY
    }

    /// Whether the ray has any point.
    pub(super) fn is_valid(&self) -> bool {
        self.has_line() && self.has_range()
    }

    /// The same line with another range.
    fn with_range(self, t_min: f64, t_max: f64) -> Self {
        Self { t_min, t_max, ..self }
    }

    /// The same points in the opposite order: t counts the other way.
    #[cfg(test)]
    fn reversed(self) -> Self {
        let direction = self.direction.map(|x| -x);
        Self { direction, t_min: -self.t_max, t_max: -self.t_min, ..self }
    }
}

impl<V: crate::Vector> From<&crate::Ray<V>> for Ray {
    fn from(ray: &crate::Ray<V>) -> Self {
        Self {
            origin: super::shapes::array(ray.origin),
            direction: super::shapes::array(ray.direction),
            t_min: ray.t_min.into(),
            t_max: ray.t_max.into(),
        }
    }
}

/// Whether every coordinate is finite.
pub(super) fn is_finite(points: &[[f64; 3]]) -> bool {
    points.as_flattened().iter().all(|x| x.is_finite())
}

/// Whether a box has a point; one that lies at infinity has none.
pub(super) fn is_box(min: [f64; 3], max: [f64; 3]) -> bool {
    (0..3).all(|k| min[k] <= max[k] && min[k] < f64::INFINITY && max[k] > f64::NEG_INFINITY)
}

/// The integer frame of a case: points relative to the ray's origin on one grid, the direction on another.
///
/// With points in units of 2^p and directions in units of 2^q, `o + t·d` keeps its form when t counts in units of 2^(p − q).
#[derive(Clone, Copy)]
struct Frame {
    ray: Ray,
    points: Grid,
    directions: Grid,
}

impl Frame {
    /// The frame of a valid ray and a shape, which is given by its points.
    #[inline]
    fn new<const N: usize>(ray: &Ray, shape: [[f64; 3]; N]) -> Self {
        Self {
            ray: *ray,
            points: Grid::through(&ray.origin).joined(Grid::through(shape.as_flattened())),
            directions: Grid::through(&ray.direction),
        }
    }

    /// Points as seen from the ray's origin.
    #[inline]
    fn relative<I: Integer, const N: usize>(&self, points: [[f64; 3]; N]) -> [Vector<I>; N] {
        let origin = self.points.vector(self.ray.origin);
        points.map(|p| sub(&self.points.vector(p), &origin))
    }

    #[inline]
    fn direction<I: Integer>(&self) -> Vector<I> {
        self.directions.vector(self.ray.direction)
    }

    fn t_shift(&self) -> i32 {
        self.directions.exponent - self.points.exponent
    }

    fn interval<I: Integer>(&self, lo: f64, hi: f64) -> Interval<I> {
        Interval::new(lo, hi, self.t_shift())
    }

    /// The ray's own range.
    fn range<I: Integer>(&self) -> Interval<I> {
        self.interval(self.ray.t_min, self.ray.t_max)
    }

    /// The bit length of the ends of an interval of t.
    fn interval_bits(&self, lo: f64, hi: f64) -> u32 {
        ratio_bits(lo, self.t_shift()).max(ratio_bits(hi, self.t_shift()))
    }

    /// The bit length of the ends of the ray's own range.
    fn range_bits(&self) -> u32 {
        self.interval_bits(self.ray.t_min, self.ray.t_max)
    }
}

/// Whether a bit length is safe in the fast tier.
fn fits_i128(bits: u32) -> bool {
    bits <= I128_BITS
}

/// What is asked about a case, in integers of which the length is known beforehand.
trait Query {
    type Answer: PartialEq + std::fmt::Debug;

    /// An upper bound on the bit length of everything that is computed.
    fn bits(&self) -> u32;

    fn answer<I: Integer>(&self) -> Self::Answer;
}

/// Answers in the fast tier where it is safe.
fn decide<Q: Query>(query: &Q) -> Q::Answer {
    if fits_i128(query.bits()) { query.answer::<i128>() } else { query.answer::<BigInt>() }
}

/// Asserts that the tiers agree about a case that the fast one admits.
#[cfg(test)]
fn assert_tiers_agree<Q: Query>(query: &Q) {
    assert!(fits_i128(query.bits()));
    assert_eq!(query.answer::<i128>(), query.answer::<BigInt>());
}

/// Asserts that the fast tier is right about cases that need all of its bits.
#[cfg(test)]
fn assert_limit_holds<Q: Query>(seed: u64, cases: u32, random: impl Fn(&mut fastrand::Rng) -> Q) {
    let mut rng = fastrand::Rng::with_seed(seed);
    for _ in 0..cases {
        let query = random(&mut rng);
        assert_eq!(query.bits(), I128_BITS);
        assert_tiers_agree(&query);
    }
}

/// Checks rays on lattices of two sizes in turn, each with the radius of its lattice.
#[cfg(test)]
fn on_lattices(
    seed: u64,
    cases: u32,
    radii: [i32; 2],
    mut check: impl FnMut(&mut fastrand::Rng, i32, Ray),
) {
    let mut rng = fastrand::Rng::with_seed(seed);
    for radius in radii.into_iter().cycle().take(cases as usize) {
        let ray = lattice_ray(&mut rng, radius);
        check(&mut rng, radius, ray);
    }
}

/// A point with integer coordinates of at most `radius`.
#[cfg(test)]
fn lattice_point(rng: &mut fastrand::Rng, radius: i32) -> [f64; 3] {
    [0; 3].map(|_| f64::from(rng.i32(-radius..=radius)))
}

/// A point with coordinates of ±1 and of nearly ±2^bits, which need a grid of so many bits, mostly the latter.
#[cfg(test)]
fn extreme_point(rng: &mut fastrand::Rng, bits: i32) -> [f64; 3] {
    let most = 2f64.powi(bits).next_down().floor();
    let mut point = [0; 3].map(|_| if rng.bool() { most } else { -most });
    point[rng.usize(..3)] = 1.0;
    point
}

/// A ray with integer coordinates and a closed, half-open or unbounded range.
#[cfg(test)]
fn lattice_ray(rng: &mut fastrand::Rng, radius: i32) -> Ray {
    let bound = |rng: &mut fastrand::Rng| f64::from(rng.i32(-16..=16)) / 8.0;
    let (a, b) = (bound(rng), bound(rng));
    let (t_min, t_max) = match rng.u8(..4) {
        0 => (0.0, f64::INFINITY),
        1 => (f64::NEG_INFINITY, f64::INFINITY),
        2 => (f64::NEG_INFINITY, a),
        _ => (a.min(b), a.max(b)),
    };
    let (origin, direction) = (lattice_point(rng, radius), lattice_point(rng, radius));
    Ray { origin, direction, t_min, t_max }
}

#[cfg(test)]
mod tests {
    use std::array::from_fn;

    use super::*;

    /// Where two shapes are the same set of points, so must be the verdicts, though their oracles share no formula.
    #[test]
    fn equal_sets_get_equal_verdicts() {
        let mut rng = fastrand::Rng::with_seed(8);
        for _ in 0..60_000 {
            let radius = rng.i32(1..=4);
            let ray = lattice_ray(&mut rng, radius);
            let (a, b) = (lattice_point(&mut rng, radius), lattice_point(&mut rng, radius));
            let (min, max): ([f64; 3], [f64; 3]) =
                (from_fn(|k| a[k].min(b[k])), from_fn(|k| a[k].max(b[k])));

            // A flat box is two triangles, which may be segments or points.
            let flat = rng.usize(..3);
            let top: [f64; 3] = from_fn(|k| if k == flat { min[k] } else { max[k] });
            let corner = |axis: usize| from_fn(|k| if k == axis { top[k] } else { min[k] });
            let (p, q) = (corner((flat + 1) % 3), corner((flat + 2) % 3));
            let halves = [[min, p, top], [min, top, q]].map(|half| triangle(&ray, half).hits());
            assert_eq!(halves.contains(&true), aabb(&ray, min, top), "{ray:?} {min:?} {top:?}");

            // A ray that crosses the triangle's plane does so at one point of that plane.
            let crosses = triangle_t_in(&ray, [min, p, q], ray.t_min, ray.t_max) == Some(true);
            let normal: [f64; 3] = from_fn(|k| if k == flat { 1.0 } else { 0.0 });
            let is_proper = p != min && q != min && ray.is_valid();
            let at = plane(&ray, normal, min[flat]) == PlaneVerdict::At;
            assert!(!is_proper || crosses == at, "{ray:?} {min:?} {p:?} {q:?}");

            // A point is a box, a sphere and a triangle.
            let is_hit = aabb(&ray, a, a);
            assert_eq!(sphere(&ray, a, 0.0), is_hit);
            assert_eq!(triangle(&ray, [a; 3]).hits(), is_hit);

            // A segment is a ray and a triangle.
            let (from, to) = (lattice_point(&mut rng, radius), lattice_point(&mut rng, radius));
            let segment = Ray {
                origin: from,
                direction: from_fn(|k| to[k] - from[k]),
                t_min: 0.0,
                t_max: 1.0,
            };
            if from != to {
                assert_eq!(triangle_aabb_sat([from, to, from], min, max), aabb(&segment, min, max));
            }
        }
    }
}
