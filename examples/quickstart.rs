//! A ray, a triangle, a box: the ten lines of the README.

use isect::ray::aabb::{BoxRay, conservative};
use isect::{Aabb, Ray, Triangle, glam::Vec3};

fn main() {
    let triangle = Triangle::new(Vec3::ZERO, Vec3::X, Vec3::Y);
    let ray = Ray::new(Vec3::new(0.25, 0.5, 3.0), Vec3::NEG_Z);
    if let Some(hit) = ray.intersect(&triangle) {
        println!("hit at {} (t = {}, front: {})", ray.at(hit.t), hit.t, hit.front);
    }
    println!("in the shadow: {}", ray.before(3.0).hits(&triangle));

    // The node of a hierarchy: no box that the ray touches is missed.
    let node = Aabb::new(Vec3::splat(-1.0), Vec3::splat(1.0));
    println!("visit the node: {}", conservative::hits(&BoxRay::new(&ray), &node));
}
