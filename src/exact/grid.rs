//! Floats as integers: a grid is a power of two of which all values of a group are multiples.

use super::integer::Integer;

/// A finite float taken apart: ±`mantissa` · 2^`exponent`.
#[derive(Clone, Copy)]
pub(crate) struct Parts {
    pub(crate) negative: bool,
    pub(crate) mantissa: u64,
    pub(crate) exponent: i32,
}

impl Parts {
    #[inline]
    pub(crate) fn new(x: f64) -> Self {
        debug_assert!(x.is_finite());
        let bits = x.to_bits();
        let biased = (bits >> 52 & 0x7ff) as i32;
        let hidden = u64::from(biased != 0) << 52;
        let mantissa = (bits & ((1 << 52) - 1)) | hidden;
        Self { negative: x.is_sign_negative(), mantissa, exponent: biased.max(1) - 1075 }
    }

    /// The same with an odd mantissa; zero is 0 · 2^0.
    #[inline]
    pub(crate) fn reduced(self) -> Self {
        if self.mantissa == 0 {
            return Self { exponent: 0, ..self };
        }
        let zeros = self.mantissa.trailing_zeros();
        Self { mantissa: self.mantissa >> zeros, exponent: self.exponent + zeros as i32, ..self }
    }
}

/// The coarsest grid through a group of values: they are integers of at most `bits()` bits, times
/// 2^`exponent()`.
#[derive(Clone, Copy)]
pub(crate) struct Grid {
    bottom: i32,
    top: i32,
}

impl Grid {
    /// The grid through no value but zero.
    const EMPTY: Self = Self { bottom: i32::MAX, top: i32::MIN };

    /// The grid through finite values.
    #[inline]
    pub(crate) fn through(values: &[f64]) -> Self {
        let mut grid = Self::EMPTY;
        for &value in values {
            if value != 0.0 {
                let Parts { mantissa, exponent, .. } = Parts::new(value);
                grid.bottom = grid.bottom.min(exponent + mantissa.trailing_zeros() as i32);
                grid.top = grid.top.max(exponent + 64 - mantissa.leading_zeros() as i32);
            }
        }
        grid
    }

    /// The grid through the values of both groups.
    #[inline]
    pub(crate) fn joined(self, other: Self) -> Self {
        Self { bottom: self.bottom.min(other.bottom), top: self.top.max(other.top) }
    }

    /// The grid through the products of a value of each group.
    #[inline]
    pub(crate) fn product(self, other: Self) -> Self {
        if self.is_empty() || other.is_empty() {
            return Self::EMPTY;
        }
        Self { bottom: self.bottom + other.bottom, top: self.top + other.top }
    }

    #[inline]
    fn is_empty(self) -> bool {
        self.bottom > self.top
    }

    #[inline]
    pub(crate) fn exponent(self) -> i32 {
        if self.is_empty() { 0 } else { self.bottom }
    }

    #[inline]
    pub(crate) fn bits(self) -> u32 {
        if self.is_empty() { 0 } else { self.top.abs_diff(self.bottom) }
    }

    /// A value of the group, counted in steps of the grid.
    #[inline]
    pub(crate) fn integer<I: Integer>(self, x: f64) -> I {
        I::from_float(x, self.exponent())
    }

    /// A point of the group, counted in steps of the grid.
    #[inline]
    pub(crate) fn vector<I: Integer>(self, [x, y, z]: [f64; 3]) -> [I; 3] {
        [self.integer(x), self.integer(y), self.integer(z)]
    }
}

#[cfg(test)]
mod tests {
    use super::super::integer::Small;
    use super::*;
    use core::cmp::Ordering;

    #[test]
    fn a_grid_goes_through_its_values() {
        let grid = Grid::through(&[0.75, -6.0, 0.0]);
        assert_eq!((grid.exponent(), grid.bits()), (-2, 5));
        let [x, y, z] = grid.vector::<Small>([0.75, -6.0, -0.0]);
        assert_eq!(x.cmp(&Small::from_float(3.0, 0)), Ordering::Equal);
        assert_eq!(y.cmp(&Small::from_float(-24.0, 0)), Ordering::Equal);
        assert_eq!(z.sign(), Ordering::Equal);
        let none = Grid::through(&[0.0, -0.0]);
        assert_eq!((none.exponent(), none.bits()), (0, 0));
        let tiny = Grid::through(&[f64::from_bits(1)]);
        assert_eq!(tiny.joined(none).exponent(), -1074);
        let all = tiny.joined(Grid::through(&[f64::MAX]));
        assert_eq!((all.exponent(), all.bits()), (-1074, 2098));
        assert_eq!((all.product(grid).exponent(), all.product(grid).bits()), (-1076, 2103));
        assert_eq!(all.product(none).bits(), 0);
    }

    #[test]
    fn parts_make_the_float_again() {
        for x in [1.0, -3.0, 0.1, 1e-310, 0.0, 1e300] {
            for parts in [Parts::new(x), Parts::new(x).reduced()] {
                let half = parts.exponent / 2;
                let magnitude = parts.mantissa as f64
                    * 2.0_f64.powi(half)
                    * 2.0_f64.powi(parts.exponent - half);
                assert_eq!(if parts.negative { -magnitude } else { magnitude }, x);
            }
            assert!(Parts::new(x).reduced().mantissa % 2 == u64::from(x != 0.0));
        }
    }
}
