//! Pyramid against sphere: outside, partial or inside, for culling.
//!
//! The verdicts are those that J. Genetti, D. Gordon, G. Williams, "Adaptive Supersampling in Object Space Using
//! Pyramidal Rays", 1998, ask for.

use super::Containment;
use super::pyramid::{Axis, Seen};
use crate::shape::{Pyramid, Sphere};
use crate::vector::{Number, Scalar, Vector};

/// Where the sphere lies: outside of the pyramid, wholly inside, or neither.
///
/// With c the centre as seen from the apex and r the radius, it is inside if nᵢ·c ≥ r·|nᵢ| for each side, and outside if
/// N·c < −r·|N| for an axis N = Σ μᵢ·nᵢ with μᵢ ≥ 0: a side's normal, the one that meets an edge
/// nearest to the centre, or −c itself, for the apex. (A pyramid has no end, so it touches the sphere if it
/// touches the ball.)
///
/// **Grade: conservative.** It is never `Outside` where the sphere touches the pyramid, and never `Inside` where a point of it is
/// not in the pyramid, whose stored normals define it. It may be `Partial` where exact arithmetic would say otherwise,
/// if the distance on the deciding axis is no more than about 8u·Σ μᵢ·|nᵢ|·|c| + 12u·r·Σ μᵢ·|nᵢ|, u = EPSILON/2.
///
/// A sphere that is never hit, a pyramid with a NaN or infinite field: `Outside`.
///
/// ```
/// use isect::overlap::{Containment, pyramid_sphere};
/// use isect::{Pyramid, Sphere, glam::Vec3};
///
/// let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
/// let pyramid = Pyramid::new(Vec3::ZERO, corners.map(|(x, y)| Vec3::new(x, y, 1.0))).expect("it is convex");
/// let at = |x, y| Sphere::new(Vec3::new(x, y, 4.0), 1.0);
/// assert_eq!(pyramid_sphere::classify(&pyramid, &at(0.0, 0.0)), Containment::Inside);
/// assert_eq!(pyramid_sphere::classify(&pyramid, &at(5.0, 0.0)), Containment::Partial);
/// assert_eq!(pyramid_sphere::classify(&pyramid, &at(5.3, 5.3)), Containment::Outside);
/// ```
#[must_use]
pub fn classify<V: Vector>(pyramid: &Pyramid<V>, sphere: &Sphere<V>) -> Containment {
    if !sphere.is_valid() {
        return Containment::Outside;
    }
    let Seen { points: [center], scale } = Seen::from(pyramid.apex, [sphere.center]);
    let radius = sphere.radius * scale[0] * scale[1];
    // How far the sphere reaches along an axis, and what rounding may add: three halves of a unit for the squares of
    // the length, and one each for two roots and products, within 8u.
    let reach = |axis: &Axis<V>| {
        let unit = V::Scalar::EPSILON;
        let longest = axis.normal.abs() + axis.magnitude * (unit + unit);
        radius * longest.length() * (V::Scalar::ONE + unit.lit(4.0) * unit)
            + axis.slack(center.abs())
    };
    let separates = |axis: Axis<V>| -axis.normal.dot(center) > reach(&axis);
    let sides = pyramid.normals.map(Axis::of_side);
    if sides.into_iter().any(separates) {
        return Containment::Outside;
    }
    if sides.iter().all(|side| side.normal.dot(center) > reach(side)) {
        return Containment::Inside;
    }
    let separates = |axis: Option<Axis<V>>| axis.is_some_and(separates);
    let across = perpendicular(center);
    let is_outside = pyramid.edges().into_iter().any(|[a, b]| {
        // In the plane of the edge and the centre lies the axis; this is across it.
        separates(Axis::of_edge([a, b], a.cross(b).cross(center)))
    }) || pyramid
        .fans()
        .into_iter()
        .any(|sides| separates(Axis::of_apex(sides, [across, center.cross(across)])))
        || !pyramid.is_valid();
    if is_outside { Containment::Outside } else { Containment::Partial }
}

/// A vector perpendicular to v, and not much shorter.
#[inline]
fn perpendicular<V: Vector>(v: V) -> V {
    let (zero, one) = (V::Scalar::ZERO, V::Scalar::ONE);
    let [x, y, z] = [v.x().abs(), v.y().abs(), v.z().abs()];
    let axis = if x <= y && x <= z {
        V::new(one, zero, zero)
    } else if y <= z {
        V::new(zero, one, zero)
    } else {
        V::new(zero, zero, one)
    };
    v.cross(axis)
}
