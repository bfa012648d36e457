//! Ray against box.
#![no_main]

use isect::glam::{DVec3, Vec3, Vec3A};
use isect::ray::aabb::{AabbHit, BoxRay, conservative, exact, slab};
use isect::testkit::verdict;
use isect::{Aabb, Ray, Scalar, Vector};
use isect_fuzz::{FACTORS, Query, can_hit, contains, scaled_ray};
use libfuzzer_sys::fuzz_target;

type Shapes<V> = (Ray<V>, Aabb<V>);

fuzz_target!(|query: Query<Shapes<Vec3>, Shapes<DVec3>>| match query {
    Query::Single { shapes: (ray, aabb), is_integral } => {
        let answers = check(&ray, &aabb, is_integral);
        let answers_a = check::<Vec3A>(&ray.into(), &aabb.into(), is_integral);
        assert_eq!(answers, answers_a, "Vec3 and Vec3A differ");
    }
    Query::Double { shapes: (ray, aabb), is_integral } => {
        check(&ray, &aabb, is_integral);
    }
});

type Answers<T> = (Option<AabbHit<T>>, Option<[T; 2]>);

/// All kernels' answers.
fn all<V: Vector>(ray: &Ray<V>, aabb: &Aabb<V>) -> Answers<V::Scalar> {
    let box_ray = BoxRay::new(ray);
    let (hit, interval) = (slab::intersect(&box_ray, aabb), conservative::interval(&box_ray, aabb));
    assert_eq!(hit.is_some(), slab::hits(&box_ray, aabb));
    assert_eq!(interval.is_some(), conservative::hits(&box_ray, aabb));
    (hit, interval)
}

fn check<V: Vector>(ray: &Ray<V>, aabb: &Aabb<V>, is_integral: bool) -> Answers<V::Scalar> {
    let zero = V::Scalar::ZERO;
    let (hit, interval) = all(ray, aabb);
    check_exact(ray, aabb, interval.is_some());
    let can_hit = can_hit(ray) && !aabb.is_empty();
    if let Some(hit) = hit {
        assert!(can_hit, "slab: bad input was hit");
        check_slab(&hit, ray);
        // The conservative bounds lie outside of the slab's, which are rounded to nearest. Where the
        // exit rounds to zero the slab may have hit a box behind the origin.
        if hit.t_exit >= V::Scalar::MIN_POSITIVE || hit.t_exit < zero {
            assert!(interval.is_some(), "slab hit, conservative did not");
        }
    }
    if let Some([t_enter, t_exit]) = interval {
        assert!(can_hit, "conservative: bad input was hit");
        assert!(ray.t_min <= t_enter && t_enter <= t_exit && t_exit <= ray.t_max);
    }
    let certain = |t| can_hit && ray.t_min <= t && t <= ray.t_max;
    let holds = |t| interval.is_some_and(|[enter, exit]| enter <= t && t <= exit);
    if certain(zero) && contains(aabb, ray.origin) {
        assert!(hit.is_some(), "slab missed the box around the origin");
        assert!(holds(zero), "conservative missed the box around the origin");
    }
    if is_integral {
        // Points of the ray with an integral t are exact.
        for t in -4_i8..=4 {
            let t = V::Scalar::from(f32::from(t));
            if certain(t) && contains(aabb, ray.at(t)) {
                assert!(holds(t), "conservative missed t = {t:?}");
            }
        }
        for factor in FACTORS.map(V::Scalar::from) {
            let aabb = Aabb::new(aabb.min * factor, aabb.max * factor);
            assert_eq!((hit, interval), all(&scaled_ray(ray, factor), &aabb));
        }
    }
    (hit, interval)
}

/// The exact verdict is that of big integers, and the conservative one misses nothing of it.
fn check_exact<V: Vector>(ray: &Ray<V>, aabb: &Aabb<V>, conservative: bool) {
    let touches = verdict::ray_aabb(ray, aabb);
    let box_ray = BoxRay::new(ray);
    assert_eq!(exact::hits(&box_ray, aabb), touches, "exact");
    assert!(conservative || !touches, "conservative missed");
    let hit = exact::intersect(&box_ray, aabb);
    assert_eq!(hit.is_some(), touches);
    assert_eq!(hit, ray.intersect(aabb));
    assert_eq!(touches, ray.hits(aabb));
    if let Some(hit) = hit {
        assert!(ray.t_min <= hit.t_enter && hit.t_enter <= hit.t_exit && hit.t_exit <= ray.t_max);
    }
}

/// The ends are in order and in the range, and a face is told just where the range does not clip.
fn check_slab<V: Vector>(hit: &AabbHit<V::Scalar>, ray: &Ray<V>) {
    let AabbHit { t_enter, t_exit, enter_face, exit_face } = *hit;
    assert!(ray.t_min <= t_enter && t_enter <= t_exit && t_exit <= ray.t_max);
    assert!(t_enter < V::Scalar::INFINITY && -V::Scalar::INFINITY < t_exit);
    for (face, t, clip, towards) in [
        (enter_face, t_enter, ray.t_min, -V::Scalar::ONE),
        (exit_face, t_exit, ray.t_max, V::Scalar::ONE),
    ] {
        let Some(face) = face else {
            assert_eq!(t, clip);
            continue;
        };
        assert!(t.is_finite());
        let along = face.normal::<V>().dot(ray.direction);
        assert!(along * towards > V::Scalar::ZERO, "the ray does not cross {face:?}");
    }
    if let Some((t, _)) = hit.surface() {
        assert!(t == t_enter || t == t_exit);
    }
}
