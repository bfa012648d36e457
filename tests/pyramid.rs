//! Claim: no pyramid leaves out a shape that touches it, or takes one in whole that is not, and a split one loses nothing.
//!
//! Shapes are made on lattices, most of them to touch a side, an edge or the apex exactly, and moved a step. What a pyramid holds
//! is decided in exact arithmetic, from the normals that it stores, by other means than its kernels': these look for an axis that
//! separates, the oracle for a point that is in both.

use std::cmp::Ordering;
use std::fmt::Debug;
use std::ops::{Add, Mul, Neg, Sub};
use std::time::Instant;

use fastrand::Rng;
use isect::glam::{DVec3, Vec3, Vec3A};
use isect::overlap::{Containment, pyramid_aabb, pyramid_sphere, pyramid_triangle};
use isect::{Aabb, Pyramid, Scalar, Sphere, Triangle, Vector};
use num_bigint::BigInt;

use crate::support::{array, for_every_vector, name, scalar, vector};

/// A number that is counted with exactly.
trait Exact:
    Clone
    + Ord
    + From<i64>
    + Neg<Output = Self>
    + for<'a> Add<&'a Self, Output = Self>
    + for<'a> Sub<&'a Self, Output = Self>
    + for<'a> Mul<&'a Self, Output = Self>
{
    /// `mantissa · 2^shift`
    fn shifted(mantissa: i64, shift: u32) -> Self {
        (0..shift).fold(Self::from(mantissa), |x, _| x * &Self::from(2))
    }

    fn sign(&self) -> Ordering {
        self.cmp(&Self::from(0))
    }

    fn is_negative(&self) -> bool {
        self.sign() == Ordering::Less
    }
}

/// Overflow panics in the profile of the tests.
impl Exact for i128 {
    fn shifted(mantissa: i64, shift: u32) -> Self {
        Self::from(mantissa) << shift
    }
}

impl Exact for BigInt {
    fn shifted(mantissa: i64, shift: u32) -> Self {
        Self::from(mantissa) << shift
    }
}

fn dot<I: Exact>(a: &[I; 3], b: &[I; 3]) -> I {
    a[0].clone() * &b[0] + &(a[1].clone() * &b[1]) + &(a[2].clone() * &b[2])
}

fn cross<I: Exact>(a: &[I; 3], b: &[I; 3]) -> [I; 3] {
    let component = |x: usize, y: usize| a[x].clone() * &b[y] - &(a[y].clone() * &b[x]);
    [component(1, 2), component(2, 0), component(0, 1)]
}

/// A vector times the least power of two that makes it one of integers.
fn integers<I: Exact>(v: [f64; 3]) -> [I; 3] {
    let parts = v.map(|x| {
        let biased = (x.to_bits() >> 52) & 0x7ff;
        let fraction = x.to_bits() & ((1 << 52) - 1);
        let mantissa = if biased == 0 { fraction } else { fraction | 1 << 52 } as i64;
        let zeros = mantissa.trailing_zeros();
        let mantissa = if mantissa == 0 { 0 } else { mantissa >> zeros };
        let exponent = biased.max(1) as i32 + if mantissa == 0 { 0 } else { zeros as i32 };
        (if x < 0.0 { -mantissa } else { mantissa }, exponent)
    });
    let lowest = parts.iter().filter(|part| part.0 != 0).map(|part| part.1).min().unwrap_or(0);
    parts.map(|(mantissa, exponent)| {
        I::shifted(mantissa, if mantissa == 0 { 0 } else { (exponent - lowest) as u32 })
    })
}

/// A pyramid by its sides, with its apex at zero.
struct Solid<I> {
    sides: [[I; 3]; 4],
}

impl<I: Exact> Solid<I> {
    fn new<V: Vector>(pyramid: &Pyramid<V>) -> Self {
        Self { sides: pyramid.normals.map(|normal| integers(array(normal))) }
    }

    /// The heights of a point above the sides.
    fn heights(&self, p: &[I; 3]) -> [I; 4] {
        self.sides.each_ref().map(|side| dot(side, p))
    }

    fn contains(&self, p: &[I; 3]) -> bool {
        !self.heights(p).iter().any(I::is_negative)
    }

    /// Whether a triangle, given by the heights of its vertices, has a point in the pyramid. If so, one is a vertex, or lies on an
    /// edge and a side, or on two sides: its weights are tried.
    fn touches_triangle(&self, heights: [&[I; 4]; 3]) -> bool {
        let rows: [[I; 3]; 4] =
            std::array::from_fn(|i| std::array::from_fn(|j| heights[j][i].clone()));
        if rows.iter().any(|row| row.iter().all(I::is_negative)) {
            return false;
        }
        let is_inside = |weights: &[I; 3]| rows.iter().all(|row| !dot(row, weights).is_negative());
        let zero = || I::from(0);
        for j in 0..3 {
            let mut weights = [zero(), zero(), zero()];
            weights[j] = I::from(1);
            if is_inside(&weights) {
                return true;
            }
        }
        for row in &rows {
            for (j, k) in [(0, 1), (1, 2), (2, 0)] {
                if row[j].sign() != row[k].sign().reverse() || row[j].sign() == Ordering::Equal {
                    continue;
                }
                let magnitude = |x: &I| if x.is_negative() { -x.clone() } else { x.clone() };
                let mut weights = [zero(), zero(), zero()];
                weights[j] = magnitude(&row[k]);
                weights[k] = magnitude(&row[j]);
                if is_inside(&weights) {
                    return true;
                }
            }
        }
        for (i, k) in [(0, 1), (1, 2), (2, 3), (3, 0), (0, 2), (1, 3)] {
            let mut weights = cross(&rows[i], &rows[k]);
            if weights.iter().any(I::is_negative) {
                weights = weights.map(|x| -x);
            }
            let is_zero = weights.iter().all(|x| x.sign() == Ordering::Equal);
            if !is_zero && !weights.iter().any(I::is_negative) && is_inside(&weights) {
                return true;
            }
        }
        false
    }

    fn triangle(&self, vertices: &[[I; 3]; 3]) -> Containment {
        let heights = vertices.each_ref().map(|v| self.heights(v));
        let [a, b, c] = &heights;
        if heights.as_flattened().iter().all(|x| !x.is_negative()) {
            Containment::Inside
        } else if self.touches_triangle([a, b, c]) {
            Containment::Partial
        } else {
            Containment::Outside
        }
    }

    /// A box touches a pyramid, which has no end, if one of its faces does.
    fn aabb(&self, min: &[I; 3], max: &[I; 3]) -> Containment {
        let heights: [[I; 4]; 8] = std::array::from_fn(|corner| {
            let component =
                |k: usize| if corner >> k & 1 == 0 { min[k].clone() } else { max[k].clone() };
            self.heights(&[component(0), component(1), component(2)])
        });
        let is_in = |heights: &[I; 4]| !heights.iter().any(I::is_negative);
        if heights.iter().all(is_in) {
            return Containment::Inside;
        }
        let is_beyond = |i: usize| heights.iter().all(|heights| heights[i].is_negative());
        if (0..4).any(is_beyond) {
            return Containment::Outside;
        }
        if heights.iter().any(is_in) {
            return Containment::Partial;
        }
        let touches = (0..3).any(|axis| {
            let (u, v) = (1 << ((axis + 1) % 3), 1 << ((axis + 2) % 3));
            [0, 1 << axis].into_iter().any(|from| {
                [u, v].into_iter().any(|third| {
                    let corners = [from, from | u | v, from | third];
                    self.touches_triangle(corners.map(|corner| &heights[corner]))
                })
            })
        });
        if touches { Containment::Partial } else { Containment::Outside }
    }

    /// The point of the pyramid that is nearest to a centre outside is the apex, or its foot on an edge or a side.
    fn sphere(&self, center: &[I; 3], radius: &I) -> Containment {
        let heights = self.heights(center);
        let squares = self.sides.each_ref().map(|side| dot(side, side));
        let (r2, c2) = (radius.clone() * radius, dot(center, center));
        let is_near = |i: usize| heights[i].clone() * &heights[i] <= r2.clone() * &squares[i];
        let is_in = |i: usize| !heights[i].is_negative();
        if (0..4).all(is_in) {
            let is_inside =
                (0..4).all(|i| heights[i].clone() * &heights[i] >= r2.clone() * &squares[i]);
            return if is_inside { Containment::Inside } else { Containment::Partial };
        }
        if (0..4).any(|i| !is_in(i) && !is_near(i)) {
            return Containment::Outside;
        }
        let at_side = (0..4).any(|i| {
            // c − n·(n·c)/n², times n².
            let in_pyramid = (0..4).all(|k| {
                let foot = heights[k].clone() * &squares[i]
                    - &(heights[i].clone() * &dot(&self.sides[i], &self.sides[k]));
                !foot.is_negative()
            });
            in_pyramid && is_near(i)
        });
        let at_edge = || {
            (0..4).any(|i| {
                let edge = cross(&self.sides[i], &self.sides[(i + 1) % 4]);
                let along = dot(&edge, center);
                let (along2, length2) = (along.clone() * &along, dot(&edge, &edge));
                // |c|² − (e·c)²/|e|² ≤ r²
                !along.is_negative()
                    && self.contains(&edge)
                    && (c2.clone() - &r2) * &length2 <= along2
            })
        };
        if c2 <= r2 || at_side || at_edge() { Containment::Partial } else { Containment::Outside }
    }
}

type Point = [i64; 3];

/// `a + times · b`
fn sum(a: Point, b: Point, times: i64) -> Point {
    std::array::from_fn(|k| a[k] + times * b[k])
}

fn within(rng: &mut Rng, radius: i64) -> Point {
    [(); 3].map(|()| rng.i64(-radius..=radius))
}

/// Integers of which a case is made.
struct Lattice {
    /// The largest coordinate of a corner's direction.
    corners: i64,
    /// And of a shape as seen from the apex.
    points: i64,
    /// And of the apex.
    apex: i64,
}

/// A pyramid with its apex and its corners as integers, and the power of two that points are multiplied with.
struct Case<V: Vector> {
    pyramid: Pyramid<V>,
    apex: Point,
    corners: [Point; 4],
    exponent: i32,
}

impl<V: Vector> Case<V> {
    fn random(rng: &mut Rng, lattice: &Lattice) -> Self {
        let (lowest, highest) = if size_of::<V::Scalar>() == 4 { (-120, 90) } else { (-900, 900) };
        let exponent = if rng.u8(..4) == 0 { rng.i32(lowest..=highest) } else { 0 };
        loop {
            let radius = if rng.u8(..4) == 0 { 4 } else { lattice.corners };
            let corners = if rng.bool() {
                // As through a pixel: about one direction.
                let (third, width) = (radius / 2, (radius / 16).max(1));
                let (center, [a, b]) = (within(rng, third), [(); 2].map(|()| within(rng, width)));
                [[-1, -1], [1, -1], [1, 1], [-1, 1]]
                    .map(|[s, t]| sum(sum(center, a, s), b, t))
                    .map(|corner| sum(corner, within(rng, (width / 8).max(1)), 1))
            } else {
                [(); 4].map(|()| within(rng, radius))
            };
            let apex = if rng.bool() { [0; 3] } else { within(rng, lattice.apex) };
            let directions = corners.map(|c| point::<V>(c, rng.i32(0..=1) * exponent / 2));
            let directions = if rng.bool() { directions } else { corners.map(|c| point(c, 0)) };
            if let Some(pyramid) = Pyramid::new(point(apex, exponent), directions) {
                return Self { pyramid, apex, corners, exponent };
            }
        }
    }

    /// A point on an edge, in a side, in the pyramid, on a line or a plane of them, or anywhere; seen from the apex.
    fn point(&self, rng: &mut Rng, lattice: &Lattice) -> Point {
        let most = (lattice.points / lattice.corners / 4).max(2);
        let first = rng.usize(..4);
        let count = match rng.u8(..16) {
            0 => 0,
            1..=3 => 1,
            4..=7 => 2,
            8..=12 => 4,
            _ => return within(rng, lattice.points / 4),
        };
        let least = if count == 4 { 1 } else { 0 };
        let mut times = || {
            let first = if rng.u8(..4) == 0 { -most } else { least };
            rng.i64(first..=most)
        };
        let weights = [times(), times(), times(), times()];
        (0..count).fold([0; 3], |p, i| sum(p, self.corners[(first + i) % 4], weights[i]))
    }

    /// Leaves a point where it is, or moves it a step.
    fn nudged(rng: &mut Rng, mut p: Point) -> Point {
        if rng.u8(..4) != 0 {
            p[rng.usize(..3)] += if rng.bool() { 1 } else { -1 };
        }
        p
    }

    /// A point in the vector's own numbers.
    fn placed(&self, p: Point) -> V {
        point(sum(self.apex, p, 1), self.exponent)
    }
}

/// Integers times a power of two, which is exact.
fn point<V: Vector>(p: Point, exponent: i32) -> V {
    let half = exponent / 2;
    vector(p.map(|x| x as f64 * 2_f64.powi(half) * 2_f64.powi(exponent - half)))
}

fn exact<I: Exact>(p: Point) -> [I; 3] {
    p.map(I::from)
}

fn vertices<V: Vector>(rng: &mut Rng, case: &Case<V>, lattice: &Lattice) -> [Point; 3] {
    let at = |rng: &mut Rng| case.point(rng, lattice);
    let quarter = lattice.points / 8;
    let points = match rng.u8(..8) {
        // An edge of it meets an edge of the pyramid.
        0..=2 => {
            let (foot, way) = (case.corners[rng.usize(..4)], within(rng, quarter));
            let (before, beyond) = (rng.i64(0..=2), rng.i64(0..=1));
            [sum(foot, way, before), sum(foot, way, -beyond), at(rng)]
        }
        // The apex lies in its plane.
        3 => {
            let (a, b) = (within(rng, quarter), within(rng, quarter));
            [a, b, sum(a.map(|x| -x), b, -1)]
        }
        4 => [(); 3].map(|()| within(rng, lattice.points)),
        _ => [(); 3].map(|()| at(rng)),
    };
    points.map(|p| Case::<V>::nudged(rng, p))
}

/// What is counted, by the exact verdict.
#[derive(Debug, Default)]
struct Tally {
    outside: u64,
    partial: u64,
    inside: u64,
    /// `Partial` where the exact verdict is `Outside`, or `Inside`.
    undecided: [u64; 2],
}

impl Tally {
    fn count(&mut self, found: Containment, expected: Containment, case: impl FnOnce() -> String) {
        let cautious = found == Containment::Partial;
        match expected {
            Containment::Outside => {
                self.outside += 1;
                self.undecided[0] += u64::from(cautious);
            }
            Containment::Partial => self.partial += 1,
            Containment::Inside => {
                self.inside += 1;
                self.undecided[1] += u64::from(cautious);
            }
        }
        assert!(found == expected || cautious, "{found:?}, not {expected:?}: {}", case());
    }

    /// Prints the counts, of which each verdict has its share, and the cautious verdicts only few.
    fn report(&self, what: &str, vector: &str, start: Instant, cases: u64) {
        let few = if what == "sphere" { 5 } else { 40 };
        let seconds = start.elapsed().as_secs_f64();
        println!("{what} {vector:<6} {cases} cases: {self:?}, {seconds:.1} s");
        let Self { outside, partial, inside, undecided: [out, within] } = *self;
        assert_eq!(outside + partial + inside, cases);
        assert!(outside.min(partial) > cases / 8 && inside > cases / 100, "{self:?}");
        assert!(out + within > 0 && out * few < outside, "{self:?}");
    }
}

type Check<V> = fn(&mut Rng, &Lattice, &Case<V>, &mut Tally);

fn check_triangle<V: Vector, I: Exact>(
    rng: &mut Rng,
    lattice: &Lattice,
    case: &Case<V>,
    tally: &mut Tally,
) {
    let points = vertices(rng, case, lattice);
    let triangle = Triangle::from(points.map(|p| case.placed(p)));
    let expected = Solid::<I>::new(&case.pyramid).triangle(&points.map(exact));
    let found = pyramid_triangle::classify(&case.pyramid, &triangle);
    tally.count(found, expected, || format!("{:?} {triangle:?}", case.pyramid));
}

fn check_aabb<V: Vector, I: Exact>(
    rng: &mut Rng,
    lattice: &Lattice,
    case: &Case<V>,
    tally: &mut Tally,
) {
    let start = case.point(rng, lattice);
    let start = Case::<V>::nudged(rng, start);
    let size = rng.i64(1..=lattice.points / 2);
    let [min, max] = if rng.u8(..4) == 0 {
        let end = case.point(rng, lattice);
        [
            std::array::from_fn(|k| start[k].min(end[k])),
            std::array::from_fn(|k| start[k].max(end[k])),
        ]
    } else {
        // From the point to any side; flat now and then.
        let reach = [(); 3].map(|()| if rng.u8(..8) == 0 { 0 } else { rng.i64(0..=size) });
        let low: Point =
            std::array::from_fn(|k| if rng.bool() { start[k] } else { start[k] - reach[k] });
        [low, sum(low, reach, 1)]
    };
    let aabb = Aabb::new(case.placed(min), case.placed(max));
    let expected = Solid::<I>::new(&case.pyramid).aabb(&exact(min), &exact(max));
    let found = pyramid_aabb::classify(&case.pyramid, &aabb);
    tally.count(found, expected, || format!("{:?} {aabb:?}", case.pyramid));
}

fn check_sphere<V: Vector>(rng: &mut Rng, lattice: &Lattice, case: &Case<V>, tally: &mut Tally) {
    let center = case.point(rng, lattice);
    let center = Case::<V>::nudged(rng, center);
    let [x, y, z] = center.map(|x| x as f64);
    let c = DVec3::new(x, y, z);
    let as_double = |p: Point| DVec3::from_array(p.map(|x| x as f64));
    // To a side, an edge or the apex, within some roundings.
    let radius = match rng.u8(..8) {
        0..=2 => {
            let normal = DVec3::from_array(array(case.pyramid.normals[rng.usize(..4)]));
            normal.dot(c).abs() / normal.length()
        }
        3..=4 => {
            let edge = as_double(case.corners[rng.usize(..4)]);
            (c - edge * (edge.dot(c) / edge.length_squared()).max(0.0)).length()
        }
        5 => c.length(),
        _ => rng.f64() * lattice.points as f64 / 4.0,
    };
    // A multiple of 2^−shift, of no more bits than an i64 has; of single precision if its sphere is.
    let (unit, shift) = if size_of::<V::Scalar>() == 4 { (2_f64.powi(-24), 40) } else { (0.0, 22) };
    let fraction = 2_f64.powi(shift);
    let radius = radius.max(1.0) * (1.0 + unit * f64::from(rng.i32(-4..=4) << rng.u32(0..10)));
    let radius: V::Scalar = scalar((radius * fraction).round() / fraction);
    #[allow(clippy::cast_possible_truncation)] // a whole number, below 2⁶³
    let counted = |x: f64| BigInt::from((x * fraction) as i64);
    let exact_radius = counted(radius.into());
    let exact_center = center.map(|x| BigInt::from(x) << shift as u32);

    let scaled = point_times(V::splat(radius), case.exponent).x();
    let sphere = Sphere::new(case.placed(center), scaled);
    let expected = Solid::new(&case.pyramid).sphere(&exact_center, &exact_radius);
    let found = pyramid_sphere::classify(&case.pyramid, &sphere);
    tally.count(found, expected, || format!("{:?} {sphere:?}", case.pyramid));
}

fn run<V: Vector>(what: &str, check: Check<V>, lattice: &Lattice, cases: u64) {
    let (mut rng, mut tally) = (Rng::with_seed(11), Tally::default());
    let start = Instant::now();
    for _ in 0..cases {
        let case = Case::random(&mut rng, lattice);
        check(&mut rng, lattice, &case, &mut tally);
    }
    tally.report(what, name::<V>(), start, cases);
}

/// The height above a side has more bits than a float: 2·11 + 1 of the normal and 13 of the point, and three such in a
/// product, which is what 128 bits hold.
const SINGLE: Lattice = Lattice { corners: 1 << 11, points: 1 << 13, apex: 1 << 22 };
const DOUBLE: Lattice = Lattice { corners: 1 << 25, points: 1 << 30, apex: 1 << 50 };

fn triangles(single: u64, double: u64) {
    run::<Vec3>("triangle", check_triangle::<_, i128>, &SINGLE, single);
    run::<Vec3A>("triangle", check_triangle::<_, i128>, &SINGLE, single);
    run::<DVec3>("triangle", check_triangle::<_, BigInt>, &DOUBLE, double);
}

fn boxes(single: u64, double: u64) {
    run::<Vec3>("box", check_aabb::<_, i128>, &SINGLE, single);
    run::<Vec3A>("box", check_aabb::<_, i128>, &SINGLE, single);
    run::<DVec3>("box", check_aabb::<_, BigInt>, &DOUBLE, double);
}

fn spheres(single: u64, double: u64) {
    run::<Vec3>("sphere", check_sphere, &SINGLE, single);
    run::<Vec3A>("sphere", check_sphere, &SINGLE, single);
    run::<DVec3>("sphere", check_sphere, &DOUBLE, double);
}

/// Cases of each kernel and vector type: as many as the environment asks for.
fn many() -> u64 {
    std::env::var("ISECT_MASS_CASES").map_or(10_000_000, |text| text.parse().expect("a number"))
}

#[test]
fn triangles_are_culled_conservatively() {
    triangles(100_000, 20_000);
}

#[test]
fn boxes_are_culled_conservatively() {
    boxes(100_000, 20_000);
}

#[test]
fn spheres_are_culled_conservatively() {
    spheres(40_000, 20_000);
}

#[test]
#[ignore = "10,000,000 cases, or ISECT_MASS_CASES"]
fn many_triangles() {
    triangles(many(), many());
}

#[test]
#[ignore = "10,000,000 cases, or ISECT_MASS_CASES"]
fn many_boxes() {
    boxes(many(), many());
}

#[test]
#[ignore = "10,000,000 cases, or ISECT_MASS_CASES"]
fn many_spheres() {
    spheres(many(), many());
}

/// What lies in a pyramid lies in a child of it, and of that, by exact arithmetic.
#[test]
fn a_split_loses_no_point() {
    fn check<V: Vector, I: Exact>(lattice: &Lattice) {
        let (mut rng, mut found) = (Rng::with_seed(12), 0);
        for _ in 0..5_000 {
            let case = Case::<V>::random(&mut rng, lattice);
            let point = exact(case.point(&mut rng, lattice));
            let mut pyramid = case.pyramid;
            if !Solid::<I>::new(&pyramid).contains(&point) {
                continue;
            }
            found += 1;
            for _ in 0..6 {
                let child = pyramid
                    .split()
                    .into_iter()
                    .find(|child| Solid::<I>::new(child).contains(&point));
                pyramid = child.expect("a child has it");
            }
        }
        assert!(found > 1_000, "{found}");
    }
    check::<Vec3, BigInt>(&SINGLE);
    check::<Vec3A, BigInt>(&SINGLE);
    check::<DVec3, BigInt>(&DOUBLE);
}

/// The share of a pyramid that its children have is a quarter each where the corners' sum is exact.
#[test]
fn children_are_quarters() {
    let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
    let pyramid = Pyramid::new(Vec3::ZERO, corners.map(|(x, y)| Vec3::new(x, y, 1.0)));
    let mut level = vec![pyramid.expect("it is convex")];
    for depth in 1..=3 {
        level = level.iter().flat_map(Pyramid::split).collect();
        let cells = 1 << depth;
        for row in 0..cells {
            for column in 0..cells {
                let center = |i: i32| (2.0 * i as f32 + 1.0) / cells as f32 - 1.0;
                let point = Vec3::new(center(column), center(row), 1.0) * 3.0;
                assert_eq!(level.iter().filter(|child| child.contains(point)).count(), 1);
            }
        }
    }
    assert_eq!(level.len(), 64);
}

fn unit<V: Vector>() -> Pyramid<V> {
    let corners = [[-1.0, -1.0, 1.0], [1.0, -1.0, 1.0], [1.0, 1.0, 1.0], [-1.0, 1.0, 1.0]];
    Pyramid::new(V::ZERO, corners.map(vector)).expect("it is convex")
}

#[test]
fn powers_of_two_change_nothing() {
    fn check<V: Vector>() {
        let mut rng = Rng::with_seed(13);
        let exponents = if size_of::<V::Scalar>() == 4 {
            [-100, -60, 60, 124]
        } else {
            [-1000, -600, 600, 1020]
        };
        for _ in 0..2_000 {
            let random = |rng: &mut Rng| [(); 3].map(|()| 4.0 * rng.f64() - 1.0);
            let [a, b, c] = [(); 3].map(|()| vector::<V>(random(&mut rng)));
            let radius: V::Scalar = scalar(rng.f64());
            let apex = vector::<V>([0.25, -0.5, 0.125]);
            let verdicts = |exponent: i32| {
                let scaled = |v: V| point_times(v, exponent);
                let pyramid = Pyramid { apex: scaled(apex), ..unit::<V>() };
                let low = scaled(a.min(b));
                [
                    pyramid_triangle::classify(&pyramid, &[a, b, c].map(scaled).into()),
                    pyramid_aabb::classify(&pyramid, &Aabb::new(low, scaled(a.max(b)))),
                    pyramid_sphere::classify(
                        &pyramid,
                        &Sphere::new(scaled(c), scaled(V::splat(radius)).x()),
                    ),
                ]
            };
            for exponent in exponents {
                assert_eq!(
                    verdicts(exponent),
                    verdicts(0),
                    "{exponent} {a:?} {b:?} {c:?} {radius:?}"
                );
            }
        }
    }
    for_every_vector!(check);
}

fn point_times<V: Vector>(v: V, exponent: i32) -> V {
    vector(array(v).map(|x| x * 2_f64.powi(exponent / 2) * 2_f64.powi(exponent - exponent / 2)))
}

#[test]
fn bad_input_is_outside() {
    fn check<V: Vector>() {
        let pyramid = unit::<V>();
        let far = vector::<V>([0.0, 0.0, 4.0]);
        let (nan, infinity) = (V::Scalar::NAN, V::Scalar::INFINITY);
        let triangle =
            Triangle::new(far, far + vector([1.0, 0.0, 0.0]), far + vector([0.0, 1.0, 0.0]));
        let (aabb, sphere) = (Aabb::new(far, far), Sphere::new(far, V::Scalar::ONE));
        let verdicts = |pyramid: &Pyramid<V>| {
            [
                pyramid_triangle::classify(pyramid, &triangle),
                pyramid_aabb::classify(pyramid, &aabb),
                pyramid_sphere::classify(pyramid, &sphere),
            ]
        };
        assert_eq!(verdicts(&pyramid), [Containment::Inside; 3]);
        for bad in [nan, infinity, -infinity] {
            for axis in 0..3 {
                let replaced = |v: V| {
                    let component = |k: usize| if k == axis { bad } else { v.component(k) };
                    V::new(component(0), component(1), component(2))
                };
                for i in 0..3 {
                    let mut corners = <[V; 3]>::from(triangle);
                    corners[i] = replaced(corners[i]);
                    let found = pyramid_triangle::classify(&pyramid, &corners.into());
                    assert_eq!(found, Containment::Outside);
                }
                let at = Sphere::new(replaced(far), V::Scalar::ONE);
                assert_eq!(pyramid_sphere::classify(&pyramid, &at), Containment::Outside);
                let apex = Pyramid { apex: replaced(pyramid.apex), ..pyramid };
                assert_eq!(verdicts(&apex), [Containment::Outside; 3]);
                let mut sides = pyramid;
                sides.normals[axis] = replaced(sides.normals[axis]);
                assert_eq!(verdicts(&sides), [Containment::Outside; 3]);
            }
            for radius in [bad, -V::Scalar::ONE] {
                let found = pyramid_sphere::classify(&pyramid, &Sphere::new(far, radius));
                assert_eq!(found, Containment::Outside);
            }
        }
        for empty in [Aabb::EMPTY, Aabb::new(far, V::ZERO), Aabb::new(far, V::splat(nan))] {
            assert_eq!(pyramid_aabb::classify(&pyramid, &empty), Containment::Outside);
        }
        // Unbounded: it holds all, lies below, reaches in from below, is a part of the axis.
        let below = |top: f64| Aabb::new(V::NEG_INFINITY, vector([0.0, f64::INFINITY, top]));
        let whole = Aabb::new(V::NEG_INFINITY, V::INFINITY);
        let axis = Aabb::new(far, V::new(V::Scalar::ZERO, V::Scalar::ZERO, infinity));
        for (aabb, expected) in [
            (whole, Containment::Partial),
            (below(1.0), Containment::Partial),
            (axis, Containment::Inside),
            (Aabb::new(-axis.max, -axis.min), Containment::Outside),
        ] {
            assert_eq!(pyramid_aabb::classify(&pyramid, &aabb), expected, "{aabb:?}");
        }
        // Shapes so far away that differences of their coordinates overflow.
        let most = V::Scalar::MAX;
        let away = Pyramid { apex: V::new(-most, -most, -most), ..pyramid };
        let far = V::new(most, most, most);
        let found = pyramid_triangle::classify(&away, &Triangle::new(far, far, far));
        assert_eq!(found, Containment::Partial, "on two sides");
        let found = pyramid_sphere::classify(
            &away,
            &Sphere::new(V::new(V::Scalar::ZERO, V::Scalar::ZERO, most), most),
        );
        assert_eq!(found, Containment::Partial);
    }
    for_every_vector!(check);
}

/// A point, a segment and a triangle that pass the edge, the apex and a side as close as they can.
#[test]
fn each_kind_of_axis_separates() {
    fn check<V: Vector>() {
        let pyramid = unit::<V>();
        let classify = |corners: [[f64; 3]; 3]| {
            pyramid_triangle::classify(&pyramid, &corners.map(vector::<V>).into())
        };
        let outside = Containment::Outside;
        // No side's normal separates these: across an edge, and below the apex.
        assert_eq!(
            classify([[9.0, 0.0, 5.0], [0.0, 9.0, 5.0], [9.0, 9.0, 5.0]]),
            Containment::Partial
        );
        assert_eq!(classify([[11.0, 0.0, 5.0], [0.0, 11.0, 5.0], [9.0, 9.0, 5.0]]), outside);
        let below = [[9.0, 9.0, -1.0], [-9.0, 9.0, -1.0], [0.0, -9.0, -1.0]];
        assert_eq!(classify(below), outside);
        assert_eq!(classify(below.map(|[x, y, _]| [x, y, 0.5])), Containment::Partial);
        // A segment, and a point.
        assert_eq!(classify([[11.0, 0.0, 5.0], [0.0, 11.0, 5.0], [0.0, 11.0, 5.0]]), outside);
        assert_eq!(
            classify([[9.0, 0.0, 5.0], [0.0, 9.0, 5.0], [9.0, 0.0, 5.0]]),
            Containment::Partial
        );
        assert_eq!(classify([[0.0, 0.0, 1.0]; 3]), Containment::Inside);
        assert_eq!(classify([[0.0, 0.0, -1.0]; 3]), outside);

        let aabb = |low: [f64; 3], high: [f64; 3]| {
            pyramid_aabb::classify(&pyramid, &Aabb::new(vector::<V>(low), vector(high)))
        };
        assert_eq!(aabb([-9.0, -9.0, -2.0], [9.0, 9.0, -1.0]), outside);
        assert_eq!(aabb([-9.0, -9.0, -2.0], [9.0, 9.0, 1.0]), Containment::Partial);
        // Turned by 45 degrees about the axis, the box's edge is parallel to none of the sides.
        let turned = [[0.0, -2.0, 1.0], [2.0, 0.0, 1.0], [0.0, 2.0, 1.0], [-2.0, 0.0, 1.0]];
        let turned = Pyramid::new(V::ZERO, turned.map(vector)).expect("it is convex");
        let aabb = |x: f64| {
            let (low, high) = ([x, -9.0, 0.0], [x + 1.0, 9.0, 1.0]);
            pyramid_aabb::classify(&turned, &Aabb::new(vector::<V>(low), vector(high)))
        };
        assert_eq!((aabb(1.75), aabb(2.25)), (Containment::Partial, outside));
    }
    for_every_vector!(check);
}
