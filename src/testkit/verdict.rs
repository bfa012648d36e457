//! Exact verdicts about shapes, of any vector type: [`super::oracle`] asked with every number converted to the double
//! that it equals.
//!
//! All sets are closed, and so is the range of t. Bad input is a miss.
//!
//! ```
//! use isect::testkit::{oracle::TriangleVerdict, verdict};
//! use isect::{Ray, Triangle, glam::Vec3};
//!
//! let triangle = Triangle::new(Vec3::ZERO, Vec3::X, Vec3::Y);
//! let ray = Ray::new(Vec3::new(0.5, 0.5, 1.0), Vec3::NEG_Z);
//! assert_eq!(verdict::ray_triangle(&ray, &triangle), TriangleVerdict::Edge(1));
//! assert_eq!(verdict::ray_triangle(&ray.before(1.0), &triangle), TriangleVerdict::Miss);
//! ```

use super::oracle::{self, PlaneVerdict, TriangleVerdict};
use super::shapes::{array, vertices};
use crate::{Aabb, Plane, Ray, Sphere, Triangle, Vector};

/// Whether a ray crosses a plane, lies in it, or misses it.
#[must_use]
pub fn ray_plane<V: Vector>(ray: &Ray<V>, plane: &Plane<V>) -> PlaneVerdict {
    oracle::plane(&ray.into(), array(plane.normal), plane.offset.into())
}

/// Whether a ray meets the surface of a sphere.
#[must_use]
pub fn ray_sphere<V: Vector>(ray: &Ray<V>, sphere: &Sphere<V>) -> bool {
    oracle::sphere(&ray.into(), array(sphere.center), sphere.radius.into())
}

/// Whether a ray touches a box.
#[must_use]
pub fn ray_aabb<V: Vector>(ray: &Ray<V>, aabb: &Aabb<V>) -> bool {
    oracle::aabb(&ray.into(), array(aabb.min), array(aabb.max))
}

/// Where a ray meets a triangle.
#[must_use]
pub fn ray_triangle<V: Vector>(ray: &Ray<V>, triangle: &Triangle<V>) -> TriangleVerdict {
    oracle::triangle(&ray.into(), vertices(triangle))
}

/// Whether a triangle touches a box, by separating axes; [`oracle::triangle_aabb_clip`] decides the same
/// independently.
#[must_use]
pub fn triangle_aabb<V: Vector>(triangle: &Triangle<V>, aabb: &Aabb<V>) -> bool {
    oracle::triangle_aabb_sat(vertices(triangle), array(aabb.min), array(aabb.max))
}
