//! The arithmetic that decides a sign exactly.

use crate::vector::Scalar;

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
