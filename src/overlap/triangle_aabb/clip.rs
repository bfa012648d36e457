//! Triangle against box by clipping.
//!
//! I. E. Sutherland, G. W. Hodgman, "Reentrant Polygon Clipping", Communications of the ACM 17.1,
//! 1974. Each new vertex is computed from the triangle and the box, not from vertices that were
//! themselves computed, so that errors do not add up.

use core::array;

use glam::Vec3;

use crate::shape::{Aabb, Polygon, Triangle};
use crate::vector::{Number, Scalar, Vector};

/// A triangle clipped by 6 planes gains at most one vertex at each.
const CAPACITY: usize = 9;

/// The part of a triangle that lies in a box: a convex polygon of at most 9 vertices, in the order
/// of the triangle's; none if they do not overlap. It may be a segment or a point, with vertices that coincide.
pub type ClippedPolygon<V = Vec3> = Polygon<V, CAPACITY>;

/// Whether the triangle and the box share a point: [`clip`] leaves a vertex.
///
/// **Grade: fast**, as [`clip`].
///
/// ```
/// use isect::{Aabb, Triangle, glam::Vec3, overlap::triangle_aabb::clip};
///
/// let triangle = Triangle::new(Vec3::ZERO, Vec3::X, Vec3::Y);
/// assert!(clip::overlaps(&triangle, &Aabb::new(Vec3::ZERO, Vec3::ONE)));
/// assert!(!clip::overlaps(&triangle, &Aabb::new(Vec3::ONE, Vec3::ONE)));
/// ```
#[inline]
#[must_use]
pub fn overlaps<V: Vector>(triangle: &Triangle<V>, aabb: &Aabb<V>) -> bool {
    !clip(triangle, aabb).vertices().is_empty()
}

/// The part of the triangle that lies in the box.
///
/// The triangle is cut by the box's six planes, one after the other; what lies on a plane stays.
///
/// **Grade: fast.** The vertices lie in the box, exactly, and within 100u·s of the triangle,
/// u = EPSILON/2, s the largest magnitude of a coordinate of the triangle. Where triangle and box are
/// closer than that to touching, the polygon may be empty or not. On a lattice on which the products
/// of three differences are exact (integers up to 64 in f32) it is empty just where they do not touch.
///
/// An empty box, a NaN, an infinite vertex: an empty polygon. Infinite bounds of the box are fine.
///
/// ```
/// use isect::{Aabb, Triangle, glam::Vec3, overlap::triangle_aabb::clip};
///
/// let triangle = Triangle::new(Vec3::ZERO, Vec3::X * 2.0, Vec3::Y * 2.0);
/// let polygon = clip::clip(&triangle, &Aabb::new(Vec3::ZERO, Vec3::new(1.5, 2.0, 0.0)));
/// let expected = [(0.0, 0.0), (1.5, 0.0), (1.5, 0.5), (0.0, 2.0)];
/// assert_eq!(polygon.vertices(), expected.map(|(x, y)| Vec3::new(x, y, 0.0)));
/// ```
#[must_use]
pub fn clip<V: Vector>(triangle: &Triangle<V>, aabb: &Aabb<V>) -> ClippedPolygon<V> {
    let corners: [V; 3] = (*triangle).into();
    if !triangle.aabb().overlaps(aabb) || !corners.iter().all(|v| v.is_finite()) {
        return ClippedPolygon::EMPTY;
    }
    let [a, b, c] = corners.map(|v| v.abs().max_element());
    let largest = a.max(b.max(c));
    if (largest * largest).is_mid_range() {
        return Cutting::new(corners).clipped(aabb);
    }
    // Products of coordinates may over- or underflow: scaled by a power of two, and back. What the
    // scaling rounds of the box is made good at the end.
    let scale = largest.normalizer();
    let scaled = Aabb::new(aabb.min * scale, aabb.max * scale);
    let polygon = Cutting::new(corners.map(|v| v * scale)).clipped(&scaled);
    polygon.map(|vertex| vertex.divided(V::splat(scale)).max(aabb.min).min(aabb.max))
}

/// A plane across an axis that keeps the points on one side of it, and on itself.
#[derive(Clone, Copy)]
struct Plane<T> {
    axis: usize,
    bound: T,
    above: bool,
}

/// What the edge from a vertex to the next lies on.
#[derive(Clone, Copy)]
enum Carrier<T> {
    /// The triangle's edge i.
    Edge(usize),
    /// The triangle's plane and a plane of the box.
    Cut(Plane<T>),
}

/// The polygon while it is being cut.
struct Cutting<V: Vector> {
    triangle: [V; 3],
    vertices: [V; CAPACITY],
    /// For each vertex what carries the edge that leaves it.
    carriers: [Carrier<V::Scalar>; CAPACITY],
    len: usize,
}

impl<V: Vector> Cutting<V> {
    fn new(triangle: [V; 3]) -> Self {
        Self {
            triangle,
            vertices: array::from_fn(|i| triangle[i % 3]),
            carriers: array::from_fn(|i| Carrier::Edge(i % 3)),
            len: 3,
        }
    }

    /// What the six planes of a box leave.
    fn clipped(self, aabb: &Aabb<V>) -> ClippedPolygon<V> {
        let bounds = Aabb::from_points(self.triangle);
        let mut polygon = self;
        for axis in 0..3 {
            let (min, max) = (aabb.min.component(axis), aabb.max.component(axis));
            // A plane that the triangle does not reach leaves all of it.
            if bounds.min.component(axis) < min {
                polygon = polygon.cut(Plane { axis, bound: min, above: true });
            }
            if max < bounds.max.component(axis) {
                polygon = polygon.cut(Plane { axis, bound: max, above: false });
            }
        }
        ClippedPolygon::new(&polygon.vertices[..polygon.len]).unwrap_or_default()
    }

    /// The part on the kept side of a plane.
    fn cut(&self, plane: Plane<V::Scalar>) -> Self {
        let keeps = |p: V| {
            let x = p.component(plane.axis);
            if plane.above { x >= plane.bound } else { x <= plane.bound }
        };
        let mut result = Self { len: 0, ..*self };
        for i in 0..self.len {
            let (from, to) = (self.vertices[i], self.vertices[(i + 1) % self.len]);
            let carrier = self.carriers[i];
            match (keeps(from), keeps(to)) {
                (true, true) => result.push(from, carrier),
                (true, false) => {
                    result.push(from, carrier);
                    result.push(self.crossing(from, to, carrier, plane), Carrier::Cut(plane));
                }
                (false, true) => result.push(self.crossing(from, to, carrier, plane), carrier),
                (false, false) => {}
            }
        }
        result
    }

    fn push(&mut self, vertex: V, carrier: Carrier<V::Scalar>) {
        // A vertex on the plane is kept, so a polygon that rounding has bent a little could cross a
        // plane more than twice. The capacity is that of the exact one, and so is the shape.
        if self.len < CAPACITY {
            self.vertices[self.len] = vertex;
            self.carriers[self.len] = carrier;
            self.len += 1;
        }
    }

    /// Where the edge between two vertices crosses a plane.
    fn crossing(&self, from: V, to: V, carrier: Carrier<V::Scalar>, plane: Plane<V::Scalar>) -> V {
        let crossing = match carrier {
            Carrier::Edge(i) => on_line(self.triangle[i], self.triangle[(i + 1) % 3], plane),
            Carrier::Cut(first) => self.on_two_planes(from, to, first, plane),
        };
        // Between the two vertices, of which one is on each side of the plane.
        let crossing = crossing.max(from.min(to)).min(from.max(to));
        with_component(crossing, plane.axis, plane.bound)
    }

    /// Where the edge between two vertices, which lies on a plane of the box, crosses another.
    ///
    /// The point between the vertices is as close to the triangle as they are, whatever its shape. The
    /// point of the triangle's own plane is exact where coordinates have few bits, but far off for a
    /// needle, whose normal is uncertain: it is taken if it is as good as on the edge.
    fn on_two_planes(
        &self,
        from: V,
        to: V,
        first: Plane<V::Scalar>,
        second: Plane<V::Scalar>,
    ) -> V {
        let between = on_line(from, to, second);
        let [v0, v1, v2] = self.triangle;
        let normal = (v1 - v0).cross(v2 - v0);
        let along = 3 - first.axis - second.axis;
        let partial = |plane: Plane<V::Scalar>| {
            normal.component(plane.axis) * (plane.bound - v0.component(plane.axis))
        };
        let free =
            v0.component(along) - (partial(first) + partial(second)) / normal.component(along);

        let step = to - from;
        let (rise, run) = (step.component(along).abs(), step.component(second.axis).abs());
        let largest = v0.abs().max(v1.abs().max(v2.abs())).max_element();
        let rounding = largest * V::Scalar::EPSILON.lit(8.0) * V::Scalar::EPSILON;
        // The distance along the axis, against that from the edge times √(1 + (rise/run)²).
        if (free - between.component(along)).abs() * run <= rounding * (rise + run) {
            with_component(between, along, free)
        } else {
            between
        }
    }
}

/// The point of the line through p and q on a plane: a quotient of exact numbers, where the
/// coordinates are few bits long.
fn on_line<V: Vector>(p: V, q: V, plane: Plane<V::Scalar>) -> V {
    let dp = plane.bound - p.component(plane.axis);
    let dq = plane.bound - q.component(plane.axis);
    (p * dq - q * dp).divided(V::splat(dq - dp))
}

fn with_component<V: Vector>(v: V, axis: usize, value: V::Scalar) -> V {
    let component = |i: usize| if i == axis { value } else { v.component(i) };
    V::new(component(0), component(1), component(2))
}
