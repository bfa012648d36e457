//! Pyramid against sphere, box and triangle.
#![no_main]

use isect::glam::{DVec3, Vec3, Vec3A};
use isect::overlap::{Containment, pyramid_aabb, pyramid_sphere, pyramid_triangle};
use isect::{Pyramid, Ray, Scalar, Vector};
use isect_fuzz::{Query, Shape, is_finite};
use libfuzzer_sys::fuzz_target;

type Shapes<V> = (Pyramid<V>, Shape<V>);

fuzz_target!(|query: Query<Shapes<Vec3>, Shapes<DVec3>>| match query {
    Query::Single { shapes: (pyramid, shape), is_integral } => {
        check(&pyramid, &shape, is_integral);
        let shape = match shape {
            Shape::Plane(plane) => Shape::Plane(plane.into()),
            Shape::Sphere(sphere) => Shape::Sphere(sphere.into()),
            Shape::Aabb(aabb) => Shape::Aabb(aabb.into()),
            Shape::Triangle(triangle) => Shape::Triangle(triangle.into()),
        };
        check::<Vec3A>(&pyramid.into(), &shape, is_integral);
    }
    Query::Double { shapes: (pyramid, shape), is_integral } => check(&pyramid, &shape, is_integral),
});

/// What an edge of a pyramid hits is not outside of it.
fn check<V: Vector>(pyramid: &Pyramid<V>, shape: &Shape<V>, is_integral: bool) {
    let (containment, is_bounded) = match shape {
        Shape::Plane(_) => return,
        Shape::Sphere(sphere) => (
            pyramid_sphere::classify(pyramid, sphere),
            sphere.center.is_finite() && sphere.radius.is_finite(),
        ),
        Shape::Aabb(aabb) => (pyramid_aabb::classify(pyramid, aabb), !aabb.is_empty()),
        Shape::Triangle(triangle) => {
            (pyramid_triangle::classify(pyramid, triangle), is_finite(triangle))
        }
    };
    let has_points = pyramid.apex.is_finite() && pyramid.normals.iter().all(|v| v.is_finite());
    if containment == Containment::Inside {
        assert!(has_points && is_bounded, "bad input is inside");
    }
    // The sides of one with small integers for its corners are exact, and go through the edges.
    let is_exact = is_integral && Pyramid::new(pyramid.apex, pyramid.corners) == Some(*pyramid);
    if is_exact && containment == Containment::Outside {
        for edge in pyramid.corners {
            assert!(!shape.is_hit(&Ray::new(pyramid.apex, edge)), "a false outside");
        }
    }
}
