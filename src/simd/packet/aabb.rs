//! One box against a packet: a node.

use fearless_simd::Simd;

use super::super::aabb::AabbHits;
use super::super::lanes::{Lanes, is_scalar, lanes_of, splat};
use super::RayPack;
use crate::ray::aabb::{BoxRay, conservative};
use crate::shape::Aabb;
use crate::vector::{Number, Vector};

impl<T: Lanes<N>, const N: usize> RayPack<T, N> {
    /// Which of some lanes' rays may hit the box, and where they enter it.
    ///
    /// t = (plane − o) · (1/d) per axis, all lanes at once; a ray of which the range reaches below zero, or of
    /// extreme coordinates, by itself.
    ///
    /// **Grade: conservative.** Each lane has the verdict of [`conservative::interval`], and its first t to
    /// the last bit.
    ///
    /// An empty box, a box with a NaN, a lane that is not active or never hit: no hit. The t of a lane without a hit
    /// means nothing.
    ///
    /// Call it where the level is known (see [the module](crate::simd)): there it is part of its caller.
    ///
    /// ```
    /// use isect::simd::{RayPack, fearless_simd::{Level, dispatch}};
    /// use isect::{Aabb, Ray, glam::Vec3};
    ///
    /// let node = Aabb::new(Vec3::ONE, Vec3::splat(2.0));
    /// let rays = [1.5, 1.0, 3.0].map(|x| Ray::new(Vec3::new(x, 1.5, 0.0), Vec3::Z));
    /// let packet = RayPack::<f32, 4>::from_rays(&rays);
    /// let hits = dispatch!(Level::new(), simd => packet.conservative(simd, &node, packet.active()));
    /// assert_eq!(hits.mask, 0b011);
    /// assert!(hits.t_enter[0] <= 1.0);
    /// ```
    #[inline(always)]
    #[must_use]
    pub fn conservative<S: Simd, V: Vector<Scalar = T>>(
        &self,
        simd: S,
        aabb: &Aabb<V>,
        active: u32,
    ) -> AabbHits<T, N> {
        let active = if aabb.is_empty() { 0 } else { active & self.active };
        if is_scalar(simd) {
            let mut hits = AabbHits { mask: 0, t_enter: [T::ZERO; N] };
            self.lane_by_lane(aabb, active, &mut hits);
            return hits;
        }
        let zero = splat(simd, T::ZERO);
        // The order of the scalar kernel's folds. For a parallel ray in a plane of the box a bound is 0 · ∞, a
        // NaN, which `min` and `max` drop in their first operand.
        let (mut enter, mut exit) = (T::load(simd, &self.t_min), T::load(simd, &self.t_max));
        for axis in 0..3 {
            let (min, max) = (aabb.min.component(axis), aabb.max.component(axis));
            let (min, max) = (splat(simd, min), splat(simd, max));
            let near_inverse = T::load(simd, &self.near_inverse[axis]);
            let backward = near_inverse.lt(zero);
            let origin = T::load(simd, &self.origin[axis]);
            let near = Number::select(backward, max, min) - origin;
            let far = Number::select(backward, min, max) - origin;
            enter = (near * near_inverse).max(enter);
            exit = (far * T::load(simd, &self.far_inverse[axis])).min(exit);
        }
        let mut hits = AabbHits {
            mask: <T as Lanes<N>>::bits::<S>(enter.le(exit)) & active,
            t_enter: <T as Lanes<N>>::store::<S>(enter.min(enter.largest())),
        };
        if active & self.boxed_apart != 0 {
            self.lane_by_lane(aabb, active & self.boxed_apart, &mut hits);
        }
        hits
    }

    /// The same by the scalar kernel, for some lanes.
    #[cold]
    #[inline(never)]
    fn lane_by_lane<V: Vector<Scalar = T>>(
        &self,
        aabb: &Aabb<V>,
        lanes: u32,
        hits: &mut AabbHits<T, N>,
    ) {
        hits.mask &= !lanes;
        for lane in lanes_of::<N>(lanes) {
            let ray = BoxRay::<V>::new(&self.get(lane));
            if let Some([enter, _]) = conservative::interval(&ray, aabb) {
                hits.mask |= 1 << lane;
                hits.t_enter[lane] = enter;
            }
        }
    }
}
