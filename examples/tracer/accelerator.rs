//! What finds the triangles that a ray hits; and the simplest such thing, the naïve loop.
//!
//! Every accelerator gives the same answers: the least t wins, and of equal ones, as on the edge
//! between two triangles, the first triangle of the mesh. So a picture does not depend on it.

use isect::glam::Vec3A;
use isect::ray::triangle::TriangleHit;
use isect::{Ray, Triangle};

use crate::kernel::TriangleKernel;

/// The most rays that go together.
pub(crate) const PACKET: usize = 8;

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

    /// The closest hits of rays that go together.
    fn closest_of_packet(&self, rays: &[Ray<Vec3A>]) -> [Option<MeshHit>; PACKET] {
        let mut hits = [None; PACKET];
        for (hit, ray) in hits.iter_mut().zip(rays) {
            *hit = self.closest(ray);
        }
        hits
    }

    /// Which of some rays that go together have any hit; the rays that count and the answer are bits.
    fn occluded_of_packet(&self, rays: &[Ray<Vec3A>], active: u32) -> u32 {
        lanes(active)
            .filter(|&lane| self.occluded(&rays[lane]))
            .fold(0, |occluded, lane| occluded | 1 << lane)
    }
}

/// The places of the bits that are set.
#[inline(always)]
pub(crate) fn lanes(mut mask: u32) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let lane = mask.trailing_zeros() as usize;
        mask &= mask.checked_sub(1)?;
        Some(lane)
    })
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
