//! The filter of [`exact::intersect`](crate::ray::triangle::exact::intersect) in the form that suits many
//! lanes, whether the triangle differs from lane to lane or the ray: around the normal and s × d, as in
//! Möller–Trumbore.
//!
//! Its four volumes have the same monomials as there, with as many roundings each (or fewer, where products
//! and sums are fused), so its bound E = 56u·kd·s·(ka + s) holds. Different is:
//!
//! * t = T·(1/den) has a rounding more: in all within 26u·s²·(ka + s)/|den|, where 56u is kept clear.
//! * 1/den must not overflow. The lengths count as at least 2⁻³² (`f64`: 2⁻²⁹⁶) instead of φ, which is 16 times
//!   as much: where the signs are certain, |den| > 3E ≥ 3·2⁻¹⁹·2⁻⁹⁶, a normal number, and so is 1/den.
//! * s counts as at least that, instead of both of its parts, and lengths from 2³⁷ (2³⁰¹) on are compared with it
//!   instead of becoming infinite.

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

/// 56u, the factor of the bounds.
#[inline(always)]
fn factor<T: Scalar>() -> T {
    let root = T::FILTER_RAISE * T::FILTER_LOWER;
    root * root * root
}

/// The least length that counts.
#[inline(always)]
fn floor<T: Scalar>() -> T {
    T::FILTER_FLOOR * T::ONE.lit(16.0)
}

/// The length from which on a product of three may overflow.
#[inline(always)]
fn cap<T: Scalar>() -> T {
    T::MAX / T::FILTER_RAISE
}

/// 56u·kd, infinite for a ray that the bound is not for: no sign is above that, so that it is left to the later
/// stages.
#[inline(always)]
pub(super) fn scaled_length<V: Vector>(ray: &Ray<V>) -> V::Scalar {
    let kd = Coordinates::abs(ray.direction).max_element();
    let usable = kd < cap::<V::Scalar>() && ray.t_min <= ray.t_max;
    if usable { kd.max(floor()) * factor::<V::Scalar>() } else { V::Scalar::INFINITY }
}

/// k1 + k2
#[inline(always)]
pub(super) fn edge_lengths<V: Coordinates>(edge1: V, edge2: V) -> V::Scalar {
    edge1.abs().max_element() + edge2.abs().max_element()
}

/// Which lanes hit in their range, and which the bound leaves open. `length` is [`scaled_length`], and `edges` are
/// [`edge_lengths`]; the one that is the same in every lane is computed but once, by the caller.
#[inline(always)]
pub(super) fn decide<T, S, const N: usize>(
    simd: S,
    frame: &Frame<Columns<T::Wide<S>>>,
    [length, edges]: [T::Wide<S>; 2],
    [t_min, t_max]: [T::Wide<S>; 2],
) -> Filtered<T::Wide<S>>
where
    T: Lanes<N>,
    S: Simd,
{
    let Frame { direction, edge1, edge2, offset } = *frame;
    let zero = splat(simd, T::ZERO);

    let s = edges.max(splat(simd, floor::<T>()));
    let size = offset.abs().max_element() + s;
    let area = s * size;
    let (bound, t_bound) = (area * length, area * (s * splat(simd, factor::<T>())));

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
