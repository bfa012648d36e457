//! Cone against plane, sphere, box and triangle.
#![no_main]

use isect::glam::{DVec3, Vec3, Vec3A};
use isect::overlap::{ConeHit, cone_aabb, cone_plane, cone_sphere, cone_triangle};
use isect::{Cone, Number, Ray, Scalar, Vector};
use isect_fuzz::{Query, Shape, can_hit};
use libfuzzer_sys::fuzz_target;

type Shapes<V> = (Cone<V>, Shape<V>);

fuzz_target!(|query: Query<Shapes<Vec3>, Shapes<DVec3>>| match query {
    Query::Single { shapes: (cone, shape), .. } => {
        let shape_a = match shape {
            Shape::Plane(plane) => Shape::<Vec3A>::Plane(plane.into()),
            Shape::Sphere(sphere) => Shape::Sphere(sphere.into()),
            Shape::Aabb(aabb) => Shape::Aabb(aabb.into()),
            Shape::Triangle(triangle) => Shape::Triangle(triangle.into()),
        };
        assert_eq!(check(&cone, &shape), check::<Vec3A>(&cone.into(), &shape_a));
    }
    Query::Double { shapes: (cone, shape), .. } => {
        check(&cone, &shape);
    }
});

/// Whatever its axis hits, a cone touches.
fn check<V: Vector>(cone: &Cone<V>, shape: &Shape<V>) -> Option<ConeHit<V::Scalar>> {
    let (hit, touches, is_bounded) = match shape {
        Shape::Plane(plane) => {
            (cone_plane::intersect(cone, plane), cone_plane::touches(cone, plane), true)
        }
        Shape::Sphere(sphere) => {
            (cone_sphere::intersect(cone, sphere), cone_sphere::touches(cone, sphere), true)
        }
        Shape::Aabb(aabb) => (
            cone_aabb::intersect(cone, aabb),
            cone_aabb::touches(cone, aabb),
            aabb.min.is_finite() && aabb.max.is_finite(),
        ),
        Shape::Triangle(triangle) => {
            (cone_triangle::intersect(cone, triangle), cone_triangle::touches(cone, triangle), true)
        }
    };
    assert_eq!(hit.is_some(), touches);
    let (zero, one) = (V::Scalar::ZERO, V::Scalar::ONE);
    let axis = Ray { t_min: cone.ray.t_min.max(zero), ..cone.ray };
    let is_size = |x: V::Scalar| zero <= x && x.is_finite();
    let is_valid = can_hit(&cone.ray)
        && can_hit(&axis)
        && is_size(cone.radius)
        && is_size(cone.spread)
        && zero < cone.radius + cone.spread;
    if let Some(hit) = hit {
        assert!(is_valid && is_bounded, "bad input was touched");
        assert!(axis.t_min <= hit.t && hit.t <= axis.t_max && hit.t.is_finite(), "{hit:?}");
        assert!(zero <= hit.coverage && hit.coverage <= one, "{hit:?}");
    } else {
        // Not at a t that no float has.
        let axis = axis.with_range(axis.t_min, axis.t_max.min(V::Scalar::MAX));
        let is_provided_for = is_moderate(cone, shape);
        assert!(
            !(is_provided_for && is_valid && is_bounded && shape.is_hit(&axis)),
            "a false miss"
        );
    }
    hit
}

/// Whether products of some numbers stay in the range of exponents: those of `f32` always do, as they are taken in `f64`.
fn is_moderate<V: Vector>(cone: &Cone<V>, shape: &Shape<V>) -> bool {
    let Ray { origin, direction, .. } = cone.ray;
    let (zero, size) = (V::Scalar::ZERO, |x: V::Scalar| V::splat(x));
    let [a, b, c] = match *shape {
        Shape::Plane(plane) => [plane.normal, size(plane.offset), V::ZERO],
        Shape::Sphere(sphere) => [sphere.center, size(sphere.radius), V::ZERO],
        Shape::Aabb(aabb) => [aabb.min, aabb.max, V::ZERO],
        Shape::Triangle(triangle) => [triangle.v0, triangle.v1, triangle.v2],
    };
    [origin, direction, size(cone.radius), size(cone.spread), a, b, c].iter().all(|v| {
        [v.x(), v.y(), v.z()].into_iter().all(|x| {
            let size: f64 = x.abs().into();
            x == zero || (1e-50..1e50).contains(&size)
        })
    })
}
