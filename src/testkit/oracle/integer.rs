//! Exact numbers: integers of two sizes, the power-of-two grids that turn floats into integers, and quotients that are
//! compared but never divided.

use std::cmp::Ordering;
use std::ops::{Add, Mul, Neg, Sub};

use num_bigint::{BigInt, Sign};

/// A ring of integers in which a verdict is computed; the caller makes sure that nothing overflows.
pub(super) trait Integer:
    Clone
    + Ord
    + Neg<Output = Self>
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + for<'a> Add<&'a Self, Output = Self>
    + for<'a> Sub<&'a Self, Output = Self>
    + for<'a> Mul<&'a Self, Output = Self>
{
    /// `mantissa · 2^shift`.
    fn new(mantissa: i64, shift: u32) -> Self;

    /// −1, 0 or 1.
    fn signum(&self) -> i32;
}

/// The fast tier: right for magnitudes below 2^[`I128_BITS`]. Its operators panic on overflow in debug builds.
impl Integer for i128 {
    #[inline]
    fn new(mantissa: i64, shift: u32) -> Self {
        let value = Self::from(mantissa) << shift;
        debug_assert_eq!(value >> shift, Self::from(mantissa), "shifted out of range");
        value
    }

    #[inline]
    fn signum(&self) -> i32 {
        i32::from(*self > 0) - i32::from(*self < 0)
    }
}

/// The tier without a limit.
impl Integer for BigInt {
    fn new(mantissa: i64, shift: u32) -> Self {
        Self::from(mantissa) << shift
    }

    fn signum(&self) -> i32 {
        match self.sign() {
            Sign::Minus => -1,
            Sign::NoSign => 0,
            Sign::Plus => 1,
        }
    }
}

/// An `i128` holds every magnitude below two to this power.
pub(super) const I128_BITS: u32 = 127;

/// A point or a vector with integer components.
pub(super) type Vector<I> = [I; 3];

/// `a − b`.
#[inline]
pub(super) fn sub<I: Integer>(a: &Vector<I>, b: &Vector<I>) -> Vector<I> {
    let component = |k: usize| a[k].clone() - &b[k];
    [component(0), component(1), component(2)]
}

/// `a · b`.
#[inline]
pub(super) fn dot<I: Integer>(a: &Vector<I>, b: &Vector<I>) -> I {
    a[0].clone() * &b[0] + a[1].clone() * &b[1] + a[2].clone() * &b[2]
}

/// `a × b`.
#[inline]
pub(super) fn cross<I: Integer>(a: &Vector<I>, b: &Vector<I>) -> Vector<I> {
    let component = |x: usize, y: usize| a[x].clone() * &b[y] - a[y].clone() * &b[x];
    [component(1, 2), component(2, 0), component(0, 1)]
}

/// A finite float taken apart: `mantissa · 2^exponent`, the mantissa odd, or zero with exponent zero.
#[derive(Clone, Copy)]
struct Dyadic {
    mantissa: i64,
    exponent: i32,
}

impl Dyadic {
    #[inline]
    fn new(x: f64) -> Self {
        debug_assert!(x.is_finite());
        if x == 0.0 {
            return Self { mantissa: 0, exponent: 0 };
        }
        let bits = x.to_bits();
        let biased = (bits >> 52 & 0x7ff) as i32;
        let hidden = i64::from(biased != 0) << 52;
        let mantissa = (bits & ((1 << 52) - 1)) as i64 | hidden;
        let zeros = mantissa.trailing_zeros();
        let sign = 1 - 2 * (bits >> 63) as i64;
        Self { mantissa: sign * (mantissa >> zeros), exponent: biased.max(1) - 1075 + zeros as i32 }
    }

    /// The bit length of the mantissa.
    #[inline]
    fn bits(self) -> u32 {
        64 - self.mantissa.unsigned_abs().leading_zeros()
    }

    /// The value times `2^shift`.
    #[inline]
    fn scaled(self, shift: i32) -> Self {
        let exponent = if self.mantissa == 0 { 0 } else { self.exponent + shift };
        Self { exponent, ..self }
    }
}

/// A power of two of which all values of a group are integer multiples.
#[derive(Clone, Copy)]
pub(super) struct Grid {
    /// The spacing is `2^exponent`.
    pub(super) exponent: i32,
    /// Every value of the group is below `2^bits` spacings.
    pub(super) bits: u32,
}

impl Grid {
    /// The coarsest grid through all values; non-finite ones and zeros do not count.
    #[inline]
    pub(super) fn through(values: &[f64]) -> Self {
        let (mut bottom, mut top) = (i32::MAX, i32::MIN);
        for &value in values {
            if value != 0.0 && value.is_finite() {
                let value = Dyadic::new(value);
                bottom = bottom.min(value.exponent);
                top = top.max(value.exponent + value.bits() as i32);
            }
        }
        if bottom == i32::MAX {
            return Self { exponent: 0, bits: 0 };
        }
        Self { exponent: bottom, bits: (top - bottom) as u32 }
    }

    /// The coarsest grid through the values of both groups.
    #[inline]
    pub(super) fn joined(self, other: Self) -> Self {
        if self.bits == 0 || other.bits == 0 {
            return if self.bits == 0 { other } else { self };
        }
        let exponent = self.exponent.min(other.exponent);
        let top = |grid: Self| grid.exponent + grid.bits as i32;
        Self { exponent, bits: (top(self).max(top(other)) - exponent) as u32 }
    }

    /// The same grid, or a finer one, with a spacing of at most `2^exponent`.
    pub(super) fn refined(self, exponent: i32) -> Self {
        let exponent = exponent.min(self.exponent);
        Self { exponent, bits: self.bits + (self.exponent - exponent) as u32 }
    }

    /// A value of the group, counted in spacings.
    #[inline]
    pub(super) fn integer<I: Integer>(self, x: f64) -> I {
        let x = Dyadic::new(x).scaled(-self.exponent);
        I::new(x.mantissa, x.exponent as u32)
    }

    /// A point of the group, counted in spacings.
    #[inline]
    pub(super) fn vector<I: Integer>(self, p: [f64; 3]) -> Vector<I> {
        let [x, y, z] = p;
        [self.integer(x), self.integer(y), self.integer(z)]
    }
}

/// A point of the extended real line: `num / den` with `den ≥ 0`, where `±1 / 0` are the infinities.
#[derive(Clone)]
pub(super) struct Ratio<I> {
    pub(super) num: I,
    pub(super) den: I,
}

impl<I: Integer> Ratio<I> {
    /// `num / den`; the denominator has any sign but is not zero.
    #[inline]
    pub(super) fn new(num: I, den: I) -> Self {
        if den.signum() < 0 { Self { num: -num, den: -den } } else { Self { num, den } }
    }

    /// `|self|`
    pub(super) fn abs(&self) -> Self {
        if self.num.signum() < 0 { self.negated() } else { self.clone() }
    }

    /// `−self`
    pub(super) fn negated(&self) -> Self {
        Self { num: -self.num.clone(), den: self.den.clone() }
    }

    /// `self · other`; no infinity times zero.
    pub(super) fn times(&self, other: &Self) -> Self {
        Self { num: self.num.clone() * &other.num, den: self.den.clone() * &other.den }
    }

    /// `self + other`; an infinity plus anything is that infinity.
    pub(super) fn plus(&self, other: &Self) -> Self {
        if self.den.signum() == 0 {
            return self.clone();
        }
        Self {
            num: self.num.clone() * &other.den + other.num.clone() * &self.den,
            den: self.den.clone() * &other.den,
        }
    }

    /// +∞ or −∞.
    #[inline]
    pub(super) fn infinity(sign: i64) -> Self {
        Self { num: I::new(sign, 0), den: I::new(0, 0) }
    }

    /// `x · 2^shift`; `x` may be infinite but not NaN.
    #[inline]
    pub(super) fn from_float(x: f64, shift: i32) -> Self {
        debug_assert!(!x.is_nan());
        if x.is_infinite() {
            return Self::infinity(if x < 0.0 { -1 } else { 1 });
        }
        let x = Dyadic::new(x).scaled(shift);
        Self {
            num: I::new(x.mantissa, x.exponent.max(0) as u32),
            den: I::new(1, (-x.exponent).max(0) as u32),
        }
    }
}

/// The bit length of the larger half of [`Ratio::from_float`].
#[inline]
pub(super) fn ratio_bits(x: f64, shift: i32) -> u32 {
    if !x.is_finite() {
        return 1;
    }
    let x = Dyadic::new(x).scaled(shift);
    let num = x.bits() + x.exponent.max(0) as u32;
    let den = 1 + (-x.exponent).max(0) as u32;
    num.max(den)
}

impl<I: Integer> Ord for Ratio<I> {
    #[inline]
    fn cmp(&self, other: &Self) -> Ordering {
        if self.den.signum() == 0 && other.den.signum() == 0 {
            return self.num.cmp(&other.num);
        }
        (self.num.clone() * &other.den).cmp(&(other.num.clone() * &self.den))
    }
}

impl<I: Integer> PartialOrd for Ratio<I> {
    #[inline]
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl<I: Integer> Eq for Ratio<I> {}

impl<I: Integer> PartialEq for Ratio<I> {
    #[inline]
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

/// A closed interval of t, empty when `enter > exit`.
#[derive(Clone)]
pub(super) struct Interval<I> {
    pub(super) enter: Ratio<I>,
    pub(super) exit: Ratio<I>,
}

impl<I: Integer> Interval<I> {
    /// From `lo · 2^shift` to `hi · 2^shift`; either may be infinite but not NaN.
    pub(super) fn new(lo: f64, hi: f64, shift: i32) -> Self {
        Self { enter: Ratio::from_float(lo, shift), exit: Ratio::from_float(hi, shift) }
    }

    pub(super) fn is_empty(&self) -> bool {
        self.enter > self.exit
    }

    #[inline]
    pub(super) fn contains(&self, t: &Ratio<I>) -> bool {
        self.enter <= *t && *t <= self.exit
    }

    /// Keeps the t at which `at_zero + t · slope ≥ 0`.
    pub(super) fn clip(&mut self, at_zero: I, slope: I) {
        match slope.signum() {
            1 => {
                let root = Ratio { num: -at_zero, den: slope };
                if root > self.enter {
                    self.enter = root;
                }
            }
            -1 => {
                let root = Ratio { num: at_zero, den: -slope };
                if root < self.exit {
                    self.exit = root;
                }
            }
            _ if at_zero.signum() < 0 => {
                *self = Self { enter: Ratio::infinity(1), exit: Ratio::infinity(-1) }
            }
            _ => {}
        }
    }

    /// Keeps the t at which `at_zero + t · slope = 0`.
    pub(super) fn clip_to_root(&mut self, at_zero: I, slope: I) {
        self.clip(at_zero.clone(), slope.clone());
        self.clip(-at_zero, -slope);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_float_is_an_integer_times_a_power_of_two() {
        for x in [1.0, -3.0, 0.1, f64::MIN_POSITIVE, f64::from_bits(1), -f64::MAX] {
            let dyadic = Dyadic::new(x);
            assert_eq!(dyadic.mantissa % 2 != 0, x != 0.0);
            // Two steps, since 2^exponent alone may underflow.
            let half = dyadic.exponent / 2;
            assert_eq!(
                dyadic.mantissa as f64 * 2f64.powi(half) * 2f64.powi(dyadic.exponent - half),
                x
            );
        }
        assert_eq!(Dyadic::new(-0.0).mantissa, 0);
    }

    #[test]
    fn a_grid_goes_through_all_its_values() {
        let grid = Grid::through(&[0.75, -6.0, 0.0, f64::INFINITY]);
        assert_eq!((grid.exponent, grid.bits), (-2, 5));
        assert_eq!(grid.vector::<i128>([0.75, -6.0, 0.0]), [3, -24, 0]);
        assert_eq!(grid.refined(-4).integer::<BigInt>(0.75), BigInt::from(12));
        assert_eq!(grid.refined(0).exponent, -2);
    }

    #[test]
    fn ratios_are_ordered_from_infinity_to_infinity() {
        let line = [f64::NEG_INFINITY, -2.0, -0.5, 0.0, 1e-3, 7.0, f64::INFINITY];
        for a in line {
            for b in line {
                let order = Ratio::<BigInt>::from_float(a, 3).cmp(&Ratio::from_float(b, 3));
                assert_eq!(Some(order), a.partial_cmp(&b), "{a} {b}");
            }
        }
        assert!(Ratio::new(1i128, -2) == Ratio::from_float(-1.0, -1));
    }

    #[test]
    fn clipping_keeps_a_closed_interval() {
        let whole = || Interval::<i128> { enter: Ratio::infinity(-1), exit: Ratio::infinity(1) };
        let mut point = whole();
        point.clip_to_root(-6, 4);
        assert!(!point.is_empty() && point.contains(&Ratio::from_float(1.5, 0)));
        point.clip(-3, 2);
        assert!(!point.is_empty());
        point.clip(-4, 2);
        assert!(point.is_empty());
        let mut nothing = whole();
        nothing.clip(0, 0);
        assert!(!nothing.is_empty());
        nothing.clip(-1, 0);
        nothing.clip(5, 1);
        assert!(nothing.is_empty());
    }
}
