//! Several shapes or rays at once: packs of triangles and boxes for the leaves and nodes of a hierarchy, packets
//! of rays, and collections for callers without a hierarchy.
//!
//! A pack holds up to `N` shapes as a structure of arrays, one per lane of the processor's vectors. A ray is
//! held against all of them at once, by the bodies of the scalar kernels where one body serves both. Each lane
//! has the scalar kernel's verdict, at every level, with or without fused operations.
//!
//! | pack | kernel | grade |
//! |---|---|---|
//! | [`AabbPack`] | [`AabbPack::conservative`]: mask and entries | conservative |
//! | [`TrianglePack`] | [`TrianglePack::exact`], [`TrianglePack::closest`], [`TrianglePack::any`] | exact |
//! | | [`TrianglePack::watertight`] | watertight |
//! | | [`TrianglePack::moller_trumbore`] | fast |
//!
//! `N` is 4, 8 or 16 in `f32`, 2, 4 or 8 in `f64`; a pack that is wider than the processor is held against the ray
//! in parts. Where there are no lanes at all, the scalar kernels are asked one by one.
//!
//! # Packets
//!
//! A [`RayPack`] holds `N` rays in the same way, for rays that go together, as those from a camera or to a light do:
//! one box or shape is held against all of them.
//!
//! | shape | kernel | grade |
//! |---|---|---|
//! | box | [`RayPack::conservative`]: mask and entries | conservative |
//! | triangle | [`RayPack::exact`], [`RayPack::exact_hits`] | exact |
//! | | [`RayPack::moller_trumbore`] | fast |
//! | sphere | [`RayPack::robust`] | exact |
//! | plane | [`RayPack::plane`] | exact |
//!
//! # Collections
//!
//! `Triangles`, `Spheres` and `Aabbs` (with the feature `alloc`) hold any number of shapes in packs, for some
//! hundreds that need no hierarchy: `closest`, `any` and `hits` dispatch once, by themselves, and have the verdicts of the
//! exact kernels.
//!
//! # Levels
//!
//! Which instructions the processor has is found out at run time, with no compiler flags, by
//! [`fearless_simd`]: `Level::new()` looks (it needs `std` on x86-64; `Level::baseline()` does not), and
//! `dispatch!` enters the level. Do that once per traversal, around the loop: a dispatch costs as much as a few
//! of these tests. Everything between `dispatch!` and the kernels must be `#[inline(always)]`, closures too: a
//! function that is not would be compiled without the level's instructions, and cost several times as much.
//!
//! ```
//! use isect::simd::fearless_simd::{Level, Simd, dispatch};
//! use isect::simd::{AabbPack, TrianglePack};
//! use isect::{Aabb, Ray, Triangle, glam::Vec3, ray::aabb::BoxRay};
//!
//! struct Mesh {
//!     bounds: AabbPack<f32, 8>,
//!     leaves: [TrianglePack<f32, 4>; 8],
//! }
//!
//! impl Mesh {
//!     fn closest_t(&self, level: Level, ray: &Ray) -> Option<f32> {
//!         dispatch!(level, simd => self.closest_t_at(simd, *ray))
//!     }
//!
//!     #[inline(always)]
//!     fn closest_t_at<S: Simd>(&self, simd: S, mut ray: Ray) -> Option<f32> {
//!         let mut closest = None;
//!         let nodes = self.bounds.conservative(simd, &BoxRay::new(&ray));
//!         for child in (0..8).filter(|child| (nodes.mask >> child) & 1 == 1) {
//!             if let Some((_, hit)) = self.leaves[child].closest(simd, &ray) {
//!                 if closest.is_none_or(|t| hit.t < t) {
//!                     closest = Some(hit.t);
//!                 }
//!                 // By the next float: the exact t may be beyond the rounded one.
//!                 ray.t_max = hit.t.next_up().min(ray.t_max);
//!             }
//!         }
//!         closest
//!     }
//! }
//!
//! let at = |z: f32| Triangle::new(Vec3::new(0.0, 0.0, z), Vec3::new(1.0, 0.0, z), Vec3::new(0.0, 1.0, z));
//! let triangles = [at(5.0), at(2.0), at(3.0)];
//! let mut mesh = Mesh { bounds: AabbPack::from_aabbs(&triangles.map(|t| t.aabb())), leaves: Default::default() };
//! for (leaf, triangle) in mesh.leaves.iter_mut().zip(triangles) {
//!     *leaf = TrianglePack::from_triangles(&[triangle]);
//! }
//! let ray = Ray::new(Vec3::new(0.2, 0.2, 0.0), Vec3::Z);
//! assert_eq!(mesh.closest_t(Level::new(), &ray), Some(2.0));
//! ```

mod aabb;
#[cfg(feature = "alloc")]
mod collection;
mod filter;
mod lanes;
mod packet;
mod sphere;
mod triangle;

pub use aabb::{AabbHits, AabbPack};
#[cfg(feature = "alloc")]
pub use collection::{Aabbs, Spheres, Triangles};
pub use fearless_simd;
pub use lanes::Lanes;
pub use packet::{ClosestSpheres, ClosestTriangles, PlaneHits, RayPack};
pub use triangle::{TriangleHits, TrianglePack};

#[cfg(test)]
mod tests {
    use fearless_simd::Level;

    /// Every level with lanes that this processor has.
    pub(super) fn levels() -> impl Iterator<Item = Level> {
        let best = Level::new();
        let levels = [Some(best).filter(|level| !level.is_fallback())];
        #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
        let levels = levels.into_iter().chain([
            best.as_sse2().map(Level::Sse2),
            best.as_sse4_2().map(Level::Sse4_2),
            best.as_avx2().map(Level::Avx2),
        ]);
        levels.into_iter().flatten()
    }
}
