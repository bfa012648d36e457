//! The axis-aligned box and its faces.

use glam::Vec3;

use super::Affine;
use crate::vector::{Coordinates, Number, Scalar, Vector};

/// The closed axis-aligned box of the points p with `min <= p <= max` on every axis.
///
/// It may be flat on some axes. A box with `min > max` on any axis is empty: it contains nothing and
/// is never hit. Infinite bounds make it unbounded on that side. A box with a NaN is never hit.
///
/// ```
/// use isect::{Aabb, glam::Vec3};
///
/// let aabb = Aabb::from_points([Vec3::ZERO, Vec3::new(1.0, 2.0, 0.0)]);
/// assert_eq!((aabb.size(), aabb.longest_axis()), (Vec3::new(1.0, 2.0, 0.0), 1));
/// assert!(!aabb.is_empty() && Aabb::<Vec3>::EMPTY.is_empty());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Aabb<V: Coordinates = Vec3> {
    /// The corner with the least coordinates.
    pub min: V,
    /// The corner with the greatest coordinates.
    pub max: V,
}

/// The empty box.
impl<V: Vector> Default for Aabb<V> {
    fn default() -> Self {
        Self::EMPTY
    }
}

impl<V: Vector> Aabb<V> {
    /// The empty box from +∞ to −∞, which a union leaves out.
    pub const EMPTY: Self = Self { min: V::INFINITY, max: V::NEG_INFINITY };

    /// The box between two corners.
    #[inline]
    #[must_use]
    pub const fn new(min: V, max: V) -> Self {
        Self { min, max }
    }

    /// The smallest box around some points; [`Self::EMPTY`] around none. NaN components are left
    /// out.
    #[inline]
    #[must_use]
    pub fn from_points(points: impl IntoIterator<Item = V>) -> Self {
        points.into_iter().fold(Self::EMPTY, |aabb, point| aabb.including(point))
    }

    /// The box that reaches from `center` by `half_extents` to either side, rounded outward where
    /// a bound is not a float. Negative half extents make an empty box.
    #[inline]
    #[must_use]
    pub fn from_center_half_extents(center: V, half_extents: V) -> Self {
        Self::new(center, center).grown(half_extents)
    }

    /// Whether the box contains no point: `min > max` on some axis, or a NaN.
    #[inline]
    #[must_use]
    pub fn is_empty(&self) -> bool {
        !self.min.all_le(self.max)
    }

    /// The smallest box around this one and a point. A NaN component of the point is left out.
    #[inline]
    #[must_use]
    pub fn including(&self, point: V) -> Self {
        Self {
            min: V::select(point.less(self.min), point, self.min),
            max: V::select(self.max.less(point), point, self.max),
        }
    }

    /// The smallest box around both. (An empty box other than [`Self::EMPTY`] is left out as well.)
    #[inline]
    #[must_use]
    pub fn union(&self, other: &Self) -> Self {
        match (self.is_empty(), other.is_empty()) {
            (true, _) => *other,
            (_, true) => *self,
            _ => Self { min: self.min.min(other.min), max: self.max.max(other.max) },
        }
    }

    /// The box of the points that both contain; empty where they do not overlap.
    #[inline]
    #[must_use]
    pub fn intersection(&self, other: &Self) -> Self {
        if self.is_empty() {
            return *self;
        }
        Self { min: self.min.max(other.min), max: self.max.min(other.max) }
    }

    /// The point half-way between the corners. Meaningless (a NaN, or some point) for an empty or
    /// unbounded box.
    #[inline]
    #[must_use]
    pub fn center(&self) -> V {
        let half = V::Scalar::ONE.lit(0.5);
        self.min * half + self.max * half
    }

    /// The edge lengths; zero for an empty box.
    #[inline]
    #[must_use]
    pub fn size(&self) -> V {
        if self.is_empty() { V::ZERO } else { self.max - self.min }
    }

    /// The area of the six faces, 2·(x·y + y·z + z·x) of the size; zero for an empty box.
    #[inline]
    #[must_use]
    pub fn surface_area(&self) -> V::Scalar {
        let size = self.size();
        let half = size.x() * size.y() + size.y() * size.z() + size.z() * size.x();
        half + half
    }

    /// The axis (0, 1 or 2) of the longest edge, the first of equals.
    #[inline]
    #[must_use]
    pub fn longest_axis(&self) -> usize {
        let size = self.size();
        if size.x() >= size.y() && size.x() >= size.z() {
            0
        } else if size.y() >= size.z() {
            1
        } else {
            2
        }
    }

    /// Whether `point` lies in the box or on its surface. **Grade: exact.** Not for an empty box, or a NaN.
    ///
    /// ```
    /// use isect::{Aabb, glam::Vec3};
    ///
    /// let aabb = Aabb::new(Vec3::ZERO, Vec3::ONE);
    /// assert!(aabb.contains(Vec3::ONE) && !aabb.contains(Vec3::splat(1.0_f32.next_up())));
    /// ```
    #[inline]
    #[must_use]
    pub fn contains(&self, point: V) -> bool {
        self.min.all_le(point) && point.all_le(self.max)
    }

    /// Whether the boxes share a point; touching is enough. **Grade: exact.** An empty box shares none.
    ///
    /// ```
    /// use isect::{Aabb, glam::Vec3};
    ///
    /// let from = |x: f32| Aabb::new(Vec3::splat(x), Vec3::splat(x + 1.0));
    /// assert!(from(0.0).overlaps(&from(1.0)) && !from(0.0).overlaps(&from(1.5)));
    /// ```
    #[inline]
    #[must_use]
    pub fn overlaps(&self, other: &Self) -> bool {
        self.min.all_le(other.max)
            && other.min.all_le(self.max)
            && !self.is_empty()
            && !other.is_empty()
    }

    /// The box with every face moved outward by `amount`, rounded outward where a bound is not a
    /// float. A negative amount shrinks it, to an empty box in the end. An empty box stays as it is.
    #[inline]
    #[must_use]
    pub fn inflated(&self, amount: V::Scalar) -> Self {
        if self.is_empty() { *self } else { self.grown(V::splat(amount)) }
    }

    /// The eight corners; bit 0, 1 or 2 of the index chooses `max` over `min` on axis x, y or z.
    #[inline]
    #[must_use]
    pub fn corners(&self) -> [V; 8] {
        core::array::from_fn(|i| {
            let corner = |bit: usize| {
                if i >> bit & 1 == 0 { self.min } else { self.max }
            };
            V::new(corner(0).x(), corner(1).y(), corner(2).z())
        })
    }

    /// A box around the image of this one under an affine map, rounded outward: the exact image of
    /// every point of the box lies in it. Empty if the box is. A NaN in the map, or an infinity that
    /// meets its opposite, leaves that side unbounded.
    #[must_use]
    pub fn transformed(&self, affine: &impl Affine<V>) -> Self {
        if self.is_empty() {
            return Self::EMPTY;
        }
        let columns = affine.columns();
        // The least coordinate of the image; of the mirrored image, which gives the greatest.
        let least = |row: usize, sign: V::Scalar| {
            let shift = sign * columns[3].component(row);
            let (mut sum, mut magnitude) = (V::Scalar::ZERO, shift.abs());
            for (axis, column) in columns[..3].iter().enumerate() {
                let factor = sign * column.component(row);
                if factor == V::Scalar::ZERO {
                    continue; // 0 times an infinite bound is 0 here, not NaN
                }
                let bounds = (self.min.component(axis), self.max.component(axis));
                let term = (factor * bounds.0).min(factor * bounds.1);
                sum = sum + term;
                magnitude = magnitude + term.abs();
            }
            // Each term passes through at most four roundings: a relative error of the sum of
            // magnitudes below 4u/(1 − 4u), u = EPSILON/2, and by no more is that sum too short.
            // 2.5·EPSILON covers both; three underflows cost less than MIN_POSITIVE.
            let error = magnitude * V::Scalar::EPSILON.lit(2.5) * V::Scalar::EPSILON
                + V::Scalar::MIN_POSITIVE;
            let bound = (sum + shift).add_down(-error);
            if bound.is_finite() { bound } else { -V::Scalar::INFINITY }
        };
        let one = V::Scalar::ONE;
        let image = |sign| V::new(least(0, sign), least(1, sign), least(2, sign));
        Self { min: image(one), max: -image(-one) }
    }

    /// Moves the faces outward by the components of `amount`, rounded outward.
    #[inline]
    fn grown(&self, amount: V) -> Self {
        let bounds = |axis: usize| {
            let amount = amount.component(axis);
            (self.min.component(axis).add_down(-amount), self.max.component(axis).add_up(amount))
        };
        let [(x0, x1), (y0, y1), (z0, z1)] = [bounds(0), bounds(1), bounds(2)];
        Self { min: V::new(x0, y0, z0), max: V::new(x1, y1, z1) }
    }
}

/// One of the six faces of an [`Aabb`], named after its outward normal.
///
/// Where a ray enters or leaves through an edge or a corner, the face of the first such axis (x,
/// then y, then z) is reported.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[repr(u8)]
pub enum Face {
    /// x = min.x
    NegX,
    /// x = max.x
    PosX,
    /// y = min.y
    NegY,
    /// y = max.y
    PosY,
    /// z = min.z
    NegZ,
    /// z = max.z
    PosZ,
}

impl Face {
    /// The axis of the normal: 0, 1 or 2.
    #[inline]
    #[must_use]
    pub const fn axis(self) -> usize {
        self as usize / 2
    }

    /// The sign of the normal along its axis: −1 or 1.
    #[inline]
    #[must_use]
    pub const fn sign(self) -> i8 {
        if self as u8 & 1 == 0 { -1 } else { 1 }
    }

    /// The outward unit normal.
    #[inline]
    #[must_use]
    pub fn normal<V: Vector>(self) -> V {
        let zero = V::Scalar::ZERO;
        let sign = zero.lit(self.sign().into());
        match self.axis() {
            0 => V::new(sign, zero, zero),
            1 => V::new(zero, sign, zero),
            _ => V::new(zero, zero, sign),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{Affine3A, Vec3A};

    #[test]
    fn an_empty_box_is_left_out_and_overlaps_nothing() {
        let unit = Aabb::new(Vec3::ZERO, Vec3::ONE);
        let inverted = Aabb::new(Vec3::ONE, Vec3::ZERO);
        for empty in [Aabb::EMPTY, inverted, Aabb::default()] {
            assert!(empty.is_empty() && !empty.overlaps(&unit) && !unit.overlaps(&empty));
            assert_eq!((empty.union(&unit), unit.union(&empty)), (unit, unit));
            assert!(empty.intersection(&unit).is_empty() && unit.intersection(&empty).is_empty());
            assert!(
                empty.inflated(2.0).is_empty() && empty.transformed(&Affine3A::IDENTITY).is_empty()
            );
            assert_eq!((empty.size(), empty.surface_area()), (Vec3::ZERO, 0.0));
            assert!(!empty.contains(Vec3::splat(0.5)));
        }
    }

    #[test]
    fn measures() {
        let aabb = Aabb::new(Vec3::new(0.0, -1.0, 2.0), Vec3::new(1.0, 1.0, 5.0));
        assert_eq!(aabb.size(), Vec3::new(1.0, 2.0, 3.0));
        assert_eq!(aabb.surface_area(), 22.0);
        assert_eq!(aabb.center(), Vec3::new(0.5, 0.0, 3.5));
        assert_eq!(aabb.longest_axis(), 2);
        assert_eq!(Aabb::<Vec3A>::new(Vec3A::ZERO, Vec3A::ONE).longest_axis(), 0);
        assert_eq!(
            Aabb::from_center_half_extents(Vec3::ONE, Vec3::splat(0.5)).min,
            Vec3::splat(0.5)
        );
        assert_eq!(Aabb::from_points(aabb.corners()), aabb);
        assert_eq!(aabb.corners()[0b110], Vec3::new(0.0, 1.0, 5.0));
        assert!(aabb.contains(aabb.min) && aabb.contains(aabb.max));
        assert!(aabb.overlaps(&Aabb::new(aabb.max, aabb.max)), "touching");
    }

    #[test]
    fn a_nan_is_left_out() {
        let nan = Vec3::new(f32::NAN, 2.0, f32::NAN);
        let aabb = Aabb::new(Vec3::ZERO, Vec3::ONE).including(nan);
        assert_eq!(aabb, Aabb::new(Vec3::ZERO, Vec3::new(1.0, 2.0, 1.0)));
        assert!(Aabb::new(nan, nan).is_empty());
    }

    #[test]
    fn an_unbounded_box_can_be_transformed() {
        let half_space =
            Aabb::new(Vec3::new(1.0, f32::NEG_INFINITY, f32::NEG_INFINITY), Vec3::INFINITY);
        let map = Affine3A::from_scale(Vec3::new(-2.0, 1.0, 1.0));
        let image = half_space.transformed(&map);
        assert!(image.contains(Vec3::new(-2.0, 1e30, -1e30)) && image.max.x < -1.999);
        assert_eq!(image.min, Vec3::NEG_INFINITY);
    }

    #[test]
    fn faces_know_their_normals() {
        let faces = [Face::NegX, Face::PosX, Face::NegY, Face::PosY, Face::NegZ, Face::PosZ];
        for (i, face) in faces.into_iter().enumerate() {
            assert_eq!((face.axis(), face.sign()), (i / 2, if i % 2 == 0 { -1 } else { 1 }));
            let normal: Vec3 = face.normal();
            assert_eq!(normal[face.axis()], f32::from(face.sign()));
            assert_eq!(normal.abs().element_sum(), 1.0);
        }
    }
}
