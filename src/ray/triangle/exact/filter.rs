//! The verdict from floats, wherever an error bound lets it be certain.
//!
//! With e1 = v1 − v0, e2 = v0 − v2, a = v0 − o, take the 3 × 4 matrix with the columns e1, e2, a, d.
//! Its four 3 × 3 minors are, up to a common sign, T, s1, s2 and den with t = T/den, u = s1/den,
//! v = s2/den; and s0 = den − s1 − s2 belongs to v0. (The line meets the plane of a triangle inside
//! if s0, s1 and s2 have the same sign: R. J. Segura, F. R. Feito, 1998.) The matrix is transposed
//! once; then each row holds one component of all four vectors, and four lanes compute the four minors.
//!
//! **The bound.** Let u be EPSILON/2, k1, k2, ka and kd the largest magnitudes of a component of each
//! column, and s = k1 + k2. Each of the six monomials of s1, s2 and den carries 7 roundings: of two
//! differences, of two products, and of three sums; T carries 8. So s1, s2 and den are off by at most
//! 7·6u = 42u times the three lengths of their columns, and s0, with two more roundings and k1·k2 ≤ s²/4,
//! by at most 54u·kd·(s·ka + s²/4). All are within
//!
//! E = 56u·kd·s·(ka + s),
//!
//! and what is left of it outweighs terms of second order and the rounding of E itself.
//!
//! * If s0, s1 and s2 are all above E, or all below −E, the line passes through the inside, and den
//!   has their sign. If one is below −E and one above E, it misses. (That holds for degenerate and
//!   coplanar triangles as well: of those that are hit all three are zero.)
//! * In the first case |t|·kd ≤ ka + s, as the point lies in the triangle. So T − t·den is off by at
//!   most 48u·k1·k2·ka + |t|·42u·k1·k2·kd ≤ 22.5u·s²·(ka + s), and t, with its own rounding, by
//!   at most 24u·s²·(ka + s)/|den|. An end of the range is on the side of t on which it seems to be if
//!   it is further off than 56u·s²·(ka + s)/|den|.
//!
//! **Underflow and overflow.** The lengths count as at least φ = 2⁻³⁶ (`f64`: 2⁻³⁰⁰), and from
//! 2³⁷ (2³⁰¹) on as infinite. With that no product of three overflows where E is finite. A product that
//! underflows is off by at most η = 2⁻¹⁵⁰ (2⁻¹⁰⁷⁵): a minor of two columns by 2η, which a third length
//! multiplies, and a determinant, with three more products, by at most η·(3 + 14k), k the longest. E is at
//! least 56u·φ·2φ·3φ, more than 2⁻¹²⁴, and at least 56u·2φ²·k: by far more, for every k, in either type.
//!
//! For t it takes more. If kd is shorter than φ, |t| may be large; but where all three signs are certain,
//! 3E < |den| ≤ 1.5·s²·kd (and what underflow loses, which is less than E), so that kd > 112u·φ·(ka + s)/s and
//! |t| ≤ (ka + s)/kd < s/(112u·φ) ≤ (ka + s)/(112u·φ). With den off by η·(3 + 8s + 6kd), t·den is off by at
//! most η·((3 + 8s)/(112u·φ) + 6)·(ka + s), where 32u·s²·(ka + s) are left over for it; as s ≥ 2φ that is
//! enough if φ³ ≥ 3η/(112u·128u), or φ ≥ 2⁻³⁸ (`f64`: 2⁻³²⁷), the other two terms being smaller by far.
//!
//! Each comparison is written so that a NaN leaves the case undecided; and where a column has a NaN
//! or an infinite component, den is NaN, or s1 and s2 are, or E is infinite.

use super::super::{Found, TriangleHit};
use crate::shape::{Ray, Triangle};
use crate::vector::{Four, Number, Scalar, Vector};

/// The bound does not decide the case.
pub(super) struct Undecided;

/// The verdict if it is certain, with t, u and v within the bounds that `intersect` documents.
#[inline(always)]
pub(super) fn decide<V: Vector>(
    ray: &Ray<V>,
    triangle: &Triangle<V>,
) -> Result<Option<TriangleHit<V::Scalar>>, Undecided> {
    let zero = V::Scalar::ZERO;
    let Triangle { v0, v1, v2 } = *triangle;
    let [x, y, z] = V::transposed([v1 - v0, v0 - v2, v0 - ray.origin, ray.direction]);

    let lengths = x.abs().max(y.abs()).max(z.abs()).max(V::Four::splat(V::Scalar::FILTER_FLOOR));
    let scaled = (lengths * V::Four::splat(V::Scalar::FILTER_RAISE))
        * V::Four::splat(V::Scalar::FILTER_LOWER);
    let [k1, k2, ka, kd] = scaled.to_array();
    let s = k1 + k2;
    let area = s * (ka + s);
    let (bound, t_bound) = (area * kd, area * s);

    // The minors of x and y for neighbouring columns, and for those with one between.
    let near = x * y.rotated() - x.rotated() * y;
    let far = x * y.rotated_twice() - x.rotated_twice() * y;
    let minors = z * near.rotated() - z.rotated() * far + z.rotated_twice() * near;
    let [_, s1, s2, den] = minors.to_array();
    let s0 = den - s1 - s2;
    let [t, u, v, _] = (minors / V::Four::splat(den)).to_array();

    // Positive if the three have the same sign: then their least magnitude.
    let inside = s1.min(s2).min(s0).max(-s1.max(s2).max(s0));
    // How far t is in the range; negative outside.
    let within = (t - ray.t_min).min(ray.t_max - t);
    if !(inside.abs() > bound && ray.t_min <= ray.t_max) {
        return Err(Undecided);
    }
    if !((within * den).abs() > t_bound || inside < zero) {
        return Err(Undecided);
    }
    let hit = inside.min(within) > zero;
    Ok(Found { hit, t, u, v, front: den > zero }.into_option())
}
