//! Boxes side by side: the children of a node.

use fearless_simd::{Level, Simd, dispatch};

use super::lanes::{Lanes, is_scalar, splat};
use crate::ray::aabb::{BoxRay, conservative};
use crate::shape::Aabb;
use crate::vector::{Number, Vector};

/// `N` boxes, the bounds of all on an axis side by side.
///
/// ```
/// use isect::simd::{AabbPack, fearless_simd::{Level, dispatch}};
/// use isect::{Aabb, Ray, glam::Vec3, ray::aabb::BoxRay};
///
/// let child = |x: f32| Aabb::new(Vec3::splat(x), Vec3::splat(x + 1.0));
/// // Five of the lanes stay empty.
/// let node = AabbPack::<f32, 8>::from_aabbs(&[child(4.0), child(1.0), child(-9.0)]);
/// let ray = BoxRay::new(&Ray::new(Vec3::ZERO, Vec3::ONE));
/// let hits = dispatch!(Level::new(), simd => node.conservative(simd, &ray));
/// assert_eq!(hits.mask, 0b011);
/// assert!(hits.t_enter[1] < hits.t_enter[0]);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct AabbPack<T, const N: usize> {
    /// By axis and lane, the least and the greatest coordinates. An empty box is from ∞ to −∞.
    bounds: [[[T; N]; 2]; 3],
}

/// Which boxes of a pack a ray may hit, and where it enters them.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct AabbHits<T, const N: usize> {
    /// Where it enters the box of each lane; of no meaning in a lane that is not hit.
    pub t_enter: [T; N],
    /// Bit i tells whether the box of lane i may be hit.
    pub mask: u32,
}

/// Nothing but empty lanes.
impl<T: Lanes<N>, const N: usize> Default for AabbPack<T, N> {
    fn default() -> Self {
        Self { bounds: [[[T::INFINITY; N], [-T::INFINITY; N]]; 3] }
    }
}

impl<T: Lanes<N>, const N: usize> AabbPack<T, N> {
    /// The boxes, from lane 0 on. The other lanes, and those of empty boxes and of boxes with a NaN, are
    /// never hit.
    ///
    /// # Panics
    ///
    /// If there are more than `N` boxes.
    #[must_use]
    pub fn from_aabbs<V: Vector<Scalar = T>>(aabbs: &[Aabb<V>]) -> Self {
        assert!(aabbs.len() <= N, "{} boxes for {N} lanes", aabbs.len());
        let mut pack = Self::default();
        for (lane, aabb) in aabbs.iter().enumerate().filter(|(_, aabb)| !aabb.is_empty()) {
            for axis in 0..3 {
                pack.bounds[axis][0][lane] = aabb.min.component(axis);
                pack.bounds[axis][1][lane] = aabb.max.component(axis);
            }
        }
        pack
    }

    /// The box of a lane; an empty one, from ∞ to −∞, where there is none.
    #[inline]
    #[must_use]
    pub fn get<V: Vector<Scalar = T>>(&self, lane: usize) -> Aabb<V> {
        if lane >= N {
            return Aabb::EMPTY;
        }
        let [min, max] = [0, 1].map(|side| {
            let [x, y, z] = self.bounds.each_ref().map(|axis| axis[side][lane]);
            V::new(x, y, z)
        });
        Aabb::new(min, max)
    }

    /// Which boxes the ray may hit, and where it enters them.
    ///
    /// t = (plane − o) · (1/d) per axis, all lanes at once; for a ray of which the range reaches below zero, or
    /// of extreme coordinates, lane by lane.
    ///
    /// **Grade: conservative.** Each lane has the verdict of [`conservative::interval`], and its first t to
    /// the last bit.
    ///
    /// An empty lane, a zero direction, a NaN or infinite origin or direction: no hit.
    ///
    /// Call it where the level is known (see [the module](super)): there it is part of its caller.
    #[inline(always)]
    #[must_use]
    pub fn conservative<S: Simd, V: Vector<Scalar = T>>(
        &self,
        simd: S,
        ray: &BoxRay<V>,
    ) -> AabbHits<T, N> {
        if is_scalar(simd) {
            return self.lane_by_lane(*ray);
        }
        let (t_enter, mask) = if ray.extreme | ray.before_origin {
            // Back into registers, so that the answer is not stored twice where it is not from here.
            let hits = self.lane_by_lane(*ray);
            (T::load(simd, &hits.t_enter), hits.mask)
        } else {
            self.bounds(simd, ray)
        };
        AabbHits { t_enter: T::store::<S>(t_enter), mask }
    }

    /// The last entries, and which of them do not come after the first exit.
    #[inline(always)]
    fn bounds<S: Simd, V: Vector<Scalar = T>>(
        &self,
        simd: S,
        ray: &BoxRay<V>,
    ) -> (T::Wide<S>, u32) {
        // The order of the scalar kernel's folds. For a parallel ray in a plane of the box a bound is 0 · ∞, a
        // NaN, which `min` and `max` drop in their first operand.
        let (mut enter, mut exit) = (splat(simd, ray.t_min), splat(simd, ray.t_max));
        for axis in 0..3 {
            let backward = usize::from(ray.entry_side[axis] & 1);
            let negated_origin = splat(simd, ray.negated_origin.component(axis));
            let near = T::load(simd, &self.bounds[axis][backward]) + negated_origin;
            let far = T::load(simd, &self.bounds[axis][backward ^ 1]) + negated_origin;
            enter = (near * splat(simd, ray.near_inverse.component(axis))).max(enter);
            exit = (far * splat(simd, ray.far_inverse.component(axis))).min(exit);
        }
        (enter.min(enter.largest()), <T as Lanes<N>>::bits::<S>(enter.le(exit)))
    }

    /// The same by the scalar kernel.
    #[cold]
    #[inline(never)]
    fn lane_by_lane<V: Vector<Scalar = T>>(&self, ray: BoxRay<V>) -> AabbHits<T, N> {
        let mut hits = AabbHits { mask: 0, t_enter: [T::ZERO; N] };
        for (lane, t_enter) in hits.t_enter.iter_mut().enumerate() {
            if let Some([enter, _]) = conservative::interval(&ray, &self.get::<V>(lane)) {
                hits.mask |= 1 << lane;
                *t_enter = enter;
            }
        }
        hits
    }

    /// [`Self::conservative`] for a caller without a level. Slow: the dispatch costs as much as the test.
    #[must_use]
    pub fn dispatch_conservative<V: Vector<Scalar = T>>(
        &self,
        level: Level,
        ray: &BoxRay<V>,
    ) -> AabbHits<T, N> {
        dispatch!(level, simd => self.conservative(simd, ray))
    }
}
