//! Claim: the conservative box kernel misses no box that the ray touches.
//!
//! An exact verdict is only needed where the kernel says that it misses, so ten million cases are quick.

use isect::glam::Vec3;
use isect::ray::aabb::{BoxRay, conservative, slab};
use isect::{Aabb, Ray, Scalar, Vector};

use crate::support::{aabb, for_every_vector, generators, name, oracle, ray};

const SEED: u64 = 2;

/// `hits`, `interval` and, for information, the fast kernel on one case after the other; returns the number of boxes that
/// the ray does touch among those that the slab kernel misses.
fn campaign<V: Vector>(cases: u64) {
    let mut rng = fastrand::Rng::with_seed(SEED);
    let (mut misses, mut false_misses_of_slab) = (0_u64, 0_u64);
    for _ in 0..cases {
        let (exact_ray, min, max) = generators::ray_aabb(&mut rng);
        let (box_ray, aabb) = (BoxRay::<V>::new(&ray(&exact_ray)), aabb::<V>(&min, &max));
        let hit = conservative::hits(&box_ray, &aabb);
        let interval = conservative::interval(&box_ray, &aabb);
        assert_eq!(hit, interval.is_some(), "{exact_ray:?} {min:?} {max:?}");
        let fast = slab::hits(&box_ray, &aabb);
        if hit && fast {
            continue;
        }
        let touches = oracle::aabb(&exact_ray, min, max);
        assert!(hit || !touches, "a false miss: {exact_ray:?} {min:?} {max:?}");
        misses += u64::from(!touches);
        false_misses_of_slab += u64::from(touches && !fast);
    }
    println!(
        "{:<6} {cases} cases, {misses} true misses: 0 false misses; slab {false_misses_of_slab}",
        name::<V>()
    );
}

#[test]
fn no_box_that_the_ray_touches_is_missed() {
    for_every_vector!(campaign, 3_400_000);
}

#[test]
#[ignore = "minutes: cargo test --test suite -- --ignored"]
fn no_box_that_the_ray_touches_is_missed_in_many_more() {
    for_every_vector!(campaign, 400_000_000);
}

/// The interval holds the exact one, and reaches no more than 9 steps out of it: checked at its ends. (In units of
/// u = EPSILON/2: 6 for three steps of the reciprocal, 1 each for its rounding, the difference's and the product's; and a
/// step of t is at least one.)
#[test]
fn the_interval_holds_the_exact_one() {
    fn check<V: Vector>() {
        let mut rng = fastrand::Rng::with_seed(SEED + 1);
        let mut touched = 0;
        for _ in 0..300_000 {
            let (exact_ray, min, max) = generators::ray_aabb(&mut rng);
            let box_ray = BoxRay::<V>::new(&ray(&exact_ray));
            let Some([enter, exit]) = conservative::interval(&box_ray, &aabb(&min, &max)) else {
                continue;
            };
            let nine_steps = |t: V::Scalar, step: fn(V::Scalar) -> V::Scalar| {
                (0..9).fold(t, |t, _| step(t)).into()
            };
            let latest = nine_steps(enter, V::Scalar::next_up);
            let earliest = nine_steps(exit, V::Scalar::next_down);
            let (enter, exit) = (enter.into(), exit.into());
            assert!(exact_ray.t_min <= enter && enter <= exit && exit <= exact_ray.t_max);
            if oracle::aabb(&exact_ray, min, max) {
                touched += 1;
                let case =
                    || format!("{} {exact_ray:?} {min:?} {max:?} {enter} {exit}", name::<V>());
                assert!(oracle::aabb_enter_in(&exact_ray, min, max, enter, latest), "{}", case());
                assert!(oracle::aabb_exit_in(&exact_ray, min, max, earliest, exit), "{}", case());
            }
        }
        assert!(touched > 100_000);
    }
    for_every_vector!(check);
}

/// Ize's factor of 1 + 2 ulp on the exit misses this one.
#[test]
fn two_ulps_are_not_enough() {
    let hex = |mantissa: i32, exponent: i32| f64::from(mantissa) * 2f64.powi(exponent);
    let (ox, dx, bx) = (-hex(0x10b_3822, -24), hex(0x1f6_90aa, -24), hex(0x140_beb4, -24));
    let (oy, dy, by) = (-hex(0x1ca_545a, -24), hex(0x1b8_2dd4, -24), hex(0x1c_52e4, -23));
    let exact_ray = oracle::Ray {
        origin: [ox, oy, 0.0],
        direction: [dx, dy, 0.0],
        t_min: 0.0,
        t_max: f64::INFINITY,
    };
    let (min, max) = ([bx, by - 1.0, -1.0], [bx + 1.0, by, 1.0]);
    assert!(oracle::aabb(&exact_ray, min, max));
    let ray = BoxRay::<Vec3>::new(&ray(&exact_ray));
    assert!(conservative::hits(&ray, &aabb(&min, &max)));
}

/// Coordinates whose differences overflow, directions whose reciprocals do.
#[test]
fn extreme_magnitudes() {
    let far = 3.0e38_f32;
    let hit = |origin: Vec3, direction: Vec3, min: Vec3, max: Vec3| {
        let ray = BoxRay::new(&Ray::new(origin, direction));
        let aabb = Aabb::new(min, max);
        assert_eq!(slab::hits(&ray, &aabb), slab::intersect(&ray, &aabb).is_some());
        (conservative::hits(&ray, &aabb), slab::hits(&ray, &aabb))
    };
    let (zero, one) = (Vec3::ZERO, Vec3::ONE);
    let across = (Vec3::splat(far * 0.9), Vec3::splat(far));
    // The exact t is beyond the largest float, and then it is not.
    assert_eq!(hit(Vec3::splat(-far), one, across.0, across.1), (true, false));
    assert_eq!(hit(Vec3::splat(-far), one * 4.0, across.0, across.1), (true, true));
    assert!(hit(Vec3::splat(-far), one * 1e-3, across.0, across.1).0);
    let tiny = Vec3::new(1e-40, 2e-40, 1e-40);
    assert_eq!(hit(zero, tiny, one * 1e-3, Vec3::new(2e-3, 4e-3, 2e-3)), (true, true));
    assert_eq!(hit(zero, tiny, one * 1e-3, Vec3::new(2e-3, 1.9e-3, 2e-3)), (false, false));
    assert_eq!(hit(zero, one * far, one, one * 2.0), (true, true));
    // One component underflows next to the others, and decides.
    let grazing = Vec3::new(1.0, 1e-45, 0.0);
    let (min, max) = (Vec3::new(1.0, 1e-45, -1.0), Vec3::new(2.0, 1.0, 1.0));
    assert_eq!(hit(zero, grazing, min, max), (true, true));
    assert_eq!(hit(zero, grazing, Vec3::new(1.0, 4e-45, -1.0), max), (false, false));
}
