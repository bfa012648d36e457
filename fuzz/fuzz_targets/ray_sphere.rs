//! Ray against sphere.
#![no_main]

use isect::glam::{DVec3, Vec3, Vec3A};
use isect::ray::sphere::{self, SphereHit, algebraic, geometric, robust};
use isect::testkit::verdict;
use isect::{Ray, Scalar, Sphere, Vector};
use isect_fuzz::{FACTORS, Query, assert_in_range, can_hit, scaled_ray};
use libfuzzer_sys::fuzz_target;

type Shapes<V> = (Ray<V>, Sphere<V>);

fuzz_target!(|query: Query<Shapes<Vec3>, Shapes<DVec3>>| match query {
    Query::Single { shapes: (ray, sphere), is_integral } => {
        let answers = check(&ray, &sphere, is_integral);
        let answers_a = check::<Vec3A>(&ray.into(), &sphere.into(), is_integral);
        assert_eq!(answers, answers_a, "Vec3 and Vec3A differ");
    }
    Query::Double { shapes: (ray, sphere), is_integral } => {
        check(&ray, &sphere, is_integral);
    }
});

/// All kernels' answers.
fn all<V: Vector>(ray: &Ray<V>, sphere: &Sphere<V>) -> [Option<SphereHit<V::Scalar>>; 3] {
    [
        algebraic::intersect(ray, sphere),
        geometric::intersect(ray, sphere),
        robust::intersect(ray, sphere),
    ]
}

fn check<V: Vector>(
    ray: &Ray<V>,
    sphere: &Sphere<V>,
    is_integral: bool,
) -> [Option<SphereHit<V::Scalar>>; 3] {
    let hits = all(ray, sphere);
    assert_eq!(hits[2].is_some(), verdict::ray_sphere(ray, sphere), "exact");
    assert_eq!(hits[2], ray.intersect(sphere));
    assert_eq!(hits[2].is_some(), ray.hits(sphere));
    let valid =
        sphere.center.is_finite() && sphere.radius.is_finite() && sphere.radius >= V::Scalar::ZERO;
    for (kernel, hit) in ["algebraic", "geometric", "robust"].iter().zip(&hits) {
        if let Some(hit) = hit {
            assert!(valid && can_hit(ray), "{kernel}: bad input was hit");
            assert_in_range(kernel, hit.t, ray);
        }
    }
    if let Some([near, far]) = sphere::roots(ray, sphere) {
        assert!(near.is_finite() && far.is_finite() && near <= far);
        let line = Ray { t_min: -V::Scalar::INFINITY, t_max: V::Scalar::INFINITY, ..*ray };
        assert!(verdict::ray_sphere(&line, sphere));
    }
    if is_integral {
        for factor in FACTORS.map(V::Scalar::from) {
            let sphere = Sphere::new(sphere.center * factor, sphere.radius * factor);
            let scaled = all(&scaled_ray(ray, factor), &sphere);
            assert_eq!(hits[..2], scaled[..2]);
            // Another stage may decide, and give another last bit.
            assert_eq!(hits[2].is_some(), scaled[2].is_some());
        }
    }
    hits
}
