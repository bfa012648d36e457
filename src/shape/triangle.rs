//! The triangle of three vertices.

use glam::Vec3;

use super::Aabb;
use crate::vector::{Coordinates, Number, Scalar, Vector};

/// The closed triangle of three vertices. Edge i joins vertex i to vertex i + 1 (modulo 3).
///
/// A triangle with an infinite or NaN vertex is never hit.
///
/// ```
/// use isect::{Triangle, glam::Vec3};
///
/// let triangle = Triangle::new(Vec3::ZERO, Vec3::X, Vec3::Y);
/// assert_eq!((triangle.normal(), triangle.area()), (Vec3::Z, 0.5));
/// assert_eq!(triangle.at(0.25, 0.5), Vec3::new(0.25, 0.5, 0.0));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Default)]
#[repr(C)]
pub struct Triangle<V: Coordinates = Vec3> {
    /// The vertex with barycentric coordinates (1, 0, 0).
    pub v0: V,
    /// The vertex with barycentric coordinates (0, 1, 0), where u = 1.
    pub v1: V,
    /// The vertex with barycentric coordinates (0, 0, 1), where v = 1.
    pub v2: V,
}

impl<V: Vector> Triangle<V> {
    /// The triangle of three vertices.
    #[inline]
    #[must_use]
    pub const fn new(v0: V, v1: V, v2: V) -> Self {
        Self { v0, v1, v2 }
    }

    /// (v1 − v0) × (v2 − v0): twice the area long, not normalised. It points to the side from
    /// which the vertices run counter-clockwise. In `f32` its products underflow where edges are
    /// shorter than about 10⁻¹⁹, and overflow where they are longer than 10¹⁹ (`f64`: 10^±154).
    #[inline]
    #[must_use]
    pub fn normal(&self) -> V {
        (self.v1 - self.v0).cross(self.v2 - self.v0)
    }

    /// The area; 0 or infinite where the area itself under- or overflows, NaN for a NaN vertex.
    #[inline]
    #[must_use]
    pub fn area(&self) -> V::Scalar {
        let (edge1, edge2) = (self.v1 - self.v0, self.v2 - self.v0);
        let [scale1, scale2] = [edge1, edge2].map(V::normalizer);
        let half = V::Scalar::ONE.lit(0.5);
        let area = (edge1 * scale1).cross(edge2 * scale2).length() * half;
        area.times_ratio(V::Scalar::ONE / scale1, scale2)
    }

    /// The smallest box around the vertices, exactly. A NaN component is left out.
    #[inline]
    #[must_use]
    pub fn aabb(&self) -> Aabb<V> {
        Aabb::from_points([self.v0, self.v1, self.v2])
    }

    /// The point (1 − u − v)·v0 + u·v1 + v·v2.
    #[inline]
    #[must_use]
    pub fn at(&self, u: V::Scalar, v: V::Scalar) -> V {
        self.v0 * (V::Scalar::ONE - u - v) + self.v1 * u + self.v2 * v
    }
}

impl<V: Vector> From<[V; 3]> for Triangle<V> {
    #[inline]
    fn from([v0, v1, v2]: [V; 3]) -> Self {
        Self { v0, v1, v2 }
    }
}

impl<V: Vector> From<Triangle<V>> for [V; 3] {
    #[inline]
    fn from(triangle: Triangle<V>) -> Self {
        [triangle.v0, triangle.v1, triangle.v2]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn areas_of_any_exponent() {
        let area = |a: f32, b: f32| Triangle::new(Vec3::ZERO, Vec3::X * a, Vec3::Y * b).area();
        assert_eq!((area(1e-30, 1e-30), area(1e30, 1e30)), (0.0, f32::INFINITY));
        // Each within three roundings.
        for (a, b) in [(1e30, 1e-30), (1e18, 1e19), (1e-18, 1e-19)] {
            let exact = f64::from(a) * f64::from(b) / 2.0;
            assert!((f64::from(area(a, b)) / exact - 1.0).abs() < 3e-7, "{a} {b}");
        }
        assert_eq!(area(1e-45, 1e38), 0.5 * (1e-45 * 1e38));
    }

    #[test]
    fn measures() {
        let triangle = Triangle::from([Vec3::ZERO, Vec3::X * 2.0, Vec3::Y * 4.0]);
        assert_eq!((triangle.normal(), triangle.area()), (Vec3::Z * 8.0, 4.0));
        assert_eq!(triangle.at(0.25, 0.5), Vec3::new(0.5, 2.0, 0.0));
        assert_eq!(triangle.aabb(), Aabb::new(Vec3::ZERO, Vec3::new(2.0, 4.0, 0.0)));
        assert_eq!(<[Vec3; 3]>::from(triangle), [triangle.v0, triangle.v1, triangle.v2]);
    }
}
