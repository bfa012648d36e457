//! The plane n·p = offset.

use glam::Vec3;

use crate::vector::{Coordinates, Number, Scalar, Vector};

/// The plane of the points p with `normal · p = offset`.
///
/// The normal may have any length but zero: no kernel relies on a unit normal, which floats cannot
/// hold anyway. A plane whose normal is zero, or with an infinite or NaN field, is never hit.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Plane<V: Coordinates = Vec3> {
    /// Perpendicular to the plane, of any length but zero.
    pub normal: V,
    /// `normal · p` for the points p of the plane.
    pub offset: V::Scalar,
}

impl<V: Vector> Plane<V> {
    /// The plane through `point`, perpendicular to `normal`. `None` if the normal is zero or a
    /// value is not finite.
    #[inline]
    #[must_use]
    pub fn from_point_normal(point: V, normal: V) -> Option<Self> {
        Self::from_hesse(normal, normal.dot(point))
    }

    /// The plane of the points `point + x·vx + y·vy`, with the normal `vx × vy`. `None` if that
    /// normal is zero as computed (parallel spans) or a value is not finite.
    #[inline]
    #[must_use]
    pub fn from_point_spans(point: V, vx: V, vy: V) -> Option<Self> {
        Self::from_point_normal(point, vx.cross(vy))
    }

    /// The plane through three points, with the normal (b − a) × (c − a): it looks to the side from
    /// which a, b, c run counter-clockwise. `None` if the normal is zero as computed (collinear
    /// points) or a value is not finite.
    #[inline]
    #[must_use]
    pub fn from_points(a: V, b: V, c: V) -> Option<Self> {
        Self::from_point_spans(a, b - a, c - a)
    }

    /// The plane n·p = d (Hesse's normal form; n need not be a unit vector). `None` if n is zero or
    /// a value is not finite.
    #[inline]
    #[must_use]
    pub fn from_hesse(n: V, d: V::Scalar) -> Option<Self> {
        let plane = Self { normal: n, offset: d };
        plane.is_valid().then_some(plane)
    }

    /// The distance of `point` from the plane, positive on the side to which the normal points.
    /// NaN for a plane that has no valid normal.
    #[inline]
    #[must_use]
    pub fn signed_distance(&self, point: V) -> V::Scalar {
        (self.normal.dot(point) - self.offset) / self.normal.length()
    }

    /// Whether the fields are finite and the normal is not zero.
    #[inline]
    pub(crate) fn is_valid(&self) -> bool {
        let longest = Coordinates::abs(self.normal).max_element();
        self.normal.is_finite() && self.offset.is_finite() && V::Scalar::ZERO.lt(longest)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn four_ways_to_the_same_plane() {
        let (a, b, c) =
            (Vec3::new(0.0, 0.0, 2.0), Vec3::new(1.0, 0.0, 2.0), Vec3::new(0.0, 1.0, 2.0));
        let expected = Some(Plane { normal: Vec3::Z, offset: 2.0 });
        assert_eq!(Plane::from_point_normal(a, Vec3::Z), expected);
        assert_eq!(Plane::from_point_spans(a, b - a, c - a), expected);
        assert_eq!(Plane::from_points(a, b, c), expected);
        assert_eq!(Plane::from_hesse(Vec3::Z, 2.0), expected);
    }

    #[test]
    fn degenerate_planes_are_refused() {
        let (a, b) = (Vec3::ZERO, Vec3::ONE);
        assert_eq!(Plane::from_points(a, b, b * 2.0), None);
        assert_eq!(Plane::from_point_spans(a, b, -b), None);
        assert_eq!(Plane::from_point_normal(b, Vec3::ZERO), None);
        assert_eq!(Plane::from_hesse(Vec3::new(f32::NAN, 1.0, 0.0), 0.0), None);
        assert_eq!(Plane::from_hesse(Vec3::X, f32::INFINITY), None);
    }

    #[test]
    fn distances_are_signed_and_in_units_of_length() {
        let plane = Plane { normal: Vec3::new(0.0, 0.0, 4.0), offset: 8.0 };
        assert_eq!(plane.signed_distance(Vec3::new(5.0, 5.0, 3.0)), 1.0);
        assert_eq!(plane.signed_distance(Vec3::ZERO), -2.0);
        let nowhere = Plane { normal: Vec3::ZERO, offset: 0.0 };
        assert!(nowhere.signed_distance(Vec3::ZERO).is_nan());
    }
}
