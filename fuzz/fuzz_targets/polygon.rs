//! Ray against polygon, and beam against polygon.
#![no_main]

use isect::glam::{DVec3, Vec3, Vec3A};
use isect::overlap::beam_polygon;
use isect::ray::polygon;
use isect::{Beam, Polygon, Ray, Scalar, Vector};
use isect_fuzz::{Query, assert_in_range, can_hit};
use libfuzzer_sys::fuzz_target;

type Shapes<V> = (Ray<V>, (Polygon<V, 8>, Polygon<V, 8>));

fuzz_target!(|query: Query<Shapes<Vec3>, Shapes<DVec3>>| match query {
    Query::Single { shapes: (ray, (a, b)), .. } => {
        check(&ray, &a, &b);
        check::<Vec3A>(&ray.into(), &a.into(), &b.into());
    }
    Query::Double { shapes: (ray, (a, b)), .. } => check(&ray, &a, &b),
});

fn check<V: Vector>(ray: &Ray<V>, a: &Polygon<V, 8>, b: &Polygon<V, 8>) {
    let is_finite = |polygon: &Polygon<V, 8>| polygon.vertices().iter().all(|v| v.is_finite());
    if let Some(hit) = polygon::intersect(ray, a) {
        assert!(can_hit(ray) && is_finite(a), "bad input was hit");
        assert_in_range("polygon", hit.t, ray);
        assert!(hit.triangle < a.triangles().count());
        assert!(hit.in_triangle().barycentric().iter().all(|x| x.is_finite()));
    }
    let Some(beam) = Beam::new(ray.origin, *a) else { return };
    assert!(ray.origin.is_finite() && is_finite(a), "a beam of bad input");
    // A square and a clip of four sides, or of five: there is room for eight, unless a base is not convex.
    if let Some(lit) = beam_polygon::clip(&beam, b) {
        assert!(is_finite(b) || lit.vertices().is_empty());
        if let Some(division) = beam_polygon::divide(&beam, &lit) {
            assert!(division.passing().len() <= lit.vertices().len().max(1));
        }
    }
}
