//! Pyramid against triangle: outside, partial or inside, for culling.
//!
//! The verdicts are those that J. Genetti, D. Gordon, G. Williams, "Adaptive Supersampling in Object Space Using
//! Pyramidal Rays", 1998, ask for. They are found by separating axes: S. Gottschalk, M. C. Lin, D. Manocha,
//! "OBBTree", SIGGRAPH 1996.

use super::Containment;
use super::pyramid::{Axis, Seen};
use crate::shape::{Pyramid, Triangle};
use crate::vector::Vector;

/// Where the triangle lies: outside of the pyramid, wholly inside, or neither.
///
/// It is inside if no vertex lies beyond a side. It is outside if one of 17 axes has all of it beyond the pyramid:
/// the four sides' normals nᵢ, the twelve across an edge of either, and the triangle's normal. All of
/// these are taken as combinations Σ μᵢ·nᵢ with μᵢ ≥ 0.
///
/// **Grade: conservative.** It is never `Outside` where the triangle touches the pyramid, and never `Inside` where a point of
/// it is not in the pyramid, whose stored normals define it. It may be `Partial` where exact arithmetic would say
/// otherwise, if the distance on the deciding axis N = Σ μᵢ·nᵢ is no more than about 8u·Σ μᵢ·|nᵢ|·|v − apex|, u = EPSILON/2; it is
/// where a triangle inside has a vertex exactly on a side. A triangle without area is the segment or the
/// point that it is.
///
/// A NaN or infinite coordinate: `Outside`.
///
/// ```
/// use isect::overlap::{Containment, pyramid_triangle};
/// use isect::{Pyramid, Triangle, glam::Vec3};
///
/// let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
/// let pyramid = Pyramid::new(Vec3::ZERO, corners.map(|(x, y)| Vec3::new(x, y, 1.0))).expect("it is convex");
/// let at = |x: f32| Triangle::from([(0.0, 0.0), (0.0, 1.0), (1.0, 0.0)].map(|(dx, y)| Vec3::new(x + dx, y, 4.0)));
/// assert_eq!(pyramid_triangle::classify(&pyramid, &at(0.0)), Containment::Inside);
/// assert_eq!(pyramid_triangle::classify(&pyramid, &at(3.5)), Containment::Partial);
/// assert_eq!(pyramid_triangle::classify(&pyramid, &at(4.5)), Containment::Outside);
/// ```
#[must_use]
pub fn classify<V: Vector>(pyramid: &Pyramid<V>, triangle: &Triangle<V>) -> Containment {
    let vertices = <[V; 3]>::from(*triangle);
    if !vertices.iter().all(|v| v.is_finite()) {
        return Containment::Outside;
    }
    let Seen { points, .. } = Seen::from(pyramid.apex, vertices);
    let separates = |axis: Axis<V>| points.iter().all(|&p| axis.is_beyond(p));
    let sides = pyramid.normals.map(Axis::of_side);
    if sides.into_iter().any(separates) {
        return Containment::Outside;
    }
    if sides.iter().all(|side| points.iter().all(|&p| side.is_before(p))) {
        return Containment::Inside;
    }
    let [a, b, c] = points;
    let edges = [b - a, c - b, a - c];
    let separates = |axis: Option<Axis<V>>| axis.is_some_and(separates);
    let is_outside = pyramid
        .fans()
        .into_iter()
        .any(|sides| separates(Axis::of_apex(sides, [edges[0], edges[2]])))
        || pyramid
            .edges()
            .into_iter()
            .any(|sides| edges.into_iter().any(|edge| separates(Axis::of_edge(sides, edge))))
        || !pyramid.is_valid();
    if is_outside { Containment::Outside } else { Containment::Partial }
}
