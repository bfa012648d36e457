//! What finds the triangles that a ray hits; and the simplest such thing, the naïve loop.
//!
//! Every accelerator gives the same answers: the least t wins, and of equal ones, as on the edge
//! between two triangles, the first triangle of the mesh. So a picture does not depend on it.

use isect::glam::Vec3A;
use isect::ray::triangle::TriangleHit;
use isect::{Ray, Triangle};

use crate::kernel::TriangleKernel;

/// A hit and the triangle of the mesh that it is on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct MeshHit {
    /// The triangle's place in the mesh.
    pub(crate) triangle: u32,
    /// Where it is hit.
    pub(crate) hit: TriangleHit<f32>,
}

impl MeshHit {
    /// Whether this hit is to be preferred to the closest one so far.
    pub(crate) fn is_before(&self, closest: &Option<Self>) -> bool {
        closest.is_none_or(|closest| {
            self.hit.t < closest.hit.t
                || (self.hit.t == closest.hit.t && self.triangle < closest.triangle)
        })
    }
}

/// Finds the triangles that a ray hits.
pub(crate) trait Accelerator: Sync {
    /// The closest hit in the ray's range.
    fn closest(&self, ray: &Ray<Vec3A>) -> Option<MeshHit>;

    /// Whether there is any hit in the ray's range.
    fn occluded(&self, ray: &Ray<Vec3A>) -> bool;
}

/// Every ray against every triangle.
pub(crate) struct NaiveLoop<K: TriangleKernel> {
    /// The triangles in the mesh's order.
    triangles: Vec<K::Triangle>,
}

impl<K: TriangleKernel> NaiveLoop<K> {
    /// Prepares the triangles.
    pub(crate) fn new(triangles: &[Triangle<Vec3A>]) -> Self {
        Self { triangles: triangles.iter().map(K::triangle).collect() }
    }
}

impl<K: TriangleKernel> Accelerator for NaiveLoop<K> {
    fn closest(&self, ray: &Ray<Vec3A>) -> Option<MeshHit> {
        let mut ray = K::ray(ray);
        let mut closest = None;
        for (triangle, prepared) in (0..).zip(&self.triangles) {
            if let Some(hit) = K::intersect(&ray, prepared) {
                let found = MeshHit { triangle, hit };
                if found.is_before(&closest) {
                    K::shorten(&mut ray, hit.t);
                    closest = Some(found);
                }
            }
        }
        closest
    }

    fn occluded(&self, ray: &Ray<Vec3A>) -> bool {
        let ray = K::ray(ray);
        self.triangles.iter().any(|triangle| K::hits(&ray, triangle))
    }
}
