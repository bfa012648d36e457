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

use crate::vector::{Scalar, Vector};

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

#[cfg(test)]
mod tests {
    use super::difference_of_products;

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
}
