//! The last stage: integers, for every finite input.

use core::cmp::Ordering;

use super::Verdict;
use crate::exact::grid::{Grid, Parts};
use crate::exact::integer::{
    Capacity, Integer, Large, Narrow, Small, cross, cross_component, dot, first_nonzero, sub,
};
use crate::exact::interval::{Interval, Parameter};
use crate::exact::wide;
use crate::shape::{Ray, Triangle};
use crate::vector::Vector;

/// A valid ray and a finite triangle.
pub(super) struct Problem {
    origin: [f64; 3],
    direction: [f64; 3],
    t_min: f64,
    t_max: f64,
    vertices: [[f64; 3]; 3],
    points: Grid,
    directions: Grid,
}

impl Problem {
    /// `None` for a ray that has no point, and for a vertex that is not finite.
    pub(super) fn new<V: Vector>(ray: &Ray<V>, triangle: &Triangle<V>) -> Option<Self> {
        if !(super::super::is_valid(ray, triangle) && ray.has_range()) {
            return None;
        }
        let (origin, direction) = (wide(ray.origin).to_array(), wide(ray.direction).to_array());
        let vertices = [triangle.v0, triangle.v1, triangle.v2].map(|v| wide(v).to_array());
        let points = Grid::through(&origin).joined(Grid::through(vertices.as_flattened()));
        let directions = Grid::through(&direction);
        let (t_min, t_max) = (ray.t_min.into(), ray.t_max.into());
        Some(Self { origin, direction, t_min, t_max, vertices, points, directions })
    }

    /// The most bits that a verdict takes (see [`crate::exact::integer`]).
    #[inline]
    fn bits(&self) -> u32 {
        let (p, d) = (self.points.bits(), self.directions.bits());
        (3 * p + d + 6).max(2 * p + d + 60)
    }

    #[inline]
    pub(super) fn classify(&self) -> Verdict {
        match Capacity::of(self.bits()) {
            Capacity::Narrow => Case::<Narrow>::new(self).classify(),
            Capacity::Small => Case::<Small>::new(self).classify(),
            Capacity::Large => self.classify_large(),
        }
    }

    #[cold]
    #[inline(never)]
    fn classify_large(&self) -> Verdict {
        Case::<Large>::new(self).classify()
    }

    /// Whether, and which way, the moved ray crosses the triangle.
    pub(super) fn crosses(&self) -> Option<bool> {
        match Capacity::of(self.bits()) {
            Capacity::Narrow => Case::<Narrow>::new(self).crosses(),
            Capacity::Small => Case::<Small>::new(self).crosses(),
            Capacity::Large => Case::<Large>::new(self).crosses(),
        }
    }

    /// The first point that ray and triangle share.
    pub(super) fn locate(&self) -> Option<Location> {
        // In the plane, the range may begin at a point of which the weights are sought.
        let t = if self.t_min.is_finite() { Parts::new(self.t_min).reduced() } else { ZERO };
        let shift = t.exponent - self.unit();
        let (p, d) = (self.points.bits(), self.directions.bits());
        let weights = (2 * p + shift.min(0).unsigned_abs()).max(p + d + 53 + shift.max(0) as u32);
        match Capacity::of(self.bits().max(weights + 6)) {
            Capacity::Narrow => Case::<Narrow>::new(self).locate(),
            Capacity::Small => Case::<Small>::new(self).locate(),
            Capacity::Large => Case::<Large>::new(self).locate(),
        }
    }

    /// t counts in units of two to this power.
    #[inline]
    fn unit(&self) -> i32 {
        self.points.exponent() - self.directions.exponent()
    }
}

const ZERO: Parts = Parts { negative: false, mantissa: 0, exponent: 0 };

/// A point of a ray and a triangle.
pub(super) struct Location {
    pub(super) t: f64,
    pub(super) u: f64,
    pub(super) v: f64,
    pub(super) front: bool,
}

/// The problem in integers: points as seen from the origin on one grid, the direction on another.
struct Case<'a, I: Integer> {
    problem: &'a Problem,
    direction: [I; 3],
    /// The vertices.
    a: [[I; 3]; 3],
    /// v1 − v0
    edge1: [I; 3],
    /// v2 − v0
    edge2: [I; 3],
}

/// Where the line goes through the triangle's plane.
struct Volumes<I: Integer> {
    normal: [I; 3],
    /// s_i, by the vertex across from the edge.
    s: [I; 3],
    /// Σ s = d·n
    sum: I,
}

/// How a ray and a triangle touch.
enum Touch<I: Integer> {
    /// In one point, off the ray's direction.
    Crossing { volumes: Volumes<I>, t: Parameter<I> },
    /// In the triangle's plane, first at t.
    InPlane { normal: [I; 3], t: Parameter<I> },
    /// The triangle is a segment or a point, touched at t.
    Degenerate { place: Place<I>, t: Parameter<I> },
    /// The same, with all vertices on the ray's line, touched first at t.
    Along { is_point: bool, t: Parameter<I> },
}

impl<'a, I: Integer> Case<'a, I> {
    #[inline]
    fn new(problem: &'a Problem) -> Self {
        let Problem { points, directions, .. } = problem;
        let origin = points.vector(problem.origin);
        let [v0, v1, v2] = problem.vertices.map(|v| points.vector::<I>(v));
        let a = [sub(&v0, &origin), sub(&v1, &origin), sub(&v2, &origin)];
        let (edge1, edge2) = (sub(&v1, &v0), sub(&v2, &v0));
        Self { problem, direction: directions.vector(problem.direction), a, edge1, edge2 }
    }

    #[inline]
    fn range(&self) -> Interval<I> {
        Interval::new(self.problem.t_min, self.problem.t_max, self.problem.unit())
    }

    /// `None` where the line passes the triangle by.
    #[inline]
    fn volumes(&self) -> Option<Volumes<I>> {
        let moment = cross(&self.a[0], &self.direction);
        let s1 = dot(&self.edge2, &moment);
        let s2 = dot(&self.edge1, &moment).neg();
        if s1.sign() == s2.sign().reverse() && !s1.is_zero() {
            return None;
        }
        let normal = cross(&self.edge1, &self.edge2);
        let sum = dot(&normal, &self.direction);
        let s0 = sum.sub(&s1).sub(&s2);
        let opposite = |s: &I| !s.is_zero() && s.sign() == s0.sign().reverse();
        if opposite(&s1) || opposite(&s2) {
            return None;
        }
        Some(Volumes { normal, s: [s0, s1, s2], sum })
    }

    /// The t at which the line goes through the plane.
    #[inline]
    fn plane_t(&self, volumes: &Volumes<I>) -> Parameter<I> {
        Parameter::fraction(dot(&self.a[0], &volumes.normal), volumes.sum.clone())
    }

    #[inline]
    fn touch(&self) -> Option<Touch<I>> {
        let volumes = self.volumes()?;
        if volumes.sum.is_zero() {
            return self.touch_in_plane(volumes.normal);
        }
        let t = self.plane_t(&volumes);
        self.range().contains(&t).then_some(Touch::Crossing { volumes, t })
    }

    /// The line is parallel to the triangle's plane, or the triangle has none.
    #[cold]
    fn touch_in_plane(&self, normal: [I; 3]) -> Option<Touch<I>> {
        let Some(axis) = first_nonzero(&normal) else {
            return self.touch_segment();
        };
        if !dot(&self.a[0], &normal).is_zero() {
            return None;
        }
        let mut range = self.range();
        for i in 0..3 {
            let (at_zero, slope) = self.weight_in_plane(i, axis);
            if normal[axis].sign() == Ordering::Less {
                range.clip(&at_zero.neg(), &slope.neg());
            } else {
                range.clip(&at_zero, &slope);
            }
        }
        (!range.is_empty()).then_some(Touch::InPlane { normal, t: range.enter })
    }

    /// The weight of vertex i at a t of a line in the plane, times the normal's component on the axis:
    /// its value at 0 and its slope.
    fn weight_in_plane(&self, i: usize, axis: usize) -> (I, I) {
        let (p, q) = (&self.a[(i + 1) % 3], &self.a[(i + 2) % 3]);
        (cross_component(p, q, axis), cross_component(&sub(q, p), &self.direction, axis))
    }

    /// The triangle is the segment between two of its vertices, or a point.
    fn touch_segment(&self) -> Option<Touch<I>> {
        let a0 = &self.a[0];
        let edge = if first_nonzero(&self.edge1).is_some() { &self.edge1 } else { &self.edge2 };
        let across = cross(edge, &self.direction);
        let Some(axis) = first_nonzero(&across) else {
            return self.touch_on_line();
        };
        if !dot(a0, &across).is_zero() {
            return None;
        }
        // o + t·d = v0 + s·e, times e.
        let t = Parameter::fraction(cross_component(edge, a0, axis), across[axis].clone());
        // How far each vertex lies from the line, in the plane of segment and ray.
        let sides = self.a.each_ref().map(|a| cross_component(a, &self.direction, axis));
        let place = Place::between(&sides)?;
        self.range().contains(&t).then_some(Touch::Degenerate { place, t })
    }

    /// The vertices lie on a line in the ray's direction.
    fn touch_on_line(&self) -> Option<Touch<I>> {
        if first_nonzero(&cross(&self.a[0], &self.direction)).is_some() {
            return None;
        }
        let axis = first_nonzero(&self.direction)?;
        let slope = &self.direction[axis];
        let [x0, x1, x2] = self.a.each_ref().map(|a| &a[axis]);
        let is_less = |x: &I, y: &I| x.cmp(y) == Ordering::Less;
        let low = [x1, x2].into_iter().fold(x0, |low, x| if is_less(x, low) { x } else { low });
        let high = [x1, x2].into_iter().fold(x0, |high, x| if is_less(high, x) { x } else { high });
        let mut range = self.range();
        range.clip(&low.neg(), slope);
        range.clip(high, &slope.neg());
        if range.is_empty() {
            return None;
        }
        let is_point = low.cmp(high) == Ordering::Equal;
        Some(Touch::Along { is_point, t: range.enter })
    }

    /// A positive multiple of `at_zero + t · slope`, the same for all functions at one t.
    fn at(&self, t: &Parameter<I>, at_zero: &I, slope: &I) -> I {
        match t {
            Parameter::Fraction { num, den } => at_zero.mul(den).add(&slope.mul(num)),
            Parameter::Float(t) => {
                let Parts { negative, mantissa, exponent } = Parts::new(*t).reduced();
                if mantissa == 0 {
                    return at_zero.clone();
                }
                let shift = exponent - self.problem.unit();
                let step = slope.mul(&I::from_limb(mantissa, negative));
                if shift >= 0 {
                    at_zero.add(&step.shl(shift.unsigned_abs()))
                } else {
                    at_zero.shl(shift.unsigned_abs()).add(&step)
                }
            }
        }
    }

    fn classify(&self) -> Verdict {
        match self.touch() {
            None => Verdict::Miss,
            Some(Touch::InPlane { .. } | Touch::Along { is_point: false, .. }) => Verdict::Coplanar,
            Some(Touch::Along { .. }) => Verdict::Vertex(0),
            Some(Touch::Degenerate { place, .. }) => place.verdict,
            Some(Touch::Crossing { volumes, .. }) => match volumes.s.each_ref().map(I::is_zero) {
                [false, false, false] => Verdict::Interior,
                [true, false, false] => Verdict::Edge(1),
                [false, true, false] => Verdict::Edge(2),
                [false, false, true] => Verdict::Edge(0),
                [_, true, true] => Verdict::Vertex(0),
                [true, _, true] => Verdict::Vertex(1),
                [true, true, _] => Verdict::Vertex(2),
            },
        }
    }

    fn locate(&self) -> Option<Location> {
        let (t, weights, front) = match self.touch()? {
            Touch::Crossing { volumes, t } => (t, volumes.s, volumes.sum.sign() == Ordering::Less),
            Touch::InPlane { normal, t } => {
                let axis = first_nonzero(&normal)?;
                let weights = [0, 1, 2].map(|i| {
                    let (at_zero, slope) = self.weight_in_plane(i, axis);
                    self.at(&t, &at_zero, &slope)
                });
                (t, weights, false)
            }
            Touch::Degenerate { place, t } => (t, place.weights, false),
            Touch::Along { t, .. } => {
                let axis = first_nonzero(&self.direction)?;
                let back = self.direction[axis].neg();
                let vertices = self.a.each_ref().map(|a| self.at(&t, &a[axis], &back));
                (t, Place::between(&vertices)?.weights, false)
            }
        };
        let [w, u, v] = &weights;
        let sum = w.add(u).add(v);
        let t = t.to_float(self.problem.unit());
        Some(Location { t, u: u.quotient(&sum, 0), v: v.quotient(&sum, 0), front })
    }

    /// The ray moved by δ = (ε, ε², ε³), ε > 0 and as small as need be: any number that is not zero keeps
    /// its sign, and in place of a zero stands the first component of its derivative that is none.
    ///
    /// With p and q moved by −δ as seen from the origin, det(p, q, d) becomes det(p, q, d) − δ·(e × d),
    /// e = q − p. That derivative vanishes only if the edge is parallel to d, and then so is the triangle.
    fn crosses(&self) -> Option<bool> {
        let volumes = self.volumes()?;
        let orientation = volumes.sum.sign();
        if orientation == Ordering::Equal {
            // The moved line is parallel to the triangle too, and passes it by.
            return None;
        }
        for (i, s) in volumes.s.iter().enumerate() {
            let moved = || {
                let edge = sub(&self.a[(i + 2) % 3], &self.a[(i + 1) % 3]);
                first_sign(&cross(&edge, &self.direction)).reverse()
            };
            if s.sign().then_with(moved) != orientation {
                return None;
            }
        }
        // t = (a·n)/(d·n) becomes t − δ·n/(d·n), which is at no end of the range.
        let normal = first_sign(&volumes.normal);
        let moved = if orientation == Ordering::Greater { normal.reverse() } else { normal };
        let (t, range, unit) = (self.plane_t(&volumes), self.range(), self.problem.unit());
        let is_inside = t.cmp(&range.enter, unit).then(moved) == Ordering::Greater
            && t.cmp(&range.exit, unit).then(moved) == Ordering::Less;
        is_inside.then_some(orientation == Ordering::Less)
    }
}

/// The sign of the first component that is not zero.
fn first_sign<I: Integer>(v: &[I; 3]) -> Ordering {
    let [x, y, z] = v.each_ref().map(I::sign);
    x.then(y).then(z)
}

const INDEX: [u8; 3] = [0, 1, 2];

/// A point of a triangle that is a segment or a point.
struct Place<I: Integer> {
    verdict: Verdict,
    /// Those of the vertices, up to a factor.
    weights: [I; 3],
}

impl<I: Integer> Place<I> {
    /// Where zero lies among the vertices, which are given by their distances along the segment.
    fn between(vertices: &[I; 3]) -> Option<Self> {
        let mut weights = [I::ZERO; 3];
        if let Some(i) = vertices.iter().position(I::is_zero) {
            weights[i] = I::from_limb(1, false);
            return Some(Self { verdict: Verdict::Vertex(INDEX[i]), weights });
        }
        let signs = vertices.each_ref().map(I::sign);
        let i = (0..3).find(|&i| signs[i] != signs[(i + 1) % 3])?;
        let next = (i + 1) % 3;
        weights[i] = vertices[next].abs();
        weights[next] = vertices[i].abs();
        Some(Self { verdict: Verdict::Edge(INDEX[i]), weights })
    }
}
