//! The algorithms of each pair: a new one is one line here, and every suite runs over it.

use isect::overlap::triangle_aabb::{clip, exact as overlap_exact, sat};
use isect::ray::aabb::{BoxRay, conservative, exact as box_exact, slab};
use isect::ray::sphere::{self, SphereHit};
use isect::ray::triangle::watertight::{self, ShearedRay};
use isect::ray::triangle::{TriangleHit, badouel, exact, moller_trumbore, segura};
use isect::{Aabb, Ray, Sphere, Triangle, Vector};

use super::bounds::{self, BoundOf};

/// A kernel's full hit, or a miss.
pub type Intersect<V, Shape, Hit> = fn(&Ray<V>, &Shape) -> Option<Hit>;

/// A ray/triangle kernel.
pub struct TriangleKernel<V: Vector> {
    pub name: &'static str,
    pub intersect: Intersect<V, Triangle<V>, TriangleHit<V::Scalar>>,
    /// The error bound that its documentation states.
    pub bound: BoundOf,
}

pub fn triangle_kernels<V: Vector>() -> [TriangleKernel<V>; 5] {
    [
        TriangleKernel {
            name: "moller_trumbore",
            intersect: moller_trumbore::intersect,
            bound: bounds::moller_trumbore,
        },
        TriangleKernel { name: "badouel", intersect: badouel::intersect, bound: bounds::badouel },
        TriangleKernel { name: "segura", intersect: segura::intersect, bound: bounds::segura },
        TriangleKernel {
            name: "watertight",
            intersect: |ray, triangle| watertight::intersect(&ShearedRay::new(ray), triangle),
            bound: bounds::watertight,
        },
        TriangleKernel { name: "exact", intersect: exact::intersect, bound: bounds::exact },
    ]
}

/// A ray/sphere kernel.
pub struct SphereKernel<V: Vector> {
    pub name: &'static str,
    pub intersect: Intersect<V, Sphere<V>, SphereHit<V::Scalar>>,
    /// By how much, at the most, the radius of the sphere that it has hit may be wrong, given the unit roundoff, the
    /// distance to the centre and the radius: as (squared radius, radius).
    pub error: fn(unit: f64, distance: f64, radius: f64) -> (f64, f64),
}

pub fn sphere_kernels<V: Vector>() -> [SphereKernel<V>; 3] {
    [
        SphereKernel {
            name: "algebraic",
            intersect: sphere::algebraic::intersect,
            error: |u, f, r| (12.0 * u * (f * f + r * r), 6.0 * u * (f + r)),
        },
        SphereKernel {
            name: "geometric",
            intersect: sphere::geometric::intersect,
            error: |u, f, r| (16.0 * u * f * f, 6.0 * u * (f + r)),
        },
        SphereKernel {
            name: "robust",
            intersect: sphere::robust::intersect,
            error: |u, f, r| (0.0, 16.0 * u * (f + r)),
        },
    ]
}

/// The yes-or-no of a ray/box kernel.
pub type BoxKernel<V> = fn(&BoxRay<V>, &Aabb<V>) -> bool;

pub fn box_kernels<V: Vector>() -> [(&'static str, BoxKernel<V>); 6] {
    [
        ("slab::hits", slab::hits),
        ("slab::intersect", |ray, aabb| slab::intersect(ray, aabb).is_some()),
        ("conservative::hits", conservative::hits),
        ("conservative::interval", |ray, aabb| conservative::interval(ray, aabb).is_some()),
        ("exact::hits", box_exact::hits),
        ("exact::intersect", |ray, aabb| box_exact::intersect(ray, aabb).is_some()),
    ]
}

/// A triangle/box kernel.
pub type OverlapKernel<V> = fn(&Triangle<V>, &Aabb<V>) -> bool;

pub fn overlap_kernels<V: Vector>() -> [(&'static str, OverlapKernel<V>); 3] {
    [("sat", sat::overlaps), ("clip", clip::overlaps), ("exact", overlap_exact::overlaps)]
}
