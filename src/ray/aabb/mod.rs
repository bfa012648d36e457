//! Ray against axis-aligned box.
//!
//! A box is the common part of three slabs. A [`BoxRay`] holds what a ray can prepare once for all
//! boxes; each kernel then cuts the ray's range with the three slabs' intervals.
//!
//! | kernel | grade | for |
//! |---|---|---|
//! | [`slab`] | fast | entry and exit with their faces |
//! | [`conservative`] | never misses a box that the ray touches | the nodes of a hierarchy |

pub mod conservative;
pub mod slab;

use super::Intersect;
use crate::shape::{Aabb, Face, Ray};
use crate::vector::{Coordinates, Number, Scalar, Vector};
use glam::Vec3;

/// Where a ray enters and leaves a box, both clipped to the ray's range.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct AabbHit<T> {
    /// The first t of the ray in the box.
    pub t_enter: T,
    /// The last t of the ray in the box, at least `t_enter`; infinite only where both the range
    /// and the box are unbounded.
    pub t_exit: T,
    /// The face through which the ray enters; `None` where its range starts inside.
    pub enter_face: Option<Face>,
    /// The face through which the ray leaves; `None` where its range ends inside.
    pub exit_face: Option<Face>,
}

impl<T: Copy> AabbHit<T> {
    /// The first point of the ray on the box's surface: the entry, or the exit for a ray that
    /// starts inside; `None` if it neither enters nor leaves in its range.
    #[inline]
    #[must_use]
    pub fn surface(&self) -> Option<(T, Face)> {
        match (self.enter_face, self.exit_face) {
            (Some(face), _) => Some((self.t_enter, face)),
            (None, Some(face)) => Some((self.t_exit, face)),
            (None, None) => None,
        }
    }
}

impl<V: Vector> Intersect<V> for Aabb<V> {
    type Hit = AabbHit<V::Scalar>;
    #[inline]
    fn intersect(&self, ray: &Ray<V>) -> Option<Self::Hit> {
        slab::intersect(&BoxRay::new(ray), self)
    }
    #[inline]
    fn hits(&self, ray: &Ray<V>) -> bool {
        slab::hits(&BoxRay::new(ray), self)
    }
}

/// A ray as the box kernels want it: with the reciprocals of its direction, made once per ray.
///
/// ```
/// use isect::{Aabb, Ray, glam::Vec3A, ray::aabb::{BoxRay, conservative}};
///
/// let boxes = [
///     Aabb::new(Vec3A::splat(3.0), Vec3A::splat(4.0)),
///     Aabb::new(Vec3A::splat(1.0), Vec3A::splat(2.0)),
/// ];
/// let mut ray = BoxRay::new(&Ray::new(Vec3A::ZERO, Vec3A::ONE));
/// assert!(boxes.iter().all(|aabb| conservative::hits(&ray, aabb)));
/// ray.t_max = 2.5; // something was hit there
/// assert!(!conservative::hits(&ray, &boxes[0]));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct BoxRay<V: Coordinates = Vec3> {
    origin: V,
    direction: V,
    /// 1 / direction, rounded to nearest.
    inverse: V,
    /// 1 / direction with its magnitude rounded down, by enough to outweigh the rounding of a
    /// difference (see [`Self::new`]).
    near_inverse: V,
    /// 1 / direction with its magnitude rounded up likewise.
    far_inverse: V,
    /// The components in which the ray comes from the side of `max`.
    backward: V::Mask3,
    t_min: V::Scalar,
    /// The greatest t that counts, as in [`Ray::t_max`]; a traversal lowers it to the closest hit
    /// so far.
    pub t_max: V::Scalar,
    /// A reciprocal or a difference may overflow: the quotients are formed one by one instead.
    extreme: bool,
    /// The range reaches below t = 0.
    before_origin: bool,
}

impl<V: Vector> BoxRay<V> {
    /// Prepares a ray. One that hits nothing (zero direction, NaN, …) stays so.
    #[inline]
    #[must_use]
    pub fn new(ray: &Ray<V>) -> Self {
        let Ray { origin, direction, t_min, t_max } = *ray;
        let zero = V::Scalar::ZERO;
        let inverse = V::splat(V::Scalar::ONE).divided(direction);
        // With u = EPSILON/2: a computed difference p − o is too long by at most the factor 1 + u,
        // the computed reciprocal by as much, and a step to the next float changes it by at least
        // the factor 1 ∓ u. Two steps down outweigh both: (1 − u)²·(1 + u)² < 1; three steps up do:
        // (1 + u)³·(1 − u)² > 1. Then difference · reciprocal, before its own rounding, is on the
        // safe side of t; and rounding keeps order, so comparing it with any float or with another
        // such product cannot go wrong. (Zero and infinite reciprocals stay what they are.)
        let step = |x: V::Scalar, outward: bool| {
            if !x.is_finite() {
                x
            } else if (x > zero) == outward {
                x.next_up()
            } else {
                x.next_down()
            }
        };
        let stepped = |outward| inverse.map(|x| step(step(step(x, outward), outward), outward));
        let valid = ray.is_valid();
        // Up to an eighth of the largest float's ulp, adding the origin to it does not overflow.
        let far_away = V::Scalar::MAX * V::Scalar::EPSILON * zero.lit(0.125);
        let overflow = |axis: usize| {
            let parallel = direction.component(axis) == zero;
            (!parallel && !inverse.component(axis).is_finite())
                || origin.component(axis).abs() > far_away
        };
        Self {
            origin,
            direction,
            inverse,
            near_inverse: stepped(false),
            far_inverse: stepped(true),
            backward: inverse.less(V::ZERO),
            // A NaN that no comparison lets through.
            t_min: if valid { t_min } else { zero / zero },
            t_max,
            extreme: valid && (0..3).any(overflow),
            before_origin: t_min < zero,
        }
    }

    /// The differences from the origin to the planes that the ray meets first and last, per axis.
    #[inline(always)]
    fn differences(&self, aabb: &Aabb<V>) -> (V, V) {
        (
            V::select(self.backward, aabb.max, aabb.min) - self.origin,
            V::select(self.backward, aabb.min, aabb.max) - self.origin,
        )
    }

    /// The slabs' intervals for extreme rays, each bound within two roundings: (−∞, ∞) or the empty
    /// (∞, −∞) for an axis to which the ray is parallel, else two quotients, infinite where they
    /// overflow.
    #[cold]
    fn quotients(&self, aabb: &Aabb<V>) -> (V, V) {
        let infinity = V::Scalar::INFINITY;
        let half = V::Scalar::ONE.lit(0.5);
        let bounds = |axis: usize| {
            let (min, max) = (aabb.min.component(axis), aabb.max.component(axis));
            let (o, d) = (self.origin.component(axis), self.direction.component(axis));
            if d == V::Scalar::ZERO {
                let inside = min <= o && o <= max;
                return if inside { (-infinity, infinity) } else { (infinity, -infinity) };
            }
            let t = |plane: V::Scalar| {
                let difference = plane - o;
                if plane.is_finite() && !difference.is_finite() {
                    let doubled = (plane * half - o * half) / d;
                    doubled + doubled
                } else {
                    difference / d
                }
            };
            if d > V::Scalar::ZERO { (t(min), t(max)) } else { (t(max), t(min)) }
        };
        let [(x0, x1), (y0, y1), (z0, z1)] = [bounds(0), bounds(1), bounds(2)];
        (V::new(x0, y0, z0), V::new(x1, y1, z1))
    }
}
