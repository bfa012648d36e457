//! One triangle against a packet.

use fearless_simd::Simd;

use super::super::filter::{self, Filtered};
use super::super::lanes::{Columns, Lanes, is_scalar, lanes_of};
use super::super::triangle::TriangleHits;
use super::{RayPack, replace};
use crate::ray::triangle::{Frame, TriangleHit, exact, moller_trumbore};
use crate::shape::{Ray, Triangle};
use crate::vector::{Scalar, Vector};

/// The closest triangle so far of each ray in a packet, and the hit there.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct ClosestTriangles<T, const N: usize> {
    /// The ray's parameter at the hit of each lane; like the rest of no meaning in a lane without a hit.
    pub t: [T; N],
    /// The weight of `v1`.
    pub u: [T; N],
    /// The weight of `v2`.
    pub v: [T; N],
    /// The number of the triangle, as the caller gave it.
    pub index: [u32; N],
    /// Bit i tells whether the direction of ray i runs against the normal of its triangle.
    pub front: u32,
    /// Bit i tells whether ray i hit any.
    pub mask: u32,
}

/// No hits yet.
impl<T: Scalar, const N: usize> Default for ClosestTriangles<T, N> {
    fn default() -> Self {
        let numbers = [T::ZERO; N];
        Self { t: numbers, u: numbers, v: numbers, index: [0; N], front: 0, mask: 0 }
    }
}

impl<T: Scalar, const N: usize> ClosestTriangles<T, N> {
    /// The triangle's number and the hit of a lane.
    #[inline]
    #[must_use]
    pub fn get(&self, lane: usize) -> Option<(u32, TriangleHit<T>)> {
        if lane >= N || (self.mask >> lane) & 1 == 0 {
            return None;
        }
        let front = (self.front >> lane) & 1 == 1;
        let hit = TriangleHit { t: self.t[lane], u: self.u[lane], v: self.v[lane], front };
        Some((self.index[lane], hit))
    }

    /// Takes over the hits of one triangle.
    #[inline(always)]
    fn keep(&mut self, hits: &TriangleHits<T, N>, index: u32) {
        replace(hits.mask, &mut self.t, &hits.t);
        replace(hits.mask, &mut self.u, &hits.u);
        replace(hits.mask, &mut self.v, &hits.v);
        replace(hits.mask, &mut self.index, &[index; N]);
        self.front = self.front & !hits.mask | hits.front & hits.mask;
        self.mask |= hits.mask;
    }
}

impl<T: Lanes<N>, const N: usize> RayPack<T, N> {
    /// Where the rays of some lanes meet the triangle, in their closed ranges.
    ///
    /// t = s·n/det, u = (s × d)·e2/det, v = −(s × d)·e1/det, det = −d·n: the body of
    /// [`moller_trumbore::intersect`], all lanes at once.
    ///
    /// The lanes that hit are returned; their `t_max` becomes the t of the hit, and `closest` gets it with the
    /// triangle's `index`. Of two triangles at the same t the later one stays.
    ///
    /// **Grade: fast.** Each lane has the verdict of that kernel, and its t, u and v to the last bit. (A lane of
    /// which the products may have over- or underflowed asks it.)
    ///
    /// A triangle without area as computed, or with a NaN or infinite vertex, a lane that is not active or never hit: no
    /// hit.
    ///
    /// Call it where the level is known (see [the module](crate::simd)): there it is part of its caller.
    ///
    /// ```
    /// use isect::simd::{ClosestTriangles, RayPack, fearless_simd::{Level, dispatch}};
    /// use isect::{Ray, Triangle, glam::Vec3, ray::triangle::moller_trumbore};
    ///
    /// let triangle = Triangle::new(Vec3::ZERO, Vec3::X, Vec3::Y);
    /// let rays = [0.1, 0.2, 0.7].map(|x| Ray::new(Vec3::new(x, x, 0.7), Vec3::new(0.1, 0.1, -0.3)));
    /// let (mut packet, mut closest) = (RayPack::<f32, 4>::from_rays(&rays), ClosestTriangles::default());
    /// let active = 0b101; // The second would hit as well.
    /// let hit = dispatch!(Level::new(), simd => {
    ///     packet.moller_trumbore(simd, &triangle, 17, active, &mut closest)
    /// });
    /// assert_eq!((hit, closest.get(1)), (0b001, None));
    /// let expected = moller_trumbore::intersect(&rays[0], &triangle).expect("a hit");
    /// assert_eq!(closest.get(0), Some((17, expected)));
    /// ```
    #[inline(always)]
    pub fn moller_trumbore<S: Simd, V: Vector<Scalar = T>>(
        &mut self,
        simd: S,
        triangle: &Triangle<V>,
        index: u32,
        active: u32,
        closest: &mut ClosestTriangles<T, N>,
    ) -> u32 {
        if is_scalar(simd) {
            return self.ask_all(triangle, index, active, closest, moller_trumbore::intersect);
        }
        let rays = self.wide(simd);
        let solution = moller_trumbore::solve(&frame(simd, &rays, triangle));
        let open = !solution.is_trustworthy();
        let filtered = Filtered { found: solution.clipped(rays.t_min, rays.t_max), open };
        self.keep(filtered, triangle, index, active, closest, moller_trumbore::intersect)
    }

    /// Where the rays of some lanes meet the triangle, in their closed ranges.
    ///
    /// t, u and v as in [`Self::moller_trumbore`]; an error bound tells whether the signs of the three weights,
    /// and t in the range, are certain, and lanes in which they are not go through the later stages of
    /// [`exact::intersect`], one by one.
    ///
    /// The lanes that hit are returned; their `t_max` becomes the t of the hit, and `closest` gets it with the
    /// triangle's `index`. Of two triangles at the same t the later one stays.
    ///
    /// **Grade: exact**: each lane has the verdict of [`exact::intersect`], that of exact arithmetic. u, v and t
    /// are within the bounds that are documented there with 9, 9 and 10 in the place of 8, 8 and 9.
    ///
    /// A triangle with a NaN or infinite vertex, a lane that is not active or never hit: no hit.
    ///
    /// Call it where the level is known (see [the module](crate::simd)): there it is part of its caller.
    ///
    /// ```
    /// use isect::simd::{ClosestTriangles, RayPack, fearless_simd::{Level, dispatch}};
    /// use isect::{Ray, Triangle, glam::Vec3};
    ///
    /// // At an edge, and a float beside it.
    /// let triangle = Triangle::new(Vec3::ZERO, Vec3::X, Vec3::Y);
    /// let rays = [0.0, -1e-45].map(|x| Ray::new(Vec3::new(x, 0.5, 1.0), Vec3::NEG_Z));
    /// let (mut packet, mut closest) = (RayPack::<f32, 8>::from_rays(&rays), ClosestTriangles::default());
    /// let active = packet.active();
    /// let hit = dispatch!(Level::new(), simd => packet.exact(simd, &triangle, 0, active, &mut closest));
    /// assert_eq!((hit, packet.t_max[0], packet.t_max[1]), (0b01, 1.0, f32::INFINITY));
    /// ```
    #[inline(always)]
    pub fn exact<S: Simd, V: Vector<Scalar = T>>(
        &mut self,
        simd: S,
        triangle: &Triangle<V>,
        index: u32,
        active: u32,
        closest: &mut ClosestTriangles<T, N>,
    ) -> u32 {
        if is_scalar(simd) {
            return self.ask_all(triangle, index, active, closest, exact::intersect);
        }
        let filtered = self.filter(simd, triangle);
        self.keep(filtered, triangle, index, active, closest, exact::undecided)
    }

    /// Which of some lanes' rays hit the triangle, as shadow rays ask: those that [`Self::exact`] would find.
    ///
    /// **Grade: exact**, as [`Self::exact`]; nothing is written down.
    ///
    /// ```
    /// use isect::simd::{RayPack, fearless_simd::{Level, dispatch}};
    /// use isect::{Ray, Triangle, glam::Vec3};
    ///
    /// let light = Vec3::new(0.2, 0.2, 4.0);
    /// let points = [Vec3::ZERO, Vec3::new(0.25, 0.25, 0.0), Vec3::new(9.0, 0.0, 0.0)];
    /// let shadows = RayPack::<f32, 4>::from_rays(&points.map(|point| Ray::segment(point, light)));
    /// let occluder = Triangle::new(Vec3::Z, Vec3::X + Vec3::Z, Vec3::Y + Vec3::Z);
    /// let mut lit = shadows.active();
    /// lit &= !dispatch!(Level::new(), simd => shadows.exact_hits(simd, &occluder, lit));
    /// assert_eq!(lit, 0b100);
    /// ```
    #[inline(always)]
    #[must_use]
    pub fn exact_hits<S: Simd, V: Vector<Scalar = T>>(
        &self,
        simd: S,
        triangle: &Triangle<V>,
        active: u32,
    ) -> u32 {
        let active = active & self.active;
        if is_scalar(simd) {
            return self.hits_of(triangle, active, exact::hits);
        }
        let Filtered { found, open } = self.filter(simd, triangle);
        let (hit, open) = (T::bits::<S>(found.hit) & active, T::bits::<S>(open) & active);
        if open == 0 {
            return hit;
        }
        hit & !open | self.hits_of(triangle, open, exact::undecided_hits)
    }

    #[inline(always)]
    fn filter<S: Simd, V: Vector<Scalar = T>>(
        &self,
        simd: S,
        triangle: &Triangle<V>,
    ) -> Filtered<T::Wide<S>> {
        let rays = self.wide(simd);
        let [edge1, edge2] = [triangle.v1 - triangle.v0, triangle.v2 - triangle.v0];
        let edges = Columns::of(simd, filter::edge_lengths(edge1, edge2, filter::floor()));
        let reach = Columns::load(simd, &self.reach, [0, 1, 2]);
        let frame = frame(simd, &rays, triangle);
        filter::decide::<T, S, N>(simd, &frame, reach, edges, [rays.t_min, rays.t_max])
    }

    /// Takes over what was found in the active lanes, after a scalar kernel was asked about the open ones.
    #[inline(always)]
    fn keep<S: Simd, V: Vector<Scalar = T>>(
        &mut self,
        Filtered { found, open }: Filtered<T::Wide<S>>,
        triangle: &Triangle<V>,
        index: u32,
        active: u32,
        closest: &mut ClosestTriangles<T, N>,
        intersect: impl Fn(&Ray<V>, &Triangle<V>) -> Option<TriangleHit<T>>,
    ) -> u32 {
        let active = active & self.active;
        let (mask, open) = (T::bits::<S>(found.hit) & active, T::bits::<S>(open) & active);
        // Most packets miss most triangles.
        if mask | open == 0 {
            return 0;
        }
        let mut hits = TriangleHits {
            t: T::store::<S>(found.t),
            u: T::store::<S>(found.u),
            v: T::store::<S>(found.v),
            front: T::bits::<S>(found.front),
            mask,
        };
        if open != 0 {
            self.ask(triangle, open, &mut hits, intersect);
        }
        self.take(&hits, index, closest)
    }

    /// Asks a scalar kernel about all active lanes.
    fn ask_all<V: Vector<Scalar = T>>(
        &mut self,
        triangle: &Triangle<V>,
        index: u32,
        active: u32,
        closest: &mut ClosestTriangles<T, N>,
        intersect: impl Fn(&Ray<V>, &Triangle<V>) -> Option<TriangleHit<T>>,
    ) -> u32 {
        let mut hits = TriangleHits::NONE;
        self.ask(triangle, active & self.active, &mut hits, intersect);
        self.take(&hits, index, closest)
    }

    /// Ends the rays that hit there, and writes down where that is.
    #[inline(always)]
    fn take(
        &mut self,
        hits: &TriangleHits<T, N>,
        index: u32,
        closest: &mut ClosestTriangles<T, N>,
    ) -> u32 {
        self.shorten(hits.mask, &hits.t);
        closest.keep(hits, index);
        hits.mask
    }

    /// Asks a scalar kernel about the lanes in `open`.
    #[cold]
    #[inline(never)]
    fn ask<V: Vector<Scalar = T>>(
        &self,
        triangle: &Triangle<V>,
        open: u32,
        hits: &mut TriangleHits<T, N>,
        intersect: impl Fn(&Ray<V>, &Triangle<V>) -> Option<TriangleHit<T>>,
    ) {
        hits.ask(open, |lane| intersect(&self.get(lane), triangle));
    }

    /// Which lanes of `open` hit the triangle.
    #[cold]
    #[inline(never)]
    fn hits_of<V: Vector<Scalar = T>>(
        &self,
        triangle: &Triangle<V>,
        open: u32,
        hits: impl Fn(&Ray<V>, &Triangle<V>) -> bool,
    ) -> u32 {
        lanes_of::<N>(open)
            .filter(|&lane| hits(&self.get(lane), triangle))
            .fold(0, |lanes, lane| lanes | 1 << lane)
    }
}

/// The same triangle in every lane, with respect to the rays.
#[inline(always)]
fn frame<T, S, V, const N: usize>(
    simd: S,
    rays: &Ray<Columns<T::Wide<S>>>,
    triangle: &Triangle<V>,
) -> Frame<Columns<T::Wide<S>>>
where
    T: Lanes<N>,
    S: Simd,
    V: Vector<Scalar = T>,
{
    let triangle = Triangle {
        v0: Columns::of(simd, triangle.v0),
        v1: Columns::of(simd, triangle.v1),
        v2: Columns::of(simd, triangle.v2),
    };
    Frame::new(rays, &triangle)
}
