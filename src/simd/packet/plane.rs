//! One plane against a packet.

use fearless_simd::Simd;

use super::super::lanes::{Columns, Lanes, is_scalar, lanes_of, splat};
use super::RayPack;
use crate::ray::plane::{self, Certain, PlaneHit};
use crate::shape::{Plane, Ray};
use crate::vector::{Scalar, Vector};

/// Which rays of a packet meet a plane, and how.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct PlaneHits<T, const N: usize> {
    /// Where the ray of each lane crosses the plane; of no meaning in a lane that does not.
    pub t: [T; N],
    /// Bit i tells whether ray i crosses the plane, at `t[i]`.
    pub mask: u32,
    /// Bit i tells whether ray i lies in the plane.
    pub contained: u32,
}

impl<T: Scalar, const N: usize> PlaneHits<T, N> {
    /// The hit of a lane.
    #[inline]
    #[must_use]
    pub fn get(&self, lane: usize) -> Option<PlaneHit<T>> {
        let has = |mask: u32| lane < N && (mask >> lane) & 1 == 1;
        if has(self.contained) {
            Some(PlaneHit::Contained)
        } else {
            has(self.mask).then(|| PlaneHit::At(self.t[lane]))
        }
    }
}

impl<T: Lanes<N>, const N: usize> RayPack<T, N> {
    /// Where some lanes' rays meet the plane: nowhere, at one t, or everywhere.
    ///
    /// t = (offset − n·o) / (n·d): the body of [`plane::intersect`], all lanes at once.
    ///
    /// `t_max` stays as it is, since a ray that lies in the plane has no t to shorten it to: for the others
    /// call [`Self::shorten`].
    ///
    /// **Grade: exact**, and t within the bound of that kernel. Each lane has its outcome, and its t to the last
    /// bit. (A lane in which the error bound leaves the outcome open asks it.)
    ///
    /// A zero normal, a NaN or infinite field, a lane that is not active or never hit: no hit.
    ///
    /// Call it where the level is known (see [the module](crate::simd)): there it is part of its caller.
    ///
    /// ```
    /// use isect::simd::{RayPack, fearless_simd::{Level, dispatch}};
    /// use isect::{Plane, Ray, glam::Vec3, ray::plane::PlaneHit};
    ///
    /// let floor = Plane::from_point_normal(Vec3::ZERO, Vec3::Y).expect("the normal is not zero");
    /// let from = |y: f32, direction| Ray::new(Vec3::Y * y, direction);
    /// let rays = [from(2.0, -Vec3::Y), from(2.0, Vec3::X), from(0.0, Vec3::X)];
    /// let mut packet = RayPack::<f32, 4>::from_rays(&rays);
    /// let hits = dispatch!(Level::new(), simd => packet.plane(simd, &floor, packet.active()));
    /// let expected = [Some(PlaneHit::At(2.0)), None, Some(PlaneHit::Contained), None];
    /// assert_eq!([0, 1, 2, 3].map(|lane| hits.get(lane)), expected);
    /// packet.shorten(hits.mask, &hits.t);
    /// assert_eq!(packet.t_max[0], 2.0);
    /// ```
    #[inline(always)]
    #[must_use]
    pub fn plane<S: Simd, V: Vector<Scalar = T>>(
        &self,
        simd: S,
        plane: &Plane<V>,
        active: u32,
    ) -> PlaneHits<T, N> {
        let active = active & self.active;
        if is_scalar(simd) {
            let mut hits = PlaneHits { t: [T::ZERO; N], mask: 0, contained: 0 };
            self.ask_plane(plane, active, &mut hits, plane::intersect);
            return hits;
        }
        let lanes =
            Plane { normal: Columns::of(simd, plane.normal), offset: splat(simd, plane.offset) };
        let (epsilon, tiny) = (splat(simd, T::EPSILON), splat(simd, T::MIN_POSITIVE));
        let Certain { open, hit, t } = plane::certain(&self.wide(simd), &lanes, epsilon, tiny);
        let mut hits =
            PlaneHits { t: T::store::<S>(t), mask: T::bits::<S>(hit) & active, contained: 0 };
        let open = T::bits::<S>(open) & active;
        if open != 0 {
            self.ask_plane(plane, open, &mut hits, plane::undecided);
        }
        hits
    }

    /// Asks the scalar kernel about the lanes in `open`.
    #[cold]
    #[inline(never)]
    fn ask_plane<V: Vector<Scalar = T>>(
        &self,
        plane: &Plane<V>,
        open: u32,
        hits: &mut PlaneHits<T, N>,
        intersect: impl Fn(&Ray<V>, &Plane<V>) -> Option<PlaneHit<T>>,
    ) {
        for lane in lanes_of::<N>(open) {
            match intersect(&self.get(lane), plane) {
                Some(PlaneHit::At(t)) => {
                    hits.t[lane] = t;
                    hits.mask |= 1 << lane;
                }
                Some(PlaneHit::Contained) => hits.contained |= 1 << lane,
                None => {}
            }
        }
    }
}
