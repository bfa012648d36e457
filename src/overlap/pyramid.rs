//! What can separate a shape from a pyramid: the axes that the culls try, and how far rounding may mislead them.

use crate::shape::Pyramid;
use crate::vector::{Number, Scalar, Vector};

/// A combination N = Σ μᵢ·nᵢ of inward normals of a pyramid with weights μᵢ ≥ 0: no point p of the pyramid has
/// N·(p − apex) < 0, so a shape of which all points have is outside.
///
/// That holds for any weights as they are, and for N as it would be without rounding. By Farkas's lemma some such axis
/// separates every convex shape that does not touch the pyramid; for a polyhedron it is the normal of a side, one
/// across an edge of the pyramid and an edge of the shape, or the normal of a face of the shape, which
/// meets the pyramid in its apex.
#[derive(Clone, Copy)]
pub(super) struct Axis<V: Vector> {
    /// N as computed, of a length of less than 6.
    pub(super) normal: V,
    /// Σ μᵢ·|nᵢ|, component by component.
    pub(super) magnitude: V,
}

impl<V: Vector> Axis<V> {
    /// The normal of a side.
    #[inline(always)]
    pub(super) fn of_side(normal: V) -> Self {
        Self { normal, magnitude: normal.abs() }
    }

    /// The axis across an edge, which is given by its two sides, and a vector. `None` if it points out of the pyramid
    /// whichever way it is turned, or is a side's.
    #[inline(always)]
    pub(super) fn of_edge(sides: [V; 2], across: V) -> Option<Self> {
        let zero = V::Scalar::ZERO;
        let [p, q] = sides.map(|normal| normal.dot(across));
        let turns = (p < zero && zero < q) || (q < zero && zero < p);
        turns.then(|| {
            let scale = p.abs().max(q.abs()).normalizer();
            let [p, q] = [sides[0] * (q.abs() * scale), sides[1] * (p.abs() * scale)];
            Self { normal: p + q, magnitude: p.abs() + q.abs() }
        })
    }

    /// The axis across two vectors, as a combination of three sides. `None` if it is none of them.
    #[inline(always)]
    pub(super) fn of_apex(sides: [V; 3], across: [V; 2]) -> Option<Self> {
        let [a, b] = across.map(|e| V::new(sides[0].dot(e), sides[1].dot(e), sides[2].dot(e)));
        let weights = a.cross(b);
        let is_combination = V::ZERO.all_le(weights) || weights.all_le(V::ZERO);
        is_combination.then(|| {
            let weights = weights.abs() * weights.normalizer();
            let [p, q, r] =
                [sides[0] * weights.x(), sides[1] * weights.y(), sides[2] * weights.z()];
            Self { normal: p + q + r, magnitude: p.abs() + q.abs() + r.abs() }
        })
    }

    /// How far N·w, as computed, may be off for a point w that [`Seen`] found, of which no component is larger
    /// than those of `reach`.
    ///
    /// With u = EPSILON/2: a component of N has at most three roundings (a product, two sums), a term of
    /// N·w four more (the difference that w is, a product, two sums); that is 7u of the magnitudes, and 8u
    /// covers the second order and the rounding of this bound. Components of N and of w are less than 8, so
    /// that what underflows is far less than `MIN_POSITIVE`.
    #[inline(always)]
    pub(super) fn slack(&self, reach: V) -> V::Scalar {
        let unit = V::Scalar::EPSILON;
        self.magnitude.dot(reach) * (unit.lit(4.0) * unit) + V::Scalar::MIN_POSITIVE
    }

    /// Whether N·(p − apex) < 0 for certain.
    #[inline(always)]
    pub(super) fn is_beyond(&self, point: V) -> bool {
        -self.normal.dot(point) > self.slack(point.abs())
    }

    /// Whether N·(p − apex) ≥ 0 for certain.
    #[inline(always)]
    pub(super) fn is_before(&self, point: V) -> bool {
        self.normal.dot(point) > self.slack(point.abs()) // both may be infinite
    }
}

/// Points as seen from an apex, times a power of two that brings the largest finite coordinate to [1, 2): so nothing
/// overflows, and what underflows is small against it.
pub(super) struct Seen<V: Vector, const N: usize> {
    pub(super) points: [V; N],
    /// What lengths are to be multiplied with: first by the one, then by the other.
    pub(super) scale: [V::Scalar; 2],
}

impl<V: Vector, const N: usize> Seen<V, N> {
    #[inline(always)]
    pub(super) fn from(apex: V, points: [V; N]) -> Self {
        let (zero, one) = (V::Scalar::ZERO, V::Scalar::ONE);
        let finite = |v: V| v.map(|x| if x.is_finite() { x.abs() } else { zero }).max_element();
        let largest = |points: &[V; N]| points.iter().fold(zero, |m, &p| finite(p).max(m));
        // The difference of halves does not overflow; of small numbers it may be another.
        let is_large = largest(&points).max(finite(apex)) > V::Scalar::MAX * one.lit(0.25);
        let shrink = if is_large { one.lit(0.5) } else { one };
        let apex = apex * shrink;
        let points = points.map(|p| p * shrink - apex);
        let scale = largest(&points).normalizer();
        Self { points: points.map(|p| p * scale), scale: [shrink, scale] }
    }
}

impl<V: Vector> Pyramid<V> {
    /// The two sides at each edge.
    #[inline(always)]
    pub(super) fn edges(&self) -> [[V; 2]; 4] {
        let [a, b, c, d] = self.normals;
        [[a, b], [b, c], [c, d], [d, a]]
    }

    /// Three sides each, of which every axis of the apex is a combination of one or the other.
    #[inline(always)]
    pub(super) fn fans(&self) -> [[V; 3]; 2] {
        let [a, b, c, d] = self.normals;
        [[a, b, c], [a, c, d]]
    }
}
