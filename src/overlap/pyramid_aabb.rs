//! Pyramid against box: outside, partial or inside, for culling.
//!
//! The corners of a box that are farthest along a normal and farthest against it are the p- and the n-vertex of
//! U. Assarsson, T. Möller, "Optimized View Frustum Culling Algorithms for Bounding Boxes", Journal of
//! Graphics Tools 5.1, 2000. The other axes are as in S. Gottschalk, M. C. Lin, D. Manocha, "OBBTree", SIGGRAPH 1996.

use super::Containment;
use super::pyramid::{Axis, Seen};
use crate::shape::{Aabb, Pyramid};
use crate::vector::{Scalar, Vector};

/// Where the box lies: outside of the pyramid, wholly inside, or neither.
///
/// It is inside if the corner farthest against each side's normal, its n-vertex, lies before that side. It is outside if
/// an axis has the corner farthest along it, the p-vertex, beyond the pyramid: one of the four sides' normals nᵢ, of the
/// twelve across an edge of either, or of the box's six. All of these are taken as combinations
/// Σ μᵢ·nᵢ with μᵢ ≥ 0.
///
/// **Grade: conservative.** It is never `Outside` where the box touches the pyramid, and never `Inside` where a point of it is
/// not in the pyramid, whose stored normals define it. It may be `Partial` where exact arithmetic would say otherwise,
/// if the distance on the deciding axis N = Σ μᵢ·nᵢ is no more than about 8u·Σ μᵢ·|nᵢ|·|b − apex|, u = EPSILON/2, b the corner
/// farthest from the apex on each axis; and for an unbounded box, where the sides alone are tried.
///
/// An empty box, a pyramid with a NaN or infinite field: `Outside`.
///
/// ```
/// use isect::overlap::{Containment, pyramid_aabb};
/// use isect::{Aabb, Pyramid, glam::Vec3};
///
/// let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
/// let pyramid = Pyramid::new(Vec3::ZERO, corners.map(|(x, y)| Vec3::new(x, y, 1.0))).expect("it is convex");
/// let at = |x| Aabb::new(Vec3::new(x, 0.0, 4.0), Vec3::new(x + 1.0, 1.0, 5.0));
/// assert_eq!(pyramid_aabb::classify(&pyramid, &at(0.0)), Containment::Inside);
/// assert_eq!(pyramid_aabb::classify(&pyramid, &at(4.5)), Containment::Partial);
/// assert_eq!(pyramid_aabb::classify(&pyramid, &at(5.5)), Containment::Outside);
/// ```
#[must_use]
pub fn classify<V: Vector>(pyramid: &Pyramid<V>, aabb: &Aabb<V>) -> Containment {
    if aabb.is_empty() {
        return Containment::Outside;
    }
    let Seen { points: [min, max], .. } = Seen::from(pyramid.apex, [aabb.min, aabb.max]);
    // An infinite bound across the axis is of no account, and no factor of zero.
    let corner = |side: &Axis<V>, farthest: V, nearest: V| {
        let corner = V::select(V::ZERO.less(side.normal), farthest, nearest);
        V::select(V::ZERO.less(side.magnitude), corner, V::ZERO)
    };
    let sides = pyramid.normals.map(Axis::of_side);
    let is_beyond = |side: &Axis<V>| side.is_beyond(corner(side, max, min));
    if !pyramid.is_valid() || sides.iter().any(is_beyond) {
        return Containment::Outside;
    }
    if sides.iter().all(|side| side.is_before(corner(side, min, max))) {
        return Containment::Inside;
    }
    let reach = min.abs().max(max.abs());
    if !reach.is_finite() {
        return Containment::Partial;
    }
    let (zero, one) = (V::Scalar::ZERO, V::Scalar::ONE);
    let axes = [V::new(one, zero, zero), V::new(zero, one, zero), V::new(zero, zero, one)];
    let separates = |axis: Option<Axis<V>>| {
        axis.is_some_and(|axis| {
            // Rounding may have taken the other corner, at the cost of its error times that corner.
            let farthest = V::select(V::ZERO.less(axis.normal), max, min);
            -axis.normal.dot(farthest) > axis.slack(reach)
        })
    };
    let is_outside = pyramid
        .edges()
        .into_iter()
        .any(|sides| axes.into_iter().any(|axis| separates(Axis::of_edge(sides, axis))))
        || pyramid.fans().into_iter().any(|sides| {
            (0..3).any(|i| separates(Axis::of_apex(sides, [axes[(i + 1) % 3], axes[(i + 2) % 3]])))
        });
    if is_outside { Containment::Outside } else { Containment::Partial }
}
