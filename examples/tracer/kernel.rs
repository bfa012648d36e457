//! The triangle kernels behind one trait, so that a loop over triangles is compiled once for each.
//!
//! The papers are named where the kernels live, in `isect::ray::triangle`.

use isect::glam::Vec3A;
use isect::ray::triangle::badouel::Prepared;
use isect::ray::triangle::watertight::ShearedRay;
use isect::ray::triangle::{TriangleHit, exact, moller_trumbore, segura, watertight};
use isect::{Ray, Triangle};

/// A ray/triangle kernel with what it prepares: once per triangle, and once per ray.
pub(crate) trait TriangleKernel {
    /// A triangle as the kernel wants it.
    type Triangle: Send + Sync;
    /// A ray as the kernel wants it.
    type Ray;

    /// By how many roundings of their distance from the ray's origin it may see vertices moved: boxes of
    /// a hierarchy have to be wider by as much.
    const ROUNDINGS: f32 = 10.0;

    /// Prepares a triangle, once per scene.
    fn triangle(triangle: &Triangle<Vec3A>) -> Self::Triangle;

    /// Prepares a ray, once per traversal.
    fn ray(ray: &Ray<Vec3A>) -> Self::Ray;

    /// Lowers the end of the ray's range to the closest hit so far, so that one as close is still found.
    fn shorten(ray: &mut Self::Ray, t: f32);

    /// Where the ray meets the triangle.
    fn intersect(ray: &Self::Ray, triangle: &Self::Triangle) -> Option<TriangleHit<f32>>;

    /// Whether it does.
    fn hits(ray: &Self::Ray, triangle: &Self::Triangle) -> bool {
        Self::intersect(ray, triangle).is_some()
    }
}

/// A kernel that prepares nothing.
trait Plain {
    const ROUNDINGS: f32;

    fn shortened(t: f32) -> f32 {
        t
    }

    fn intersect(ray: &Ray<Vec3A>, triangle: &Triangle<Vec3A>) -> Option<TriangleHit<f32>>;

    fn hits(ray: &Ray<Vec3A>, triangle: &Triangle<Vec3A>) -> bool {
        Self::intersect(ray, triangle).is_some()
    }
}

impl<K: Plain> TriangleKernel for K {
    type Triangle = Triangle<Vec3A>;
    type Ray = Ray<Vec3A>;

    const ROUNDINGS: f32 = <Self as Plain>::ROUNDINGS;

    fn triangle(triangle: &Triangle<Vec3A>) -> Self::Triangle {
        *triangle
    }

    fn ray(ray: &Ray<Vec3A>) -> Self::Ray {
        *ray
    }

    fn shorten(ray: &mut Self::Ray, t: f32) {
        ray.t_max = Self::shortened(t).min(ray.t_max);
    }

    fn intersect(ray: &Self::Ray, triangle: &Self::Triangle) -> Option<TriangleHit<f32>> {
        <Self as Plain>::intersect(ray, triangle)
    }

    fn hits(ray: &Self::Ray, triangle: &Self::Triangle) -> bool {
        <Self as Plain>::hits(ray, triangle)
    }
}

/// Never wrong, and t, u, v to the last digit. All that is hit is refined, not the closest alone: of triangles within the
/// error of a t, which one that is would depend on the order of the visits.
pub(crate) struct Exact;

impl Plain for Exact {
    const ROUNDINGS: f32 = 0.0;

    /// The kernel compares the exact t, which the rounded one may be below.
    fn shortened(t: f32) -> f32 {
        t.next_up()
    }

    fn intersect(ray: &Ray<Vec3A>, triangle: &Triangle<Vec3A>) -> Option<TriangleHit<f32>> {
        exact::hits(ray, triangle).then(|| exact::refine(ray, triangle))
    }

    fn hits(ray: &Ray<Vec3A>, triangle: &Triangle<Vec3A>) -> bool {
        exact::hits(ray, triangle)
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

    fn shorten(ray: &mut Self::Ray, t: f32) {
        ray.t_max = t;
    }

    fn intersect(ray: &Self::Ray, triangle: &Self::Triangle) -> Option<TriangleHit<f32>> {
        watertight::intersect(ray, triangle)
    }
}

/// As fast as it gets, but for a ray lost now and then.
pub(crate) struct MollerTrumbore;

impl Plain for MollerTrumbore {
    const ROUNDINGS: f32 = 10.0;

    fn intersect(ray: &Ray<Vec3A>, triangle: &Triangle<Vec3A>) -> Option<TriangleHit<f32>> {
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

    fn shorten(ray: &mut Self::Ray, t: f32) {
        ray.t_max = t;
    }

    fn intersect(ray: &Self::Ray, triangle: &Self::Triangle) -> Option<TriangleHit<f32>> {
        triangle.intersect(ray)
    }
}

/// Shadow rays need no division.
pub(crate) struct Segura;

impl Plain for Segura {
    const ROUNDINGS: f32 = 10.0;

    fn intersect(ray: &Ray<Vec3A>, triangle: &Triangle<Vec3A>) -> Option<TriangleHit<f32>> {
        segura::intersect(ray, triangle)
    }

    fn hits(ray: &Ray<Vec3A>, triangle: &Triangle<Vec3A>) -> bool {
        segura::detects(ray, triangle)
    }
}
