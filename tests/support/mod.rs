//! What the tests share: the list of kernels, their error bounds, and the way from the testkit's doubles to shapes.

pub mod bounds;
pub mod kernels;

pub use isect::testkit::{generators, meshes, oracle};

use isect::{Aabb, Ray, Scalar, Sphere, Triangle, Vector};

/// The scalar nearest to a double.
pub fn scalar<T: Scalar>(x: f64) -> T {
    T::ZERO.lit(x)
}

/// The vector nearest to an array of doubles.
pub fn vector<V: Vector>([x, y, z]: [f64; 3]) -> V {
    V::new(scalar(x), scalar(y), scalar(z))
}

/// A vector as an array of doubles, exactly.
pub fn array<V: Vector>(v: V) -> [f64; 3] {
    [v.x().into(), v.y().into(), v.z().into()]
}

/// A ray of the oracle's, as the kernels take it.
pub fn ray<V: Vector>(ray: &oracle::Ray) -> Ray<V> {
    Ray::new(vector(ray.origin), vector(ray.direction))
        .with_range(scalar(ray.t_min), scalar(ray.t_max))
}

/// A triangle of three arrays.
pub fn triangle<V: Vector>(vertices: &[[f64; 3]; 3]) -> Triangle<V> {
    vertices.map(vector).into()
}

/// A box of two arrays.
pub fn aabb<V: Vector>(min: &[f64; 3], max: &[f64; 3]) -> Aabb<V> {
    Aabb::new(vector(*min), vector(*max))
}

/// A sphere of an array and a radius.
pub fn sphere<V: Vector>(center: &[f64; 3], radius: f64) -> Sphere<V> {
    Sphere::new(vector(*center), scalar(radius))
}

/// The name of a vector type, for messages.
pub fn name<V: Vector>() -> &'static str {
    std::any::type_name::<V>().rsplit("::").next().expect("a path has a last segment")
}

/// Runs a generic check with all three vector types.
macro_rules! for_every_vector {
    ($check:ident $(, $argument:expr)*) => {
        $check::<isect::glam::Vec3>($($argument),*);
        $check::<isect::glam::Vec3A>($($argument),*);
        $check::<isect::glam::DVec3>($($argument),*);
    };
}
pub(crate) use for_every_vector;
