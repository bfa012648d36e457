//! The sphere |p − center| = radius.

use glam::Vec3;

use super::Aabb;
use crate::vector::{Coordinates, Number, Scalar, Vector};

/// The sphere of the points p with `|p − center| = radius`: the surface, not the ball.
///
/// A radius of zero is a point. A negative radius, or an infinite or NaN field, makes a sphere that
/// is never hit.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Sphere<V: Coordinates = Vec3> {
    /// The centre.
    pub center: V,
    /// The radius, not negative.
    pub radius: V::Scalar,
}

impl<V: Vector> Sphere<V> {
    /// The sphere around `center`.
    #[inline]
    #[must_use]
    pub const fn new(center: V, radius: V::Scalar) -> Self {
        Self { center, radius }
    }

    /// The outward unit normal at the point of the sphere nearest to `point`; zero if `point` is
    /// the centre.
    #[inline]
    #[must_use]
    pub fn normal_at(&self, point: V) -> V {
        let outward = point - self.center;
        let length = outward.length();
        if V::Scalar::ZERO.lt(length) { outward * (V::Scalar::ONE / length) } else { V::ZERO }
    }

    /// The smallest box around the sphere, rounded outward; [`Aabb::EMPTY`] for a sphere that is
    /// never hit.
    #[inline]
    #[must_use]
    pub fn aabb(&self) -> Aabb<V> {
        if self.is_valid() {
            Aabb::from_center_half_extents(self.center, V::splat(self.radius))
        } else {
            Aabb::EMPTY
        }
    }

    /// Whether the fields are finite and the radius is not negative.
    #[inline]
    pub(crate) fn is_valid(&self) -> bool {
        self.center.is_finite() && self.radius.is_finite() && V::Scalar::ZERO.le(self.radius)
    }
}
