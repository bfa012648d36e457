//! The cases of [`super::cases`] as proptest strategies.
//!
//! A case shrinks number by number: to 0, else to ±1, to an integer, to a number of 8 binary digits, as long as the property
//! still fails; and that again until nothing is left to do.
//!
//! ```
//! use isect::{glam::Vec3, ray::triangle::exact, testkit::{strategies, verdict}};
//! use proptest::prelude::*;
//!
//! proptest!(|((ray, triangle) in strategies::ray_triangle::<Vec3>())| {
//!     let expected = verdict::ray_triangle(&ray, &triangle).hits();
//!     prop_assert_eq!(exact::hits(&ray, &triangle), expected);
//! });
//! ```

use std::marker::PhantomData;

use fastrand::Rng;
use proptest::prelude::any;
use proptest::strategy::{NewTree, Strategy, ValueTree};
use proptest::test_runner::TestRunner;

use super::query::{self, Query};
use crate::{Aabb, Plane, Ray, Sphere, Triangle, Vector};

/// A ray and a plane: [`super::cases::ray_plane`].
pub fn ray_plane<V: Vector>() -> impl Strategy<Value = (Ray<V>, Plane<V>)> {
    Cases(PhantomData)
}

/// A ray and a sphere: [`super::cases::ray_sphere`].
pub fn ray_sphere<V: Vector>() -> impl Strategy<Value = (Ray<V>, Sphere<V>)> {
    Cases(PhantomData)
}

/// A ray and a box: [`super::cases::ray_aabb`].
pub fn ray_aabb<V: Vector>() -> impl Strategy<Value = (Ray<V>, Aabb<V>)> {
    Cases(PhantomData)
}

/// A ray and a triangle: [`super::cases::ray_triangle`].
pub fn ray_triangle<V: Vector>() -> impl Strategy<Value = (Ray<V>, Triangle<V>)> {
    Cases(PhantomData)
}

/// A triangle and a box: [`super::cases::triangle_aabb`].
pub fn triangle_aabb<V: Vector>() -> impl Strategy<Value = (Triangle<V>, Aabb<V>)> {
    Cases(PhantomData)
}

#[derive(Debug)]
struct Cases<Q>(PhantomData<Q>);

impl<Q: Query> Strategy for Cases<Q> {
    type Tree = Shrinking<Q>;
    type Value = Q;

    fn new_tree(&self, runner: &mut TestRunner) -> NewTree<Self> {
        let seed = any::<u64>().new_tree(runner)?.current();
        let query = query::random::<Q>(&mut Rng::with_seed(seed));
        let numbers = query.numbers();
        Ok(Shrinking { numbers, next: 0, last: None, has_progress: false, query: PhantomData })
    }
}

/// A case on its way to a simpler one.
#[derive(Debug)]
struct Shrinking<Q> {
    numbers: Vec<f64>,
    /// The next step of this pass: one after the other for each number.
    next: usize,
    /// The number changed last, and what it was.
    last: Option<(usize, f64)>,
    /// Whether a change of this pass was kept.
    has_progress: bool,
    query: PhantomData<Q>,
}

/// What a number becomes in each step.
const STEPS: [fn(f64) -> f64; 4] = [
    |_| 0.0,
    f64::signum,
    f64::trunc,
    // The sign, the exponent, and 7 of the mantissa's bits, to which the leading one comes.
    |x| f64::from_bits(x.to_bits() & !0 << 45),
];

impl<Q: Query> ValueTree for Shrinking<Q> {
    type Value = Q;

    fn current(&self) -> Q {
        Q::from_numbers(&self.numbers)
    }

    fn simplify(&mut self) -> bool {
        self.has_progress |= self.last.take().is_some();
        loop {
            if self.next == STEPS.len() * self.numbers.len() {
                // No number comes back to what it was: the passes have an end.
                if !std::mem::take(&mut self.has_progress) {
                    return false;
                }
                self.next = 0;
            }
            let (index, step) = (self.next / STEPS.len(), STEPS[self.next % STEPS.len()]);
            self.next += 1;
            let before = self.numbers[index];
            let after = step(before);
            // Infinities and NaN stay what they are, and so does zero: no step makes them simpler.
            if before.is_finite() && before != 0.0 && after != before {
                self.numbers[index] = after;
                self.last = Some((index, before));
                return true;
            }
        }
    }

    fn complicate(&mut self) -> bool {
        let Some((index, before)) = self.last.take() else { return false };
        self.numbers[index] = before;
        true
    }
}

#[cfg(test)]
mod tests {
    use proptest::test_runner::{Config, RngSeed, TestCaseError, TestError};

    use super::*;
    use crate::glam::{DVec3, Vec3};
    use crate::testkit::verdict;

    /// Runs a property from a fixed seed.
    fn run<S: Strategy>(
        strategy: &S,
        property: impl Fn(S::Value) -> Result<(), TestCaseError>,
    ) -> Result<(), TestError<S::Value>> {
        let config =
            Config { failure_persistence: None, rng_seed: RngSeed::Fixed(4), ..Config::default() };
        TestRunner::new(config).run(strategy, property)
    }

    #[test]
    fn a_failing_case_shrinks_as_far_as_it_fails() {
        // Any hit fails: what is left of it still hits, and is as simple as that allows.
        let failure = run(&ray_triangle::<Vec3>(), |(ray, triangle)| {
            if verdict::ray_triangle(&ray, &triangle).hits() {
                return Err(TestCaseError::fail("a hit"));
            }
            Ok(())
        });
        let Err(TestError::Fail(_, case)) = failure else { panic!("{failure:?}") };
        assert!(verdict::ray_triangle(&case.0, &case.1).hits());
        let numbers = case.numbers();
        assert!(numbers.iter().all(|x| x.is_infinite() || x.abs() <= 4.0), "{case:?}");
        for (index, &x) in numbers.iter().enumerate() {
            if x.is_finite() && x != 0.0 {
                let mut simpler = numbers.clone();
                simpler[index] = 0.0;
                let (ray, triangle) = <(Ray, Triangle)>::from_numbers(&simpler);
                assert!(!verdict::ray_triangle(&ray, &triangle).hits(), "{index} of {case:?}");
            }
        }
    }

    #[test]
    fn every_pair_has_a_strategy_with_hits_and_misses() {
        fn check<S: Strategy>(strategy: &S, touches: impl Fn(&S::Value) -> bool) {
            let hits = std::cell::Cell::new(0);
            run(strategy, |case| {
                hits.set(hits.get() + i32::from(touches(&case)));
                Ok(())
            })
            .expect("no property");
            assert!((64..192).contains(&hits.get()), "{hits:?} of 256");
        }
        check(&ray_plane::<Vec3>(), Query::touches);
        check(&ray_sphere::<DVec3>(), Query::touches);
        check(&ray_aabb::<Vec3>(), Query::touches);
        check(&ray_triangle::<DVec3>(), Query::touches);
        check(&triangle_aabb::<Vec3>(), Query::touches);
    }
}
