//! Ray against box for the nodes of a hierarchy: no box that the ray touches is missed.
//!
//! After T. Ize, "Robust BVH Ray Traversal", JCGT 2.2, 2013, which widens the exit by two ulps: too
//! little, as exact arithmetic shows, and the wrong way for negative t. Here the reciprocals carry
//! the margin, a factor of 1 ∓ 4u with u = EPSILON/2, and a range below zero gets both.

use super::BoxRay;
use crate::shape::Aabb;
use crate::vector::{Number, Scalar, Vector};

/// The part of the ray's range in which it may be in the box: [t_enter, t_exit].
///
/// Per axis, t = (plane − o) · (1/d), with the reciprocal rounded down for the plane of entry and up
/// for the plane of exit, by more than all rounding errors together.
///
/// **Grade: conservative.** If any point of the ray lies in the closed box, in exact arithmetic, the
/// answer is not `None`, and the interval holds every t at which one does, for every finite ray
/// and box. In return a box may be reported that the ray passes within a few ulps; and one with
/// infinite bounds that a parallel ray passes at any distance. The bounds are within 9 ulps of the
/// exact ones: the margin of 4u, up to four ulps of t, and four roundings of up to one each.
///
/// An empty box, a box with a NaN, a zero direction, a NaN or infinite origin or direction: `None`.
///
/// ```
/// use isect::{Aabb, Ray, glam::Vec3, ray::aabb::{BoxRay, conservative}};
///
/// let aabb = Aabb::new(Vec3::splat(-1.0), Vec3::splat(1.0));
/// let ray = BoxRay::new(&Ray::new(Vec3::new(-3.0, 0.0, 0.0), Vec3::X));
/// let [t_enter, t_exit] = conservative::interval(&ray, &aabb).expect("it is aimed at the centre");
/// assert!(1.999_999 < t_enter && t_enter <= 2.0 && 4.0 <= t_exit && t_exit < 4.000_003);
/// ```
#[inline]
#[must_use]
pub fn interval<V: Vector>(ray: &BoxRay<V>, aabb: &Aabb<V>) -> Option<[V::Scalar; 2]> {
    let (t_enter, t_exit) = bounds(ray, aabb);
    // A bound that has overflowed stands for a finite t beyond the largest float. (Written so that it
    // compiles to conditional moves and not to branches, which random rays would mispredict.)
    let largest = V::Scalar::MAX;
    let mut interval = Some([t_enter.min(largest), t_exit.max(-largest)]);
    if !(aabb.min.all_le(aabb.max) & t_enter.le(t_exit)) {
        interval = None;
    }
    interval
}

/// Whether the ray may hit the box: [`interval`] is not `None`.
///
/// **Grade: conservative**, as [`interval`]; and like it false for an empty box, a box with a NaN, a
/// zero direction, a NaN or infinite origin or direction.
///
/// ```
/// use isect::{Aabb, Ray, glam::Vec3, ray::aabb::{BoxRay, conservative}};
///
/// let flat = Aabb::new(Vec3::ZERO, Vec3::new(1.0, 1.0, 0.0));
/// let ray = BoxRay::new(&Ray::new(Vec3::new(-1.0, 0.5, 0.0), Vec3::X));
/// assert!(conservative::hits(&ray, &flat));
/// ```
#[inline]
#[must_use]
pub fn hits<V: Vector>(ray: &BoxRay<V>, aabb: &Aabb<V>) -> bool {
    let (t_enter, t_exit) = bounds(ray, aabb);
    aabb.min.all_le(aabb.max) & t_enter.le(t_exit)
}

/// The last entry and the first exit, clipped to the range.
#[inline(always)]
fn bounds<V: Vector>(ray: &BoxRay<V>, aabb: &Aabb<V>) -> (V::Scalar, V::Scalar) {
    let (near, far) = if ray.extreme | ray.before_origin {
        both_ways(ray, aabb)
    } else {
        // Bounds below zero are moved the wrong way, but not across it: the range ends there.
        let (near, far) = ray.differences(aabb);
        (near.scaled(ray.near_inverse), far.scaled(ray.far_inverse))
    };
    // For a parallel ray in a plane of the box a bound is 0 · ∞, a NaN, which folding drops.
    (near.fold_max(ray.t_min), far.fold_min(ray.t_max))
}

/// The slabs' bounds, moved outward whatever their sign.
#[cold]
fn both_ways<V: Vector>(ray: &BoxRay<V>, aabb: &Aabb<V>) -> (V, V) {
    if ray.extreme {
        // Two roundings, of the difference and of the quotient: three steps outweigh them.
        let (near, far) = ray.quotients(aabb);
        return (
            near.map(|t| t.next_down().next_down().next_down()),
            far.map(|t| t.next_up().next_up().next_up()),
        );
    }
    let (near, far) = ray.differences(aabb);
    (
        near.scaled(ray.near_inverse).min(near.scaled(ray.far_inverse)),
        far.scaled(ray.near_inverse).max(far.scaled(ray.far_inverse)),
    )
}
