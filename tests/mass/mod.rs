//! Claim: the exact kernels are right about a billion cases and more.
//!
//! The cases are integers, times powers of two: rays exactly through edges and vertices or a step beside, origins on the
//! shape, ranges that end at the exact t or a float beside it. The oracle decides almost all of them in `i128`, so that there
//! is time for many. All kernels of a pair are asked about the same case; the three vector types take turns, part by part.
//!
//! ```text
//! ISECT_MASS_CASES=1000000000 ISECT_MASS_SEED=1 cargo test --release --test suite mass::triangle -- --exact --ignored --nocapture
//! ```
//!
//! Each part has a seed of its own, one more than the part before it, and prints a line when it is done: a run may be
//! stopped at any time, and go on from the next seed.

mod aabb;
mod lattice;
mod plane;
mod sphere;
mod triangle;
mod triangle_aabb;

use std::time::Instant;

use fastrand::Rng;
use isect::Vector;
use isect::glam::{DVec3, Vec3, Vec3A};

use crate::support::{array, name};

/// Cases under one seed.
const PART: u64 = 10_000_000;
/// The same where only a few are run.
const SMALL_PART: u64 = 30_000;

/// A pair of shapes with exact kernels.
trait Pair {
    const NAME: &'static str;
    /// Of the exact verdicts, as they are counted.
    const KINDS: &'static [&'static str];

    /// Makes a case, and asks the kernels about it.
    fn check<V: Vector>(rng: &mut Rng, tally: &mut Tally);
}

/// What is counted.
#[derive(Default)]
struct Tally {
    cases: u64,
    wrong: u64,
    /// By the kind of the exact verdict.
    verdicts: [u64; 6],
    /// Of one case in 64, by the stage that decides it.
    stages: [u64; 3],
}

impl Tally {
    fn add(&mut self, other: &Self) {
        self.cases += other.cases;
        self.wrong += other.wrong;
        for (count, more) in self.verdicts.iter_mut().zip(other.verdicts) {
            *count += more;
        }
        for (count, more) in self.stages.iter_mut().zip(other.stages) {
            *count += more;
        }
    }

    /// Counts a case with its verdict.
    fn count(&mut self, kind: usize, stage: impl FnOnce() -> usize) {
        if self.cases.is_multiple_of(64) {
            self.stages[stage()] += 1;
        }
        self.cases += 1;
        self.verdicts[kind] += 1;
    }

    /// Counts a wrong answer, and prints its case.
    fn wrong(&mut self, what: &str, case: &str) {
        self.wrong += 1;
        println!("WRONG: {what}\n{case}");
    }

    fn line<P: Pair>(&self) -> String {
        let Self { cases, wrong, verdicts, stages } = self;
        let counts = P::KINDS.iter().zip(verdicts).map(|(kind, count)| format!("{count} {kind}"));
        let counts = counts.collect::<Vec<_>>().join(", ");
        let sampled = stages.iter().sum::<u64>() as f64;
        let [_, second, third] = stages.map(|count| 100.0 * count as f64 / sampled);
        format!("{cases} cases, {wrong} wrong ({counts}; f64 {second:.1} %, integers {third:.1} %)")
    }
}

/// A case to the last bit: vectors, then scalars.
fn source<V: Vector>(vectors: &[V], scalars: &[V::Scalar]) -> String {
    let number = |x: f64| {
        if lattice::is_single::<V>() {
            format!("f32::from_bits({:#010x})", single_bits(x))
        } else {
            format!("f64::from_bits({:#018x})", x.to_bits())
        }
    };
    let vector = |&v: &V| {
        let [x, y, z] = array(v).map(number);
        format!("{}::new({x}, {y}, {z})", name::<V>())
    };
    let scalars = scalars.iter().map(|&x| number(x.into()));
    vectors.iter().map(vector).chain(scalars).collect::<Vec<_>>().join("\n")
}

#[expect(clippy::cast_possible_truncation, reason = "the number is one of single precision")]
fn single_bits(x: f64) -> u32 {
    (x as f32).to_bits()
}

/// Runs so many cases, in parts.
fn run<P: Pair>(cases: u64, first_seed: u64, part: u64) {
    let types = [
        (name::<Vec3>(), P::check::<Vec3> as fn(&mut Rng, &mut Tally)),
        (name::<Vec3A>(), P::check::<Vec3A>),
        (name::<DVec3>(), P::check::<DVec3>),
    ];
    let mut total = Tally::default();
    for (seed, index) in (first_seed..).zip(0..cases.div_ceil(part)) {
        let start = Instant::now();
        let (vector, check) = types[(seed % 3) as usize];
        let (mut rng, mut tally) = (Rng::with_seed(seed), Tally::default());
        for _ in 0..part.min(cases - index * part) {
            check(&mut rng, &mut tally);
        }
        let seconds = start.elapsed().as_secs_f64();
        println!("{} seed {seed} {vector}: {}, {seconds:.1} s", P::NAME, tally.line::<P>());
        total.add(&tally);
    }
    println!("{} in all: {}", P::NAME, total.line::<P>());
    assert_eq!((total.cases, total.wrong), (cases, 0), "{}", P::NAME);
    // Each kind of verdict is common, and so are cases that floats do not decide.
    for (kind, count) in P::KINDS.iter().zip(total.verdicts) {
        assert!(count > cases / 200, "{}: {count} {kind}", P::NAME);
    }
    assert!(total.stages[2] > cases / 64 / 20, "{}: {:?}", P::NAME, total.stages);
}

/// Runs as many cases as the environment asks for.
fn run_many<P: Pair>() {
    let number = |name: &str, default: u64| {
        std::env::var(name).map_or(default, |text| text.parse().expect("a number"))
    };
    run::<P>(number("ISECT_MASS_CASES", 6 * PART), number("ISECT_MASS_SEED", 1), PART);
}

fn run_a_few<P: Pair>() {
    run::<P>(6 * SMALL_PART, 1, SMALL_PART);
}

#[test]
fn a_few_of_each() {
    run_a_few::<triangle::RayTriangle>();
    run_a_few::<triangle_aabb::TriangleAabb>();
    run_a_few::<aabb::RayAabb>();
    run_a_few::<sphere::RaySphere>();
    run_a_few::<plane::RayPlane>();
}

#[test]
#[ignore = "60,000,000 cases, or ISECT_MASS_CASES from ISECT_MASS_SEED on"]
fn triangle() {
    run_many::<triangle::RayTriangle>();
}

#[test]
#[ignore = "60,000,000 cases, or ISECT_MASS_CASES from ISECT_MASS_SEED on"]
fn triangle_aabb() {
    run_many::<triangle_aabb::TriangleAabb>();
}

#[test]
#[ignore = "60,000,000 cases, or ISECT_MASS_CASES from ISECT_MASS_SEED on"]
fn aabb() {
    run_many::<aabb::RayAabb>();
}

#[test]
#[ignore = "60,000,000 cases, or ISECT_MASS_CASES from ISECT_MASS_SEED on"]
fn sphere() {
    run_many::<sphere::RaySphere>();
}

#[test]
#[ignore = "60,000,000 cases, or ISECT_MASS_CASES from ISECT_MASS_SEED on"]
fn plane() {
    run_many::<plane::RayPlane>();
}
