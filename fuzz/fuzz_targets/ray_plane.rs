//! Ray against plane.
#![no_main]

use isect::glam::{DVec3, Vec3, Vec3A};
use isect::ray::plane::{self, PlaneHit};
use isect::testkit::{oracle::PlaneVerdict, verdict};
use isect::{Plane, Ray, Scalar, Vector};
use isect_fuzz::{FACTORS, Query, assert_in_range, can_hit, scaled_ray};
use libfuzzer_sys::fuzz_target;

type Shapes<V> = (Ray<V>, Plane<V>);

fuzz_target!(|query: Query<Shapes<Vec3>, Shapes<DVec3>>| match query {
    Query::Single { shapes: (ray, plane), is_integral } => {
        let answer = check(&ray, &plane, is_integral);
        let answer_a = check::<Vec3A>(&ray.into(), &plane.into(), is_integral);
        assert_eq!(answer, answer_a, "Vec3 and Vec3A differ");
    }
    Query::Double { shapes: (ray, plane), is_integral } => {
        check(&ray, &plane, is_integral);
    }
});

/// Without t, of which the last bit is that of the stage that decides.
fn outcome<T>(hit: Option<PlaneHit<T>>) -> Option<PlaneHit<()>> {
    hit.map(|hit| match hit {
        PlaneHit::At(_) => PlaneHit::At(()),
        PlaneHit::Contained => PlaneHit::Contained,
    })
}

fn check<V: Vector>(
    ray: &Ray<V>,
    plane: &Plane<V>,
    is_integral: bool,
) -> Option<PlaneHit<V::Scalar>> {
    let exactly = match verdict::ray_plane(ray, plane) {
        PlaneVerdict::Miss => None,
        PlaneVerdict::At => Some(PlaneHit::At(())),
        PlaneVerdict::Contained => Some(PlaneHit::Contained),
    };
    let hit = plane::intersect(ray, plane);
    assert_eq!(outcome(hit), exactly);
    assert_eq!(hit, ray.intersect(plane));
    assert_eq!(hit.is_some(), ray.hits(plane));
    let valid = plane.normal.is_finite() && plane.normal != V::ZERO && plane.offset.is_finite();
    match hit {
        None => {}
        _ if !(valid && can_hit(ray)) => panic!("bad input was hit"),
        Some(PlaneHit::At(t)) => assert_in_range("plane", t, ray),
        Some(PlaneHit::Contained) => {}
    }
    if is_integral {
        // The numerator and the denominator are exact.
        let numerator = plane.offset - plane.normal.dot(ray.origin);
        let denominator = plane.normal.dot(ray.direction);
        let contained =
            numerator == V::Scalar::ZERO && denominator == V::Scalar::ZERO && valid && can_hit(ray);
        assert_eq!(hit == Some(PlaneHit::Contained), contained);
        for factor in FACTORS.map(V::Scalar::from) {
            let plane = Plane { offset: plane.offset * factor, ..*plane };
            assert_eq!(exactly, outcome(plane::intersect(&scaled_ray(ray, factor), &plane)));
        }
    }
    hit
}
