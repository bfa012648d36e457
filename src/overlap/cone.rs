//! What the cone's overlaps share: its own frame, in which its section is the unit disk, and the area of a
//! polygon in that.
//!
//! Lines of sight through a cone's (virtual) apex, or along a cylinder, are the points of its section: with
//! x and y across the axis, z along it and w = radius + slope·z, the map (x, y, z) → (x, y)/w takes all
//! points of a line of sight to one, the cone's sections to the unit disk, and planes to planes. What is
//! covered is an area in that disk. The points stay homogeneous, (x, y, w), so that those of w = 0 have a
//! place: a polygon that reaches beside the apex goes on to infinity.
//!
//! All of it is in `f64`, for all vectors: a narrow cone loses as many digits as it is narrow.

use core::f64::consts::PI;

use glam::{DVec2, DVec3, Vec3Swizzles};

use crate::exact::wide;
use crate::shape::{Aabb, Cone};
use crate::vector::{Number, Scalar, Vector, atan2};

/// Where a cone touches a shape, and how much of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConeHit<T = f32> {
    /// The least t of the range at which the section, a closed disk, shares a point with the shape.
    pub t: T,
    /// The share in [0, 1] of the section that the shape covers: of its lines of sight those that meet the
    /// shape in the range, by their area in the disk.
    pub coverage: T,
}

/// A cone in its own frame, scaled by a power of two.
#[derive(Clone, Copy, Debug)]
pub(super) struct Section {
    /// Where z is 0.
    pub(super) radius: f64,
    /// By how much the radius grows with z.
    pub(super) slope: f64,
    /// The ends of the range of z.
    pub(super) near: f64,
    pub(super) far: f64,
    /// z for a t of 1.
    per_t: f64,
    /// By what lengths have been multiplied.
    pub(super) scale: f64,
    /// By how much rounding may have moved a point, for the radius.
    pub(super) margin: f64,
}

impl Section {
    /// The cone, and points in its frame, scaled so that these and the extent are about 1 at most. `None`
    /// for bad input, and where the range begins behind all of it.
    ///
    /// Let u be EPSILON/2 of `f64`, and |f| the distance of a point from the origin. The difference f has one
    /// rounding, the frame is orthonormal within 4u, a product with it has 3 more: points are off by at
    /// most 12u·|f|, and those that are clipped from them, in at most 4 operations each, by 24u·|f| with
    /// the largest |f|. The radius there is off by 6u·(radius + slope·|f|). The margin is 64u·((1 + slope)·|f| + radius).
    #[inline]
    pub(super) fn new<V: Vector, const N: usize>(
        cone: &Cone<V>,
        points: [V; N],
        extent: V::Scalar,
    ) -> Option<(Self, [DVec3; N])> {
        if !cone.is_valid() || !points.iter().all(|p| p.is_finite()) {
            return None;
        }
        let (origin, extent) = (wide(cone.ray.origin), extent.into());
        let from_origin = points.map(|p| wide(p) - origin);
        let radius: f64 = cone.radius.into();
        let largest = from_origin
            .iter()
            .fold(radius.max(extent), |largest, f| largest.max(f.abs().max_element()));
        let scale = if largest > 0.0 { largest.normalizer() } else { 1.0 };
        let Axis { frame, length, slope } = Axis::new(cone);
        let points = from_origin.map(|f| {
            let f = f * scale;
            DVec3::from(frame.map(|e| e.dot(f)))
        });

        let per_t = length * scale;
        let reach = points.iter().fold(0.0_f64, |reach, p| reach.max(p.length())) + extent * scale;
        let radius = radius * scale;
        let margin = 32.0 * f64::EPSILON * ((1.0 + slope) * reach + radius);
        let [near, far] = [cone.ray.t_min, cone.ray.t_max].map(|t| t.into().max(0.0) * per_t);
        // All is nearer than 16: an infinite range need not be.
        let section = Self { radius, slope, near, far: far.min(16.0), per_t, scale, margin };
        (near <= section.far && per_t < f64::INFINITY).then_some((section, points))
    }

    /// The radius of the section at z.
    #[inline]
    pub(super) fn radius_at(&self, z: f64) -> f64 {
        self.radius + self.slope * z
    }

    /// The cone that is wider and longer by the margin: it touches whatever the exact one does.
    #[inline]
    pub(super) fn inflated(&self) -> Self {
        let Self { radius, slope, near, far, margin, .. } = *self;
        // The margin at the near end too, which comes nearer by as much.
        let radius = radius + margin * (1.0 + slope);
        Self { radius, near: near - margin, far: far + margin, ..*self }
    }

    /// Whether a point is in the cone.
    #[inline]
    pub(super) fn holds(&self, p: DVec3) -> bool {
        let radius = self.radius_at(p.z);
        self.near <= p.z && p.z <= self.far && p.xy().length_squared() <= radius * radius
    }

    /// The hit at z, with the covered area of the disk.
    #[inline]
    pub(super) fn hit<V: Vector>(&self, cone: &Cone<V>, z: f64, area: f64) -> ConeHit<V::Scalar> {
        let share = if area > 0.0 { (area / PI).min(1.0) } else { 0.0 };
        let coverage = V::Scalar::ONE.lit(share);
        ConeHit { t: self.t(cone, z), coverage }
    }

    /// The t at z, in the range.
    #[inline]
    pub(super) fn t<V: Vector>(&self, cone: &Cone<V>, z: f64) -> V::Scalar {
        cone.ray.nearest_in_range((z / self.per_t).max(0.0))
    }

    /// A point, homogeneous in the disk.
    #[inline]
    fn seen(&self, p: DVec3) -> DVec3 {
        DVec3::new(p.x, p.y, self.radius_at(p.z))
    }

    /// The line of sight between two vertices of an outline.
    #[inline]
    fn edge(&self, p: DVec3, q: DVec3) -> Edge {
        Edge::new(self.seen(p), self.seen(q))
    }

    /// Twice the signed area of the part of the unit disk that an outline covers: positive if it runs
    /// counter-clockwise around the axis.
    pub(super) fn double_area(&self, outline: &Outline) -> f64 {
        // A vertex at the apex is not seen anywhere.
        let is_seen = |p: &DVec3| self.seen(*p) != DVec3::ZERO;
        let vertices = || outline.vertices[..outline.len].iter().copied().filter(is_seen);
        let next = vertices().cycle().skip(1);
        vertices().zip(next).map(|(p, q)| self.edge(p, q).double_area()).sum()
    }

    /// Twice the signed area of the disk under the edge along which the near end of the range has cut an
    /// outline, seen from the other side.
    pub(super) fn double_cap(&self, outline: &Outline) -> f64 {
        outline.cap.map_or(0.0, |[p, q]| self.edge(q, p).double_area())
    }

    /// The least z at which the section meets the outline, which lies in a plane.
    ///
    /// The set is convex: the least z is that of an edge within the cone, or, if it is that of none, of the
    /// plane within the cone, which is on the rim, where the plane's normal points to.
    pub(super) fn nearest(&self, outline: &Outline) -> Option<f64> {
        let mut nearest: Option<f64> = None;
        let mut found = |z: f64| nearest = Some(nearest.map_or(z, |nearest| nearest.min(z)));
        for [p, q] in outline.edges() {
            if let Some(s) = self.edge(p, q).within() {
                found(p.z + s[0] * (q.z - p.z));
                found(p.z + s[1] * (q.z - p.z));
            }
        }
        if nearest.is_none() && !self.surrounds(outline, DVec2::ZERO) {
            return None;
        }
        let mut found = |z: f64| nearest = Some(nearest.map_or(z, |nearest| nearest.min(z)));
        let (normal, offset) = (outline.normal, outline.normal.dot(outline.vertices[0]));
        let across = normal.xy().length();
        let rim = if across > 0.0 { normal.xy() / across } else { DVec2::ZERO };
        for (rim, across) in [(rim, across), (-rim, -across)] {
            if self.surrounds(outline, rim) {
                let z = (offset - self.radius * across) / (normal.z + self.slope * across);
                let [least, greatest] = outline.ends();
                found(z.max(least).min(greatest));
            }
        }
        nearest.or_else(|| Some(outline.ends()[0]))
    }

    /// Whether an outline runs around a point of the disk, as seen. An edge that is not near to the point is
    /// on the right side of it: where it crosses the line y, no cancellation harms the sign.
    fn surrounds(&self, outline: &Outline, point: DVec2) -> bool {
        let from_point = |p: DVec3| p.xy() - point * self.radius_at(p.z);
        let mut winding = 0;
        for [p, q] in outline.edges() {
            let (p, q) = (from_point(p), from_point(q));
            if (p.y < 0.0) != (q.y < 0.0) {
                let is_upward = p.y < 0.0;
                if (p.perp_dot(q) > 0.0) == is_upward {
                    winding += if is_upward { 1 } else { -1 };
                }
            }
        }
        winding != 0
    }
}

/// Whether the ball around the box is clear of the cone, for certain: most that are not touched.
///
/// The distance from the cone's side, a straight line in the plane of the axis and the centre, is at most that
/// from the cone. What some tens of roundings do to it is far below the margin.
#[inline]
pub(super) fn is_far<V: Vector>(cone: &Cone<V>, aabb: &Aabb<V>) -> bool {
    let Axis { frame: [.., axis], length, slope } = Axis::new(cone);
    let half = (wide(aabb.max) - wide(aabb.min)) * 0.5;
    let center = wide(aabb.min) + half - wide(cone.ray.origin);
    // Squares of lengths that are far from 1 leave the range of exponents.
    let scale = center.abs().max(half).max_element().max(cone.radius.into()).normalizer();
    let (half, center, radius) = (half * scale, center * scale, cone.radius.into() * scale);
    let z = center.dot(axis);
    let away = (center - axis * z).length() - (radius + slope * z);
    let margin = 1e-12 * ((1.0 + slope) * center.length() + radius);
    let reach = half.length() * (1.0 + 1e-12) + margin;
    let [near, far] = [cone.ray.t_min, cone.ray.t_max].map(|t| t.into() * length * scale);
    away > reach * Number::sqrt(1.0 + slope * slope) || z + reach < near || far < z - reach
}

/// The axis of a cone.
pub(super) struct Axis {
    /// Across it, twice, and along it.
    pub(super) frame: [DVec3; 3],
    /// Of the direction.
    pub(super) length: f64,
    /// The growth of the radius with the distance.
    pub(super) slope: f64,
}

impl Axis {
    /// The frame is that of T. Duff et al., "Building an Orthonormal Basis, Revisited", JCGT 6.1, 2017.
    #[inline]
    pub(super) fn new<V: Vector>(cone: &Cone<V>) -> Self {
        let direction = wide(cone.ray.direction);
        let scale = Vector::normalizer(direction);
        let scaled = direction * scale;
        let length = scaled.length();
        let axis = scaled / length;
        let sign = 1.0_f64.copysign(axis.z);
        let a = -1.0 / (sign + axis.z);
        let b = axis.x * axis.y * a;
        let first = DVec3::new(1.0 + sign * axis.x * axis.x * a, sign * b, -sign * axis.x);
        let second = DVec3::new(b, sign + axis.y * axis.y * a, -axis.y);
        let spread: f64 = cone.spread.into();
        Self {
            frame: [first, second, axis],
            length: length / scale,
            slope: spread * scale / length,
        }
    }
}

/// A convex polygon in a plane, clipped to the range of a cone.
pub(super) struct Outline {
    vertices: [DVec3; 6],
    len: usize,
    /// The edge along which the near end of the range has cut it.
    cap: Option<[DVec3; 2]>,
    /// Of the plane, of any length.
    normal: DVec3,
}

impl Outline {
    /// The part of a triangle or of a parallelogram in the range.
    #[inline]
    pub(super) fn new<const N: usize>(section: &Section, corners: [DVec3; N]) -> Self {
        let vertices = core::array::from_fn(|i| corners[i % N]);
        let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
        let whole = Self { vertices, len: N, cap: None, normal };
        let (nearer, cap) = whole.cut(section.near, 1.0);
        let (both, _) = nearer.cut(section.far, -1.0);
        Self { cap, ..both }
    }

    /// The part on the side `sign` of the section at z, and the edge along which it is cut.
    #[inline]
    fn cut(self, z: f64, sign: f64) -> (Self, Option<[DVec3; 2]>) {
        let keeps = |p: DVec3| sign * (p.z - z) >= 0.0;
        if self.edges().all(|[p, _]| keeps(p)) {
            return (self, None);
        }
        // From the vertex that is kept, so that neighbours find the same point.
        let crossing = |kept: DVec3, lost: DVec3| {
            let share = (z - kept.z) / (lost.z - kept.z);
            (kept + (lost - kept) * share).xy().extend(z)
        };
        let mut result = Self { len: 0, ..self };
        let [mut leaves, mut enters] = [None; 2];
        for [p, q] in self.edges() {
            if keeps(p) {
                result.push(p);
            }
            if keeps(p) && !keeps(q) {
                let vertex = crossing(p, q);
                result.push(vertex);
                leaves = Some(vertex);
            } else if !keeps(p) && keeps(q) {
                let vertex = crossing(q, p);
                result.push(vertex);
                enters = Some(vertex);
            }
        }
        let edge = leaves.zip(enters).map(|(leaves, enters)| [leaves, enters]);
        (result, edge)
    }

    /// A convex polygon gains a vertex with each cut: there is room for all of them.
    #[inline]
    fn push(&mut self, vertex: DVec3) {
        self.vertices[self.len] = vertex;
        self.len += 1;
    }

    #[inline]
    fn edges(&self) -> impl Iterator<Item = [DVec3; 2]> {
        let vertices = &self.vertices[..self.len];
        vertices.iter().zip(vertices.iter().cycle().skip(1)).map(|(&p, &q)| [p, q])
    }

    /// The least and the greatest z.
    fn ends(&self) -> [f64; 2] {
        let vertices = self.vertices[..self.len].iter();
        vertices.fold([f64::INFINITY, f64::NEG_INFINITY], |[least, greatest], p| {
            [least.min(p.z), greatest.max(p.z)]
        })
    }
}

/// An edge as it is seen: from p to q, homogeneous in the unit disk.
struct Edge {
    p: DVec3,
    q: DVec3,
    /// The distance of its line from the centre, positive where that is on its left.
    distance: f64,
    /// How far p and q are along the line, from its point nearest to the centre; homogeneous.
    along: [f64; 2],
    /// p × q
    cross: f64,
}

impl Edge {
    #[inline]
    fn new(p: DVec3, q: DVec3) -> Self {
        let step = q.xy() * p.z - p.xy() * q.z;
        let length = step.length();
        let unit = step / length;
        let cross = p.xy().perp_dot(q.xy());
        Self { p, q, distance: cross / length, along: [p, q].map(|v| v.xy().dot(unit)), cross }
    }

    /// Half of the chord in the disk, if there is one. There is none for points that look the same.
    #[inline]
    fn half_chord(&self) -> Option<f64> {
        let h = self.distance;
        (h.abs() < 1.0).then(|| Number::sqrt((1.0 - h) * (1.0 + h)))
    }

    /// Twice the signed area between the centre and the edge, as far as it is in the disk: of triangles where
    /// the edge is within it, of sectors where it is not. By Green's theorem the sum over all edges is that of the
    /// polygon.
    ///
    /// None of the terms is more than π, and each comes from a few operations, of which an error of u in one moves
    /// an end or turns an angle by a few u: each edge is off by at most 16u, those of five over 2π by 13u.
    #[inline]
    fn double_area(&self) -> f64 {
        let outside = || atan2(self.cross, self.p.xy().dot(self.q.xy()));
        let Some(k) = self.half_chord() else { return outside() };
        // The places on the chord, and the angles from p to its one end and from its other end to q.
        let [a, b] = [(self.along[0], self.p.z), (self.along[1], self.q.z)];
        let on_chord = |(along, w): (f64, f64)| {
            if along <= -k * w {
                -k
            } else if along >= k * w {
                k
            } else {
                along / w
            }
        };
        let (from, to) = (on_chord(a), on_chord(b));
        if from >= to {
            return outside();
        }
        let h = self.distance;
        let beyond = |along: f64, w: f64| atan2(h * (along - k * w), h * h * w + k * along);
        let before = if a.0 < -k * a.1 { beyond(-a.0, a.1) } else { 0.0 };
        let after = if b.0 > k * b.1 { beyond(b.0, b.1) } else { 0.0 };
        before + h * (to - from) + after
    }

    /// The part of the edge that is within the disk, as shares of the way from p to q.
    ///
    /// It is the point nearest to the centre that decides: wherever rounding puts it on the edge, it is a
    /// point of the edge.
    #[inline]
    fn within(&self) -> Option<[f64; 2]> {
        let Self { p, q, along: [a, b], .. } = *self;
        let is_within = |v: DVec3| v.xy().length_squared() <= v.z * v.z;
        let foot = if a < 0.0 && 0.0 < b { a / (a - b) } else { 0.0 };
        let nearest = p + (q - p) * foot;
        let (first, last) = (is_within(p), is_within(q));
        if !first && !last && !is_within(nearest) {
            return None;
        }
        let mut ends = [if first { 0.0 } else { foot }, if last { 1.0 } else { foot }];
        if let Some(k) = self.half_chord() {
            // Where along + s·(b − a) is ∓k·w.
            let at = |k: f64| (k * p.z - a) / ((b - a) - k * (q.z - p.z));
            if !first && a < -k * p.z {
                ends[0] = at(-k);
            }
            if !last && b > k * q.z {
                ends[1] = at(k);
            }
        }
        // An end that has no place on the edge is one of a chord that hardly is.
        let ends = ends.map(|s| if (0.0..=1.0).contains(&s) { s } else { foot });
        Some(ends)
    }
}
