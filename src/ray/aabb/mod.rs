//! Ray against axis-aligned box.
//!
//! A box is the common part of three slabs. A [`BoxRay`] holds what a ray can prepare once for all
//! boxes; each kernel then cuts the ray's range with the three slabs' intervals.
//!
#![doc = include_str!("../../doc/slabs.svg")]
//!
//! | kernel | grade | for |
//! |---|---|---|
//! | [`exact`] | exact | everything; the default |
//! | [`slab`] | fast | entry and exit with their faces |
//! | [`conservative`] | never misses a box that the ray touches | the nodes of a hierarchy |

pub mod conservative;
pub mod exact;
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
        exact::intersect(&BoxRay::new(ray), self)
    }
    #[inline]
    fn hits(&self, ray: &Ray<V>) -> bool {
        exact::hits(&BoxRay::new(ray), self)
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
    /// −origin: a plane plus it is a vector addition with an operand in memory, in a pack.
    pub(crate) negated_origin: V,
    direction: V,
    /// 1 / direction, rounded to nearest.
    inverse: V,
    /// 1 / direction with its magnitude rounded down, by enough to outweigh the rounding of a
    /// difference (see [`Self::new`]).
    pub(crate) near_inverse: V,
    /// 1 / direction with its magnitude rounded up likewise.
    pub(crate) far_inverse: V,
    /// The components in which the ray comes from the side of `max`.
    backward: V::Mask3,
    /// The same by axis: 1 where it comes from the side of `max`, else 0.
    pub(crate) entry_side: [u8; 3],
    pub(crate) t_min: V::Scalar,
    /// `t_min`, or the least float for a range without a start.
    t_first: V::Scalar,
    /// The greatest t that counts, as in [`Ray::t_max`]; a traversal lowers it to the closest hit
    /// so far.
    pub t_max: V::Scalar,
    /// A reciprocal or a difference may overflow, or a reciprocal is subnormal and has lost bits: the
    /// quotients are formed one by one instead.
    pub(crate) extreme: bool,
    /// The range reaches below t = 0.
    pub(crate) before_origin: bool,
}

impl<V: Vector> BoxRay<V> {
    /// Prepares a ray. One that hits nothing (zero direction, NaN, …) stays so.
    #[inline]
    #[must_use]
    pub fn new(ray: &Ray<V>) -> Self {
        let Ray { origin, direction, t_max, .. } = *ray;
        let zero = V::Scalar::ZERO;
        let inverse = V::splat(V::Scalar::ONE).divided(direction);
        // With u = EPSILON/2: a computed difference p − o is too long by at most the factor 1 + u, or too
        // short by 1 − u, and the computed reciprocal by as much. A factor of 1 ∓ 4u, itself exact, outweighs
        // both, its own rounding included: (1 − 4u)·(1 + u)³ < 1 and (1 + 4u)·(1 − u)³ > 1. Then
        // difference · reciprocal, before its own rounding, is on the safe side of t; and rounding keeps
        // order, so comparing it with any float or with another such product cannot go wrong. (Zero and
        // infinite reciprocals stay what they are; what underflow may lose of the least normal one is
        // less than a rounding.)
        let margin = V::Scalar::EPSILON + V::Scalar::EPSILON;
        // A range that lies at infinity holds no t.
        let reaches = ray.t_min < V::Scalar::INFINITY && -V::Scalar::INFINITY < t_max;
        let valid = ray.is_valid() && reaches;
        // Of a ray that hits nothing, a NaN that no comparison lets through.
        let t_min = if valid { ray.t_min } else { V::Scalar::NAN };
        // Up to an eighth of the largest float's ulp, adding the origin to it does not overflow.
        let far_away = V::Scalar::MAX * V::Scalar::EPSILON * zero.lit(0.125);
        let is_far = origin.abs().max_element() > far_away;
        // Of an axis to which the ray is parallel the reciprocal is infinite, and may be.
        let crossed = V::ZERO.less(direction.abs());
        let magnitudes = V::select(crossed, inverse.abs(), V::splat(V::Scalar::ONE));
        let is_normal = V::splat(V::Scalar::MIN_POSITIVE).all_le(magnitudes)
            & magnitudes.all_le(V::splat(V::Scalar::MAX));
        Self {
            negated_origin: -origin,
            direction,
            inverse,
            near_inverse: inverse * (V::Scalar::ONE - margin),
            far_inverse: inverse * (V::Scalar::ONE + margin),
            backward: inverse.less(V::ZERO),
            entry_side: [0, 1, 2].map(|axis| u8::from(inverse.component(axis) < zero)),
            t_min,
            t_first: (-V::Scalar::MAX).max(t_min),
            t_max,
            extreme: valid & (is_far | !is_normal),
            before_origin: t_min < zero,
        }
    }

    /// The differences from the origin to the planes that the ray meets first and last, per axis.
    #[inline(always)]
    fn differences(&self, aabb: &Aabb<V>) -> (V, V) {
        (
            V::select(self.backward, aabb.max, aabb.min) + self.negated_origin,
            V::select(self.backward, aabb.min, aabb.max) + self.negated_origin,
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
            let (o, d) = (-self.negated_origin.component(axis), self.direction.component(axis));
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

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DVec3, Vec3A};

    const UNIT: Aabb = Aabb::new(Vec3::ZERO, Vec3::ONE);

    fn hits(ray: &Ray, aabb: &Aabb) -> bool {
        let ray = BoxRay::new(ray);
        let verdicts = [
            slab::hits(&ray, aabb),
            slab::intersect(&ray, aabb).is_some(),
            conservative::hits(&ray, aabb),
            conservative::interval(&ray, aabb).is_some(),
            exact::hits(&ray, aabb),
        ];
        assert!(verdicts.iter().all(|v| *v == verdicts[0]), "{ray:?} {aabb:?} {verdicts:?}");
        verdicts[0]
    }

    /// Along every face, edge and diagonal, with zeros of both signs in the direction.
    #[test]
    fn parallel_rays_on_the_surface_hit() {
        for zero in [0.0, -0.0] {
            for (y, z) in [(0.0, 0.0), (0.0, 0.5), (1.0, 0.5), (1.0, 1.0), (0.5, 0.5)] {
                for (x, dx) in [(-1.0, 1.0), (2.0, -1.0), (0.0, 1.0), (1.0, 1.0), (0.5, -1.0)] {
                    let ray = Ray::new(Vec3::new(x, y, z), Vec3::new(dx, zero, zero));
                    assert!(hits(&ray, &UNIT), "{ray:?}");
                }
            }
            for (y, z) in [(-0.01, 0.5), (1.01, 0.5), (0.5, 1.01), (1.01, 1.01)] {
                let ray = Ray::new(Vec3::new(-1.0, y, z), Vec3::new(1.0, zero, zero));
                assert!(!hits(&ray, &UNIT), "{ray:?}");
                let line = ray.with_range(f32::NEG_INFINITY, f32::INFINITY);
                assert!(!hits(&line, &UNIT), "{line:?}");
            }
        }
    }

    #[test]
    fn flat_boxes_and_points_are_hit() {
        let through = Ray::new(Vec3::new(0.5, 0.5, -1.0), Vec3::Z);
        assert!(hits(&through, &Aabb::new(Vec3::ZERO, Vec3::new(1.0, 1.0, 0.0))));
        let within = Ray::new(Vec3::new(-1.0, 0.5, 0.0), Vec3::X);
        assert!(hits(&within, &Aabb::new(Vec3::ZERO, Vec3::new(1.0, 1.0, 0.0))));
        let corner = Ray::new(Vec3::splat(-1.0), Vec3::ONE);
        assert!(hits(&corner, &Aabb::new(Vec3::ONE, Vec3::ONE)));
        assert!(!hits(&corner, &Aabb::new(Vec3::X, Vec3::X)));
    }

    #[test]
    fn empty_boxes_are_not() {
        let ray =
            Ray::new(Vec3::splat(0.5), Vec3::ONE).with_range(f32::NEG_INFINITY, f32::INFINITY);
        assert!(!hits(&ray, &Aabb::EMPTY));
        for axis in 0..3 {
            let mut inverted = UNIT;
            inverted.min[axis] = 1.0_f32.next_up();
            assert!(!hits(&ray, &inverted));
            let mut nan = UNIT;
            nan.max[axis] = f32::NAN;
            assert!(!hits(&ray, &nan));
        }
    }

    #[test]
    fn the_range_is_closed_and_may_be_negative() {
        let ray = Ray::new(Vec3::new(3.0, 0.5, 0.5), Vec3::X);
        assert!(!hits(&ray, &UNIT));
        assert!(hits(&ray.with_range(-2.5, -2.0), &UNIT));
        assert!(hits(&ray.with_range(-9.0, -3.0), &UNIT));
        assert!(!hits(&ray.with_range(-1.5, 9.0), &UNIT));
        let hit = slab::intersect(&BoxRay::new(&ray.with_range(-9.0, 9.0)), &UNIT).expect("a hit");
        assert_eq!((hit.t_enter, hit.t_exit), (-3.0, -2.0));
    }

    #[test]
    fn the_surface_from_outside_inside_and_within_the_range() {
        let across = Ray::new(Vec3::new(-1.0, 0.5, 0.5), Vec3::X);
        let surface = |ray: &Ray| ray.intersect(&UNIT).expect("a hit").surface();
        assert_eq!(surface(&across), Some((1.0, Face::NegX)));
        assert_eq!(surface(&across.after(1.0)), Some((2.0, Face::PosX)));
        assert_eq!(surface(&across.with_range(1.25, 1.75)), None);
        // Through an edge and a corner: the first axis.
        let diagonal = Ray::new(Vec3::new(-1.0, 2.0, 0.5), Vec3::new(1.0, -1.0, 0.0));
        let hit = diagonal.intersect(&UNIT).expect("a hit");
        assert_eq!((hit.enter_face, hit.exit_face), (Some(Face::NegX), Some(Face::PosX)));
        let back = Ray::new(Vec3::splat(2.0), -Vec3::ONE).intersect(&UNIT).expect("a hit");
        assert_eq!((back.enter_face, back.exit_face), (Some(Face::PosX), Some(Face::NegX)));
    }

    #[test]
    fn unbounded_boxes() {
        let half_space =
            Aabb::new(Vec3::new(f32::NEG_INFINITY, f32::NEG_INFINITY, 0.0), Vec3::INFINITY);
        let hit = Ray::new(Vec3::NEG_Z, Vec3::Z).intersect(&half_space).expect("a hit");
        assert_eq!((hit.t_enter, hit.enter_face), (1.0, Some(Face::NegZ)));
        assert_eq!((hit.t_exit, hit.exit_face), (f32::INFINITY, None));
        assert!(!slab::hits(&BoxRay::new(&Ray::new(Vec3::NEG_Z, Vec3::X)), &half_space));
        let everything = Aabb::new(Vec3::NEG_INFINITY, Vec3::INFINITY);
        let line = Ray::new(Vec3::ONE, Vec3::ONE).with_range(f32::NEG_INFINITY, f32::INFINITY);
        let hit = line.intersect(&everything).expect("a hit");
        assert_eq!(
            (hit.t_enter, hit.t_exit, hit.surface()),
            (f32::NEG_INFINITY, f32::INFINITY, None)
        );
    }

    /// Beyond the largest float is not unbounded.
    #[test]
    fn far_ends_are_finite_and_have_faces() {
        let cube = |size: f32| Aabb::new(Vec3::splat(-size), Vec3::splat(size));
        let slow = |from: f32| Ray::new(Vec3::X * from, Vec3::X * 1e-20);
        let hit = slow(0.0).intersect(&cube(1e30)).expect("from inside");
        assert_eq!((hit.t_exit, hit.surface()), (f32::MAX, Some((f32::MAX, Face::PosX))));
        let before = slow(0.0).with_range(f32::NEG_INFINITY, 0.0);
        let hit = before.intersect(&cube(1e30)).expect("from inside");
        assert_eq!((hit.t_enter, hit.enter_face), (f32::MIN, Some(Face::NegX)));
        let line = slow(-2e30).with_range(f32::NEG_INFINITY, f32::INFINITY);
        let hit = line.intersect(&cube(1e30)).expect("before it");
        assert_eq!((hit.t_enter, hit.t_exit), (f32::MAX, f32::MAX));
        assert_eq!((hit.enter_face, hit.exit_face), (Some(Face::NegX), Some(Face::PosX)));
    }

    #[test]
    fn all_vectors_give_the_same_faces() {
        let ray = Ray::new(Vec3::new(0.5, 3.0, 0.5), Vec3::new(0.25, -2.0, 0.125));
        let hit = ray.intersect(&UNIT).expect("a hit");
        let (wide_ray, wide_box) = (Ray::<Vec3A>::from(ray), Aabb::<Vec3A>::from(UNIT));
        assert_eq!(wide_ray.intersect(&wide_box), Some(hit));
        let exact = Ray::<DVec3>::from(ray).intersect(&Aabb::<DVec3>::from(UNIT)).expect("a hit");
        assert_eq!((exact.enter_face, exact.exit_face), (hit.enter_face, hit.exit_face));
    }
}
