//! Triangles without a hierarchy.

use core::slice;

use fearless_simd::{Level, Simd, dispatch};

use super::super::lanes::Lanes;
use super::super::triangle::TrianglePack;
use super::{Packs, any, closer, side_by_side};
use crate::ray::triangle::TriangleHit;
use crate::shape::{Ray, Triangle};
use crate::vector::Vector;

/// Some triangles, in packs of `N`, for rays that are held against all of them: up to some hundreds, where a
/// hierarchy does not pay.
///
/// Every verdict is that of [`exact::intersect`](crate::ray::triangle::exact::intersect). Each call dispatches once
/// ([`Self::hits`] for every 64 of them), to the level of the processor, which the collection has found out when it was made.
///
/// ```
/// use isect::simd::Triangles;
/// use isect::{Ray, Triangle, glam::Vec3};
///
/// let at = |z| Triangle::new(Vec3::new(0.0, 0.0, z), Vec3::new(1.0, 0.0, z), Vec3::new(0.0, 1.0, z));
/// let triangles: Triangles = [at(5.0), at(2.0), at(8.0)].into_iter().collect();
/// let ray = Ray::new(Vec3::new(0.25, 0.5, 0.0), Vec3::Z);
/// let (index, hit) = triangles.closest(&ray).expect("a hit");
/// assert_eq!((index, hit.t, hit.u, hit.v), (1, 2.0, 0.25, 0.5));
/// assert!(triangles.any(&ray) && !triangles.any(&ray.with_range(0.0, 1.0)));
/// assert_eq!(triangles.hits(&ray.with_range(0.0, 6.0)).collect::<Vec<_>>(), [0, 1]);
/// ```
#[derive(Clone, Debug)]
pub struct Triangles<T = f32, const N: usize = 8> {
    packs: Packs<TrianglePack<T, N>>,
}

impl<T, const N: usize> Default for Triangles<T, N> {
    fn default() -> Self {
        Self { packs: Packs::default() }
    }
}

impl<T: Lanes<N>, V: Vector<Scalar = T>, const N: usize> Extend<Triangle<V>> for Triangles<T, N> {
    fn extend<I: IntoIterator<Item = Triangle<V>>>(&mut self, triangles: I) {
        self.packs.extend(triangles, N, TrianglePack::from_triangles, TrianglePack::get);
    }
}

impl<T: Lanes<N>, V: Vector<Scalar = T>, const N: usize> FromIterator<Triangle<V>>
    for Triangles<T, N>
{
    fn from_iter<I: IntoIterator<Item = Triangle<V>>>(triangles: I) -> Self {
        let mut all = Self::default();
        all.extend(triangles);
        all
    }
}

impl<T: Lanes<N>, const N: usize> Triangles<T, N> {
    /// The same triangles, but with another level for the calls to come: where there is no standard library to find it
    /// out with, and in tests.
    #[must_use]
    pub fn with_level(mut self, level: Level) -> Self {
        self.packs.level = level;
        self
    }

    /// How many there are.
    #[must_use]
    pub const fn len(&self) -> usize {
        self.packs.len
    }

    /// Whether there are none.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.packs.len == 0
    }

    /// The triangle at an index.
    #[must_use]
    pub fn get<V: Vector<Scalar = T>>(&self, index: usize) -> Option<Triangle<V>> {
        self.packs.get(index, N, TrianglePack::get)
    }

    /// The closest hit in the closed range of the ray, and the index of its triangle; of several at the same t
    /// the lowest index.
    ///
    /// **Grade: exact**, as far as hits go; t, u and v are within the bounds of [`TrianglePack::exact`], and of two
    /// hits whose t are closer to each other than that either may be called the closer one.
    ///
    /// A zero direction, a NaN or infinite field, an empty range: `None`.
    #[must_use]
    pub fn closest<V: Vector<Scalar = T>>(&self, ray: &Ray<V>) -> Option<(usize, TriangleHit<T>)> {
        let mut closest = [None];
        self.closest_of(slice::from_ref(ray), &mut closest);
        closest[0]
    }

    /// [`Self::closest`] for many rays, with one dispatch for all.
    ///
    /// # Panics
    ///
    /// If there are not as many places in `closest` as rays.
    ///
    /// ```
    /// use isect::simd::Triangles;
    /// use isect::{Ray, Triangle, glam::Vec3};
    ///
    /// let triangles: Triangles = [Triangle::new(Vec3::ZERO, Vec3::X, Vec3::Y)].into_iter().collect();
    /// let rays = [0.25, 0.75].map(|x| Ray::new(Vec3::new(x, x, 1.0), Vec3::NEG_Z));
    /// let mut closest = [None; 2];
    /// triangles.closest_of(&rays, &mut closest);
    /// assert_eq!(closest.map(|hit| hit.map(|(index, hit)| (index, hit.t))), [Some((0, 1.0)), None]);
    /// ```
    pub fn closest_of<V: Vector<Scalar = T>>(
        &self,
        rays: &[Ray<V>],
        closest: &mut [Option<(usize, TriangleHit<T>)>],
    ) {
        assert_eq!(rays.len(), closest.len(), "a place for the hit of each ray");
        dispatch!(self.packs.level, simd => {
            for (ray, closest) in rays.iter().zip(closest) {
                *closest = self.closest_at(simd, ray);
            }
        });
    }

    /// Whether the ray hits any of them, as a shadow ray asks.
    ///
    /// **Grade: exact.**
    #[must_use]
    pub fn any<V: Vector<Scalar = T>>(&self, ray: &Ray<V>) -> bool {
        dispatch!(self.packs.level, simd => any(
            &self.packs.packs,
            #[inline(always)]
            |pack| pack.any(simd, ray),
        ))
    }

    /// The indices of all that the ray hits, in order.
    ///
    /// **Grade: exact.**
    pub fn hits<'a, V: Vector<Scalar = T>>(
        &'a self,
        ray: &Ray<V>,
    ) -> impl Iterator<Item = usize> + use<'a, T, V, N> {
        let (ray, level) = (*ray, self.packs.level);
        self.packs.indices(N, move |packs| {
            dispatch!(level, simd => side_by_side(
                packs,
                N,
                #[inline(always)]
                |pack| pack.exact(simd, &ray).mask,
            ))
        })
    }

    #[inline(always)]
    fn closest_at<S: Simd, V: Vector<Scalar = T>>(
        &self,
        simd: S,
        ray: &Ray<V>,
    ) -> Option<(usize, TriangleHit<T>)> {
        let mut best = None;
        for (number, pack) in self.packs.packs.iter().enumerate() {
            // The range is not cut to the best so far: a neighbour that is hit at the same t, on the common edge,
            // would be left to the later stages.
            if let Some((lane, hit)) = pack.closest(simd, ray) {
                let next = Some((number * N + lane, hit));
                best = closer(best, next, |next, best| next.t < best.t);
            }
        }
        best
    }
}
