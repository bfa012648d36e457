//! The arithmetic that decides a sign exactly.
//!
//! An exact kernel works in stages: floats with an error bound, which settle almost every case, and
//! where the bound does not rule a wrong sign out, integers, which settle the rest.
//!
//! Every finite float is an integer times a power of two. The points of a case are counted on one
//! [`grid`], its direction on another; what decides is the sign of a polynomial of these
//! [`integer`]s, of a degree of four at the most, with no division and no root. Numbers of t are compared
//! as fractions, in an [`interval`].
//!
//! Integers and not floating-point expansions (Shewchuk 1997): the products of an expansion underflow
//! and overflow, from 2⁻¹⁰²² on or, with their rounding errors, long before, and the verdict would
//! be exact for moderate exponents only. Integers of a fixed capacity hold every finite input; for
//! ordinary exponents they are a few limbs long, on the stack, and as quick.

pub(crate) mod grid;
pub(crate) mod integer;
pub(crate) mod interval;

use glam::DVec3;

use crate::vector::{Number, Scalar, Vector, two_sum};

/// The same vector in `f64`, exactly.
#[inline]
pub(crate) fn wide<V: Vector>(v: V) -> DVec3 {
    DVec3::new(v.x().into(), v.y().into(), v.z().into())
}

/// a·b − c·d with the exact sign, unless a product comes close to the ends of the exponent range.
///
/// Where the rounded products differ, so do the exact ones, in the same direction. Where they are
/// equal, the exact difference is that of their rounding errors.
///
/// The result for (c, d, a, b) is exactly the negative.
#[inline]
pub(crate) fn difference_of_products<T: Scalar>(a: T, b: T, c: T, d: T) -> T {
    let (ab, ab_error) = a.two_product(b);
    let (cd, cd_error) = c.two_product(d);
    if ab == cd { ab_error - cd_error } else { ab - cd }
}

/// A number with the exact sign of a·b: of the dot product of the floats as they are, unless components
/// are smaller than the largest by the whole range of exponents.
#[inline]
pub(crate) fn dot_sign<V: Vector>(a: V, b: V) -> V::Scalar {
    let dot = a.dot(b);
    // Three roundings, u = EPSILON/2 each: 3u of the products' magnitudes, which are rounded too.
    let bound = a.abs().dot(b.abs()) * (V::Scalar::EPSILON + V::Scalar::EPSILON);
    if dot.abs() > bound && bound.is_mid_range() { dot } else { expanded_dot(a, b) }
}

/// The largest term of the dot product as an expansion: a sum of floats that do not overlap, of which the
/// largest that is not zero has the sign of the whole (J. R. Shewchuk, "Adaptive Precision
/// Floating-Point Arithmetic and Fast Robust Geometric Predicates", 1997, GROW-EXPANSION).
#[cold]
fn expanded_dot<V: Vector>(a: V, b: V) -> V::Scalar {
    // By powers of two to a length at which the errors of products do not underflow.
    let scaled = |v: V| {
        let longest = v.abs().max_element();
        v.times_powers(longest.normalizer(), longest.large_length())
    };
    let (a, b) = (scaled(a), scaled(b));
    let mut expansion = [V::Scalar::ZERO; 6];
    for axis in 0..3 {
        let (product, error) = a.component(axis).two_product(b.component(axis));
        for (term, length) in [(error, 2 * axis), (product, 2 * axis + 1)] {
            let mut sum = term;
            for part in &mut expansion[..length] {
                (sum, *part) = two_sum(sum, *part);
            }
            expansion[length] = sum;
        }
    }
    let largest = expansion.into_iter().rfind(|part| *part != V::Scalar::ZERO);
    largest.unwrap_or(V::Scalar::ZERO)
}

#[cfg(test)]
mod tests {
    use super::{difference_of_products, dot_sign};
    use crate::vector::{Number, Scalar, Vector};
    use glam::{DVec3, Vec3, Vec3A};

    #[test]
    fn sign_of_products_that_round_alike() {
        let (a, b) = (1.0 + f32::EPSILON, 1.0 - f32::EPSILON);
        // a·b = 1 − ε², which rounds to 1.
        assert_eq!(a * b, 1.0);
        assert_eq!(difference_of_products(a, b, 1.0, 1.0), -f32::EPSILON * f32::EPSILON);
        assert_eq!(difference_of_products(1.0, 1.0, a, b), f32::EPSILON * f32::EPSILON);
        let (a, b) = (1.0 + f64::EPSILON, 1.0 - f64::EPSILON);
        assert_eq!(a * b, 1.0);
        assert_eq!(difference_of_products(a, b, 1.0, 1.0), -f64::EPSILON * f64::EPSILON);
        assert_eq!(difference_of_products(3.0, 5.0, 5.0, 3.0), 0.0);
    }

    #[test]
    fn sign_of_a_dot_product_that_rounds_to_zero_or_to_the_wrong_side() {
        // (1 + ε)(1 − ε) − 1·1 + ε²·c = (c − 1)·ε²
        fn check<V: Vector>(scale: f64) {
            let (one, epsilon) = (V::Scalar::ONE, V::Scalar::EPSILON);
            let scale = one.lit(scale);
            for c in [0.0, 0.5, 1.0, 1.5] {
                let a = V::new(one + epsilon, one, epsilon) * scale;
                let b = V::new(one - epsilon, -one, epsilon * one.lit(c)) * scale;
                for (a, b) in [(a, b), (a.yzx(), b.yzx()), (a.zxy(), b.zxy())] {
                    let sign = dot_sign(a, b).partial_cmp(&V::Scalar::ZERO);
                    assert_eq!(sign, c.partial_cmp(&1.0), "{c}");
                    assert_eq!(dot_sign(-a, b), -dot_sign(a, b));
                }
            }
            assert_eq!(dot_sign(V::ZERO, V::new(one, one, one)), V::Scalar::ZERO);
        }
        for scale in [1.0, 2.0_f64.powi(-90), 2.0_f64.powi(100)] {
            check::<Vec3>(scale);
            check::<Vec3A>(scale);
            check::<DVec3>(scale * scale);
        }
    }
}
