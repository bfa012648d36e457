//! Triangle against axis-aligned box.
//!
//! Both sets are closed: touching is overlapping. A degenerate triangle (a segment or a point) is
//! taken as the point set that it is.
//!
//! | kernel | method | for |
//! |---|---|---|
//! | [`exact`] | 13 separating axes, certain | yes or no; the default |
//! | [`sat`] | 13 separating axes | yes or no |
//! | [`clip`] | Sutherland–Hodgman | the part of the triangle in the box |

pub mod clip;
pub mod exact;
pub mod sat;

use crate::shape::{Aabb, Triangle};
use crate::vector::Vector;

impl<V: Vector> Triangle<V> {
    /// Whether the triangle and the box share a point, by the kernel that the crate recommends:
    /// [`exact::overlaps`].
    ///
    /// ```
    /// use isect::{Aabb, Triangle, glam::Vec3};
    ///
    /// let aabb = Aabb::new(Vec3::ZERO, Vec3::ONE);
    /// let triangle = Triangle::new(Vec3::new(1.0, 1.0, 1.0), Vec3::X * 3.0, Vec3::Y * 3.0);
    /// assert!(triangle.overlaps(&aabb));
    /// ```
    #[inline]
    #[must_use]
    pub fn overlaps(&self, aabb: &Aabb<V>) -> bool {
        exact::overlaps(self, aabb)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{Vec3, Vec3A};

    fn overlaps(triangle: &Triangle, aabb: &Aabb) -> bool {
        let verdicts = [
            sat::overlaps(triangle, aabb),
            clip::overlaps(triangle, aabb),
            exact::overlaps(triangle, aabb),
            sat::overlaps(&Triangle::<Vec3A>::from(*triangle), &Aabb::<Vec3A>::from(*aabb)),
        ];
        assert!(verdicts.iter().all(|v| *v == verdicts[0]), "{triangle:?} {aabb:?} {verdicts:?}");
        verdicts[0]
    }

    #[test]
    fn each_kind_of_axis_separates() {
        let aabb = Aabb::new(Vec3::ZERO, Vec3::splat(2.0));
        let v = Vec3::new;
        // A face of the box, the plane of the triangle, an edge against an edge.
        assert!(!overlaps(
            &Triangle::new(v(3.0, 0.0, 0.0), v(4.0, 0.0, 2.0), v(3.0, 2.0, 1.0)),
            &aabb
        ));
        assert!(!overlaps(
            &Triangle::new(v(7.0, 0.0, 0.0), v(0.0, 7.0, 0.0), v(0.0, 0.0, 7.0)),
            &aabb
        ));
        assert!(overlaps(
            &Triangle::new(v(6.0, 0.0, 0.0), v(0.0, 6.0, 0.0), v(0.0, 0.0, 6.0)),
            &aabb
        ));
        assert!(!overlaps(
            &Triangle::new(v(1.0, 3.5, 0.0), v(3.5, 1.0, 0.0), v(4.0, 4.0, 2.0)),
            &aabb
        ));
    }

    #[test]
    fn degenerate_triangles_are_segments_and_points() {
        let aabb = Aabb::new(Vec3::ZERO, Vec3::splat(2.0));
        let (a, b) = (Vec3::new(-1.0, 1.0, 1.0), Vec3::new(3.0, 1.0, 1.0));
        assert!(
            overlaps(&Triangle::new(a, b, (a + b) * 0.5), &aabb)
                && overlaps(&Triangle::new(a, b, b), &aabb)
        );
        let beside = Vec3::new(0.0, 1.5, 0.0);
        assert!(!overlaps(&Triangle::new(a + beside, b + beside, b + beside), &aabb));
        assert!(
            overlaps(&[Vec3::splat(2.0); 3].into(), &aabb)
                && !overlaps(&[Vec3::splat(2.1); 3].into(), &aabb)
        );
    }

    #[test]
    fn bad_input_does_not_overlap_and_unbounded_boxes_do() {
        let triangle = Triangle::new(Vec3::ZERO, Vec3::X, Vec3::Y);
        let whole = Aabb::new(Vec3::NEG_INFINITY, Vec3::INFINITY);
        assert!(overlaps(&triangle, &whole));
        assert!(!overlaps(&triangle, &Aabb::EMPTY));
        assert!(!overlaps(&triangle, &Aabb::new(Vec3::ZERO, Vec3::NAN)));
        for bad in [f32::NAN, f32::INFINITY] {
            for vertex in 0..3 {
                let mut corners = [Vec3::ZERO, Vec3::X, Vec3::Y];
                corners[vertex].y = bad;
                assert!(!overlaps(&corners.into(), &whole), "{corners:?}");
            }
        }
    }

    #[test]
    fn sizes_of_any_exponent() {
        for scale in [1e-38, 1e-30, 1e-22, 1e22, 1e37] {
            let aabb = Aabb::new(Vec3::ZERO, Vec3::splat(2.0 * scale));
            let corners = |x: f32| [Vec3::X * x, Vec3::Y * x, Vec3::Z * x].map(|p| p * scale);
            assert!(
                overlaps(&corners(5.0).into(), &aabb) && !overlaps(&corners(7.0).into(), &aabb),
                "{scale}"
            );
        }
    }
}
