//! Boxes without a hierarchy.

use core::slice;

use fearless_simd::{Level, Simd, dispatch};

use super::super::aabb::AabbPack;
use super::super::lanes::{Lanes, lanes_of};
use super::{Packs, any, closer, side_by_side};
use crate::ray::aabb::{AabbHit, BoxRay, exact};
use crate::shape::{Aabb, Ray};
use crate::vector::Vector;

/// Some boxes, in packs of `N`, for rays that are held against all of them: up to some hundreds, where a
/// hierarchy does not pay.
///
/// Every verdict is that of [`exact::hits`]: it is asked about the boxes that the conservative packs let pass. Each call
/// dispatches once ([`Self::hits`] for every 64 of them), to the level of the processor, which the collection has found out
/// when it was made.
///
/// ```
/// use isect::simd::Aabbs;
/// use isect::{Aabb, Face, Ray, glam::Vec3};
///
/// let at = |x: f32| Aabb::new(Vec3::splat(x), Vec3::splat(x + 1.0));
/// let boxes: Aabbs = [at(4.0), at(-3.0), at(2.0)].into_iter().collect();
/// let ray = Ray::new(Vec3::new(0.0, 0.5, 0.5), Vec3::ONE);
/// let (index, hit) = boxes.closest(&ray).expect("a hit");
/// assert_eq!((index, hit.t_enter, hit.enter_face), (2, 2.0, Some(Face::NegX)));
/// assert_eq!(boxes.hits(&ray).collect::<Vec<_>>(), [0, 2]);
/// assert!(boxes.any(&ray) && !boxes.any(&ray.with_range(0.0, 1.0)));
/// ```
#[derive(Clone, Debug)]
pub struct Aabbs<T = f32, const N: usize = 8> {
    packs: Packs<AabbPack<T, N>>,
}

impl<T, const N: usize> Default for Aabbs<T, N> {
    fn default() -> Self {
        Self { packs: Packs::default() }
    }
}

impl<T: Lanes<N>, V: Vector<Scalar = T>, const N: usize> Extend<Aabb<V>> for Aabbs<T, N> {
    fn extend<I: IntoIterator<Item = Aabb<V>>>(&mut self, aabbs: I) {
        self.packs.extend(aabbs, N, AabbPack::from_aabbs, AabbPack::get);
    }
}

impl<T: Lanes<N>, V: Vector<Scalar = T>, const N: usize> FromIterator<Aabb<V>> for Aabbs<T, N> {
    fn from_iter<I: IntoIterator<Item = Aabb<V>>>(aabbs: I) -> Self {
        let mut all = Self::default();
        all.extend(aabbs);
        all
    }
}

impl<T: Lanes<N>, const N: usize> Aabbs<T, N> {
    /// The same boxes, but with another level for the calls to come: where there is no standard library to find it
    /// out with, and in tests.
    #[must_use]
    pub fn with_level(mut self, level: Level) -> Self {
        self.packs.level = level;
        self
    }

    /// How many there are, the empty ones too.
    #[must_use]
    pub const fn len(&self) -> usize {
        self.packs.len
    }

    /// Whether there are none.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.packs.len == 0
    }

    /// The box at an index; for one that was empty, or had a NaN, [`Aabb::EMPTY`].
    #[must_use]
    pub fn get<V: Vector<Scalar = T>>(&self, index: usize) -> Option<Aabb<V>> {
        self.packs.get(index, N, AabbPack::get)
    }

    /// The box that the ray enters first in its closed range, by its index, and where it enters and leaves it: the
    /// hit of [`exact::intersect`] with the least `t_enter`; of several the one of the lowest index.
    ///
    /// **Grade: exact** for hit or miss.
    ///
    /// A zero direction, a NaN or infinite origin or direction, an empty range: `None`.
    #[must_use]
    pub fn closest<V: Vector<Scalar = T>>(&self, ray: &Ray<V>) -> Option<(usize, AabbHit<T>)> {
        let mut closest = [None];
        self.closest_of(slice::from_ref(ray), &mut closest);
        closest[0]
    }

    /// [`Self::closest`] for many rays, with one dispatch for all.
    ///
    /// # Panics
    ///
    /// If there are not as many places in `closest` as rays.
    pub fn closest_of<V: Vector<Scalar = T>>(
        &self,
        rays: &[Ray<V>],
        closest: &mut [Option<(usize, AabbHit<T>)>],
    ) {
        assert_eq!(rays.len(), closest.len(), "a place for the hit of each ray");
        dispatch!(self.packs.level, simd => {
            for (ray, closest) in rays.iter().zip(closest) {
                *closest = self.closest_at(simd, ray);
            }
        });
    }

    /// Whether the ray hits any of them.
    ///
    /// **Grade: exact.**
    #[must_use]
    pub fn any<V: Vector<Scalar = T>>(&self, ray: &Ray<V>) -> bool {
        let ray = BoxRay::new(ray);
        dispatch!(self.packs.level, simd => any(
            &self.packs.packs,
            #[inline(always)]
            |pack| exact_mask(simd, pack, &ray) != 0,
        ))
    }

    /// The indices of all that the ray hits, in order.
    ///
    /// **Grade: exact.**
    pub fn hits<'a, V: Vector<Scalar = T>>(
        &'a self,
        ray: &Ray<V>,
    ) -> impl Iterator<Item = usize> + use<'a, T, V, N> {
        let (ray, level) = (BoxRay::new(ray), self.packs.level);
        self.packs.indices(N, move |packs| {
            dispatch!(level, simd => side_by_side(
                packs,
                N,
                #[inline(always)]
                |pack| exact_mask(simd, pack, &ray),
            ))
        })
    }

    #[inline(always)]
    fn closest_at<S: Simd, V: Vector<Scalar = T>>(
        &self,
        simd: S,
        ray: &Ray<V>,
    ) -> Option<(usize, AabbHit<T>)> {
        let ray = BoxRay::new(ray);
        let mut best: Option<(usize, AabbHit<T>)> = None;
        for (number, pack) in self.packs.packs.iter().enumerate() {
            let hits = pack.conservative(simd, &ray);
            if hits.mask == 0 {
                continue;
            }
            for lane in lanes_of::<N>(hits.mask) {
                // A conservative entry is not beyond the one that is reported.
                if best.is_none_or(|(_, best)| hits.t_enter[lane] < best.t_enter) {
                    let hit = exact::intersect(&ray, &pack.get::<V>(lane));
                    let next = hit.map(|hit| (number * N + lane, hit));
                    best = closer(best, next, |next, best| next.t_enter < best.t_enter);
                }
            }
        }
        best
    }
}

/// The lanes that are hit.
#[inline(always)]
fn exact_mask<T: Lanes<N>, S: Simd, V: Vector<Scalar = T>, const N: usize>(
    simd: S,
    pack: &AabbPack<T, N>,
    ray: &BoxRay<V>,
) -> u32 {
    let mask = pack.conservative(simd, ray).mask;
    if mask == 0 { 0 } else { exact_of(pack, ray, mask) }
}

/// The lanes of a mask that are hit.
#[inline(never)]
fn exact_of<T: Lanes<N>, V: Vector<Scalar = T>, const N: usize>(
    pack: &AabbPack<T, N>,
    ray: &BoxRay<V>,
    mask: u32,
) -> u32 {
    lanes_of::<N>(mask)
        .filter(|&lane| exact::hits(ray, &pack.get(lane)))
        .fold(0, |lanes, lane| lanes | 1 << lane)
}
