//! Claim: where obvhs and isect disagree, rounding is why, and exact arithmetic sides with isect.

use std::cell::Cell;

use isect::glam::Vec3A;
use isect::ray::aabb::{BoxRay, conservative};
use isect::{Aabb, Ray, Triangle};
use proptest::prelude::*;
use proptest::test_runner::{RngSeed, TestRunner};

use crate::bounds::check_triangle;
use crate::support::bounds::unit_roundoff;
use crate::support::kernels::triangle_kernels;
use crate::support::{array, oracle};

const SEED: u64 = 8;

/// A coordinate: an integer, which brings coincidences, or any number in a range.
fn coordinate() -> impl Strategy<Value = f32> {
    prop_oneof![(-4..=4_i8).prop_map(f32::from), -4.0..4.0_f32]
}

fn point() -> impl Strategy<Value = Vec3A> {
    [coordinate(), coordinate(), coordinate()].prop_map(Vec3A::from)
}

fn exact(ray: &Ray<Vec3A>) -> oracle::Ray {
    oracle::Ray {
        origin: array(ray.origin),
        direction: array(ray.direction),
        t_min: ray.t_min.into(),
        t_max: ray.t_max.into(),
    }
}

/// The distance of a point from the nearest edge.
fn edge_distance(p: Vec3A, triangle: &Triangle<Vec3A>) -> f32 {
    let [a, b, c] = (*triangle).into();
    let distance = |a: Vec3A, b: Vec3A| {
        let (along, offset) = (b - a, p - a);
        (offset - along * (offset.dot(along) / along.length_squared()).clamp(0.0, 1.0)).length()
    };
    distance(a, b).min(distance(b, c)).min(distance(c, a))
}

/// Runs a check on many random tuples, from a fixed seed.
fn on_many<S: Strategy>(strategy: S, check: impl Fn(S::Value) -> Result<(), TestCaseError>) {
    let config = ProptestConfig {
        failure_persistence: None,
        rng_seed: RngSeed::Fixed(SEED),
        ..ProptestConfig::with_cases(100_000)
    };
    if let Err(error) = TestRunner::new(config).run(&strategy, check) {
        panic!("{error}");
    }
}

/// Off the edges by more than 16·EPSILON·D/cosθ (D the largest distance of a vertex from the origin, θ the angle
/// between ray and normal: rounding a vertex by EPSILON·D moves the hit by that over cosθ, and 16 of them cover the
/// dozen roundings of either kernel) both must agree about the hit, and about t by as much. Within, the oracle
/// decides, and every kernel of isect's must be right to its own bound, whatever obvhs says.
#[test]
fn triangles_agree_off_the_edges() {
    let (clear_hits, clear_misses, unclear) = (Cell::new(0), Cell::new(0), Cell::new(0));
    let points = [point(), point(), point(), point(), point()];
    // One ray in four is aimed at an edge.
    let along_edge = prop::option::weighted(0.25, 0.0..=1.0_f32);
    on_many((points, along_edge), |([origin, anywhere, v0, v1, v2], along_edge)| {
        let target = along_edge.map_or(anywhere, |weight| v0 + (v1 - v0) * weight);
        let direction = target - origin;
        prop_assume!(direction != Vec3A::ZERO);
        let triangle = Triangle::new(v0, v1, v2);
        let ray = Ray::new(origin, direction.normalize());
        let theirs = obvhs::triangle::Triangle { v0, v1, v2 }
            .intersect(&obvhs::ray::Ray::new_inf(ray.origin, ray.direction));

        let normal = triangle.normal();
        let cos = (normal.normalize_or_zero().dot(ray.direction)).abs();
        let far = [v0, v1, v2].iter().map(|v| v.distance(origin)).fold(0.0, f32::max);
        let band = 16.0 * f32::EPSILON * far / cos;
        let (exact_ray, exact_vertices) = (exact(&ray), [v0, v1, v2].map(array));
        let t = normal.dot(v0 - origin) / normal.dot(ray.direction);
        // A needle's normal is itself uncertain: its band is as wide as the needle.
        let longest = (v1 - v0).length().max((v2 - v0).length());
        let clear = normal.length() > 1e-3 * longest * longest
            && band.is_finite()
            && edge_distance(ray.at(t), &triangle) > band
            && t.abs() > band;
        for kernel in triangle_kernels::<Vec3A>() {
            let ours = (kernel.intersect)(&ray, &triangle);
            if clear {
                count(if ours.is_some() { &clear_hits } else { &clear_misses });
                prop_assert_eq!(
                    ours.is_some(),
                    theirs.is_finite(),
                    "{}: {:?} {}",
                    kernel.name,
                    ours,
                    theirs
                );
                if let Some(hit) = ours {
                    prop_assert!(
                        (hit.t - theirs).abs() <= band,
                        "{}: {} {} {}",
                        kernel.name,
                        hit.t,
                        theirs,
                        band
                    );
                }
                let verdict = oracle::triangle(&exact_ray, exact_vertices);
                prop_assert_eq!(verdict.hits(), ours.is_some(), "{}", kernel.name);
            } else if let Some(bound) =
                (kernel.bound)(unit_roundoff::<f32>(), &exact_ray, &exact_vertices)
            {
                count(&unclear);
                check_triangle(&kernel, &exact_ray, exact_vertices, bound);
            }
        }
        Ok(())
    });
    let counts = [clear_hits, clear_misses, unclear].map(Cell::into_inner);
    println!("{counts:?} clear hits, clear misses, unclear within bounds");
    assert!(counts[0] > 20_000 && counts[1] > 100_000 && counts[2] > 5_000, "{counts:?}");
}

/// obvhs ignores the range and lets a hit be negative; it takes components of the direction up to EPSILON for
/// EPSILON. Apart from that its verdict may differ only where the conservative one is a hit by margin.
#[test]
fn boxes_agree() {
    let (inside, outside, unclear) = (Cell::new(0), Cell::new(0), Cell::new(0));
    on_many([point(), point(), point(), point()], |[origin, target, a, b]| {
        let direction = target - origin;
        let aabb = Aabb::from_points([a, b]);
        let ray = Ray::new(origin, direction);
        let comparable = direction.abs().min_element() > f32::EPSILON;
        let theirs = obvhs::aabb::Aabb::new(aabb.min, aabb.max)
            .intersect_ray(&obvhs::ray::Ray::new_inf(origin, direction))
            .max(0.0);
        let ours = conservative::interval(&BoxRay::new(&ray), &aabb);
        let touches = oracle::aabb(&exact(&ray), array(aabb.min), array(aabb.max));
        prop_assert!(ours.is_some() || !touches);
        if let (Some([enter, _]), true) = (ours, comparable && theirs.is_finite()) {
            // Three roundings there, three steps outward here.
            prop_assert!((enter - theirs).abs() <= 8.0 * f32::EPSILON * theirs, "{enter} {theirs}");
        }
        // Inside of the box by a margin, both hit; outside of it by one, both miss: the oracle says which.
        let margin = Vec3A::splat(16.0 * f32::EPSILON * 16.0);
        let (small, large) = (
            oracle::aabb(&exact(&ray), array(aabb.min + margin), array(aabb.max - margin)),
            oracle::aabb(&exact(&ray), array(aabb.min - margin), array(aabb.max + margin)),
        );
        if comparable {
            count(if small {
                &inside
            } else if large {
                &unclear
            } else {
                &outside
            });
        }
        if comparable && small {
            prop_assert!(theirs.is_finite() && ours.is_some());
        }
        if comparable && !large {
            prop_assert!(theirs.is_infinite() && ours.is_none());
        }
        Ok(())
    });
    let counts = [inside, outside, unclear].map(Cell::into_inner);
    println!("{counts:?} clearly inside, clearly outside, unclear");
    assert!(counts[0] > 10_000 && counts[1] > 10_000 && counts[2] > 500, "{counts:?}");
}

fn count(counter: &Cell<u32>) {
    counter.set(counter.get() + 1);
}
