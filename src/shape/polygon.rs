//! The convex polygon of up to N vertices.

use core::fmt;

use super::{Aabb, Plane, Triangle};
use crate::vector::{Coordinates, Number, Scalar, Vector};

/// A closed, planar, convex polygon of at most `N` vertices, in order; the array is its own.
///
/// That the vertices lie in a plane (within the rounding of their coordinates) and go round a convex polygon is up to
/// the caller: what takes one promises for such polygons alone. It may be empty, or a segment or a point with
/// vertices that coincide: that is what clipping leaves of a polygon which is just touched.
///
/// ```
/// use isect::{Polygon, glam::Vec3};
///
/// let corners = [Vec3::ZERO, Vec3::X * 2.0, Vec3::new(2.0, 1.0, 0.0), Vec3::Y];
/// let polygon = Polygon::<Vec3, 8>::new(&corners).expect("four are no more than eight");
/// assert_eq!((polygon.vertices().len(), polygon.area()), (4, 2.0));
/// assert_eq!(Polygon::<Vec3, 3>::new(&corners), None);
/// ```
#[derive(Clone, Copy)]
#[repr(C)]
pub struct Polygon<V: Coordinates, const N: usize> {
    /// Those from `len` on mean nothing.
    vertices: [V; N],
    len: usize,
}

/// Of the vertices.
impl<V: Vector, const N: usize> fmt::Debug for Polygon<V, N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Polygon").field(&self.vertices()).finish()
    }
}

/// Of the vertices, in order.
impl<V: Vector, const N: usize> PartialEq for Polygon<V, N> {
    fn eq(&self, other: &Self) -> bool {
        self.vertices() == other.vertices()
    }
}

/// The empty polygon.
impl<V: Vector, const N: usize> Default for Polygon<V, N> {
    fn default() -> Self {
        Self::EMPTY
    }
}

impl<V: Vector, const N: usize> Polygon<V, N> {
    /// The polygon of no vertex.
    pub const EMPTY: Self = Self { vertices: [V::ZERO; N], len: 0 };

    /// The polygon of some vertices; `None` if there are more than `N`.
    #[inline]
    #[must_use]
    pub fn new(vertices: &[V]) -> Option<Self> {
        let mut polygon = Self::EMPTY;
        polygon.vertices.get_mut(..vertices.len())?.copy_from_slice(vertices);
        polygon.len = vertices.len();
        Some(polygon)
    }

    /// The vertices, in order.
    #[inline]
    #[must_use]
    pub fn vertices(&self) -> &[V] {
        &self.vertices[..self.len]
    }

    /// The smallest box around the vertices, exactly; [`Aabb::EMPTY`] if there is none. A NaN component is left out.
    #[inline]
    #[must_use]
    pub fn aabb(&self) -> Aabb<V> {
        Aabb::from_points(self.vertices().iter().copied())
    }

    /// From each vertex to the next, and from the last to the first.
    #[inline]
    pub(crate) fn edges(&self) -> impl Iterator<Item = [V; 2]> + '_ {
        let vertices = self.vertices();
        let next = vertices.iter().cycle().skip(1);
        vertices.iter().zip(next).map(|(&from, &to)| [from, to])
    }

    /// The fan of triangles from the first vertex: triangle i has the vertices 0, i + 1 and i + 2.
    #[inline]
    pub fn triangles(&self) -> impl Iterator<Item = Triangle<V>> + '_ {
        let vertices = self.vertices();
        vertices.windows(2).skip(1).map(|edge| Triangle::new(vertices[0], edge[0], edge[1]))
    }

    /// Σ (vᵢ − v₀) × (vᵢ₊₁ − v₀): twice the area long, not normalised. It points to the side from which the vertices run
    /// counter-clockwise.
    ///
    /// It is the sum of M. E. Newell, taken about the first vertex so that a polygon far from zero does not
    /// cancel: each component is twice the area of the projection across its axis, and it is the mean of what
    /// the vertices span, should they not lie in a plane. In `f32` its products underflow where edges are shorter
    /// than about 10⁻¹⁹, and overflow where they are longer than 10¹⁹ (`f64`: 10^±154).
    #[inline]
    #[must_use]
    pub fn normal(&self) -> V {
        self.triangles().map(|triangle| triangle.normal()).fold(V::ZERO, |sum, normal| sum + normal)
    }

    /// The area; 0 or infinite where the area itself under- or overflows, NaN for a NaN vertex.
    #[inline]
    #[must_use]
    pub fn area(&self) -> V::Scalar {
        let Some(&first) = self.vertices().first() else { return V::Scalar::ZERO };
        let offsets = self.vertices().iter().map(|&vertex| vertex - first);
        let largest = offsets.fold(V::ZERO, |largest, offset| largest.max(offset.abs()));
        let scale = largest.normalizer();
        let unit = |vertex: V| (vertex - first) * scale;
        let scaled = self.triangles().map(|t| unit(t.v1).cross(unit(t.v2)));
        let normal = scaled.fold(V::ZERO, |sum, normal| sum + normal);
        let area = normal.length() * V::Scalar::ONE.lit(0.5);
        area.times_ratio(V::Scalar::ONE / scale, scale)
    }

    /// The plane through the first vertex with [`Self::normal`]. `None` if that is zero as computed, or a value is
    /// not finite.
    #[inline]
    #[must_use]
    pub fn plane(&self) -> Option<Plane<V>> {
        Plane::from_point_normal(*self.vertices().first()?, self.normal())
    }

    /// The parts before and behind a plane, on the side to which its normal points and on the other; each is empty if the
    /// polygon is wholly on the other side, and one that lies in the plane is before it. `None` if a part needs more than `N`
    /// vertices.
    ///
    /// A vertex as close to the plane as rounding, 8u·(|n|·|p| + |offset|) times 1/|n| with u = EPSILON/2, counts as on it. The
    /// parts share the new vertices to the last bit; each of these is off by at most 4u times the largest coordinate.
    ///
    /// ```
    /// use isect::{Plane, Polygon, glam::Vec3};
    ///
    /// let corners = [Vec3::ZERO, Vec3::X * 2.0, Vec3::new(2.0, 1.0, 0.0), Vec3::Y];
    /// let polygon = Polygon::<Vec3, 4>::new(&corners).expect("four are no more than four");
    /// let plane = Plane::from_hesse(Vec3::X, 0.5).expect("the normal is not zero");
    /// let [before, behind] = polygon.split(&plane).expect("four corners each");
    /// assert_eq!((before.area(), behind.area()), (1.5, 0.5));
    /// ```
    #[must_use]
    pub fn split(&self, plane: &Plane<V>) -> Option<[Self; 2]> {
        let scale = plane.normal.normalizer();
        let (normal, offset) = (plane.normal * scale, plane.offset * scale);
        let unit = V::Scalar::EPSILON;
        self.divided(|p| {
            let height = normal.dot(p) - offset;
            let terms = normal.abs().dot(p.abs()) + offset.abs();
            let is_on = height.abs() <= terms * (unit.lit(4.0) * unit);
            if is_on { V::Scalar::ZERO } else { height }
        })
    }

    /// The same polygon seen from behind: its vertices in reverse order.
    #[inline]
    #[must_use]
    pub fn reversed(mut self) -> Self {
        self.vertices[..self.len].reverse();
        self
    }

    /// Appends a vertex; `None` if there is no room.
    #[inline]
    pub(crate) fn push(&mut self, vertex: V) -> Option<()> {
        *self.vertices.get_mut(self.len)? = vertex;
        self.len += 1;
        Some(())
    }

    /// The polygon with another one in the place of each vertex.
    #[inline]
    pub(crate) fn map(mut self, f: impl Fn(V) -> V) -> Self {
        for vertex in &mut self.vertices[..self.len] {
            *vertex = f(*vertex);
        }
        self
    }

    /// The part on which a linear function of the vertices is not negative, and the one on which it is not positive, each
    /// empty if no vertex is truly on its side: I. E. Sutherland, G. W. Hodgman, "Reentrant Polygon Clipping",
    /// Communications of the ACM 17.1, 1974, with both sides kept. `None` if a part needs more than `N` vertices.
    ///
    /// The parts share the new vertices to the last bit: together they are the polygon with these on its edges. Each lies
    /// within 4u times the largest coordinate of the place on the edge where the function, as computed, is zero.
    pub(crate) fn divided(&self, height: impl Fn(V) -> V::Scalar) -> Option<[Self; 2]> {
        let zero = V::Scalar::ZERO;
        let largest = self.vertices().iter().fold(zero, |m, &p| height(p).abs().max(m));
        let scale = largest.normalizer();
        let height = |p: V| height(p) * scale;
        let [above, below] = self.vertices().iter().fold([false; 2], |[above, below], &p| {
            [above || height(p) > zero, below || height(p) < zero]
        });
        if !(above && below) {
            // A polygon in the plane itself is on neither side, and counts as above.
            return Some(if below { [Self::EMPTY, *self] } else { [*self, Self::EMPTY] });
        }
        let mut parts = [Self::EMPTY; 2];
        for [p, q] in self.edges() {
            let (from, to) = (height(p), height(q));
            if from >= zero {
                parts[0].push(p)?;
            }
            if from <= zero {
                parts[1].push(p)?;
            }
            if (from < zero && zero < to) || (to < zero && zero < from) {
                // The same for the edge the other way around, and between its ends.
                let crossing = (p * to - q * from).divided(V::splat(to - from));
                let crossing = crossing.max(p.min(q)).min(p.max(q));
                parts[0].push(crossing)?;
                parts[1].push(crossing)?;
            }
        }
        Some(parts)
    }
}

impl<const N: usize> From<Polygon<glam::Vec3, N>> for Polygon<glam::Vec3A, N> {
    #[inline]
    fn from(polygon: Polygon<glam::Vec3, N>) -> Self {
        Self { vertices: polygon.vertices.map(glam::Vec3A::from), len: polygon.len }
    }
}

impl<const N: usize> From<Polygon<glam::Vec3A, N>> for Polygon<glam::Vec3, N> {
    #[inline]
    fn from(polygon: Polygon<glam::Vec3A, N>) -> Self {
        Self { vertices: polygon.vertices.map(glam::Vec3::from), len: polygon.len }
    }
}

impl<const N: usize> From<Polygon<glam::Vec3, N>> for Polygon<glam::DVec3, N> {
    #[inline]
    fn from(polygon: Polygon<glam::Vec3, N>) -> Self {
        Self { vertices: polygon.vertices.map(|v| v.as_dvec3()), len: polygon.len }
    }
}

impl<const N: usize> From<Polygon<glam::Vec3A, N>> for Polygon<glam::DVec3, N> {
    #[inline]
    fn from(polygon: Polygon<glam::Vec3A, N>) -> Self {
        Self { vertices: polygon.vertices.map(|v| v.as_dvec3()), len: polygon.len }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    fn hexagon(size: f32) -> Polygon<Vec3, 8> {
        let corners = [(2, 0), (4, 0), (6, 2), (6, 4), (4, 6), (0, 6)];
        let corners = corners.map(|(x, y)| Vec3::new(x as f32, y as f32, 1.0) * size);
        Polygon::new(&corners).expect("six are no more than eight")
    }

    #[test]
    fn measures() {
        let polygon = hexagon(1.0);
        // The square less three corners of which the legs are 2 and 6, 2 and 2, 2 and 2.
        assert_eq!((polygon.area(), polygon.normal()), (26.0, Vec3::Z * 52.0));
        assert_eq!(polygon.plane(), Plane::from_hesse(Vec3::Z * 52.0, 52.0));
        assert_eq!(polygon.reversed().normal(), Vec3::NEG_Z * 52.0);
        assert_eq!(polygon.triangles().count(), 4);
        assert_eq!(polygon.triangles().map(|t| t.area()).sum::<f32>(), 26.0);
        assert_eq!(polygon.aabb(), Aabb::new(Vec3::Z, Vec3::new(6.0, 6.0, 1.0)));
        assert_eq!(hexagon(2.0_f32.powi(60)).area(), 26.0 * 2.0_f32.powi(120));
        assert_eq!(hexagon(2.0_f32.powi(-70)).area(), 26.0 * 2.0_f32.powi(-140));
    }

    #[test]
    fn few_vertices_have_no_area() {
        for count in 0..3 {
            let polygon = Polygon::<Vec3, 4>::new(&[Vec3::X, Vec3::Y, Vec3::Z][..count]);
            let polygon = polygon.expect("three are no more than four");
            assert_eq!(
                (polygon.area(), polygon.normal(), polygon.plane()),
                (0.0, Vec3::ZERO, None)
            );
            assert_eq!((polygon.triangles().count(), polygon.vertices().len()), (0, count));
        }
        assert_eq!(Polygon::<Vec3, 4>::default(), Polygon::EMPTY);
        assert!(Polygon::<Vec3, 4>::EMPTY.aabb().is_empty());
    }

    #[test]
    fn a_polygon_is_divided_through_its_vertices_and_edges() {
        let polygon = hexagon(1.0);
        let [above, below] = polygon.divided(|p| p.x - 4.0).expect("there is room");
        assert_eq!(
            above.vertices(),
            [(4, 0), (6, 2), (6, 4), (4, 6)].map(|(x, y)| Vec3::new(x as f32, y as f32, 1.0))
        );
        assert_eq!(above.area() + below.area(), 26.0);
        let [above, below] = polygon.divided(|p| p.y - 3.0).expect("there is room");
        assert_eq!((above.vertices().len(), below.vertices().len()), (5, 5));
        assert_eq!(above.area() + below.area(), 26.0);
        assert_eq!(polygon.divided(|p| p.x), Some([polygon, Polygon::EMPTY]));
        assert_eq!(polygon.divided(|p| p.x - 7.0), Some([Polygon::EMPTY, polygon]));
        assert_eq!(polygon.divided(|_| 0.0), Some([polygon, Polygon::EMPTY]));
        let narrow = Polygon::<Vec3, 3>::new(&[Vec3::ZERO, Vec3::X, Vec3::Y]).expect("three");
        assert_eq!(narrow.divided(|p| p.x - 0.5), None, "four vertices below");
    }
}
