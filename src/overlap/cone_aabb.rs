//! Cone against axis-aligned box.
//!
//! The box is solid, as to a ray. Its faces are polygons, counted as [`super::cone_triangle`] counts a triangle:
//! those that are turned to the apex cover what the box covers, and none of it twice.

use glam::DVec3;

use super::cone::{ConeHit, Outline, Section, is_far};
use crate::exact::wide;
use crate::shape::{Aabb, Cone, Ray};
use crate::vector::{Scalar, Vector};

/// The corners of the six faces, by [`Aabb::corners`], counter-clockwise from outside.
const FACES: [[usize; 4]; 6] =
    [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];

/// Where the cone touches the box, and what share of its section the box covers.
///
/// The coverage is the sum over the faces that are turned to the cone's apex, and over the cut of the
/// first section through the box, if it begins in it, each projected into the section.
/// t is the least one at which the disk around `ray.at(t)` touches the box.
///
/// **Grade: conservative**, as [`super::cone_triangle::intersect`], and with its bounds; the coverage within
/// 200u.
///
/// A flat box covers what its one face does. Bad input, which is a cone that touches nothing, or a box
/// that is empty, unbounded, or has a NaN: `None`.
///
/// ```
/// use isect::{Aabb, Cone, Ray, glam::Vec3, overlap::cone_aabb};
///
/// let cone = Cone::new(Ray::new(Vec3::ZERO, Vec3::Z), 0.0, 0.5);
/// let aabb = Aabb::new(Vec3::new(0.0, -9.0, 2.0), Vec3::new(9.0, 9.0, 3.0));
/// let hit = cone_aabb::intersect(&cone, &aabb).expect("the axis touches it");
/// assert_eq!((hit.t, hit.coverage), (2.0, 0.5));
/// ```
#[must_use]
pub fn intersect<V: Vector>(cone: &Cone<V>, aabb: &Aabb<V>) -> Option<ConeHit<V::Scalar>> {
    if is_far(cone, aabb) {
        return None;
    }
    let (section, corners) = in_frame(cone, aabb)?;
    let z = nearest(&section, cone, aabb, corners)?;
    let (mut turned, mut cut) = (0.0, 0.0);
    for face in FACES {
        let outline = Outline::new(&section, face.map(|i| corners[i]));
        // Seen from outside a face runs clockwise around the axis, which points away from the apex.
        turned += (-section.double_area(&outline)).max(0.0);
        cut += section.double_cap(&outline);
    }
    // A flat box has a face twice, once from each side: only one of them is turned to the apex.
    Some(section.hit(cone, z, 0.5 * (turned + cut.abs())))
}

/// Whether the cone touches the box: the verdict of [`intersect`], in less time; the test for the nodes of a
/// hierarchy.
///
/// **Grade: conservative**, as [`intersect`]: no box that the cone touches is missed.
///
/// ```
/// use isect::{Aabb, Cone, Ray, glam::Vec3, overlap::cone_aabb};
///
/// let node = Aabb::new(Vec3::ONE, Vec3::splat(2.0));
/// let cone = |spread| Cone::new(Ray::new(Vec3::ZERO, Vec3::Z), 0.0, spread);
/// assert!(cone_aabb::touches(&cone(0.75), &node) && !cone_aabb::touches(&cone(0.5), &node));
/// ```
#[must_use]
pub fn touches<V: Vector>(cone: &Cone<V>, aabb: &Aabb<V>) -> bool {
    if is_far(cone, aabb) {
        return false;
    }
    in_frame(cone, aabb).is_some_and(|(section, corners)| {
        corners.iter().any(|&corner| section.holds(corner))
            || nearest(&section, cone, aabb, corners).is_some()
    })
}

/// The cone and the corners in its frame.
fn in_frame<V: Vector>(cone: &Cone<V>, aabb: &Aabb<V>) -> Option<(Section, [DVec3; 8])> {
    if aabb.is_empty() {
        return None;
    }
    Section::new(cone, aabb.corners(), V::Scalar::ZERO)
}

/// The least z at which the section meets the box.
fn nearest<V: Vector>(
    section: &Section,
    cone: &Cone<V>,
    aabb: &Aabb<V>,
    corners: [DVec3; 8],
) -> Option<f64> {
    // The centre of the first section, within the margin.
    let Ray { origin, direction, t_min, .. } = cone.ray;
    let start = wide(origin) + wide(direction) * t_min.into().max(0.0);
    let wider = Aabb::new(wide(aabb.min), wide(aabb.max)).inflated(section.margin / section.scale);
    if wider.contains(start) {
        return Some(section.near);
    }
    // Now the box is touched only where a face is.
    let inflated = section.inflated();
    FACES
        .iter()
        .filter_map(|face| inflated.nearest(&Outline::new(&inflated, face.map(|i| corners[i]))))
        .reduce(f64::min)
}
