//! The pyramid of the rays from an apex through a convex quadrilateral.

use core::array;

use glam::Vec3;

use crate::vector::{Coordinates, Number, Scalar, Vector};

/// The pyramid of the points p with `normals[i] · (p − apex) >= 0` for all four sides: solid, closed, and
/// without an end away from its apex.
///
/// It is what a pixel, or a part of one, sees of a scene: J. Genetti, D. Gordon, G. Williams, "Adaptive
/// Supersampling in Object Space Using Pyramidal Rays", Computer Graphics Forum 17.1, 1998. The
/// normals as they are stored define it, though they are rounded: what [`crate::overlap`] promises is about
/// these points, and [`Self::split`] loses none of them. A side with a normal of zero bounds nothing. A
/// pyramid with an infinite or NaN apex or normal has no points.
///
/// ```
/// use isect::{Pyramid, glam::Vec3};
///
/// let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
/// let pyramid = Pyramid::new(Vec3::ZERO, corners.map(|(x, y)| Vec3::new(x, y, 2.0))).expect("it is convex");
/// assert!(pyramid.contains(Vec3::new(4.0, 3.0, 8.0)) && !pyramid.contains(Vec3::new(4.5, 3.0, 8.0)));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Pyramid<V: Coordinates = Vec3> {
    /// Where the sides meet.
    pub apex: V,
    /// The directions of the edges, in the order in which `corners[i] × corners[i + 1]` points inward, within the
    /// rounding of the sides: [`Self::split`] goes by them.
    pub corners: [V; 4],
    /// The inward normals of the sides; side i lies between the corners i and i + 1 (modulo 4).
    pub normals: [V; 4],
}

impl<V: Vector> Pyramid<V> {
    /// The pyramid with these edges, given in order, either way around. `None` if a value is not finite, or if
    /// the corners, as computed, do not go round a convex quadrilateral.
    ///
    /// Side i has the normal cᵢ × (cᵢ₊₁ − cᵢ), brought to a length of about 1 by a power of two. The corners
    /// are stored times a power of two, and in reverse order if they came the other way around.
    #[must_use]
    pub fn new(apex: V, corners: [V; 4]) -> Option<Self> {
        let largest = corners.map(|c| Coordinates::abs(c)).into_iter().fold(V::ZERO, V::max);
        let scale = largest.normalizer();
        let mut corners = corners.map(|corner| corner * scale);
        let mut normals = side_normals(&corners);
        // Each side has both corners that are not its own on one side.
        let is_clockwise = normals[0].dot(corners[2]) < V::Scalar::ZERO;
        if is_clockwise {
            corners.reverse();
            normals = side_normals(&corners);
        }
        let is_convex = (0..4).all(|i| {
            let height = |next: usize| normals[i].dot(corners[(i + next) % 4]);
            height(2) > V::Scalar::ZERO && height(3) > V::Scalar::ZERO
        });
        let pyramid = Self { apex, corners, normals };
        (is_convex && pyramid.is_valid()).then_some(pyramid)
    }

    /// The direction halfway between the corners.
    #[inline]
    #[must_use]
    pub fn center(&self) -> V {
        let [a, b, c, d] = self.corners;
        halfway(halfway(a, b), halfway(c, d))
    }

    /// Whether `point` lies in the pyramid as computed: nearer to a side than 4u times the sum of the magnitudes of the terms
    /// of the product nᵢ·(p − apex), u = EPSILON/2, the answer may be wrong. False for a NaN.
    #[inline]
    #[must_use]
    pub fn contains(&self, point: V) -> bool {
        let seen = point - self.apex;
        self.normals.iter().all(|normal| normal.dot(seen) >= V::Scalar::ZERO)
    }

    /// The four pyramids into which the planes through the middles of opposite sides divide this one. Child i has the
    /// corner i.
    ///
    /// Each has two of the parent's sides, to the last bit, and shares the others with its neighbours, with the
    /// opposite normal: **every point of the parent lies in a child**, however the middles are rounded.
    #[must_use]
    pub fn split(&self) -> [Self; 4] {
        let [c0, c1, c2, c3] = self.corners;
        let [n0, n1, n2, n3] = self.normals;
        let [m0, m1, m2, m3] =
            array::from_fn(|i| halfway(self.corners[i], self.corners[(i + 1) % 4]));
        let center = self.center();
        // The one points to side 3, the other to side 0.
        let (a, b) = (side_normal(m0, m2), side_normal(m1, m3));
        let child = |corners, normals| Self { apex: self.apex, corners, normals };
        [
            child([c0, m0, center, m3], [n0, a, b, n3]),
            child([m0, c1, m1, center], [n0, n1, b, -a]),
            child([center, m1, c2, m2], [-b, n1, n2, -a]),
            child([m3, center, m2, c3], [-b, a, n2, n3]),
        ]
    }

    /// Whether apex and normals are finite.
    #[inline]
    pub(crate) fn is_valid(&self) -> bool {
        self.apex.is_finite() && self.normals.iter().all(|normal| normal.is_finite())
    }
}

fn side_normals<V: Vector>(corners: &[V; 4]) -> [V; 4] {
    array::from_fn(|i| side_normal(corners[i], corners[(i + 1) % 4]))
}

/// a × b, of a length of about 1.
#[inline]
fn side_normal<V: Vector>(a: V, b: V) -> V {
    // The corners of a pixel are nearly parallel: their difference is exact, where the products of the two would cancel.
    let normal = a.cross(b - a);
    normal * normal.normalizer()
}

#[inline]
fn halfway<V: Vector>(a: V, b: V) -> V {
    (a + b) * V::Scalar::ONE.lit(0.5)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(size: f32) -> [Vec3; 4] {
        [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
            .map(|(x, y)| Vec3::new(x, y, 2.0) * size)
    }

    #[test]
    fn corners_may_go_either_way_around_and_have_any_length() {
        let expected = Pyramid::new(Vec3::X, square(1.0)).expect("it is convex");
        for (i, normal) in expected.normals.into_iter().enumerate() {
            assert!(normal.dot(Vec3::Z) > 0.0);
            for (j, corner) in expected.corners.into_iter().enumerate() {
                let is_own = j == i || j == (i + 1) % 4;
                assert_eq!(normal.dot(corner) > 0.0, !is_own, "{i} {j}");
            }
        }
        let mut reversed = square(1.0);
        reversed.reverse();
        let reversed = Pyramid::new(Vec3::X, reversed).expect("it is convex");
        for normal in reversed.normals {
            assert!(expected.normals.contains(&normal));
        }
        for size in [2.0_f32.powi(-140), 2.0_f32.powi(-60), 2.0_f32.powi(125)] {
            assert_eq!(
                Pyramid::new(Vec3::X, square(size)).map(|p| p.normals),
                Some(expected.normals)
            );
        }
    }

    #[test]
    fn what_is_not_convex_or_not_finite_is_refused() {
        let [a, b, c, d] = square(1.0);
        assert_eq!(Pyramid::new(Vec3::ZERO, [a, c, b, d]), None, "a bow");
        assert_eq!(Pyramid::new(Vec3::ZERO, [a, b, c, Vec3::new(0.5, -0.5, 2.0)]), None, "a dart");
        assert_eq!(Pyramid::new(Vec3::ZERO, [a, b, c, c]), None, "a triangle");
        assert_eq!(Pyramid::new(Vec3::ZERO, [Vec3::ZERO; 4]), None);
        assert_eq!(Pyramid::new(Vec3::ZERO, [a, b, c, Vec3::NAN]), None);
        assert_eq!(Pyramid::new(Vec3::ZERO, [a, b, c, Vec3::INFINITY]), None);
        assert_eq!(Pyramid::new(Vec3::NAN, [a, b, c, d]), None);
    }

    #[test]
    fn children_share_the_parents_sides_and_each_others() {
        let parent = Pyramid::new(Vec3::ZERO, square(1.0)).expect("it is convex");
        let children = parent.split();
        for (i, child) in children.iter().enumerate() {
            assert_eq!(child.corners[i], parent.corners[i]);
            assert_eq!(child.normals[i], parent.normals[i]);
            assert_eq!(child.normals[(i + 3) % 4], parent.normals[(i + 3) % 4]);
            assert_eq!(child.normals[(i + 1) % 4], -children[(i + 1) % 4].normals[(i + 3) % 4]);
            // It is what its corners alone would give.
            assert_eq!(
                Pyramid::new(Vec3::ZERO, child.corners).map(|p| p.normals),
                Some(child.normals)
            );
        }
        assert_eq!(parent.center(), Vec3::Z * 1.0);
    }
}
