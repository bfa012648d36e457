//! Triangle against axis-aligned box.
//!
//! Both sets are closed: touching is overlapping. A degenerate triangle (a segment or a point) is
//! taken as the point set that it is.
//!
//! | kernel | method | for |
//! |---|---|---|
//! | [`sat`] | 13 separating axes | yes or no; the default |
//! | [`clip`] | Sutherland–Hodgman | the part of the triangle in the box |

pub mod clip;
pub mod sat;

use crate::shape::{Aabb, Triangle};
use crate::vector::Vector;

impl<V: Vector> Triangle<V> {
    /// Whether the triangle and the box share a point, by the kernel that the crate recommends:
    /// today [`sat::overlaps`].
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
        sat::overlaps(self, aabb)
    }
}
