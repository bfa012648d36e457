//! Ray against sphere.
#![no_main]

use isect::glam::{DVec3, Vec3, Vec3A};
use isect::ray::sphere::{self, SphereHit, algebraic, exact, geometric, robust};
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
    assert_eq!(exact::hits(ray, sphere), verdict::ray_sphere(ray, sphere), "exact");
    let hits = all(ray, sphere);
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
        // A root in the range is a hit, and the near one goes first.
        let in_range = |t| can_hit(ray) && ray.t_min <= t && t <= ray.t_max;
        let expected = if in_range(near) {
            Some((near, false))
        } else {
            Some((far, true)).filter(|_| in_range(far))
        };
        assert_eq!(hits[2].map(|hit| (hit.t, hit.leaving)), expected);
    }
    if is_integral {
        for factor in FACTORS.map(V::Scalar::from) {
            let sphere = Sphere::new(sphere.center * factor, sphere.radius * factor);
            assert_eq!(hits, all(&scaled_ray(ray, factor), &sphere));
        }
    }
    hits
}
