//! Triangles side by side: a leaf.

use fearless_simd::{Level, Simd, dispatch};

use super::filter::{self, Filtered};
use super::lanes::{Columns, Fused, Lanes, is_scalar, lanes_of, splat};
use crate::ray::triangle::watertight::{self, ShearedRay};
use crate::ray::triangle::{Found, Frame, TriangleHit, exact, moller_trumbore};
use crate::shape::{Ray, Triangle};
use crate::vector::{Coordinates, Number, Scalar, Vector};

/// `N` triangles, the coordinates of all on an axis side by side.
///
/// ```
/// use isect::simd::{TrianglePack, fearless_simd::{Level, dispatch}};
/// use isect::{Ray, Triangle, glam::Vec3};
///
/// let at = |z| Triangle::new(Vec3::new(0.0, 0.0, z), Vec3::new(1.0, 0.0, z), Vec3::new(0.0, 1.0, z));
/// // Six of the lanes stay empty.
/// let leaf = TrianglePack::<f32, 8>::from_triangles(&[at(-2.0), at(-1.0)]);
/// let ray = Ray::new(Vec3::new(0.25, 0.5, 3.0), Vec3::NEG_Z);
/// let (lane, hit) = dispatch!(Level::new(), simd => leaf.closest(simd, &ray)).expect("a hit");
/// assert_eq!((lane, hit.t, hit.u, hit.v, hit.front), (1, 4.0, 0.25, 0.5, true));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct TrianglePack<T, const N: usize> {
    /// By vertex, axis and lane. The vertices of an empty lane are NaN.
    vertices: [[[T; N]; 3]; 3],
}

/// Which triangles of a pack a ray hits, and where.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct TriangleHits<T, const N: usize> {
    /// The ray's parameter at the hit of each lane; like the rest of no meaning in a lane that is not hit.
    pub t: [T; N],
    /// The weight of `v1`.
    pub u: [T; N],
    /// The weight of `v2`.
    pub v: [T; N],
    /// Bit i tells whether the direction runs against the normal of the triangle in lane i.
    pub front: u32,
    /// Bit i tells whether the triangle of lane i is hit.
    pub mask: u32,
}

impl<T: Scalar, const N: usize> TriangleHits<T, N> {
    /// The hit of a lane.
    #[inline]
    #[must_use]
    pub fn get(&self, lane: usize) -> Option<TriangleHit<T>> {
        if lane >= N || (self.mask >> lane) & 1 == 0 {
            return None;
        }
        let front = (self.front >> lane) & 1 == 1;
        Some(TriangleHit { t: self.t[lane], u: self.u[lane], v: self.v[lane], front })
    }

    /// Nothing found.
    pub(super) const NONE: Self =
        Self { t: [T::ZERO; N], u: [T::ZERO; N], v: [T::ZERO; N], front: 0, mask: 0 };

    /// Asks about some lanes, and writes down what is found there.
    #[inline]
    pub(super) fn ask(&mut self, lanes: u32, intersect: impl Fn(usize) -> Option<TriangleHit<T>>) {
        for lane in lanes_of::<N>(lanes) {
            let bit = 1 << lane;
            self.mask &= !bit;
            if let Some(hit) = intersect(lane) {
                (self.t[lane], self.u[lane], self.v[lane]) = (hit.t, hit.u, hit.v);
                self.front = self.front & !bit | u32::from(hit.front) << lane;
                self.mask |= bit;
            }
        }
    }

    /// The lane of the least t, and the hit there; of several at the same t the lowest lane.
    #[inline]
    #[must_use]
    pub fn closest(&self) -> Option<(usize, TriangleHit<T>)> {
        let hits = (0..N).filter_map(|lane| Some((lane, self.get(lane)?)));
        hits.reduce(|best, other| if other.1.t < best.1.t { other } else { best })
    }
}

/// Nothing but empty lanes.
impl<T: Lanes<N>, const N: usize> Default for TrianglePack<T, N> {
    fn default() -> Self {
        Self { vertices: [[[T::NAN; N]; 3]; 3] }
    }
}

impl<T: Lanes<N>, const N: usize> TrianglePack<T, N> {
    /// The triangles, from lane 0 on. The other lanes are never hit.
    ///
    /// # Panics
    ///
    /// If there are more than `N` triangles.
    #[must_use]
    pub fn from_triangles<V: Vector<Scalar = T>>(triangles: &[Triangle<V>]) -> Self {
        assert!(triangles.len() <= N, "{} triangles for {N} lanes", triangles.len());
        let mut pack = Self::default();
        for (lane, triangle) in triangles.iter().enumerate() {
            for (vertex, of_pack) in <[V; 3]>::from(*triangle).into_iter().zip(&mut pack.vertices) {
                for (axis, lanes) in of_pack.iter_mut().enumerate() {
                    lanes[lane] = vertex.component(axis);
                }
            }
        }
        pack
    }

    /// The triangle of a lane; one of NaN where there is none.
    #[inline]
    #[must_use]
    pub fn get<V: Vector<Scalar = T>>(&self, lane: usize) -> Triangle<V> {
        if lane >= N {
            return [V::splat(T::NAN); 3].into();
        }
        let vertices = self.vertices.each_ref().map(|vertex| {
            let [x, y, z] = vertex.each_ref().map(|axis| axis[lane]);
            V::new(x, y, z)
        });
        vertices.into()
    }

    /// Where the ray meets each triangle, in the closed range of the ray.
    ///
    /// t = s·n/det, u = (s × d)·e2/det, v = −(s × d)·e1/det, det = −d·n: the body of
    /// [`moller_trumbore::intersect`], all lanes at once.
    ///
    /// **Grade: fast.** Each lane has the verdict of that kernel, and its t, u and v to the last bit. (A lane of
    /// which the products may have over- or underflowed asks it.)
    ///
    /// An empty lane, a triangle without area as computed, a zero direction, a NaN or infinite field: no hit.
    ///
    /// Call it where the level is known (see [the module](super)): there it is part of its caller.
    ///
    /// ```
    /// use isect::simd::{TrianglePack, fearless_simd::{Level, dispatch}};
    /// use isect::{Ray, Triangle, glam::Vec3, ray::triangle::moller_trumbore};
    ///
    /// let triangle = Triangle::new(Vec3::ZERO, Vec3::X, Vec3::Y);
    /// let leaf = TrianglePack::<f32, 4>::from_triangles(&[triangle]);
    /// let ray = Ray::new(Vec3::new(0.3, 0.1, 0.7), Vec3::new(0.1, 0.1, -0.3));
    /// let hits = dispatch!(Level::new(), simd => leaf.moller_trumbore(simd, &ray));
    /// assert_eq!(hits.mask, 1);
    /// assert_eq!(hits.get(0), moller_trumbore::intersect(&ray, &triangle));
    /// ```
    #[inline(always)]
    #[must_use]
    pub fn moller_trumbore<S: Simd, V: Vector<Scalar = T>>(
        &self,
        simd: S,
        ray: &Ray<V>,
    ) -> TriangleHits<T, N> {
        if is_scalar(simd) {
            return self.lane_by_lane(*ray, moller_trumbore::intersect::<V>);
        }
        let (lanes, triangles) = (wide_ray(simd, ray), self.wide(simd, [0, 1, 2]));
        let solution = moller_trumbore::solve(&Frame::new(&lanes, &triangles));
        let open = T::bits::<S>(!solution.is_trustworthy() & is_present(&triangles));
        let found = solution.clipped(lanes.t_min, lanes.t_max);
        self.settled(simd, *ray, found, open, moller_trumbore::intersect::<V>)
    }

    /// Where the ray meets each triangle, in the closed range of the ray.
    ///
    /// The three edge functions of the sheared vertices, over their sum: the body of [`watertight::intersect`], all
    /// lanes at once. Their products are never fused, at no level.
    ///
    /// **Grade: watertight.** Each lane has the verdict of that kernel, and its t, u and v to the last bit. (A lane with
    /// an edge function of zero, or one whose products may have over- or underflowed, asks it.)
    ///
    /// An empty lane, a triangle without area as seen along the ray, a zero direction, a NaN or infinite field: no hit.
    ///
    /// Call it where the level is known (see [the module](super)): there it is part of its caller.
    ///
    /// ```
    /// use isect::simd::{TrianglePack, fearless_simd::{Level, dispatch}};
    /// use isect::ray::triangle::watertight::{self, ShearedRay};
    /// use isect::{Ray, Triangle, glam::Vec3};
    ///
    /// let triangle = Triangle::new(Vec3::ZERO, Vec3::X, Vec3::Y);
    /// let leaf = TrianglePack::<f32, 4>::from_triangles(&[triangle]);
    /// let ray = ShearedRay::new(&Ray::new(Vec3::new(0.3, 0.1, 0.7), Vec3::new(0.1, 0.1, -0.3)));
    /// let hits = dispatch!(Level::new(), simd => leaf.watertight(simd, &ray));
    /// assert_eq!(hits.get(0), watertight::intersect(&ray, &triangle));
    /// ```
    #[inline(always)]
    #[must_use]
    pub fn watertight<S: Simd, V: Vector<Scalar = T>>(
        &self,
        simd: S,
        ray: &ShearedRay<V>,
    ) -> TriangleHits<T, N> {
        if is_scalar(simd) {
            return self.lane_by_lane(*ray, watertight::intersect::<V>);
        }
        // The axes in the order in which the shear wants them: it is along the last.
        let (axes, origin) = match ray.axis {
            0 => ([1, 2, 0], ray.origin.yzx()),
            1 => ([2, 0, 1], ray.origin.zxy()),
            _ => ([0, 1, 2], ray.origin),
        };
        let lanes = ShearedRay {
            origin: Columns::of(simd, origin),
            axis: 2,
            shear: [splat(simd, ray.shear[0]), splat(simd, ray.shear[1])],
            inverse: splat(simd, ray.inverse),
            t_scale: splat(simd, ray.t_scale),
            t_min: splat(simd, ray.t_min),
            t_max: splat(simd, ray.t_max),
        };
        let triangles = self.wide(simd, axes);
        let sheared = lanes.sheared(&triangles);
        let weights = sheared.rounded_weights();
        let determinant = weights.x() + weights.y() + weights.z();
        let zero = splat(simd, T::ZERO);
        let nonzero = zero.lt(weights.x().abs().min(weights.y().abs()).min(weights.z().abs()));
        let settled = nonzero & determinant.is_mid_range();
        let open = T::bits::<S>(!settled & is_present(&triangles));
        let found = sheared.found(&lanes, weights, determinant);
        self.settled(simd, *ray, found, open, watertight::intersect::<V>)
    }

    /// Where the ray meets each triangle, in the closed range of the ray.
    ///
    /// t, u and v as in [`Self::moller_trumbore`]; an error bound tells whether the signs of the three weights,
    /// and t in the range, are certain, and lanes in which they are not go through the later stages of
    /// [`exact::intersect`], one by one.
    ///
    /// **Grade: exact**: each lane has the verdict of [`exact::intersect`], that of exact arithmetic. u, v and t
    /// are within the bounds that are documented there with 9, 9 and 10 in the place of 8, 8 and 9.
    ///
    /// An empty lane, a zero direction, a NaN or infinite field, an empty range: no hit.
    ///
    /// Call it where the level is known (see [the module](super)): there it is part of its caller.
    ///
    /// ```
    /// use isect::simd::{TrianglePack, fearless_simd::{Level, dispatch}};
    /// use isect::{Ray, Triangle, glam::Vec3};
    ///
    /// // Two halves of a square, and a ray at the edge between them.
    /// let [a, b, c, d] = [Vec3::ZERO, Vec3::X, Vec3::new(1.0, 1.0, 0.0), Vec3::Y];
    /// let halves = [Triangle::new(a, b, c), Triangle::new(a, c, d)];
    /// let leaf = TrianglePack::<f32, 4>::from_triangles(&halves);
    /// let ray = Ray::new(Vec3::new(0.5, 0.5, 1.0), Vec3::NEG_Z);
    /// assert_eq!(dispatch!(Level::new(), simd => leaf.exact(simd, &ray)).mask, 0b11);
    /// ```
    #[inline(always)]
    #[must_use]
    pub fn exact<S: Simd, V: Vector<Scalar = T>>(
        &self,
        simd: S,
        ray: &Ray<V>,
    ) -> TriangleHits<T, N> {
        if is_scalar(simd) {
            return self.lane_by_lane(*ray, exact::intersect::<V>);
        }
        let Filtered { found, open } = self.filter(simd, ray);
        let open = T::bits::<S>(open);
        self.settled(simd, *ray, found, open, exact::undecided::<V>)
    }

    /// The closest hit of [`Self::exact`], and its lane: [`TriangleHits::closest`], for less.
    ///
    /// **Grade: exact**, as far as hits go; of two hits whose t are closer to each other than their error bounds
    /// either may be called the closer one.
    ///
    /// ```
    /// use isect::simd::{TrianglePack, fearless_simd::{Level, dispatch}};
    /// use isect::{Ray, Triangle, glam::Vec3};
    ///
    /// let at = |z| Triangle::new(Vec3::Z * z, Vec3::X + Vec3::Z * z, Vec3::Y + Vec3::Z * z);
    /// let leaf = TrianglePack::<f32, 4>::from_triangles(&[at(3.0), at(2.0)]);
    /// let ray = Ray::new(Vec3::new(0.25, 0.25, 0.0), Vec3::Z);
    /// let (lane, hit) = dispatch!(Level::new(), simd => leaf.closest(simd, &ray)).expect("two hits");
    /// assert_eq!((lane, hit.t), (1, 2.0));
    /// ```
    #[inline(always)]
    #[must_use]
    pub fn closest<S: Simd, V: Vector<Scalar = T>>(
        &self,
        simd: S,
        ray: &Ray<V>,
    ) -> Option<(usize, TriangleHit<T>)> {
        if is_scalar(simd) {
            return self.exact(simd, ray).closest();
        }
        let Filtered { found, open } = self.filter(simd, ray);
        let open = T::bits::<S>(open);
        if open != 0 {
            let mut hits = collected::<T, S, N>(found);
            self.ask(*ray, open, &mut hits, exact::undecided::<V>);
            return hits.closest();
        }
        let mask = T::bits::<S>(found.hit);
        if mask == 0 {
            return None;
        }
        let t = <T::Wide<S> as Number>::select(found.hit, found.t, splat(simd, T::INFINITY));
        let least = splat(simd, T::least::<S>(t));
        let lane = (T::bits::<S>(t.le(least)) & mask).trailing_zeros() as usize;
        Some((lane, collected::<T, S, N>(found).get(lane)?))
    }

    /// Whether the ray hits any of the triangles, as a shadow ray asks: whether [`Self::exact`] has a hit.
    ///
    /// **Grade: exact**, as [`Self::exact`]. Where a hit is certain the later stages are not asked.
    ///
    /// ```
    /// use isect::simd::{TrianglePack, fearless_simd::{Level, dispatch}};
    /// use isect::{Ray, Triangle, glam::Vec3};
    ///
    /// let leaf = TrianglePack::<f32, 4>::from_triangles(&[Triangle::new(Vec3::ZERO, Vec3::X, Vec3::Y)]);
    /// let shadow = Ray::segment(Vec3::new(0.25, 0.25, -1.0), Vec3::new(0.25, 0.25, 3.0));
    /// let any = |ray| dispatch!(Level::new(), simd => leaf.any(simd, &ray));
    /// assert!(any(shadow) && !any(shadow.after(0.25)));
    /// ```
    #[inline(always)]
    #[must_use]
    pub fn any<S: Simd, V: Vector<Scalar = T>>(&self, simd: S, ray: &Ray<V>) -> bool {
        if is_scalar(simd) {
            return (0..N).any(|lane| exact::hits(ray, &self.get(lane)));
        }
        let Filtered { found, open } = self.filter(simd, ray);
        let (hit, open) = (T::bits::<S>(found.hit), T::bits::<S>(open));
        hit & !open != 0 || (open != 0 && self.any_of(*ray, open))
    }

    /// [`Self::closest`] for a caller without a level. Slow: a dispatch costs as much as some of these tests,
    /// and nothing is shared between calls.
    #[must_use]
    pub fn dispatch_closest<V: Vector<Scalar = T>>(
        &self,
        level: Level,
        ray: &Ray<V>,
    ) -> Option<(usize, TriangleHit<T>)> {
        dispatch!(level, simd => self.closest(simd, ray))
    }

    /// The triangles with these axes as x, y and z.
    #[inline(always)]
    fn wide<S: Simd>(&self, simd: S, axes: [usize; 3]) -> Triangle<Columns<T::Wide<S>>> {
        let [v0, v1, v2] = &self.vertices;
        Triangle {
            v0: Columns::load(simd, v0, axes),
            v1: Columns::load(simd, v1, axes),
            v2: Columns::load(simd, v2, axes),
        }
    }

    /// What [`filter`] finds in the lanes that hold a triangle.
    #[inline(always)]
    fn filter<S: Simd, V: Vector<Scalar = T>>(
        &self,
        simd: S,
        ray: &Ray<V>,
    ) -> Filtered<T::Wide<S>> {
        let (lanes, triangles) = (wide_ray(simd, ray), self.wide(simd, [0, 1, 2]));
        let frame = Frame::new(&lanes, &triangles);
        let floor = splat(simd, filter::floor::<T>());
        let edges = filter::edge_lengths(frame.edge1, frame.edge2, floor);
        let reach = Columns::of(simd, filter::reach(ray));
        let range = [lanes.t_min, lanes.t_max];
        let Filtered { found, open } = filter::decide::<T, S, N>(simd, &frame, reach, edges, range);
        Filtered { found, open: open & is_present(&triangles) }
    }

    /// What is found, once a scalar kernel has been asked about the lanes in `open`.
    ///
    /// The lanes stay in registers but for that: an answer whose address is known to the later stages would be stored
    /// twice.
    #[inline(always)]
    fn settled<S: Simd, V: Vector<Scalar = T>, R>(
        &self,
        simd: S,
        ray: R,
        found: Found<T::Wide<S>>,
        open: u32,
        intersect: impl Fn(&R, &Triangle<V>) -> Option<TriangleHit<T>>,
    ) -> TriangleHits<T, N> {
        let Found { mut t, mut u, mut v, .. } = found;
        let (mut front, mut mask) = (T::bits::<S>(found.front), T::bits::<S>(found.hit));
        if open != 0 {
            let mut hits = collected::<T, S, N>(found);
            self.ask(ray, open, &mut hits, intersect);
            t = T::load(simd, &hits.t);
            u = T::load(simd, &hits.u);
            v = T::load(simd, &hits.v);
            (front, mask) = (hits.front, hits.mask);
        }
        TriangleHits { t: T::store::<S>(t), u: T::store::<S>(u), v: T::store::<S>(v), front, mask }
    }

    /// Asks a scalar kernel about all lanes.
    #[inline(never)]
    fn lane_by_lane<V: Vector<Scalar = T>, R>(
        &self,
        ray: R,
        intersect: impl Fn(&R, &Triangle<V>) -> Option<TriangleHit<T>>,
    ) -> TriangleHits<T, N> {
        let mut hits = TriangleHits::NONE;
        self.ask(ray, u32::MAX, &mut hits, intersect);
        hits
    }

    /// Asks a scalar kernel about the lanes in `open`.
    #[cold]
    #[inline(never)]
    fn ask<V: Vector<Scalar = T>, R>(
        &self,
        ray: R,
        open: u32,
        hits: &mut TriangleHits<T, N>,
        intersect: impl Fn(&R, &Triangle<V>) -> Option<TriangleHit<T>>,
    ) {
        hits.ask(open, |lane| intersect(&ray, &self.get(lane)));
    }

    /// Whether the ray hits a triangle in the lanes of `open`.
    #[cold]
    #[inline(never)]
    fn any_of<V: Vector<Scalar = T>>(&self, ray: Ray<V>, open: u32) -> bool {
        lanes_of::<N>(open).any(|lane| exact::undecided_hits(&ray, &self.get::<V>(lane)))
    }
}

/// The lanes that hold a triangle. (A NaN elsewhere leaves everything open.)
#[inline(always)]
fn is_present<N: Fused>(triangles: &Triangle<Columns<N>>) -> N::Mask {
    triangles.v0.x.le(triangles.v0.x)
}

#[inline(always)]
fn wide_ray<T, S, V, const N: usize>(simd: S, ray: &Ray<V>) -> Ray<Columns<T::Wide<S>>>
where
    T: Lanes<N>,
    S: Simd,
    V: Vector<Scalar = T>,
{
    Ray {
        origin: Columns::of(simd, ray.origin),
        direction: Columns::of(simd, ray.direction),
        t_min: splat(simd, ray.t_min),
        t_max: splat(simd, ray.t_max),
    }
}

#[inline(always)]
fn collected<T: Lanes<N>, S: Simd, const N: usize>(found: Found<T::Wide<S>>) -> TriangleHits<T, N> {
    TriangleHits {
        t: T::store::<S>(found.t),
        u: T::store::<S>(found.u),
        v: T::store::<S>(found.v),
        front: T::bits::<S>(found.front),
        mask: T::bits::<S>(found.hit),
    }
}
