//! One sphere against a packet.

use fearless_simd::Simd;

use super::super::lanes::{Columns, Lanes, is_scalar, splat};
use super::super::sphere::SphereHits;
use super::{RayPack, replace};
use crate::ray::sphere::robust::{self, Approach, Certain};
use crate::ray::sphere::{Quadratic, SphereHit};
use crate::shape::Sphere;
use crate::vector::{Scalar, Vector};

/// The closest sphere so far of each ray in a packet, and the hit there.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct ClosestSpheres<T, const N: usize> {
    /// The ray's parameter at the hit of each lane; like the rest of no meaning in a lane without a hit.
    pub t: [T; N],
    /// The number of the sphere, as the caller gave it.
    pub index: [u32; N],
    /// Bit i tells whether ray i leaves the ball there.
    pub leaving: u32,
    /// Bit i tells whether ray i hit any.
    pub mask: u32,
}

/// No hits yet.
impl<T: Scalar, const N: usize> Default for ClosestSpheres<T, N> {
    fn default() -> Self {
        Self { t: [T::ZERO; N], index: [0; N], leaving: 0, mask: 0 }
    }
}

impl<T: Scalar, const N: usize> ClosestSpheres<T, N> {
    /// The sphere's number and the hit of a lane.
    #[inline]
    #[must_use]
    pub fn get(&self, lane: usize) -> Option<(u32, SphereHit<T>)> {
        if lane >= N || (self.mask >> lane) & 1 == 0 {
            return None;
        }
        let leaving = (self.leaving >> lane) & 1 == 1;
        Some((self.index[lane], SphereHit { t: self.t[lane], leaving }))
    }
}

impl<T: Lanes<N>, const N: usize> RayPack<T, N> {
    /// The nearest roots in the ranges of some lanes' rays.
    ///
    /// With f from the origin to the centre and q = f − (f·d/d²)·d: the roots of
    /// d²·t² − 2(f·d)·t + f² − r², from d²·(r + |q|)·(r − |q|) as the discriminant: the body of
    /// [`robust::intersect`], all lanes at once.
    ///
    /// The lanes that hit are returned; their `t_max` becomes the t of the hit, and `closest` gets it with the
    /// sphere's `index`. Of two spheres at the same t the later one stays.
    ///
    /// **Grade: exact**, and t within the bound of that kernel. Each lane has its verdict, and its t to the last
    /// bit. (A lane in which the error bound leaves the verdict open asks it.)
    ///
    /// A negative radius, a NaN or infinite field, a lane that is not active or never hit: no hit.
    ///
    /// Call it where the level is known (see [the module](crate::simd)): there it is part of its caller.
    ///
    /// ```
    /// use isect::simd::{ClosestSpheres, RayPack, fearless_simd::{Level, dispatch}};
    /// use isect::{Ray, Sphere, glam::Vec3};
    ///
    /// let spheres = [4.0, 9.0].map(|z| Sphere::new(Vec3::Z * z, 1.0));
    /// let rays = [0.0, 0.5, 1.5].map(|x| Ray::new(Vec3::X * x, Vec3::Z));
    /// let (mut packet, mut closest) = (RayPack::<f32, 4>::from_rays(&rays), ClosestSpheres::default());
    /// dispatch!(Level::new(), simd => for (index, sphere) in (0..).zip(&spheres) {
    ///     packet.robust(simd, sphere, index, packet.active(), &mut closest);
    /// });
    /// assert_eq!(closest.get(0).map(|(index, hit)| (index, hit.t)), Some((0, 3.0)));
    /// assert_eq!(closest.mask, 0b011);
    /// ```
    #[inline(always)]
    pub fn robust<S: Simd, V: Vector<Scalar = T>>(
        &mut self,
        simd: S,
        sphere: &Sphere<V>,
        index: u32,
        active: u32,
        closest: &mut ClosestSpheres<T, N>,
    ) -> u32 {
        let active = active & self.active;
        let hits = if is_scalar(simd) {
            let mut hits = SphereHits::NONE;
            hits.ask(active, |lane| robust::intersect(&self.get(lane), sphere));
            hits
        } else {
            let rays = self.wide(simd);
            let center: Columns<T::Wide<S>> = Columns::of(simd, sphere.center);
            let q =
                Quadratic::new(rays.direction, center - rays.origin, splat(simd, sphere.radius));
            let Certain { open, hit, t, leaving } =
                Approach::new(&q, splat(simd, T::EPSILON)).certain(&q, [rays.t_min, rays.t_max]);
            let open = T::bits::<S>(open | !q.is_mid_range()) & active;
            let mask = T::bits::<S>(hit) & active;
            if mask | open == 0 {
                return 0;
            }
            let mut hits = SphereHits { t: T::store::<S>(t), leaving: T::bits::<S>(leaving), mask };
            if open != 0 {
                self.ask_sphere(sphere, open, &mut hits);
            }
            hits
        };
        let mask = hits.mask;
        self.shorten(mask, &hits.t);
        replace(mask, &mut closest.t, &hits.t);
        replace(mask, &mut closest.index, &[index; N]);
        closest.leaving = closest.leaving & !mask | hits.leaving & mask;
        closest.mask |= mask;
        mask
    }

    /// Asks the later stages about the lanes in `open`.
    #[cold]
    #[inline(never)]
    fn ask_sphere<V: Vector<Scalar = T>>(
        &self,
        sphere: &Sphere<V>,
        open: u32,
        hits: &mut SphereHits<T, N>,
    ) {
        hits.ask(open, |lane| robust::undecided(&self.get(lane), sphere));
    }
}
