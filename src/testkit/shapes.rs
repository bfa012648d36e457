//! Between the oracle's doubles and the shapes that kernels take.

use super::oracle;
use crate::{Aabb, Plane, Ray, Scalar, Sphere, Triangle, Vector};

/// The scalar nearest to a double.
#[must_use]
pub fn scalar<T: Scalar>(x: f64) -> T {
    T::ZERO.lit(x)
}

/// The vector nearest to an array of doubles.
#[must_use]
pub fn vector<V: Vector>([x, y, z]: [f64; 3]) -> V {
    V::new(scalar(x), scalar(y), scalar(z))
}

/// A vector as an array of doubles, exactly.
#[must_use]
pub fn array<V: Vector>(v: V) -> [f64; 3] {
    [v.x().into(), v.y().into(), v.z().into()]
}

/// A ray of the oracle's, each number rounded to the nearest.
#[must_use]
pub fn ray<V: Vector>(ray: &oracle::Ray) -> Ray<V> {
    Ray::new(vector(ray.origin), vector(ray.direction))
        .with_range(scalar(ray.t_min), scalar(ray.t_max))
}

/// A triangle of three arrays.
#[must_use]
pub fn triangle<V: Vector>(vertices: &[[f64; 3]; 3]) -> Triangle<V> {
    vertices.map(vector).into()
}

/// A box of two arrays.
#[must_use]
pub fn aabb<V: Vector>(min: &[f64; 3], max: &[f64; 3]) -> Aabb<V> {
    Aabb::new(vector(*min), vector(*max))
}

/// A sphere of an array and a radius.
#[must_use]
pub fn sphere<V: Vector>(center: &[f64; 3], radius: f64) -> Sphere<V> {
    Sphere::new(vector(*center), scalar(radius))
}

/// A plane of an array and an offset.
#[must_use]
pub fn plane<V: Vector>(normal: &[f64; 3], offset: f64) -> Plane<V> {
    Plane { normal: vector(*normal), offset: scalar(offset) }
}

/// The vertices of a triangle as arrays of doubles, exactly.
#[must_use]
pub fn vertices<V: Vector>(triangle: &Triangle<V>) -> [[f64; 3]; 3] {
    <[V; 3]>::from(*triangle).map(array)
}

/// The name of a vector type, for messages.
#[must_use]
pub fn name<V: Vector>() -> &'static str {
    let path = std::any::type_name::<V>();
    path.rsplit("::").next().unwrap_or(path)
}
