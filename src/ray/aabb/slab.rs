//! Ray against box by slabs.
//!
//! T. L. Kay, J. T. Kajiya, "Ray tracing complex scenes", SIGGRAPH 1986; with the planes ordered by
//! the direction's sign, as in A. Williams et al., "An efficient and robust ray-box intersection
//! algorithm", 2005, and closed sets in the face of 0·∞.

use super::{AabbHit, BoxRay};
use crate::shape::{Aabb, Face};
use crate::vector::{Number, Scalar, Vector};

/// Where the ray enters and leaves the box, through which faces, clipped to the ray's range.
///
/// Per axis, t = (plane − o) · (1/d) for the two planes; the ray is in the box from the last
/// entry to the first exit. An axis to which the ray is parallel lets it pass if the origin lies
/// between its planes or on one of them.
///
/// **Grade: fast.** t_enter and t_exit are within 3 roundings of the exact ones (a relative error
/// below 3.1u, u = EPSILON/2). The verdict is certain unless an entry and an exit, or an end of the
/// range, are that close to each other: for a promise there see [`super::conservative`].
///
/// An empty box, a box with a NaN, a zero direction, a NaN or infinite origin or direction: a miss.
/// So is a box of which the entry is beyond the largest float.
///
/// ```
/// use isect::{Aabb, Face, Ray, glam::Vec3, ray::aabb::{BoxRay, slab}};
///
/// let aabb = Aabb::new(Vec3::splat(-1.0), Vec3::splat(1.0));
/// let ray = BoxRay::new(&Ray::new(Vec3::new(-3.0, 0.0, 0.0), Vec3::X));
/// let hit = slab::intersect(&ray, &aabb).expect("it is aimed at the centre");
/// assert_eq!((hit.t_enter, hit.t_exit), (2.0, 4.0));
/// assert_eq!((hit.enter_face, hit.exit_face), (Some(Face::NegX), Some(Face::PosX)));
/// ```
#[inline]
#[must_use]
pub fn intersect<V: Vector>(ray: &BoxRay<V>, aabb: &Aabb<V>) -> Option<AabbHit<V::Scalar>> {
    let (overlap, crossing) = crossing(ray, aabb);
    // Written so that it compiles to conditional moves and not to branches, which random rays would
    // mispredict.
    let mut hit = Some(crossing);
    if !overlap {
        hit = None;
    }
    hit
}

/// Where the ray's line enters and leaves the box, clipped to the range, and whether in this order.
#[inline(always)]
pub(super) fn crossing<V: Vector>(ray: &BoxRay<V>, aabb: &Aabb<V>) -> (bool, AabbHit<V::Scalar>) {
    let infinity = V::Scalar::INFINITY;
    let (near, far) = slabs(ray, aabb);
    let (last_entry, first_exit) = (near.fold_max(-infinity), far.fold_min(infinity));
    let (t_enter, t_exit) = (last_entry.max(ray.t_min), first_exit.min(ray.t_max));
    // Where the range clips, or the box is unbounded, no face is crossed.
    let face = |bounds: V, t: V::Scalar, crossed: bool, far_side: u8| {
        let (not_x, not_y) = (usize::from(bounds.x() != t), usize::from(bounds.y() != t));
        let axis = not_x + (not_x & not_y);
        let face = 2 * axis + usize::from(ray.entry_side[axis] ^ far_side);
        FACES[if crossed & t.is_finite() { face } else { NO_FACE }]
    };
    let hit = AabbHit {
        t_enter,
        t_exit,
        enter_face: face(near, last_entry, last_entry >= ray.t_min, 0),
        exit_face: face(far, first_exit, first_exit <= ray.t_max, 1),
    };
    (overlap(aabb, last_entry.max(ray.t_first), V::Scalar::MAX.min(t_exit)), hit)
}

const NO_FACE: usize = 6;

/// By axis, then side; and none.
pub(super) const FACES: [Option<Face>; 7] = [
    Some(Face::NegX),
    Some(Face::PosX),
    Some(Face::NegY),
    Some(Face::PosY),
    Some(Face::NegZ),
    Some(Face::PosZ),
    None,
];

/// Whether the ray hits the box: the same verdict as [`intersect`], for less.
///
/// **Grade: fast**, as [`intersect`]; and like it false for an empty box, a box with a NaN, a zero
/// direction, a NaN or infinite origin or direction.
///
/// ```
/// use isect::{Aabb, Ray, glam::Vec3, ray::aabb::{BoxRay, slab}};
///
/// // Along a face of the box: the set is closed.
/// let aabb = Aabb::new(Vec3::ZERO, Vec3::ONE);
/// let ray = Ray::new(Vec3::new(-1.0, 1.0, 0.5), Vec3::new(1.0, -0.0, 0.0));
/// assert!(slab::hits(&BoxRay::new(&ray), &aabb));
/// ```
#[inline]
#[must_use]
pub fn hits<V: Vector>(ray: &BoxRay<V>, aabb: &Aabb<V>) -> bool {
    let (near, far) = slabs(ray, aabb);
    // The end of the range first, which does not wait for the box.
    let t_last = V::Scalar::MAX.min(ray.t_max);
    overlap(aabb, near.fold_max(ray.t_first), far.fold_min(t_last))
}

/// The t at which the ray enters and leaves each slab. For a parallel ray in a plane of the box one
/// is 0 · ∞, a NaN, which folding drops.
#[inline(always)]
pub(super) fn slabs<V: Vector>(ray: &BoxRay<V>, aabb: &Aabb<V>) -> (V, V) {
    if ray.extreme {
        return ray.quotients(aabb);
    }
    let (near, far) = ray.differences(aabb);
    (near.scaled(ray.inverse), far.scaled(ray.inverse))
}

/// Whether what is left of the range is not empty. For a parallel ray outside of its slab the entry
/// is +∞ or the exit −∞, and so may be the exit and the entry of an unbounded box: the ends of the
/// range are finite here.
#[inline(always)]
fn overlap<V: Vector>(aabb: &Aabb<V>, t_enter: V::Scalar, t_exit: V::Scalar) -> bool {
    aabb.min.all_le(aabb.max) & t_enter.le(t_exit)
}
