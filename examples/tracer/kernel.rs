//! The triangle kernels behind one trait, so that a loop over triangles is compiled once for each.
//!
//! The papers are named where the kernels live, in `isect::ray::triangle`.

use isect::glam::Vec3A;
use isect::ray::triangle::badouel::Prepared;
use isect::ray::triangle::watertight::ShearedRay;
use isect::ray::triangle::{TriangleHit, moller_trumbore, segura, watertight};
use isect::{Ray, Triangle};

/// A ray/triangle kernel with what it prepares: once per triangle, and once per ray.
pub(crate) trait TriangleKernel {
    /// A triangle as the kernel wants it.
    type Triangle: Send + Sync;
    /// A ray as the kernel wants it.
    type Ray;

    /// Prepares a triangle, once per scene.
    fn triangle(triangle: &Triangle<Vec3A>) -> Self::Triangle;

    /// Prepares a ray, once per traversal.
    fn ray(ray: &Ray<Vec3A>) -> Self::Ray;

    /// Lowers the end of the ray's range to the closest hit so far.
    fn shorten(ray: &mut Self::Ray, t_max: f32);

    /// Where the ray meets the triangle.
    fn intersect(ray: &Self::Ray, triangle: &Self::Triangle) -> Option<TriangleHit<f32>>;

    /// Whether it does.
    fn hits(ray: &Self::Ray, triangle: &Self::Triangle) -> bool {
        Self::intersect(ray, triangle).is_some()
    }
}

/// No ray slips between two triangles that share an edge.
pub(crate) struct Watertight;

impl TriangleKernel for Watertight {
    type Triangle = Triangle<Vec3A>;
    type Ray = ShearedRay<Vec3A>;

    fn triangle(triangle: &Triangle<Vec3A>) -> Self::Triangle {
        *triangle
    }

    fn ray(ray: &Ray<Vec3A>) -> Self::Ray {
        ShearedRay::new(ray)
    }

    fn shorten(ray: &mut Self::Ray, t_max: f32) {
        ray.t_max = t_max;
    }

    fn intersect(ray: &Self::Ray, triangle: &Self::Triangle) -> Option<TriangleHit<f32>> {
        watertight::intersect(ray, triangle)
    }
}

/// Nothing is prepared.
pub(crate) struct MollerTrumbore;

impl TriangleKernel for MollerTrumbore {
    type Triangle = Triangle<Vec3A>;
    type Ray = Ray<Vec3A>;

    fn triangle(triangle: &Triangle<Vec3A>) -> Self::Triangle {
        *triangle
    }

    fn ray(ray: &Ray<Vec3A>) -> Self::Ray {
        *ray
    }

    fn shorten(ray: &mut Self::Ray, t_max: f32) {
        ray.t_max = t_max;
    }

    fn intersect(ray: &Self::Ray, triangle: &Self::Triangle) -> Option<TriangleHit<f32>> {
        moller_trumbore::intersect(ray, triangle)
    }
}

/// The plane and the projected edges are prepared once per triangle.
pub(crate) struct Badouel;

impl TriangleKernel for Badouel {
    type Triangle = Prepared<Vec3A>;
    type Ray = Ray<Vec3A>;

    fn triangle(triangle: &Triangle<Vec3A>) -> Self::Triangle {
        Prepared::new(triangle)
    }

    fn ray(ray: &Ray<Vec3A>) -> Self::Ray {
        *ray
    }

    fn shorten(ray: &mut Self::Ray, t_max: f32) {
        ray.t_max = t_max;
    }

    fn intersect(ray: &Self::Ray, triangle: &Self::Triangle) -> Option<TriangleHit<f32>> {
        triangle.intersect(ray)
    }
}

/// Shadow rays need no division.
pub(crate) struct Segura;

impl TriangleKernel for Segura {
    type Triangle = Triangle<Vec3A>;
    type Ray = Ray<Vec3A>;

    fn triangle(triangle: &Triangle<Vec3A>) -> Self::Triangle {
        *triangle
    }

    fn ray(ray: &Ray<Vec3A>) -> Self::Ray {
        *ray
    }

    fn shorten(ray: &mut Self::Ray, t_max: f32) {
        ray.t_max = t_max;
    }

    fn intersect(ray: &Self::Ray, triangle: &Self::Triangle) -> Option<TriangleHit<f32>> {
        segura::intersect(ray, triangle)
    }

    fn hits(ray: &Self::Ray, triangle: &Self::Triangle) -> bool {
        segura::detects(ray, triangle)
    }
}
