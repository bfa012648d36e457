//! Integers of a fixed capacity, on the stack.
//!
//! # How many bits
//!
//! A finite `f64` is a multiple of 2⁻¹⁰⁷⁴ and below 2¹⁰²⁴: on that grid, or a coarser one, any group
//! of coordinates has at most 2,098 bits. The difference of two has one bit more; a sum of three
//! products has at most two bits more than the longest product. With p bits for the points of a case
//! and d for its direction:
//!
//! * a normal, a cross product of two differences, has 2p + 3 bits; a volume, its product with the
//!   direction, 2p + d + 5; with a third difference, 3p + 6. To compare t, a 53-bit number, a volume
//!   is multiplied by it: 2p + d + 60 in sums of up to three volumes.
//! * Two fractions of a product of differences (2p + 3) and one of a difference and the direction
//!   (p + d + 2) are compared, or summed, in 3p + d + 6 bits.
//! * At a float t, between 2⁻¹⁰⁷⁴ and 2¹⁰²⁴, the weights of a point are sums of a number between 2⁻²¹⁴⁸ and
//!   2²⁰⁵¹ and one between 2⁻³²²² and 2³⁰⁷⁶: 6,300.
//! * The squared distance of the ray's point at a float t from a sphere's centre: t·d lies between
//!   2⁻²¹⁴⁸ and 2²⁰⁴⁸, so it and its sums have 4,198 bits, the square 8,399.
//! * A sphere's discriminant, a difference of two products of four factors, has 2p + 2d + 8.
//!
//! So 8,400 bits are the most: [`LARGE`] limbs hold 8,704. A comparison of numbers that differ by a
//! power of two shifts nothing unless their lengths agree, and needs no more than they do.
//!
//! Ordinary cases need far less: with all coordinates between 2⁻³⁰ and 1 times a length 3p + d is below
//! 340 in `f64`, 220 in `f32`, so that there are three [`Capacity`]s. The least is [`Wide`]: loops of a
//! fixed length and no branch on a sign, as both would be mispredicted, cost more than the limbs that they
//! spare. The others are [`Int`], which counts the limbs in use.

use core::cmp::Ordering;

use super::grid::Parts;

/// The integers that hold all numbers of a case.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Capacity {
    Narrow,
    Small,
    Large,
}

/// For [`Capacity::Narrow`].
pub(crate) type Narrow = Wide<4>;

/// For [`Capacity::Small`].
pub(crate) type Small = Int<8>;

/// For [`Capacity::Large`].
pub(crate) type Large = Int<LARGE>;

/// The limbs of the integers for any exponents.
const LARGE: usize = 136;

impl Capacity {
    /// The least for magnitudes of so many bits.
    #[inline]
    pub(crate) fn of(bits: u32) -> Self {
        match bits {
            // The sign takes another, and so does the difference of two that are compared.
            0..=254 => Self::Narrow,
            255..=512 => Self::Small,
            _ => Self::Large,
        }
    }
}

/// An integer of some capacity; the caller sees to it that no result exceeds that.
pub(crate) trait Integer: Clone {
    const ZERO: Self;

    /// ±`limb`
    #[must_use]
    fn from_limb(limb: u64, negative: bool) -> Self;
    /// How the integer compares with zero.
    #[must_use]
    fn sign(&self) -> Ordering;
    #[must_use]
    fn is_zero(&self) -> bool;
    /// The number of bits of the magnitude.
    #[must_use]
    fn bits(&self) -> u32;
    /// The leading 64 bits of the magnitude, which is not zero: the first of them is 1.
    #[must_use]
    fn leading(&self) -> u64;
    #[must_use]
    fn neg(&self) -> Self;
    #[must_use]
    fn abs(&self) -> Self;
    #[must_use]
    fn add(&self, other: &Self) -> Self;
    #[must_use]
    fn sub(&self, other: &Self) -> Self;
    #[must_use]
    fn mul(&self, other: &Self) -> Self;
    /// The integer times 2^`bits`.
    #[must_use]
    fn shl(&self, bits: u32) -> Self;
    #[must_use]
    fn cmp(&self, other: &Self) -> Ordering;

    /// `x / 2^exponent`, which is an integer.
    #[inline]
    #[must_use]
    fn from_float(x: f64, exponent: i32) -> Self {
        let parts = Parts::new(x);
        let shift = parts.exponent - exponent;
        if parts.mantissa == 0 {
            Self::ZERO
        } else if shift <= 0 {
            // What is shifted out is zero.
            debug_assert!(parts.mantissa.trailing_zeros() >= shift.unsigned_abs());
            Self::from_limb(parts.mantissa >> shift.unsigned_abs(), parts.negative)
        } else {
            Self::from_limb(parts.mantissa, parts.negative).shl(shift.unsigned_abs())
        }
    }

    /// How `self · 2^shift` compares with the other.
    #[inline]
    #[must_use]
    fn cmp_shifted(&self, shift: i32, other: &Self) -> Ordering {
        let signs = self.sign().cmp(&other.sign());
        if signs != Ordering::Equal || self.is_zero() {
            return signs;
        }
        let lengths = (self.bits() as i32 + shift).cmp(&(other.bits() as i32));
        if lengths != Ordering::Equal {
            return if self.sign() == Ordering::Less { lengths.reverse() } else { lengths };
        }
        if shift >= 0 {
            self.shl(shift.unsigned_abs()).cmp(other)
        } else {
            self.cmp(&other.shl(shift.unsigned_abs()))
        }
    }

    /// `self / divisor · 2^exponent`, off by less than an ulp: by less than 0.51 where the result is
    /// a normal number. A quotient that is a float is exact; one beyond the largest float is infinite.
    /// The divisor is not zero.
    #[must_use]
    fn quotient(&self, divisor: &Self, exponent: i32) -> f64 {
        if self.is_zero() {
            return 0.0;
        }
        // The leading bits determine dividend and divisor within the factor 1 + 2⁻⁶³, and the
        // quotient of at least 64 bits, of which 53 remain, within 5 units of the last.
        let leading = (u128::from(self.leading()) << 64) / u128::from(divisor.leading());
        let magnitude =
            scaled(leading as f64, self.bits() as i32 - divisor.bits() as i32 - 64 + exponent);
        if self.sign() == divisor.sign() { magnitude } else { -magnitude }
    }
}

/// An integer of a fixed length: 64 `N` bits in two's complement, the least limb first.
#[derive(Clone, Debug)]
pub(crate) struct Wide<const N: usize>([u64; N]);

impl<const N: usize> Wide<N> {
    /// `self + other`, or `self − other` if told.
    #[inline(always)]
    fn sum(&self, other: &Self, subtract: bool) -> Self {
        let mask = u64::from(subtract).wrapping_neg();
        let (mut limbs, mut carry) = ([0; N], subtract);
        for (limb, (&a, &b)) in limbs.iter_mut().zip(self.0.iter().zip(&other.0)) {
            let (half, over) = a.overflowing_add(b ^ mask);
            let (whole, over_again) = half.overflowing_add(u64::from(carry));
            *limb = whole;
            carry = over | over_again;
        }
        Self(limbs)
    }

    #[inline]
    fn is_negative(&self) -> bool {
        self.0[N - 1] >> 63 != 0
    }

    /// The magnitude, as an integer that counts its limbs.
    #[inline]
    fn magnitude(&self) -> Int<N> {
        let limbs = self.abs().0;
        let len = limbs.iter().rposition(|&limb| limb != 0).map_or(0, |last| last + 1);
        Int { limbs, len, negative: false }
    }
}

impl<const N: usize> Integer for Wide<N> {
    const ZERO: Self = Self([0; N]);

    #[inline]
    fn from_limb(limb: u64, negative: bool) -> Self {
        let mut limbs = [0; N];
        limbs[0] = limb;
        Self::ZERO.sum(&Self(limbs), negative)
    }

    #[inline]
    fn sign(&self) -> Ordering {
        match (self.is_zero(), self.is_negative()) {
            (true, _) => Ordering::Equal,
            (_, true) => Ordering::Less,
            (_, false) => Ordering::Greater,
        }
    }

    #[inline]
    fn is_zero(&self) -> bool {
        self.0.iter().fold(0, |all, limb| all | limb) == 0
    }

    #[inline]
    fn bits(&self) -> u32 {
        self.magnitude().bits()
    }

    #[inline]
    fn leading(&self) -> u64 {
        self.magnitude().leading()
    }

    #[inline]
    fn neg(&self) -> Self {
        Self::ZERO.sum(self, true)
    }

    #[inline]
    fn abs(&self) -> Self {
        Self::ZERO.sum(self, self.is_negative())
    }

    #[inline(always)]
    fn add(&self, other: &Self) -> Self {
        self.sum(other, false)
    }

    #[inline(always)]
    fn sub(&self, other: &Self) -> Self {
        self.sum(other, true)
    }

    #[allow(clippy::cast_possible_truncation)] // a product taken apart into two limbs
    #[inline(always)]
    fn mul(&self, other: &Self) -> Self {
        // Modulo 2^(64 N), signs take care of themselves.
        let mut limbs = [0; N];
        for i in 0..N {
            let mut carry = 0;
            for j in 0..N - i {
                let product = u128::from(self.0[i]) * u128::from(other.0[j])
                    + u128::from(limbs[i + j])
                    + carry;
                limbs[i + j] = product as u64;
                carry = product >> 64;
            }
        }
        Self(limbs)
    }

    #[inline]
    fn shl(&self, bits: u32) -> Self {
        let (whole, bits) = ((bits / 64) as usize, bits % 64);
        let mut limbs = [0; N];
        let mut carry = 0;
        for (limb, &x) in limbs.iter_mut().skip(whole).zip(&self.0) {
            *limb = x << bits | carry;
            // In two steps, since bits may be zero.
            carry = x >> 1 >> (63 - bits);
        }
        Self(limbs)
    }

    #[inline]
    fn cmp(&self, other: &Self) -> Ordering {
        self.sum(other, true).sign()
    }
}

/// An integer: sign and magnitude, the magnitude in `L` limbs of 64 bits, the least first.
///
/// The caller sees to it that no result exceeds the capacity.
#[derive(Clone, Debug)]
pub(crate) struct Int<const L: usize> {
    /// Zero from `len` on.
    limbs: [u64; L],
    /// The limbs in use: the last of them is not zero.
    len: usize,
    /// Means nothing for zero.
    negative: bool,
}

impl<const L: usize> Int<L> {
    /// The sum, with the sign of the other as told.
    #[inline]
    fn sum(&self, other: &Self, other_negative: bool) -> Self {
        let mut limbs = [0; L];
        let mut len = self.len.max(other.len);
        let pairs = self.limbs[..len].iter().zip(&other.limbs[..len]);
        let mut negative = self.negative;
        let mut carry = false;
        if negative == other_negative {
            for (limb, (&a, &b)) in limbs.iter_mut().zip(pairs) {
                let (sum, over) = a.overflowing_add(b);
                let (sum, over_again) = sum.overflowing_add(u64::from(carry));
                *limb = sum;
                carry = over | over_again;
            }
            if carry {
                limbs[len] = 1;
                len += 1;
            }
        } else {
            for (limb, (&a, &b)) in limbs.iter_mut().zip(pairs) {
                let (difference, under) = a.overflowing_sub(b);
                let (difference, under_again) = difference.overflowing_sub(u64::from(carry));
                *limb = difference;
                carry = under | under_again;
            }
            if carry {
                // The other was the larger: what is there is its complement.
                negative = other_negative;
                let mut carry = true;
                for limb in &mut limbs[..len] {
                    (*limb, carry) = (!*limb).overflowing_add(u64::from(carry));
                }
            }
            while len > 0 && limbs[len - 1] == 0 {
                len -= 1;
            }
        }
        Self { limbs, len, negative }
    }
}

impl<const L: usize> Integer for Int<L> {
    const ZERO: Self = Self { limbs: [0; L], len: 0, negative: false };

    #[inline]
    fn from_limb(limb: u64, negative: bool) -> Self {
        let mut limbs = [0; L];
        limbs[0] = limb;
        Self { limbs, len: usize::from(limb != 0), negative }
    }

    #[inline]
    fn sign(&self) -> Ordering {
        match (self.len, self.negative) {
            (0, _) => Ordering::Equal,
            (_, true) => Ordering::Less,
            (_, false) => Ordering::Greater,
        }
    }

    #[inline]
    fn is_zero(&self) -> bool {
        self.len == 0
    }

    #[allow(clippy::cast_possible_truncation)] // some thousands
    #[inline]
    fn bits(&self) -> u32 {
        match self.len {
            0 => 0,
            len => 64 * len as u32 - self.limbs[len - 1].leading_zeros(),
        }
    }

    #[inline]
    fn neg(&self) -> Self {
        Self { negative: !self.negative, ..self.clone() }
    }

    #[inline]
    fn abs(&self) -> Self {
        Self { negative: false, ..self.clone() }
    }

    #[inline]
    fn add(&self, other: &Self) -> Self {
        self.sum(other, other.negative)
    }

    #[inline]
    fn sub(&self, other: &Self) -> Self {
        self.sum(other, !other.negative)
    }

    #[allow(clippy::cast_possible_truncation)] // a product taken apart into two limbs
    #[inline]
    fn mul(&self, other: &Self) -> Self {
        let mut limbs = [0; L];
        let (a, b) = (&self.limbs[..self.len], &other.limbs[..other.len]);
        for (i, &x) in a.iter().enumerate() {
            let mut carry = 0;
            for (limb, &y) in limbs[i..].iter_mut().zip(b) {
                let product = u128::from(x) * u128::from(y) + u128::from(*limb) + carry;
                *limb = product as u64;
                carry = product >> 64;
            }
            // A product that just fits has a carry of zero there.
            debug_assert!(i + b.len() < L || carry == 0, "capacity");
            if let Some(limb) = limbs.get_mut(i + b.len()) {
                *limb = carry as u64;
            }
        }
        let mut len = if a.is_empty() || b.is_empty() { 0 } else { (a.len() + b.len()).min(L) };
        if len > 0 && limbs[len - 1] == 0 {
            len -= 1;
        }
        Self { limbs, len, negative: self.negative != other.negative }
    }

    #[inline]
    fn shl(&self, bits: u32) -> Self {
        if self.len == 0 {
            return Self::ZERO;
        }
        let (whole, bits) = ((bits / 64) as usize, bits % 64);
        debug_assert!(self.len + whole <= L, "capacity");
        let mut limbs = [0; L];
        let mut carry = 0;
        let mut len = whole;
        for (limb, &x) in limbs[whole..].iter_mut().zip(&self.limbs[..self.len]) {
            *limb = x << bits | carry;
            // In two steps, since bits may be zero.
            carry = x >> 1 >> (63 - bits);
            len += 1;
        }
        if carry != 0 {
            limbs[len] = carry;
            len += 1;
        }
        Self { limbs, len, negative: self.negative }
    }

    #[inline]
    fn cmp(&self, other: &Self) -> Ordering {
        let signs = self.sign().cmp(&other.sign());
        if signs != Ordering::Equal {
            return signs;
        }
        let magnitudes = self.len.cmp(&other.len).then_with(|| {
            let (a, b) = (&self.limbs[..self.len], &other.limbs[..other.len]);
            a.iter().rev().cmp(b.iter().rev())
        });
        if self.negative { magnitudes.reverse() } else { magnitudes }
    }

    #[inline]
    fn leading(&self) -> u64 {
        let last = self.len - 1;
        let zeros = self.limbs[last].leading_zeros();
        let below = if last > 0 { self.limbs[last - 1] } else { 0 };
        self.limbs[last] << zeros | below >> 1 >> (63 - zeros)
    }
}

/// `x · 2^exponent`, rounded once, for an x between 1 and 2⁶⁶.
fn scaled(x: f64, exponent: i32) -> f64 {
    let exponent = exponent.clamp(-1300, 1300);
    let pow2 = |exponent: i32| f64::from_bits(((1023 + exponent) as u64) << 52);
    let half = exponent / 2;
    x * pow2(half) * pow2(exponent - half)
}

/// `a − b`
#[inline]
pub(crate) fn sub<I: Integer>(a: &[I; 3], b: &[I; 3]) -> [I; 3] {
    [a[0].sub(&b[0]), a[1].sub(&b[1]), a[2].sub(&b[2])]
}

/// `a · b`
#[inline]
pub(crate) fn dot<I: Integer>(a: &[I; 3], b: &[I; 3]) -> I {
    a[0].mul(&b[0]).add(&a[1].mul(&b[1])).add(&a[2].mul(&b[2]))
}

/// The component `axis` of `a × b`.
#[inline]
pub(crate) fn cross_component<I: Integer>(a: &[I; 3], b: &[I; 3], axis: usize) -> I {
    let (y, z) = ((axis + 1) % 3, (axis + 2) % 3);
    a[y].mul(&b[z]).sub(&a[z].mul(&b[y]))
}

/// `a × b`
#[inline]
pub(crate) fn cross<I: Integer>(a: &[I; 3], b: &[I; 3]) -> [I; 3] {
    [cross_component(a, b, 0), cross_component(a, b, 1), cross_component(a, b, 2)]
}

/// The first component that is not zero.
#[inline]
pub(crate) fn first_nonzero<I: Integer>(a: &[I; 3]) -> Option<usize> {
    a.iter().position(|component| !component.is_zero())
}

#[cfg(test)]
#[allow(clippy::cast_possible_truncation)] // limbs in halves, small numbers
mod tests {
    use super::*;
    use num_bigint::{BigInt, Sign};

    fn big<const L: usize>(x: &Int<L>) -> BigInt {
        assert!(x.limbs[x.len..].iter().all(|&limb| limb == 0));
        assert!(x.len == 0 || x.limbs[x.len - 1] != 0);
        let digits: Vec<u32> =
            x.limbs.iter().flat_map(|&limb| [limb as u32, (limb >> 32) as u32]).collect();
        BigInt::from_slice(if x.negative { Sign::Minus } else { Sign::Plus }, &digits)
    }

    /// Up to `limbs` limbs, many of them with all bits alike.
    fn random<const L: usize>(rng: &mut fastrand::Rng, limbs: usize) -> Int<L> {
        let len = rng.usize(0..=limbs);
        let mut x = Int { negative: rng.bool(), ..Int::ZERO };
        for limb in &mut x.limbs[..len] {
            *limb = match rng.u8(..4) {
                0 => 0,
                1 => u64::MAX,
                2 => 1 << rng.u32(..64),
                _ => rng.u64(..),
            };
        }
        x.len = x.limbs.iter().rposition(|&limb| limb != 0).map_or(0, |last| last + 1);
        x
    }

    #[test]
    fn arithmetic_agrees_with_big_integers() {
        fn check<const L: usize>(cases: u32) {
            let mut rng = fastrand::Rng::with_seed(20);
            for _ in 0..cases {
                let (a, b) = (random::<L>(&mut rng, L / 2), random::<L>(&mut rng, L / 2));
                let (x, y) = (big(&a), big(&b));
                assert_eq!(big(&a.add(&b)), &x + &y);
                assert_eq!(big(&a.sub(&b)), &x - &y);
                assert_eq!(big(&a.mul(&b)), &x * &y);
                assert_eq!(big(&a.neg()), -&x);
                assert!(a.abs().sign() != Ordering::Less && a.abs().bits() == a.bits());
                assert!(a.sub(&a).is_zero());
                assert_eq!(a.cmp(&b), x.cmp(&y));
                assert_eq!(a.sign(), x.cmp(&BigInt::ZERO));
                assert_eq!(u64::from(a.bits()), x.bits());
                let shift = rng.u32(0..=32 * L as u32);
                assert_eq!(big(&a.shl(shift)), &x << shift);
                let near = if rng.bool() { &a } else { &b };
                let (other, z) = (near.shl(shift), big(near) << shift);
                assert_eq!(a.cmp_shifted(shift as i32, &other), (&x << shift).cmp(&z));
                assert_eq!(other.cmp_shifted(-(shift as i32), &a), z.cmp(&(&x << shift)));
            }
        }
        check::<4>(200_000);
        check::<8>(100_000);
        check::<LARGE>(2_000);
    }

    #[test]
    fn integers_of_a_fixed_length_agree_with_those_that_count() {
        /// In two's complement; the value must leave a bit for the sign.
        fn wide(x: &Int<4>) -> Wide<4> {
            let magnitude = Wide(x.limbs);
            if x.negative { magnitude.neg() } else { magnitude }
        }
        let mut rng = fastrand::Rng::with_seed(22);
        for _ in 0..200_000 {
            let (a, b) = (random::<4>(&mut rng, 2), random::<4>(&mut rng, 1));
            let (x, y) = (wide(&a), wide(&b));
            assert_eq!(x.add(&y).0, wide(&a.add(&b)).0);
            assert_eq!(x.sub(&y).0, wide(&a.sub(&b)).0);
            assert_eq!(x.mul(&y).0, wide(&a.mul(&b)).0);
            assert_eq!((x.neg().0, x.abs().0), (wide(&a.neg()).0, wide(&a.abs()).0));
            assert_eq!((x.sign(), x.is_zero(), x.bits()), (a.sign(), a.is_zero(), a.bits()));
            assert_eq!((x.cmp(&y), y.cmp(&x)), (a.cmp(&b), b.cmp(&a)));
            let shift = rng.u32(0..=120);
            assert_eq!(x.shl(shift).0, wide(&a.shl(shift)).0);
            let (c, z) = (b.shl(shift), y.shl(shift));
            assert_eq!(x.cmp_shifted(shift as i32, &z), a.cmp_shifted(shift as i32, &c));
            assert_eq!(z.cmp_shifted(-(shift as i32), &x), c.cmp_shifted(-(shift as i32), &a));
            if !b.is_zero() {
                assert_eq!(x.quotient(&y, 3), a.quotient(&b, 3));
            }
        }
    }

    #[test]
    fn the_least_capacity_that_does() {
        let capacities = [254, 255, 512, 513, 8_400].map(Capacity::of);
        use Capacity::{Large, Narrow, Small};
        assert_eq!(capacities, [Narrow, Small, Small, Large, Large]);
    }

    /// A product of as many limbs as there are, of which the last may not come to use.
    #[test]
    fn the_capacity_is_used_up() {
        let ones = |len: usize| {
            let mut x = Int::<4>::ZERO;
            x.limbs[..len].fill(u64::MAX);
            Int { len, ..x }
        };
        for (i, j) in [(1, 3), (2, 2), (3, 1)] {
            assert_eq!(big(&ones(i).mul(&ones(j))), big(&ones(i)) * big(&ones(j)));
        }
        let (three, two) = (Int { len: 3, limbs: [0, 0, 5, 0], negative: true }, ones(1).shl(64));
        assert_eq!(big(&three.mul(&Int::from_limb(u64::MAX, false))), big(&three) * u64::MAX);
        let fits = Int { len: 2, limbs: [7, 3, 0, 0], negative: false };
        assert_eq!(big(&three.mul(&fits)), big(&three) * big(&fits));
        assert_eq!(big(&two.sub(&ones(2))), BigInt::from(-i128::from(u64::MAX)));
    }

    #[test]
    fn quotients_are_within_an_ulp_and_floats_exact() {
        let mut rng = fastrand::Rng::with_seed(21);
        for _ in 0..100_000 {
            let (mut a, b) = (random::<8>(&mut rng, 4), random::<8>(&mut rng, 4));
            if b.is_zero() {
                continue;
            }
            let exponent = rng.i32(-1300..=1200);
            let float = a.quotient(&b, exponent);
            // In steps of 2^−1200, a power below the smallest float.
            let exact = |x: f64| big(&Int::<64>::from_float(x, -1200));
            let wanted = (big(&a) << 2600) / big(&b);
            let error = |x: f64| (exact(x) << (1400 - exponent)) - &wanted;
            if float.is_infinite() {
                let (below, sign) = (f64::MAX.copysign(float), float.signum() as i32);
                assert!(error(below) * sign <= BigInt::ZERO);
                continue;
            }
            let (down, up) = (float.next_down(), float.next_up());
            assert!(down.is_infinite() || error(down) <= BigInt::from(1));
            assert!(up.is_infinite() || error(up) >= BigInt::ZERO);
            // A multiple of the divisor.
            let times = Int::from_float((rng.f64() * 1e6).round() + 1.0, 0);
            a = b.mul(&times);
            assert_eq!(big(&Int::<8>::from_float(a.quotient(&b, 0), 0)), big(&times));
            assert_eq!(a.neg().quotient(&b, -1).abs(), a.quotient(&b, 0) / 2.0);
        }
        let one = Int::<2>::from_limb(1, false);
        assert_eq!(one.quotient(&one, -1074), f64::from_bits(1));
        assert_eq!(one.quotient(&one, -1076), 0.0);
        assert_eq!(one.neg().quotient(&one, 1024), f64::NEG_INFINITY);
        assert_eq!(one.quotient(&one, 5_000), f64::INFINITY);
        assert_eq!(Int::ZERO.quotient(&one, 0), 0.0);
    }

    #[test]
    fn vectors() {
        let v = |p: [f64; 3]| p.map(|x| Int::<2>::from_float(x, 0));
        let (a, b) = (v([1.0, 2.0, 3.0]), v([-4.0, 0.0, 5.0]));
        assert_eq!(big(&dot(&a, &b)), BigInt::from(11));
        assert_eq!(cross(&a, &b).each_ref().map(big), [10, -17, 8].map(BigInt::from));
        assert_eq!(sub(&a, &b).each_ref().map(big), [5, 2, -2].map(BigInt::from));
        assert_eq!(first_nonzero(&v([0.0, -0.0, 1.0])), Some(2));
        assert_eq!(first_nonzero(&v([0.0; 3])), None);
    }
}
