//! Cone against triangle.
//!
//! J. Amanatides, "Ray Tracing with Cones", SIGGRAPH 1984, counts a polygon by its distances from the cone's
//! axis; here its outline is projected to the cone's section and the area common to both is computed, which
//! Green's theorem gives edge by edge.

use super::cone::{ConeHit, Outline, Section, is_far};
use crate::shape::{Cone, Triangle};
use crate::vector::{Scalar, Vector};

/// Where the cone touches the triangle, and what share of its section the triangle covers.
///
/// The triangle is clipped to the range and projected from the cone's apex (of a cylinder: along the axis) into
/// its section, a disk. The coverage is the area there of polygon ∩ disk, over that of the disk: the sum over
/// the edges of ½·p × q for what of an edge lies within, and of half the angle for what does not. So the
/// coverages of triangles side by side add up to that of their union. t is the least one at which the
/// disk around `ray.at(t)` touches the triangle: where an edge or a cut enters the cone, or where the
/// triangle's plane does.
///
/// **Grade: conservative** for hit or miss: no triangle that the cone touches is missed; let u be 2⁻⁵³ and s the
/// largest distance of a vertex from the cone's origin: it may be found by a cone that is wider and
/// longer by 128u·((1 + spread/|d|)·s + radius). t is that of such a cone. The coverage is within 40u, and the
/// rounding to the scalar, of that of a triangle with its points moved by at most 24u·s.
///
/// A triangle without area covers nothing, nor does one in a plane through the apex: it is seen edge-on. Bad
/// input, which is a cone that touches nothing or a NaN or infinite vertex: `None`.
///
/// ```
/// use isect::{Cone, Ray, Triangle, glam::Vec3, overlap::cone_triangle};
///
/// let cone = Cone::new(Ray::new(Vec3::ZERO, Vec3::Z), 0.0, 0.5);
/// // Its edge from v0 to v1 runs through the axis.
/// let far = [(-9.0, 0.0), (9.0, 0.0), (0.0, 9.0)].map(|(x, y)| Vec3::new(x, y, 2.0));
/// let hit = cone_triangle::intersect(&cone, &far.into()).expect("the axis hits it");
/// assert_eq!((hit.t, hit.coverage), (2.0, 0.5));
/// // The axis passes by this one.
/// let beside = Triangle::new(Vec3::new(0.5, -1.0, 2.0), Vec3::new(9.0, -1.0, 2.0), Vec3::new(0.5, 1.0, 2.0));
/// assert!(cone_triangle::touches(&cone, &beside));
/// ```
#[must_use]
pub fn intersect<V: Vector>(cone: &Cone<V>, triangle: &Triangle<V>) -> Option<ConeHit<V::Scalar>> {
    if is_far(cone, &triangle.aabb()) {
        return None;
    }
    let (section, corners) = Section::new(cone, (*triangle).into(), V::Scalar::ZERO)?;
    let inflated = section.inflated();
    let z = inflated.nearest(&Outline::new(&inflated, corners))?;
    let area = 0.5 * section.double_area(&Outline::new(&section, corners)).abs();
    Some(section.hit(cone, z, area))
}

/// Whether the cone touches the triangle: the verdict of [`intersect`].
///
/// **Grade: conservative**, as [`intersect`].
///
/// ```
/// use isect::{Cone, Ray, Triangle, glam::Vec3, overlap::cone_triangle};
///
/// let cone = Cone::new(Ray::new(Vec3::ZERO, Vec3::Z), 1.0, 0.0);
/// let triangle = |x| Triangle::new(Vec3::new(x, 0.0, 1.0), Vec3::new(5.0, 0.0, 1.0), Vec3::new(5.0, 1.0, 1.0));
/// assert!(cone_triangle::touches(&cone, &triangle(1.0)));
/// assert!(!cone_triangle::touches(&cone, &triangle(1.000_001)));
/// ```
#[must_use]
pub fn touches<V: Vector>(cone: &Cone<V>, triangle: &Triangle<V>) -> bool {
    if is_far(cone, &triangle.aabb()) {
        return false;
    }
    let in_frame = Section::new(cone, (*triangle).into(), V::Scalar::ZERO);
    in_frame.is_some_and(|(section, corners)| {
        let inflated = section.inflated();
        inflated.nearest(&Outline::new(&inflated, corners)).is_some()
    })
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::overlap::cone_aabb;
    use crate::shape::Ray;

    /// Also where the squares of lengths leave the range of exponents. The middle of the triangle is beyond the end of the cone.
    #[test]
    fn sizes_of_any_exponent() {
        for exponent in [-700, -330, 0, 330, 500] {
            let size = 2.0_f64.powi(exponent);
            let cone = |radius: f64| {
                let ray = Ray::new(DVec3::ZERO, DVec3::Z * size).with_range(0.0, 3.0);
                Cone::new(ray, radius * size, 0.5 * size)
            };
            let at = |x: f64| {
                let corners = [(x, 0.0, 2.0), (9.0, 0.0, 2.0), (9.0, 1.0, 6.0)];
                Triangle::from(corners.map(|(x, y, z)| DVec3::new(x, y, z) * size))
            };
            for (x, expected) in [(1.0, false), (1.25, true), (1.251, false), (-1.0, true)] {
                let (cone, triangle) = (cone(if x == 1.0 { -1.0 } else { 0.25 }), at(x));
                assert_eq!(touches(&cone, &triangle), expected, "{exponent} {x}");
                assert_eq!(intersect(&cone, &triangle).is_some(), expected, "{exponent} {x}");
                // The box around it comes nearer.
                let aabb = triangle.aabb();
                assert_eq!(cone_aabb::touches(&cone, &aabb), x != 1.0, "{exponent} {x}");
                assert_eq!(cone_aabb::intersect(&cone, &aabb).is_some(), x != 1.0);
            }
        }
    }
}
