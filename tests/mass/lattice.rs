//! Integers that make hard cases, and the floats that they become.

use fastrand::Rng;
use isect::{Ray, Scalar, Vector};

use crate::support::{scalar, vector};

pub type Point = [i64; 3];

pub fn is_single<V: Vector>() -> bool {
    size_of::<V::Scalar>() == 4
}

/// `a` + `times` · `b`
pub fn sum(a: Point, b: Point, times: i64) -> Point {
    [a[0] + times * b[0], a[1] + times * b[1], a[2] + times * b[2]]
}

pub fn pick<T: Copy>(rng: &mut Rng, choices: &[T]) -> T {
    choices[rng.usize(..choices.len())]
}

/// A number of at most this magnitude.
pub fn within(rng: &mut Rng, most: i64) -> i64 {
    between(rng, -most, most)
}

/// A number in a closed range.
pub fn between(rng: &mut Rng, first: i64, last: i64) -> i64 {
    // The high half of the product; that some numbers come up a little more often does not matter here.
    let count = last.abs_diff(first) + 1;
    first + ((u128::from(rng.u64(..)) * u128::from(count)) >> 64) as i64
}

/// ±1, or another power of two that is no more than 2^`bits`.
pub fn step(rng: &mut Rng, bits: u32) -> i64 {
    let length = 1 << if rng.u8(..4) == 0 { 0 } else { rng.u32(0..=bits) };
    if rng.bool() { length } else { -length }
}

/// A cube of lattice points: a small one, where coincidences are common, one of any size, or most of what is exact;
/// about zero or far from it.
#[derive(Clone, Copy)]
pub struct Space {
    pub center: Point,
    pub radius: i64,
    /// The bits of the radius.
    pub bits: u32,
}

impl Space {
    /// With coordinates up to 2^`bits`.
    pub fn random(rng: &mut Rng, most_bits: u32) -> Self {
        let (bits, radius) = match rng.u8(..8) {
            0 => (2, between(rng, 1, 4)),
            1..=3 => {
                let bits = rng.u32(3..most_bits);
                (bits, 1 << bits)
            }
            _ => {
                let bits = most_bits - rng.u32(0..3);
                (bits, 1 << bits)
            }
        };
        let room = (1 << most_bits) - radius;
        let is_far = rng.u8(..4) == 0;
        let center = [(); 3].map(|()| if is_far { within(rng, room) } else { 0 });
        Self { center, radius, bits }
    }

    pub fn point(&self, rng: &mut Rng) -> Point {
        self.center.map(|x| x + within(rng, self.radius))
    }

    /// A vector between points, about half as long as the cube is wide.
    pub fn vector(&self, rng: &mut Rng) -> Point {
        [(); 3].map(|()| within(rng, self.radius))
    }

    /// Two vectors that are one unit off being parallel, as seen along an axis: there p × q = 1.
    pub fn unimodular(&self, rng: &mut Rng, axis: usize) -> [Point; 2] {
        let m = within(rng, self.radius / 2);
        let turned = |x, y, z| {
            let mut v = [x, y, z];
            v.rotate_right((axis + 1) % 3);
            v
        };
        let p = turned(m, m + 1, within(rng, self.radius));
        let q = turned(m - 1, m, within(rng, self.radius));
        match rng.u8(..4) {
            0 => [p, sum(q, p, pick(rng, &[-2, -1, 1]))],
            1 => [q, p],
            _ => [p, q],
        }
    }
}

/// Leaves a point where it is, or, seven times in eight, moves it by a step along one axis.
pub fn nudged(rng: &mut Rng, mut p: Point, bits: u32) -> Point {
    if rng.u8(..8) != 0 {
        p[rng.usize(..3)] += step(rng, bits);
    }
    p
}

/// The same number: all integers here are exact.
pub fn double(x: i64) -> f64 {
    x as f64
}

/// 2^`exponent`, which may be subnormal.
fn power(exponent: i32) -> f64 {
    if exponent < -1022 {
        f64::from_bits(1 << (exponent + 1074))
    } else {
        f64::from_bits(((exponent + 1023) as u64) << 52)
    }
}

/// By which powers of two the lattices of points and of directions are multiplied, and which sign their zeros have.
#[derive(Clone, Copy)]
pub struct Scale {
    points: i32,
    directions: i32,
    zero: f64,
}

impl Scale {
    /// Brings most cases to lengths between one and the lattice's own. Of the others, one in 16, half come close to the lengths
    /// below which the filter of triangles takes a length for a longer one; others to those above which it is undecided, to
    /// subnormal numbers and to the largest; and one in 64 lies anywhere that keeps integers of so many bits exact: those have
    /// the kernels count in their longest integers.
    pub fn random<V: Vector>(rng: &mut Rng, bits: u32) -> Self {
        let zero = if rng.bool() { 0.0 } else { -0.0 };
        let (lowest, highest, floor, cap) =
            if is_single::<V>() { (-149, 127, -36, 37) } else { (-1074, 1023, -300, 301) };
        let bits = bits as i32;
        let (first, last) = match rng.u16(..1024) {
            0 => (lowest, highest - bits),
            1..=9 => (lowest, lowest + bits),
            10..=24 => (cap - bits - 2, cap),
            25..=33 => (highest - 2 * bits, highest - bits),
            34..=63 => (floor - bits - 2, floor),
            _ => (-bits, 0),
        };
        Self { points: rng.i32(first..=last), directions: rng.i32(first..=last), zero }
    }

    fn vector<V: Vector>(&self, p: Point, exponent: i32) -> V {
        let power = power(exponent);
        vector(p.map(|x| if x == 0 { self.zero } else { double(x) * power }))
    }

    pub fn point<V: Vector>(&self, p: Point) -> V {
        self.vector(p, self.points)
    }

    pub fn direction<V: Vector>(&self, d: Point) -> V {
        self.vector(d, self.directions)
    }

    /// A length on the lattice of points.
    pub fn length<T: Scalar>(&self, x: f64) -> T {
        scalar(x * power(self.points))
    }

    /// A normal and an offset, the latter on the lattice of points times that of normals, of twice as many bits.
    pub fn normal_and_offset<V: Vector>(
        &self,
        rng: &mut Rng,
        normal: Point,
        offset: i64,
        bits: u32,
    ) -> (V, V::Scalar) {
        let (lowest, highest) = if is_single::<V>() { (-149, 127) } else { (-1074, 1023) };
        let bits = bits as i32;
        let first = lowest.max(lowest - self.points);
        let last = (highest - bits).min(highest - 2 * bits - self.points);
        let exponent = if self.points == 0 { 0 } else { rng.i32(first..=last) };
        (self.vector(normal, exponent), scalar(double(offset) * power(self.points + exponent)))
    }

    /// A ray with a range that may begin or end about t, which is counted in steps of both lattices.
    pub fn ray<V: Vector>(
        &self,
        rng: &mut Rng,
        origin: Point,
        direction: Point,
        t: f64,
        is_short: bool,
    ) -> Ray<V> {
        // In two steps: the quotient of the powers may be no float.
        let exponent = self.points - self.directions;
        let scaled = |t: f64| t * power(exponent / 2) * power(exponent - exponent / 2);
        let (t_min, t_max) = range(rng, t, is_short, scaled);
        Ray::new(self.point(origin), self.direction(direction)).with_range(t_min, t_max)
    }
}

/// A range that may begin or end at t, or some floats beside it.
///
/// For fractions in `i128` the long mantissas of double precision do not leave much room: where told, t is cut short, and
/// the next of the short numbers stands for the next float.
fn range<T: Scalar>(rng: &mut Rng, t: f64, is_short: bool, scaled: impl Fn(f64) -> f64) -> (T, T) {
    let (zero, infinity) = (T::ZERO, T::INFINITY);
    let t = if t.is_nan() { 1.0 } else { t };
    let at = |rng: &mut Rng, is_beside: bool| {
        let steps = if is_beside { if rng.bool() { 1 } else { rng.u32(1..=64) } } else { 0 };
        let is_up = rng.bool();
        if is_short {
            let unit = 1 << 45;
            let (bits, offset) = (t.to_bits() & !(unit - 1), u64::from(steps) * unit);
            let bits = if is_up { bits + offset } else { bits.saturating_sub(offset) };
            return zero.lit(scaled(f64::from_bits(bits)));
        }
        let start: T = zero.lit(scaled(t));
        (0..steps).fold(start, |t, _| if is_up { t.next_up() } else { t.next_down() })
    };
    match rng.u8(..16) {
        0..=5 => (zero, infinity),
        6..=7 => (-infinity, infinity),
        8 => (-infinity, at(rng, false)),
        9 => (at(rng, false), infinity),
        10 => {
            let t = at(rng, false);
            if rng.bool() { (t, t) } else { (zero, t) }
        }
        11 => (at(rng, true), infinity),
        12 => (-infinity, at(rng, true)),
        13 => (at(rng, true), at(rng, true)),
        14 => (zero.lit(scaled(-1.0)), zero.lit(scaled(1.0))),
        _ => {
            let end = |rng: &mut Rng| zero.lit(scaled(double(within(rng, 64)) / 16.0));
            (end(rng), end(rng))
        }
    }
}
