//! The filter of [`exact::intersect`](crate::ray::triangle::exact::intersect) in the form that suits many
//! lanes, whether the triangle differs from lane to lane or the ray: around the normal and s × d, as in
//! Möller–Trumbore.
//!
//! Its bound is tighter, component by component, as in a leaf of small triangles far from the ray's origin more lanes would be
//! left open otherwise; a scalar stage costs as much as the pack. With [x y z] = Σ |x_i·y_j·z_k| over the six permutations of
//! (i, j, k), p = |e1| + |e2| and q = |a| + p, where a = v0 − o:
//!
//! * Each monomial of s1, s2 and den carries at most 7 roundings: of two differences, of a product and a sum in the cross
//!   product, of a product and two sums in the dot product; fewer where these are fused. Those of s0 = den − s1 − s2 carry two
//!   more. So with u = EPSILON/2 all are off by at most 9u·([e1 a d] + [e2 a d] + [e1 e2 d]) ≤ 9u·[p q d], and
//!   E = 9.5u·[p q d] leaves enough for terms of second order and the rounding of E itself.
//! * T = a·n carries 8, and |t·d| ≤ q in each component if the point lies in the triangle, so that T − t·den is off by at most
//!   (8 + 7)u·Σ q_k·p_i·p_j, and t = T·(1/den) by (15 + 2)u/|den| times that sum, which is at most a quarter of P²·Q, P and Q
//!   being the sums of the components of p and q. An end of the range is on the side of t on which it seems to be if it is
//!   further off than 6u·P²·Q/|den|.
//! * The components of p, q and d count as at least φ = 2⁻³² (`f64`: 2⁻²⁹⁶), and are below 2³⁷ (2³⁰¹), or the lane stays open.
//!   So no product of three overflows, and where the signs are certain, |den| > 3E ≥ 3·6·9.5u·φ³, a normal number, and so is
//!   1/den. What underflow loses of a determinant, at most η·(3 + 14k) with η = 2⁻¹⁵⁰ (2⁻¹⁰⁷⁵) and k the longest component, is
//!   less than 19u·φ²·k ≤ E by far. For t: with K_p and K_q the largest components, 57u·φ²·K_q ≤ 3E < |den| ≤ 3·K_p²·kd, to
//!   which underflow adds less than E, so that |t| ≤ K_q/kd ≤ K_p²/(12u·φ²). Underflow in t·den then loses at most
//!   η·((3 + 8·K_p)·K_p²/(12u·φ²) + 6·K_q), and (6 − 17/4)u·K_p²·K_q is left over for it: enough if φ³ ≥ η/(4u²), or φ ≥ 2⁻³⁴
//!   (2⁻³²³), the other terms being smaller by far.

use fearless_simd::Simd;

use super::lanes::{Columns, Lanes, splat};
use crate::ray::triangle::{Found, Frame};
use crate::shape::Ray;
use crate::vector::{Coordinates, Number, Scalar, Vector};

/// What the filter finds: where `open` holds, nothing.
pub(super) struct Filtered<N: Number> {
    pub(super) found: Found<N>,
    pub(super) open: N::Mask,
}

/// The least length that counts.
#[inline(always)]
pub(super) fn floor<T: Scalar>() -> T {
    T::FILTER_FLOOR * T::ONE.lit(16.0)
}

/// The length from which on a product of three may overflow.
#[inline(always)]
fn cap<T: Scalar>() -> T {
    T::MAX / T::FILTER_RAISE
}

/// 9.5u·|d|, infinite for a ray that the bound is not for: no sign is above that, so that it is left to the later stages.
#[inline(always)]
pub(super) fn reach<V: Vector>(ray: &Ray<V>) -> V {
    let lengths = Coordinates::abs(ray.direction);
    let usable = lengths.max_element() < cap::<V::Scalar>() && ray.t_min <= ray.t_max;
    let factor = V::Scalar::EPSILON * V::Scalar::ONE.lit(4.75);
    let factor = if usable { factor } else { V::Scalar::INFINITY };
    Coordinates::max(lengths, V::splat(floor())) * factor
}

/// p = |e1| + |e2|
#[inline(always)]
pub(super) fn edge_lengths<V: Coordinates>(edge1: V, edge2: V, floor: V::Scalar) -> V {
    edge1.abs().max(V::splat(floor)) + edge2.abs()
}

/// Which lanes hit in their range, and which the bound leaves open. `reach` is [`reach`], and `edges` are [`edge_lengths`]; the
/// one that is the same in every lane is computed but once, by the caller.
#[inline(always)]
pub(super) fn decide<T, S, const N: usize>(
    simd: S,
    frame: &Frame<Columns<T::Wide<S>>>,
    reach: Columns<T::Wide<S>>,
    edges: Columns<T::Wide<S>>,
    [t_min, t_max]: [T::Wide<S>; 2],
) -> Filtered<T::Wide<S>>
where
    T: Lanes<N>,
    S: Simd,
{
    let Frame { direction, edge1, edge2, offset } = *frame;
    let zero = splat(simd, T::ZERO);

    let size = offset.abs() + edges;
    let bound = edges.fused_dot(size.fused_permanents(reach));
    let (edges, size) = (edges.x + edges.y + edges.z, size.x + size.y + size.z);
    let t_bound = (edges * edges) * (size * splat(simd, T::EPSILON * T::ONE.lit(3.0)));

    let normal = edge1.fused_cross(edge2);
    let moment = offset.fused_cross(direction);
    let den = -direction.fused_dot(normal);
    let inverse = splat(simd, T::ONE) / den;
    let s1 = edge2.fused_dot(moment);
    let s2 = -edge1.fused_dot(moment);
    let s0 = den - s1 - s2;
    let t = offset.fused_dot(normal) * inverse;

    // As in the scalar filter, down to the order of the operands: with any NaN, s0 is one, and both stay.
    let inside = s1.min(s2).min(s0).max(-s1.max(s2).max(s0));
    let within = (t - t_min).min(t_max - t);
    let certain = bound.lt(inside.abs())
        & (t_bound.lt((within * den).abs()) | inside.lt(zero))
        & size.lt(splat(simd, cap::<T>()));
    let hit = zero.lt(inside.min(within));
    let found = Found { hit, t, u: s1 * inverse, v: s2 * inverse, front: zero.lt(den) };
    Filtered { found, open: !certain }
}
