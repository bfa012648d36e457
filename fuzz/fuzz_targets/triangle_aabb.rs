//! Triangle against box.
#![no_main]

use isect::glam::{DVec3, Vec3, Vec3A};
use isect::overlap::triangle_aabb::{clip, exact, sat};
use isect::testkit::{oracle, shapes, verdict};
use isect::{Aabb, Triangle, Vector};
use isect_fuzz::{FACTORS, Query, contains, is_finite};
use libfuzzer_sys::fuzz_target;

type Shapes<V> = (Triangle<V>, Aabb<V>);

fuzz_target!(|query: Query<Shapes<Vec3>, Shapes<DVec3>>| match query {
    Query::Single { shapes: (triangle, aabb), is_integral } => {
        let verdicts = check(&triangle, &aabb, is_integral);
        let verdicts_a = check::<Vec3A>(&triangle.into(), &aabb.into(), is_integral);
        assert_eq!(verdicts, verdicts_a, "Vec3 and Vec3A differ");
    }
    Query::Double { shapes: (triangle, aabb), is_integral } => {
        check(&triangle, &aabb, is_integral);
    }
});

/// The verdicts of `sat` and `clip`.
fn all<V: Vector>(triangle: &Triangle<V>, aabb: &Aabb<V>) -> [bool; 2] {
    [sat::overlaps(triangle, aabb), clip::overlaps(triangle, aabb)]
}

fn check<V: Vector>(triangle: &Triangle<V>, aabb: &Aabb<V>, is_integral: bool) -> [bool; 2] {
    let touches = verdict::triangle_aabb(triangle, aabb);
    let [min, max] = [aabb.min, aabb.max].map(shapes::array);
    let clipped = oracle::triangle_aabb_clip(shapes::vertices(triangle), min, max);
    assert_eq!(touches, clipped, "two independent oracles");
    assert_eq!(exact::overlaps(triangle, aabb), touches, "exact");
    let [sat, clip] = all(triangle, aabb);
    let polygon = clip::clip(triangle, aabb);
    let vertices = polygon.vertices();
    assert_eq!(clip, !vertices.is_empty());
    assert!(vertices.len() <= 9);
    for &vertex in vertices {
        assert!(vertex.is_finite(), "{vertex:?}");
        assert!(contains(aabb, vertex), "{vertex:?} is outside of the box");
    }

    let valid = is_finite(triangle) && !aabb.is_empty();
    assert!(valid || !sat, "sat: bad input overlaps");
    assert!(valid || !clip, "clip: bad input overlaps");
    if valid && triangle.aabb().intersection(aabb).is_empty() {
        // The box's own axes are decided exactly.
        assert!(!sat, "sat: the boxes are apart");
    }
    let inside = |&v: &V| contains(aabb, v);
    if valid && <[V; 3]>::from(*triangle).iter().any(inside) {
        assert!(clip, "clip: a vertex is inside");
    }
    if is_integral {
        assert_eq!(sat, clip, "products of small integers are exact");
        for factor in FACTORS.map(V::Scalar::from) {
            let vertices = <[V; 3]>::from(*triangle).map(|v| v * factor);
            let aabb = Aabb::new(aabb.min * factor, aabb.max * factor);
            assert_eq!([sat, clip], all(&vertices.into(), &aabb));
        }
    }
    [sat, clip]
}
