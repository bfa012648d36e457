//! What is found of spheres, by the rays of a packet or in the packs of a collection.

use super::lanes::lanes_of;
use crate::ray::sphere::SphereHit;
use crate::vector::Scalar;

/// Which lanes hit, and where.
pub(super) struct SphereHits<T, const N: usize> {
    pub(super) t: [T; N],
    pub(super) leaving: u32,
    pub(super) mask: u32,
}

impl<T: Scalar, const N: usize> SphereHits<T, N> {
    /// Nothing found.
    pub(super) const NONE: Self = Self { t: [T::ZERO; N], leaving: 0, mask: 0 };

    /// Asks about some lanes, and writes down what is found there.
    #[inline]
    pub(super) fn ask(&mut self, lanes: u32, intersect: impl Fn(usize) -> Option<SphereHit<T>>) {
        for lane in lanes_of::<N>(lanes) {
            let bit = 1 << lane;
            self.mask &= !bit;
            if let Some(hit) = intersect(lane) {
                self.t[lane] = hit.t;
                self.leaving = self.leaving & !bit | u32::from(hit.leaving) << lane;
                self.mask |= bit;
            }
        }
    }
}
