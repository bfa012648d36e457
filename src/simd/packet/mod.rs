//! Rays side by side: a packet, against one shape at a time.
//!
//! I. Wald, P. Slusallek, C. Benthin, M. Wagner, "Interactive Rendering with Coherent Ray Tracing", Computer
//! Graphics Forum 20.3, 2001.

mod aabb;
mod plane;
mod sphere;
mod triangle;

use fearless_simd::Simd;

use super::filter;
use super::lanes::{Columns, Lanes};
use crate::ray::aabb::BoxRay;
use crate::shape::Ray;
use crate::vector::Vector;

pub use plane::PlaneHits;
pub use sphere::ClosestSpheres;
pub use triangle::ClosestTriangles;

/// `N` rays, the coordinates of all on an axis side by side, with the reciprocals that boxes ask for.
///
/// Each kernel holds one shape against all of the rays. It takes the lanes that count as the bits of a mask:
/// a traversal begins with [`Self::active`], descends with those that enter a node, and lets those go that have
/// found what they look for. In the other lanes nothing changes, to the last bit. Kernels that look for the closest hit
/// lower [`Self::t_max`] to it, so that boxes and shapes behind it are missed from then on; they write down
/// what was hit ([`ClosestTriangles`], [`ClosestSpheres`]), and return the lanes that did.
///
/// I. Wald, P. Slusallek, C. Benthin, M. Wagner, "Interactive Rendering with Coherent Ray Tracing", Computer
/// Graphics Forum 20.3, 2001.
///
/// ```
/// use isect::simd::fearless_simd::{Level, Simd, dispatch};
/// use isect::simd::{ClosestTriangles, RayPack};
/// use isect::{Aabb, Ray, Triangle, glam::Vec3};
///
/// struct Leaf { bounds: Aabb, triangles: Vec<Triangle> }
///
/// #[inline(always)]
/// fn trace<S: Simd>(simd: S, leaves: &[Leaf], rays: &mut RayPack<f32, 8>) -> ClosestTriangles<f32, 8> {
///     let mut closest = ClosestTriangles::default();
///     let (all, mut index) = (rays.active(), 0);
///     for leaf in leaves {
///         let active = rays.conservative(simd, &leaf.bounds, all).mask;
///         for triangle in &leaf.triangles {
///             if active != 0 {
///                 rays.exact(simd, triangle, index, active, &mut closest);
///             }
///             index += 1;
///         }
///     }
///     closest
/// }
///
/// let leaves = [5.0, 2.0, 9.0].map(|z| {
///     let triangle = Triangle::new(Vec3::new(0.0, 0.0, z), Vec3::new(4.0, 0.0, z), Vec3::new(0.0, 4.0, z));
///     Leaf { bounds: triangle.aabb(), triangles: vec![triangle] }
/// });
/// let rays = [0.5, 1.5, 2.5].map(|x| Ray::new(Vec3::new(x, x, 0.0), Vec3::Z));
/// let mut packet = RayPack::from_rays(&rays);
/// let closest = dispatch!(Level::new(), simd => trace(simd, &leaves, &mut packet));
/// // The third ray passes by, and five lanes are empty.
/// assert_eq!(closest.mask, 0b011);
/// let (index, hit) = closest.get(1).expect("inside");
/// assert_eq!((index, hit.t, hit.u, packet.t_max[1]), (1, 2.0, 0.375, 2.0));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct RayPack<T, const N: usize> {
    /// By axis and lane; like the rest zero in a lane without a ray.
    origin: [[T; N]; 3],
    direction: [[T; N]; 3],
    /// As in [`BoxRay`].
    near_inverse: [[T; N]; 3],
    far_inverse: [[T; N]; 3],
    /// As the filter of triangles wants it.
    reach: [[T; N]; 3],
    t_min: [T; N],
    /// The greatest t that counts in each lane, as in [`Ray::t_max`]; a traversal lowers it to the closest hit
    /// so far, as the kernels do.
    pub t_max: [T; N],
    /// The lanes with rays that may hit something.
    active: u32,
    /// The lanes of which boxes ask the scalar kernel: the range reaches below zero, or numbers are extreme.
    boxed_apart: u32,
}

/// Nothing but empty lanes.
impl<T: Lanes<N>, const N: usize> Default for RayPack<T, N> {
    fn default() -> Self {
        let (vectors, numbers) = ([[T::ZERO; N]; 3], [T::ZERO; N]);
        Self {
            origin: vectors,
            direction: vectors,
            near_inverse: vectors,
            far_inverse: vectors,
            reach: vectors,
            t_min: numbers,
            t_max: numbers,
            active: 0,
            boxed_apart: 0,
        }
    }
}

impl<T: Lanes<N>, const N: usize> RayPack<T, N> {
    /// The rays, from lane 0 on. The other lanes, and those of rays that hit nothing (a zero direction, a NaN, an
    /// empty range), are never hit.
    ///
    /// # Panics
    ///
    /// If there are more than `N` rays.
    #[must_use]
    pub fn from_rays<V: Vector<Scalar = T>>(rays: &[Ray<V>]) -> Self {
        assert!(rays.len() <= N, "{} rays for {N} lanes", rays.len());
        let mut pack = Self::default();
        for (lane, ray) in rays.iter().enumerate() {
            let boxed = BoxRay::new(ray);
            let reach = filter::reach(ray);
            for axis in 0..3 {
                pack.reach[axis][lane] = reach.component(axis);
                pack.origin[axis][lane] = ray.origin.component(axis);
                pack.direction[axis][lane] = ray.direction.component(axis);
                pack.near_inverse[axis][lane] = boxed.near_inverse.component(axis);
                pack.far_inverse[axis][lane] = boxed.far_inverse.component(axis);
            }
            (pack.t_min[lane], pack.t_max[lane]) = (ray.t_min, ray.t_max);
            pack.active |= u32::from(ray.is_valid() && ray.has_range()) << lane;
            pack.boxed_apart |= u32::from(boxed.extreme | boxed.before_origin) << lane;
        }
        pack
    }

    /// The ray of a lane, with the present `t_max`; one with a zero direction where there is none.
    #[inline]
    #[must_use]
    pub fn get<V: Vector<Scalar = T>>(&self, lane: usize) -> Ray<V> {
        if lane >= N {
            return Ray::new(V::ZERO, V::ZERO);
        }
        let [origin, direction] = [&self.origin, &self.direction].map(|vectors| {
            let [x, y, z] = vectors.each_ref().map(|axis| axis[lane]);
            V::new(x, y, z)
        });
        Ray { origin, direction, t_min: self.t_min[lane], t_max: self.t_max[lane] }
    }

    /// The lanes with rays that may hit something, as bits: with these a traversal begins.
    #[inline]
    #[must_use]
    pub const fn active(&self) -> u32 {
        self.active
    }

    /// Lowers `t_max` to `t` in the lanes of a mask: after a hit of a shape of your own, or of a plane.
    #[inline(always)]
    pub fn shorten(&mut self, lanes: u32, t: &[T; N]) {
        replace(lanes, &mut self.t_max, t);
    }

    #[inline(always)]
    fn wide<S: Simd>(&self, simd: S) -> Ray<Columns<T::Wide<S>>> {
        Ray {
            origin: Columns::load(simd, &self.origin, [0, 1, 2]),
            direction: Columns::load(simd, &self.direction, [0, 1, 2]),
            t_min: T::load(simd, &self.t_min),
            t_max: T::load(simd, &self.t_max),
        }
    }
}

/// The numbers of the lanes in a mask; the others stay what they are.
#[inline(always)]
fn replace<T: Copy, const N: usize>(lanes: u32, numbers: &mut [T; N], by: &[T; N]) {
    for lane in 0..N {
        numbers[lane] = if (lanes >> lane) & 1 == 1 { by[lane] } else { numbers[lane] };
    }
}
