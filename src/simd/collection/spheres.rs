//! Spheres without a hierarchy.

use core::slice;

use fearless_simd::{Level, Simd, dispatch};

use super::super::lanes::{Columns, Lanes, is_scalar, lanes_of, splat};
use super::super::sphere::SphereHits;
use super::{Packs, any, closer, side_by_side};
use crate::ray::sphere::robust::{self, Approach, Certain};
use crate::ray::sphere::{Quadratic, SphereHit};
use crate::shape::{Ray, Sphere};
use crate::vector::{Number, Vector};

/// Some spheres, in packs of `N`, for rays that are held against all of them: up to some hundreds, where a
/// hierarchy does not pay.
///
/// Every verdict is that of [`robust::intersect`], and every t has its bits. Each call dispatches once ([`Self::hits`] for
/// every 64 of them), to the level of the processor, which the collection has found out when it was made.
///
/// ```
/// use isect::simd::Spheres;
/// use isect::{Ray, Sphere, glam::Vec3};
///
/// let spheres: Spheres = [9.0, 4.0].map(|z| Sphere::new(Vec3::Z * z, 1.0)).into_iter().collect();
/// let ray = Ray::new(Vec3::ZERO, Vec3::Z);
/// let (index, hit) = spheres.closest(&ray).expect("a hit");
/// assert_eq!((index, hit.t, hit.leaving), (1, 3.0, false));
/// assert_eq!(spheres.hits(&ray.after(5.0)).collect::<Vec<_>>(), [0]);
/// assert!(spheres.any(&ray) && !spheres.any(&ray.with_range(0.0, 1.0)));
/// ```
#[derive(Clone, Debug)]
pub struct Spheres<T = f32, const N: usize = 8> {
    packs: Packs<SpherePack<T, N>>,
}

/// `N` spheres, the coordinates of all on an axis side by side.
#[derive(Clone, Copy, Debug)]
struct SpherePack<T, const N: usize> {
    /// By axis and lane.
    center: [[T; N]; 3],
    /// Negative in an empty lane.
    radius: [T; N],
}

impl<T, const N: usize> Default for Spheres<T, N> {
    fn default() -> Self {
        Self { packs: Packs::default() }
    }
}

impl<T: Lanes<N>, V: Vector<Scalar = T>, const N: usize> Extend<Sphere<V>> for Spheres<T, N> {
    fn extend<I: IntoIterator<Item = Sphere<V>>>(&mut self, spheres: I) {
        self.packs.extend(spheres, N, SpherePack::from_spheres, SpherePack::get);
    }
}

impl<T: Lanes<N>, V: Vector<Scalar = T>, const N: usize> FromIterator<Sphere<V>> for Spheres<T, N> {
    fn from_iter<I: IntoIterator<Item = Sphere<V>>>(spheres: I) -> Self {
        let mut all = Self::default();
        all.extend(spheres);
        all
    }
}

impl<T: Lanes<N>, const N: usize> Spheres<T, N> {
    /// The same spheres, but with another level for the calls to come: where there is no standard library to find it
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

    /// The sphere at an index.
    #[must_use]
    pub fn get<V: Vector<Scalar = T>>(&self, index: usize) -> Option<Sphere<V>> {
        self.packs.get(index, N, SpherePack::get)
    }

    /// The closest hit in the closed range of the ray, and the index of its sphere; of several at the same t
    /// the lowest index.
    ///
    /// **Grade: exact** for the hit of each sphere; t is within the bound of [`robust::intersect`], and the least t, so
    /// computed, is the closest one.
    ///
    /// A zero direction, a NaN or infinite field, an empty range: `None`. A sphere with a negative radius, a NaN or infinite
    /// field is never hit.
    #[must_use]
    pub fn closest<V: Vector<Scalar = T>>(&self, ray: &Ray<V>) -> Option<(usize, SphereHit<T>)> {
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
        closest: &mut [Option<(usize, SphereHit<T>)>],
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
            |pack| pack.robust(simd, ray).mask != 0,
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
                |pack| pack.robust(simd, &ray).mask,
            ))
        })
    }

    #[inline(always)]
    fn closest_at<S: Simd, V: Vector<Scalar = T>>(
        &self,
        simd: S,
        ray: &Ray<V>,
    ) -> Option<(usize, SphereHit<T>)> {
        let mut best = None;
        for (number, pack) in self.packs.packs.iter().enumerate() {
            let hits = pack.robust(simd, ray);
            if hits.mask != 0 {
                for lane in lanes_of::<N>(hits.mask) {
                    let leaving = (hits.leaving >> lane) & 1 == 1;
                    let next = Some((number * N + lane, SphereHit { t: hits.t[lane], leaving }));
                    best = closer(best, next, |next, best| next.t < best.t);
                }
            }
        }
        best
    }
}

impl<T: Lanes<N>, const N: usize> SpherePack<T, N> {
    fn from_spheres<V: Vector<Scalar = T>>(spheres: &[Sphere<V>]) -> Self {
        let mut pack = Self { center: [[T::ZERO; N]; 3], radius: [-T::ONE; N] };
        for (lane, sphere) in spheres.iter().enumerate() {
            for axis in 0..3 {
                pack.center[axis][lane] = sphere.center.component(axis);
            }
            pack.radius[lane] = sphere.radius;
        }
        pack
    }

    fn get<V: Vector<Scalar = T>>(&self, lane: usize) -> Sphere<V> {
        let [x, y, z] = self.center.each_ref().map(|axis| axis[lane]);
        Sphere::new(V::new(x, y, z), self.radius[lane])
    }

    /// The body of [`robust::intersect`], all lanes at once.
    #[inline(always)]
    fn robust<S: Simd, V: Vector<Scalar = T>>(&self, simd: S, ray: &Ray<V>) -> SphereHits<T, N> {
        if is_scalar(simd) {
            let mut hits = SphereHits::NONE;
            hits.ask(u32::MAX, |lane| robust::intersect(ray, &self.get(lane)));
            return hits;
        }
        let (origin, direction) = (Columns::of(simd, ray.origin), Columns::of(simd, ray.direction));
        let radius = T::load(simd, &self.radius);
        let q = Quadratic::new(
            direction,
            Columns::load(simd, &self.center, [0, 1, 2]) - origin,
            radius,
        );
        let range = [splat(simd, ray.t_min), splat(simd, ray.t_max)];
        let approach = Approach::new(&q, splat(simd, T::EPSILON));
        let Certain { open, hit, t, leaving } = approach.certain(&q, range);
        // An empty lane, and a bad radius, have no part in it.
        let is_sphere = splat(simd, T::ZERO).le(radius);
        let open = (open | !q.is_mid_range()) & is_sphere;
        let mut hits = SphereHits {
            t: T::store::<S>(t),
            leaving: T::bits::<S>(leaving),
            mask: T::bits::<S>(hit & is_sphere),
        };
        let open = T::bits::<S>(open);
        if open != 0 {
            self.ask(ray, open, &mut hits);
        }
        hits
    }

    /// Asks the later stages about the lanes in `open`.
    #[cold]
    #[inline(never)]
    fn ask<V: Vector<Scalar = T>>(&self, ray: &Ray<V>, open: u32, hits: &mut SphereHits<T, N>) {
        hits.ask(open, |lane| robust::undecided(ray, &self.get(lane)));
    }
}
