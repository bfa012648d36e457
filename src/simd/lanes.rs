//! Numbers and vectors side by side: what the kernel bodies compute with in a pack.
//!
//! The operations are those of one float, lane by lane, rounded alike: a body without [`Fused`] gives
//! the same bits in every lane, at every level, as it gives for one float.

use core::fmt::Debug;
use core::ops::{Add, Mul, Neg, Sub};

use fearless_simd::{
    Select, Simd, SimdBase, SimdFloat, SimdMask, f32x4, f32x8, f32x16, f64x2, f64x4, f64x8,
    mask32x4, mask32x8, mask32x16, mask64x2, mask64x4, mask64x8, u32x4, u32x8, u32x16, u64x2,
    u64x4, u64x8,
};

use crate::vector::sealed::Sealed;
use crate::vector::{Coordinates, Mask, Number, Scalar, Vector};

/// Numbers side by side that can be multiplied and added at once, with one rounding where the processor has
/// an instruction for it, and with two elsewhere.
pub trait Fused: Number {
    /// `self · factor + addend`
    #[must_use]
    fn times_plus(self, factor: Self, addend: Self) -> Self;

    /// `self · factor − subtrahend`
    #[must_use]
    fn times_minus(self, factor: Self, subtrahend: Self) -> Self;
}

/// A float of which `N` make a pack: `f32` by 4, 8 and 16, `f64` by 2, 4 and 8. (Sealed.)
pub trait Lanes<const N: usize>: Scalar {
    /// `N` of them side by side.
    #[doc(hidden)]
    type Wide<S: Simd>: Fused;

    /// The same number in every lane.
    #[doc(hidden)]
    #[must_use]
    fn splat<S: Simd>(self, simd: S) -> Self::Wide<S>;

    /// A number for each lane.
    #[doc(hidden)]
    #[must_use]
    fn load<S: Simd>(simd: S, numbers: &[Self; N]) -> Self::Wide<S>;

    /// The number of each lane.
    #[doc(hidden)]
    #[must_use]
    fn store<S: Simd>(wide: Self::Wide<S>) -> [Self; N];

    /// The least number in a lane, where none is NaN.
    #[doc(hidden)]
    #[must_use]
    fn least<S: Simd>(wide: Self::Wide<S>) -> Self;

    /// Lane i as bit i.
    #[doc(hidden)]
    #[must_use]
    fn bits<S: Simd>(mask: <Self::Wide<S> as Number>::Mask) -> u32;
}

/// Whether the level's own minimum and maximum choose the second operand if one is NaN, as the
/// instructions of x86 do. Their documentation leaves it open; the test below holds them to it.
#[inline(always)]
fn keeps_second<S: Simd>(simd: S) -> bool {
    cfg!(any(target_arch = "x86", target_arch = "x86_64")) && !is_scalar(simd)
}

macro_rules! lanes {
    ($wide:ident, $mask:ident, $bits:ident, $t:ident, $int:ident, $n:literal, $mantissa_bits:literal, $max_exponent:literal) => {
        impl<S: Simd> Sealed for $wide<S> {}

        impl<S: Simd> Mask for $mask<S> {}

        impl<S: Simd> Number for $wide<S> {
            type Mask = $mask<S>;

            // A literal rounds to the nearest `f32`, as one written in the code does.
            #[allow(clippy::cast_possible_truncation)]
            #[inline(always)]
            fn lit(self, value: f64) -> Self {
                SimdBase::splat(self.simd, value as $t)
            }
            #[inline(always)]
            fn largest(self) -> Self {
                SimdBase::splat(self.simd, $t::MAX)
            }
            #[inline(always)]
            fn lt(self, other: Self) -> $mask<S> {
                self.simd_lt(other)
            }
            #[inline(always)]
            fn le(self, other: Self) -> $mask<S> {
                self.simd_le(other)
            }
            #[inline(always)]
            fn select(mask: $mask<S>, if_true: Self, if_false: Self) -> Self {
                Select::select(mask, if_true, if_false)
            }
            #[inline(always)]
            fn abs(self) -> Self {
                SimdBase::abs(self)
            }
            #[inline(always)]
            fn sqrt(self) -> Self {
                SimdFloat::sqrt(self)
            }
            #[inline(always)]
            fn min(self, other: Self) -> Self {
                if keeps_second(self.simd) {
                    SimdBase::min(self, other)
                } else {
                    Select::select(self.simd_lt(other), self, other)
                }
            }
            #[inline(always)]
            fn max(self, other: Self) -> Self {
                if keeps_second(self.simd) {
                    SimdBase::max(self, other)
                } else {
                    Select::select(self.simd_gt(other), self, other)
                }
            }
            #[inline(always)]
            fn two_product(self, other: Self) -> (Self, Self) {
                let product = self * other;
                (product, self.mul_sub_precise(other, product))
            }
            #[inline(always)]
            fn is_mid_range(self) -> $mask<S> {
                self.are_mid_range(self)
            }
            #[inline(always)]
            fn are_mid_range(self, other: Self) -> $mask<S> {
                // As for one float: the exponent less the lowest, the sign shifted out.
                let lowest: $bits<S> =
                    SimdBase::splat(self.simd, ($max_exponent / 4 + 1) << ($mantissa_bits + 1));
                let above = ((self.to_bits() << 1) - lowest) | ((other.to_bits() << 1) - lowest);
                above.simd_lt(1 << ($int::BITS - 1))
            }
            #[inline(always)]
            fn large_length(self) -> Self {
                SimdBase::splat(self.simd, Number::large_length($t::ONE))
            }
            #[inline(always)]
            fn normalizer(self) -> Self {
                let biased = (self.to_bits() >> $mantissa_bits) & $max_exponent;
                let largest: $bits<S> = SimdBase::splat(self.simd, $max_exponent - 1);
                let inverse = (largest - biased.min($max_exponent - 2)).max(1);
                Self::from_bits(inverse << $mantissa_bits)
            }
        }

        impl<S: Simd> Fused for $wide<S> {
            #[inline(always)]
            fn times_plus(self, factor: Self, addend: Self) -> Self {
                self.mul_add(factor, addend)
            }
            #[inline(always)]
            fn times_minus(self, factor: Self, subtrahend: Self) -> Self {
                self.mul_sub(factor, subtrahend)
            }
        }

        impl Lanes<$n> for $t {
            type Wide<S: Simd> = $wide<S>;

            #[inline(always)]
            fn splat<S: Simd>(self, simd: S) -> $wide<S> {
                SimdBase::splat(simd, self)
            }
            #[inline(always)]
            fn load<S: Simd>(simd: S, numbers: &[Self; $n]) -> $wide<S> {
                SimdBase::load_array_ref(simd, numbers)
            }
            #[inline(always)]
            fn store<S: Simd>(wide: $wide<S>) -> [Self; $n] {
                wide.to_array()
            }
            #[inline(always)]
            fn least<S: Simd>(wide: $wide<S>) -> Self {
                wide.reduce_min()
            }
            #[allow(clippy::cast_possible_truncation)] // 16 lanes at the most
            #[inline(always)]
            fn bits<S: Simd>(mask: $mask<S>) -> u32 {
                mask.to_bitmask() as u32
            }
        }
    };
}

lanes!(f32x4, mask32x4, u32x4, f32, u32, 4, 23, 0xff);
lanes!(f32x8, mask32x8, u32x8, f32, u32, 8, 23, 0xff);
lanes!(f32x16, mask32x16, u32x16, f32, u32, 16, 23, 0xff);
lanes!(f64x2, mask64x2, u64x2, f64, u64, 2, 52, 0x7ff);
lanes!(f64x4, mask64x4, u64x4, f64, u64, 4, 52, 0x7ff);
lanes!(f64x8, mask64x8, u64x8, f64, u64, 8, 52, 0x7ff);

/// Whether the processor has no lanes: there the packs ask the scalar kernels, lane by lane. (As arrays of
/// numbers the lanes would be slower than that, and take most of the time to compile.)
#[inline(always)]
pub(super) fn is_scalar<S: Simd>(simd: S) -> bool {
    simd.level().is_fallback()
}

/// The lanes of a mask, in order.
#[inline(always)]
pub(super) fn lanes_of<const N: usize>(mask: u32) -> impl Iterator<Item = usize> {
    (0..N).filter(move |lane| (mask >> lane) & 1 == 1)
}

/// The same number in every lane.
#[inline(always)]
pub(super) fn splat<T: Lanes<N>, S: Simd, const N: usize>(simd: S, number: T) -> T::Wide<S> {
    <T as Lanes<N>>::splat(number, simd)
}

/// Vectors side by side as a structure of arrays: the x of all, the y of all, the z of all.
#[derive(Clone, Copy, Debug)]
pub(super) struct Columns<N> {
    pub(super) x: N,
    pub(super) y: N,
    pub(super) z: N,
}

impl<N> Sealed for Columns<N> {}

impl<N> Columns<N> {
    /// The same vector in every lane.
    #[inline(always)]
    pub(super) fn of<T, S, V, const L: usize>(simd: S, vector: V) -> Self
    where
        T: Lanes<L, Wide<S> = N>,
        S: Simd,
        V: Vector<Scalar = T>,
    {
        Self {
            x: splat::<T, S, L>(simd, vector.x()),
            y: splat::<T, S, L>(simd, vector.y()),
            z: splat::<T, S, L>(simd, vector.z()),
        }
    }

    /// A vector for each lane, of these axes.
    #[inline(always)]
    pub(super) fn load<T, S, const L: usize>(
        simd: S,
        vectors: &[[T; L]; 3],
        [x, y, z]: [usize; 3],
    ) -> Self
    where
        T: Lanes<L, Wide<S> = N>,
        S: Simd,
    {
        Self {
            x: T::load(simd, &vectors[x]),
            y: T::load(simd, &vectors[y]),
            z: T::load(simd, &vectors[z]),
        }
    }
}

impl<N: Number> Add for Columns<N> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self { x: self.x + other.x, y: self.y + other.y, z: self.z + other.z }
    }
}

impl<N: Number> Sub for Columns<N> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self { x: self.x - other.x, y: self.y - other.y, z: self.z - other.z }
    }
}

impl<N: Number> Neg for Columns<N> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self { x: -self.x, y: -self.y, z: -self.z }
    }
}

impl<N: Number> Mul<N> for Columns<N> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, factor: N) -> Self {
        Self { x: self.x * factor, y: self.y * factor, z: self.z * factor }
    }
}

impl<N: Number> Coordinates for Columns<N> {
    type Scalar = N;
    type Mask3 = [N::Mask; 3];

    #[inline(always)]
    fn new(x: N, y: N, z: N) -> Self {
        Self { x, y, z }
    }
    #[inline(always)]
    fn splat(value: N) -> Self {
        Self { x: value, y: value, z: value }
    }
    #[inline(always)]
    fn x(self) -> N {
        self.x
    }
    #[inline(always)]
    fn y(self) -> N {
        self.y
    }
    #[inline(always)]
    fn z(self) -> N {
        self.z
    }
    #[inline(always)]
    fn scaled(self, other: Self) -> Self {
        Self { x: self.x * other.x, y: self.y * other.y, z: self.z * other.z }
    }
    #[inline(always)]
    fn divided(self, other: Self) -> Self {
        Self { x: self.x / other.x, y: self.y / other.y, z: self.z / other.z }
    }
    #[inline(always)]
    fn dot(self, other: Self) -> N {
        (self.x * other.x + self.y * other.y) + self.z * other.z
    }
    #[inline(always)]
    fn cross(self, other: Self) -> Self {
        Self {
            x: self.y * other.z - self.z * other.y,
            y: self.z * other.x - self.x * other.z,
            z: self.x * other.y - self.y * other.x,
        }
    }
    #[inline(always)]
    fn yzx(self) -> Self {
        Self { x: self.y, y: self.z, z: self.x }
    }
    #[inline(always)]
    fn zxy(self) -> Self {
        Self { x: self.z, y: self.x, z: self.y }
    }
    #[inline(always)]
    fn abs(self) -> Self {
        Self { x: self.x.abs(), y: self.y.abs(), z: self.z.abs() }
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Self { x: self.x.min(other.x), y: self.y.min(other.y), z: self.z.min(other.z) }
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self { x: self.x.max(other.x), y: self.y.max(other.y), z: self.z.max(other.z) }
    }
    #[inline(always)]
    fn max_element(self) -> N {
        self.x.max(self.y).max(self.z)
    }
    #[inline(always)]
    fn less(self, other: Self) -> [N::Mask; 3] {
        [self.x.lt(other.x), self.y.lt(other.y), self.z.lt(other.z)]
    }
    #[inline(always)]
    fn all_le(self, other: Self) -> N::Mask {
        self.x.le(other.x) & self.y.le(other.y) & self.z.le(other.z)
    }
    #[inline(always)]
    fn select([x, y, z]: [N::Mask; 3], if_true: Self, if_false: Self) -> Self {
        Self {
            x: N::select(x, if_true.x, if_false.x),
            y: N::select(y, if_true.y, if_false.y),
            z: N::select(z, if_true.z, if_false.z),
        }
    }
}

impl<N: Fused> Columns<N> {
    /// The dot product, fused where that is free.
    #[inline(always)]
    pub(super) fn fused_dot(self, other: Self) -> N {
        self.z.times_plus(other.z, self.y.times_plus(other.y, self.x * other.x))
    }

    /// The cross product, fused where that is free: not antisymmetric to the last bit.
    #[inline(always)]
    pub(super) fn fused_cross(self, other: Self) -> Self {
        Self {
            x: self.y.times_minus(other.z, self.z * other.y),
            y: self.z.times_minus(other.x, self.x * other.z),
            z: self.x.times_minus(other.y, self.y * other.x),
        }
    }

    /// The cross product with sums in place of differences: of lengths, it bounds what the cross product may be.
    #[inline(always)]
    pub(super) fn fused_permanents(self, other: Self) -> Self {
        Self {
            x: self.y.times_plus(other.z, self.z * other.y),
            y: self.z.times_plus(other.x, self.x * other.z),
            z: self.x.times_plus(other.y, self.y * other.x),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simd::tests::levels;
    use fearless_simd::dispatch;

    /// Numbers that operations could treat differently.
    const HARD: [f64; 16] = [
        0.0,
        -0.0,
        1.0,
        -1.5,
        f64::NAN,
        f64::INFINITY,
        f64::NEG_INFINITY,
        1e-45,
        -1e-40,
        3e38,
        1.084_202_172_485_504_4e-19, // 2^-63
        3.689_348_814_741_910_3e19,  // 2^65
        2.2e-308,
        1e300,
        7.0,
        -0.1,
    ];

    /// Each operation of a lane is that of one number.
    #[inline(always)]
    fn check<T: Lanes<N>, S: Simd, const N: usize>(simd: S) {
        let number = |i: usize| T::ONE.lit(HARD[i % HARD.len()]);
        for shift in 0..HARD.len() {
            for start in (0..HARD.len()).step_by(N) {
                let a: [T; N] = core::array::from_fn(|lane| number(start + lane));
                let b: [T; N] = core::array::from_fn(|lane| number(start + lane + shift));
                let (wide_a, wide_b) = (T::load(simd, &a), T::load(simd, &b));
                let numbers = [
                    wide_a + wide_b,
                    wide_a - wide_b,
                    wide_a * wide_b,
                    wide_a / wide_b,
                    -wide_a,
                    wide_a.min(wide_b),
                    wide_a.max(wide_b),
                    wide_a.abs(),
                    wide_a.sqrt(),
                    wide_a.normalizer(),
                    wide_a.lit(0.1),
                    wide_a.largest(),
                    wide_a.large_length(),
                    Number::select(wide_a.lt(wide_b), wide_a, wide_b),
                ]
                .map(T::store::<S>);
                let masks = [
                    wide_a.lt(wide_b),
                    wide_a.le(wide_b),
                    wide_a.is_mid_range(),
                    wide_a.are_mid_range(wide_b),
                ]
                .map(T::bits::<S>);
                for (lane, (&a, &b)) in a.iter().zip(&b).enumerate() {
                    let expected = [
                        a + b,
                        a - b,
                        a * b,
                        a / b,
                        -a,
                        Number::min(a, b),
                        Number::max(a, b),
                        Number::abs(a),
                        Number::sqrt(a),
                        a.normalizer(),
                        a.lit(0.1),
                        a.largest(),
                        a.large_length(),
                        if a < b { a } else { b },
                    ];
                    for (i, (wide, expected)) in numbers.iter().zip(expected).enumerate() {
                        let (wide, expected): (f64, f64) = (wide[lane].into(), expected.into());
                        let same = wide.to_bits() == expected.to_bits();
                        assert!(same || wide.is_nan() && expected.is_nan(), "{i}: {a:?} {b:?}");
                    }
                    let expected = [a < b, a <= b, a.is_mid_range(), a.are_mid_range(b)];
                    for (i, (bits, expected)) in masks.iter().zip(expected).enumerate() {
                        assert_eq!((bits >> lane) & 1 == 1, expected, "{i}: {a:?} {b:?}");
                    }
                }
            }
        }
    }

    #[test]
    fn a_lane_computes_as_one_number_does() {
        for level in levels() {
            dispatch!(level, simd => check::<f32, _, 4>(simd));
            dispatch!(level, simd => check::<f32, _, 8>(simd));
            dispatch!(level, simd => check::<f32, _, 16>(simd));
            dispatch!(level, simd => check::<f64, _, 2>(simd));
            dispatch!(level, simd => check::<f64, _, 4>(simd));
            dispatch!(level, simd => check::<f64, _, 8>(simd));
        }
    }

    #[test]
    fn products_and_their_errors() {
        #[inline(always)]
        fn check<T: Lanes<N>, S: Simd, const N: usize>(simd: S) {
            let a = T::ONE + T::EPSILON;
            let (product, error) = splat(simd, a).two_product(splat(simd, a));
            let expected = a.two_product(a);
            assert_eq!((T::store::<S>(product)[N - 1], T::store::<S>(error)[0]), expected);
            let fused = splat(simd, a).times_minus(splat(simd, a), splat(simd, T::ONE));
            let sum = splat(simd, a).times_plus(splat(simd, a), splat(simd, T::ONE));
            let least: f64 = T::store::<S>(fused)[0].into();
            let epsilon: f64 = T::EPSILON.into();
            assert!((2.0 * epsilon..2.1 * epsilon).contains(&least));
            assert_eq!(T::store::<S>(sum)[1], a * a + T::ONE);
        }
        for level in levels() {
            dispatch!(level, simd => check::<f32, _, 8>(simd));
            dispatch!(level, simd => check::<f64, _, 4>(simd));
        }
    }
}
