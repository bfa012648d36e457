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

    /// The plane of the points `point + x·vx + y·vy`, with the normal `vx × vy`; where that leaves
    /// the middle of the range of exponents, with a positive multiple of it. `None` if the normal is
    /// zero as computed (parallel spans) or a value is not finite.
    #[inline]
    #[must_use]
    pub fn from_point_spans(point: V, vx: V, vy: V) -> Option<Self> {
        let mut normal = vx.cross(vy);
        if !Coordinates::abs(normal).max_element().is_mid_range() {
            let unit = |v: V| v * v.normalizer();
            normal = unit(vx).cross(unit(vy));
        }
        Self::from_point_normal(point, normal)
    }

    /// The plane through three points, with the normal (b − a) × (c − a), or a multiple of it as in
    /// [`Self::from_point_spans`]: it looks to the side from which a, b, c run counter-clockwise.
    /// `None` if the normal is zero as computed (collinear points) or a value is not finite.
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
    /// NaN for a plane that is not valid; infinite or NaN where products of the coordinates overflow.
    ///
    /// ```
    /// use isect::{Plane, glam::Vec3};
    ///
    /// let plane = Plane::from_point_normal(Vec3::Z, Vec3::Z * 2.0).expect("a normal");
    /// assert_eq!((plane.signed_distance(Vec3::Z * 4.0), plane.signed_distance(Vec3::X)), (3.0, -1.0));
    /// ```
    #[inline]
    #[must_use]
    pub fn signed_distance(&self, point: V) -> V::Scalar {
        if !self.is_valid() {
            return V::Scalar::NAN;
        }
        let scale = self.normal.normalizer();
        let normal = self.normal * scale;
        (normal.dot(point) - self.offset * scale) / normal.length()
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
    fn points_of_any_scale_span_a_plane() {
        for scale in [1e-44, 1e-25, 1e-12, 1e12, 1e20, 1e37] {
            let [a, b, c] = [Vec3::X, Vec3::Y, Vec3::Z].map(|p| p * scale);
            let plane = Plane::from_points(a, b, c).expect("they are not collinear");
            assert!(plane.normal.x > 0.0 && plane.normal == Vec3::splat(plane.normal.x));
            assert_eq!(Plane::from_points(a, b, a + (b - a) * 2.0), None);
        }
    }

    #[test]
    fn distances_are_signed_and_in_units_of_length() {
        let plane = Plane { normal: Vec3::new(0.0, 0.0, 4.0), offset: 8.0 };
        assert_eq!(plane.signed_distance(Vec3::new(5.0, 5.0, 3.0)), 1.0);
        assert_eq!(plane.signed_distance(Vec3::ZERO), -2.0);
        for offset in [0.0, 1.0] {
            let nowhere = Plane { normal: Vec3::ZERO, offset };
            assert!(nowhere.signed_distance(Vec3::ZERO).is_nan());
        }
        for length in [1e-30, 1e-40, 1e30] {
            let plane = Plane { normal: Vec3::Z * length, offset: 0.0 };
            // A product, a square, a root and a quotient, each rounded.
            let error = plane.signed_distance(Vec3::Z * 3.0) - 3.0;
            assert!(error.abs() <= 3.0 * 4.0 * (f32::EPSILON / 2.0), "{length}: {error}");
        }
    }
}
