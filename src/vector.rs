//! What a kernel may ask of its numbers and vectors.
//!
//! A kernel body is written once, against [`Number`] and [`Coordinates`], with masks in the place
//! of branches: a `Number` is one float or several side by side, and a comparison gives a mask with
//! as many lanes. [`Scalar`] and [`Vector`] narrow them to one float, which is what a user of the
//! crate holds: `f32` and `f64`, glam's `Vec3`, `Vec3A` and `DVec3`. All four traits are sealed.

use core::fmt::Debug;
use core::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

use glam::{
    BVec3, BVec3A, DMat4, DVec3, DVec4, Mat4, Vec3, Vec3A, Vec3Swizzles, Vec4, Vec4Swizzles,
};

pub(crate) mod sealed {
    pub trait Sealed {}
    impl Sealed for f32 {}
    impl Sealed for f64 {}
    impl Sealed for glam::Vec3 {}
    impl Sealed for glam::Vec3A {}
    impl Sealed for glam::DVec3 {}
    impl Sealed for glam::Vec4 {}
    impl Sealed for glam::DVec4 {}
}

/// The answer of a comparison: one truth value per lane.
pub trait Mask:
    Copy + Debug + BitAnd<Output = Self> + BitOr<Output = Self> + Not<Output = Self>
{
}

impl Mask for bool {}

/// A number, or several side by side in lanes, as a kernel body sees it.
///
/// Comparisons with a NaN are false, as in IEEE 754.
pub trait Number:
    sealed::Sealed
    + Copy
    + Debug
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// One truth value per lane.
    type Mask: Mask;

    /// The literal `value` in every lane. Constants come from a value, so that the lanes (and with
    /// them the processor's level) need not be named.
    #[must_use]
    fn lit(self, value: f64) -> Self;

    /// The largest finite number, in every lane.
    #[must_use]
    fn largest(self) -> Self;

    /// `self < other`
    #[must_use]
    fn lt(self, other: Self) -> Self::Mask;

    /// `self <= other`
    #[must_use]
    fn le(self, other: Self) -> Self::Mask;

    /// `if_true` where `mask` holds, `if_false` elsewhere.
    #[must_use]
    fn select(mask: Self::Mask, if_true: Self, if_false: Self) -> Self;

    /// The absolute value.
    #[must_use]
    fn abs(self) -> Self;

    /// The square root, correctly rounded; NaN of a negative number.
    #[must_use]
    fn sqrt(self) -> Self;

    /// `if self < other { self } else { other }`: a NaN in `self` is dropped, one in `other` stays.
    /// (It is what the processor's instruction does. Kernels lean on it in both directions.)
    #[must_use]
    fn min(self, other: Self) -> Self;

    /// `if self > other { self } else { other }`: a NaN in `self` is dropped, one in `other` stays.
    #[must_use]
    fn max(self, other: Self) -> Self;

    /// `(p, e)` with `p` the rounded product and `e` its rounding error: `p + e = self · other`,
    /// exactly, unless the product comes close to the ends of the exponent range.
    #[doc(hidden)]
    #[must_use]
    fn two_product(self, other: Self) -> (Self, Self);

    /// Whether the magnitude lies in the middle half of the range of exponents, from 2⁻⁶³ to 2⁶⁴
    /// (2⁻⁵¹¹ to 2⁵¹² for `f64`): where a computed sum of products does not, over- and underflow may
    /// have spoilt it.
    #[doc(hidden)]
    #[must_use]
    fn is_mid_range(self) -> Self::Mask;

    /// Whether both numbers lie in the middle half of the range of exponents.
    #[doc(hidden)]
    #[must_use]
    fn are_mid_range(self, other: Self) -> Self::Mask;

    /// 2³⁸ (2³⁰⁰ for `f64`): a length of which the cube, six times, is still far from overflow. Scaled
    /// up to it, a problem keeps the products of its small components from underflow.
    #[doc(hidden)]
    #[must_use]
    fn large_length(self) -> Self;

    /// The power of two that brings `|self|` into [1, 2), as far as it is a normal number: [1, 4)
    /// for the largest numbers, less than 1 for subnormal ones.
    #[doc(hidden)]
    #[must_use]
    fn normalizer(self) -> Self;
}

/// One float: `f32` or `f64`.
pub trait Scalar:
    Number<Mask = bool> + PartialOrd + Default + From<f32> + Into<f64> + Send + Sync + 'static
{
    /// 0
    const ZERO: Self;
    /// 1
    const ONE: Self;
    /// The distance from 1 to the next larger number, 2⁻²³ or 2⁻⁵².
    const EPSILON: Self;
    /// Positive infinity.
    const INFINITY: Self;
    /// Not a number.
    const NAN: Self;
    /// The largest finite number.
    const MAX: Self;
    /// The smallest positive normal number.
    const MIN_POSITIVE: Self;

    /// The least length that a filter reckons with, 2⁻³⁶ (2⁻³⁰⁰ for `f64`): it takes shorter vectors
    /// to be that long, so that a product of three lengths stays far above what underflow loses.
    #[doc(hidden)]
    const FILTER_FLOOR: Self;

    /// 2⁹¹ (2⁷²³): what it raises to infinity, lengths from 2³⁷ (2³⁰¹) on, is so long that a product of
    /// three may overflow.
    #[doc(hidden)]
    const FILTER_RAISE: Self;

    /// Undoes [`Self::FILTER_RAISE`], and scales by the cube root of 56·(EPSILON/2): so much is the product
    /// of three lengths so scaled, times that of the lengths.
    #[doc(hidden)]
    const FILTER_LOWER: Self;

    /// The next larger number.
    #[must_use]
    fn next_up(self) -> Self;

    /// The next smaller number.
    #[must_use]
    fn next_down(self) -> Self;

    /// Neither infinite nor NaN.
    #[must_use]
    fn is_finite(self) -> bool;

    /// `self · numerator / denominator` for two powers of two, rounded once, though their quotient may
    /// not be a float.
    #[doc(hidden)]
    #[must_use]
    #[inline]
    fn times_ratio(self, numerator: Self, denominator: Self) -> Self {
        let ratio = numerator / denominator;
        if ratio >= Self::MIN_POSITIVE && ratio.is_finite() {
            self * ratio
        } else {
            // One is below 1 and the other above: both steps go the same way.
            self * numerator / denominator
        }
    }

    /// The sum, rounded towards −∞ instead of to nearest.
    #[must_use]
    #[inline]
    fn add_down(self, other: Self) -> Self {
        let (sum, error) = two_sum(self, other);
        if error < Self::ZERO { sum.next_down() } else { sum }
    }

    /// The sum, rounded towards +∞ instead of to nearest.
    #[must_use]
    #[inline]
    fn add_up(self, other: Self) -> Self {
        let (sum, error) = two_sum(self, other);
        if error > Self::ZERO { sum.next_up() } else { sum }
    }
}

/// `(s, e)` with `s` the rounded sum and `e` its rounding error, NaN if `s` overflows (Knuth, The
/// Art of Computer Programming, volume 2, 4.2.2).
#[inline(always)]
pub(crate) fn two_sum<N: Number>(a: N, b: N) -> (N, N) {
    let sum = a + b;
    let b_part = sum - a;
    (sum, (a - (sum - b_part)) + (b - b_part))
}

macro_rules! scalar {
    ($t:ident, $mantissa_bits:literal, $exponent_bits:literal, $max_exponent:literal, $large_length:expr, $filter:expr, $sqrt:path, $two_product:path) => {
        impl Number for $t {
            type Mask = bool;

            // A literal rounds to the nearest `f32`, as one written in the code does.
            #[allow(clippy::cast_possible_truncation)]
            #[inline(always)]
            fn lit(self, value: f64) -> Self {
                value as $t
            }
            #[inline(always)]
            fn largest(self) -> Self {
                $t::MAX
            }
            #[inline(always)]
            fn lt(self, other: Self) -> bool {
                self < other
            }
            #[inline(always)]
            fn le(self, other: Self) -> bool {
                self <= other
            }
            #[inline(always)]
            fn select(mask: bool, if_true: Self, if_false: Self) -> Self {
                if mask { if_true } else { if_false }
            }
            #[inline(always)]
            fn abs(self) -> Self {
                $t::abs(self)
            }
            #[inline(always)]
            fn sqrt(self) -> Self {
                $sqrt(self)
            }
            #[inline(always)]
            fn min(self, other: Self) -> Self {
                if self < other { self } else { other }
            }
            #[inline(always)]
            fn max(self, other: Self) -> Self {
                if self > other { self } else { other }
            }
            #[inline(always)]
            fn two_product(self, other: Self) -> (Self, Self) {
                $two_product(self, other)
            }
            #[inline(always)]
            fn is_mid_range(self) -> bool {
                self.are_mid_range(self)
            }
            #[inline(always)]
            fn are_mid_range(self, other: Self) -> bool {
                // The exponent less the lowest, the sign shifted out: in the middle half the top bit
                // is clear. In integers it runs beside the arithmetic on floats.
                let lowest = ($max_exponent / 4 + 1) << ($mantissa_bits + 1);
                let above = |x: $t| (x.to_bits() << 1).wrapping_sub(lowest);
                (above(self) | above(other)) >> ($mantissa_bits + $exponent_bits) == 0
            }
            #[allow(clippy::cast_possible_truncation)] // a power of two that f32 has
            #[inline(always)]
            fn large_length(self) -> Self {
                $large_length as $t
            }
            #[inline(always)]
            fn normalizer(self) -> Self {
                let biased = (self.to_bits() >> $mantissa_bits) & $max_exponent;
                let inverse = ($max_exponent - 1 - biased.min($max_exponent - 2)).max(1);
                $t::from_bits(inverse << $mantissa_bits)
            }
        }

        #[allow(clippy::cast_possible_truncation)] // powers of two that the type has
        impl Scalar for $t {
            const ZERO: Self = 0.0;
            const ONE: Self = 1.0;
            const EPSILON: Self = $t::EPSILON;
            const INFINITY: Self = $t::INFINITY;
            const NAN: Self = $t::NAN;
            const MAX: Self = $t::MAX;
            const MIN_POSITIVE: Self = $t::MIN_POSITIVE;
            const FILTER_FLOOR: Self = pow2(-$filter.0) as $t;
            const FILTER_RAISE: Self = pow2($filter.1) as $t;
            const FILTER_LOWER: Self = ($filter.2 * pow2(-$filter.1)) as $t;

            #[inline(always)]
            fn next_up(self) -> Self {
                $t::next_up(self)
            }
            #[inline(always)]
            fn next_down(self) -> Self {
                $t::next_down(self)
            }
            #[inline(always)]
            fn is_finite(self) -> bool {
                $t::is_finite(self)
            }
        }
    };
}

/// `f64` holds the product of two `f32` exactly.
#[allow(clippy::cast_possible_truncation)] // the rounding is the point
#[inline(always)]
fn two_product_f32(a: f32, b: f32) -> (f32, f32) {
    let exact = f64::from(a) * f64::from(b);
    let product = exact as f32;
    (product, (exact - f64::from(product)) as f32)
}

/// Dekker's product with Veltkamp's splitting (T. J. Dekker, "A floating-point technique for
/// extending the available precision", 1971): needs no fused multiply-add, which the default
/// x86-64 target does not have.
#[inline(always)]
fn two_product_f64(a: f64, b: f64) -> (f64, f64) {
    let split = |x: f64| {
        let c = 134_217_729.0 * x; // 2^27 + 1
        let high = c - (c - x);
        (high, x - high)
    };
    let product = a * b;
    let (a_high, a_low) = split(a);
    let (b_high, b_low) = split(b);
    let error = a_low * b_low - (((product - a_high * b_high) - a_low * b_high) - a_high * b_low);
    (product, error)
}

#[cfg(feature = "std")]
use std::primitive::{f32 as root32, f64 as root64};

#[cfg(not(feature = "std"))]
mod root32 {
    pub(super) use libm::sqrtf as sqrt;
}
#[cfg(not(feature = "std"))]
mod root64 {
    pub(super) use libm::{acos, asinh, atan2, sqrt, tan};
}

/// The angle in [0, π] with this cosine.
pub(crate) fn acos(cosine: f64) -> f64 {
    root64::acos(cosine)
}

/// The inverse of the hyperbolic sine.
pub(crate) fn asinh(x: f64) -> f64 {
    root64::asinh(x)
}

/// The angle of the point (x, y), in [−π, π]; 0 for the point (0, 0).
pub(crate) fn atan2(y: f64, x: f64) -> f64 {
    root64::atan2(y, x)
}

/// The tangent.
pub(crate) fn tan(angle: f64) -> f64 {
    root64::tan(angle)
}

/// 2 to the power of a normal exponent.
const fn pow2(exponent: i64) -> f64 {
    f64::from_bits(((1023 + exponent) as u64) << 52)
}

scalar!(f32, 23, 8, 0xff, pow2(38), (36, 91, 0.014_944_78), root32::sqrt, two_product_f32);
scalar!(f64, 52, 11, 0x7ff, pow2(300), (300, 723, 1.838_792_7e-5), root64::sqrt, two_product_f64);

/// Three numbers x, y, z (or three times several, side by side in lanes), as a kernel body sees
/// them.
pub trait Coordinates:
    sealed::Sealed
    + Copy
    + Debug
    + Add<Output = Self>
    + Sub<Output = Self>
    + Neg<Output = Self>
    + Mul<Self::Scalar, Output = Self>
{
    /// The type of one component.
    type Scalar: Number;

    /// One truth value per component (and lane).
    type Mask3: Copy + Debug;

    /// The vector (x, y, z).
    #[must_use]
    fn new(x: Self::Scalar, y: Self::Scalar, z: Self::Scalar) -> Self;

    /// The vector (value, value, value).
    #[must_use]
    fn splat(value: Self::Scalar) -> Self;

    /// The first component.
    #[must_use]
    fn x(self) -> Self::Scalar;

    /// The second component.
    #[must_use]
    fn y(self) -> Self::Scalar;

    /// The third component.
    #[must_use]
    fn z(self) -> Self::Scalar;

    /// The product of each component with the one of `other`.
    #[must_use]
    fn scaled(self, other: Self) -> Self;

    /// The quotient of each component by the one of `other`.
    #[must_use]
    fn divided(self, other: Self) -> Self;

    /// `(x·x′ + y·y′) + z·z′`
    #[must_use]
    fn dot(self, other: Self) -> Self::Scalar;

    /// The cross product. Its six products are rounded one by one, whatever the processor: so
    /// `a.cross(b)` is the negative of `b.cross(a)` to the last bit, which a fused multiply-add
    /// would not give.
    #[must_use]
    fn cross(self, other: Self) -> Self;

    /// (y, z, x)
    #[must_use]
    fn yzx(self) -> Self;

    /// (z, x, y)
    #[must_use]
    fn zxy(self) -> Self;

    /// The absolute value of each component.
    #[must_use]
    fn abs(self) -> Self;

    /// The lesser of each two components; either of them where one is NaN.
    #[must_use]
    fn min(self, other: Self) -> Self;

    /// The greater of each two components; either of them where one is NaN.
    #[must_use]
    fn max(self, other: Self) -> Self;

    /// The greatest component, if none is NaN.
    #[must_use]
    fn max_element(self) -> Self::Scalar;

    /// The least of the components and `start`, by [`Number::min`]: NaN components are dropped, a NaN
    /// in `start` stays.
    #[must_use]
    #[inline(always)]
    fn fold_min(self, start: Self::Scalar) -> Self::Scalar {
        self.z().min(self.y().min(self.x().min(start)))
    }

    /// The greatest of the components and `start`, by [`Number::max`]: NaN components are dropped, a
    /// NaN in `start` stays.
    #[must_use]
    #[inline(always)]
    fn fold_max(self, start: Self::Scalar) -> Self::Scalar {
        self.z().max(self.y().max(self.x().max(start)))
    }

    /// Which components are less than those of `other`.
    #[must_use]
    fn less(self, other: Self) -> Self::Mask3;

    /// Whether each component is at most the one of `other`; false if one is NaN.
    #[must_use]
    fn all_le(self, other: Self) -> <Self::Scalar as Number>::Mask;

    /// The components of `if_true` where `mask` holds, of `if_false` elsewhere.
    #[must_use]
    fn select(mask: Self::Mask3, if_true: Self, if_false: Self) -> Self;
}

/// Three floats: glam's `Vec3`, `Vec3A` or `DVec3`.
pub trait Vector:
    Coordinates<Scalar: Scalar, Mask3: Send + Sync> + PartialEq + Default + Send + Sync + 'static
{
    /// (0, 0, 0)
    const ZERO: Self;
    /// (∞, ∞, ∞)
    const INFINITY: Self;
    /// (−∞, −∞, −∞)
    const NEG_INFINITY: Self;

    /// The component `axis`: 0, 1, and for anything else 2.
    #[must_use]
    #[inline(always)]
    fn component(self, axis: usize) -> Self::Scalar {
        match axis {
            0 => self.x(),
            1 => self.y(),
            _ => self.z(),
        }
    }

    /// The vector of `f` applied to each component.
    #[must_use]
    #[inline(always)]
    fn map(self, f: impl Fn(Self::Scalar) -> Self::Scalar) -> Self {
        Self::new(f(self.x()), f(self.y()), f(self.z()))
    }

    /// [`Number::normalizer`] of the largest magnitude of a component.
    #[doc(hidden)]
    #[must_use]
    #[inline(always)]
    fn normalizer(self) -> Self::Scalar {
        Coordinates::abs(self).max_element().normalizer()
    }

    /// The Euclidean length, with no over- or underflow on the way.
    #[must_use]
    #[inline]
    fn length(self) -> Self::Scalar {
        let scale = self.normalizer();
        let unit = self * scale;
        unit.dot(unit).sqrt() / scale
    }

    /// The vector times two powers of two, of which the second is at least 1: exact unless the result
    /// over- or underflows, though their product may not be a float.
    #[doc(hidden)]
    #[must_use]
    #[inline]
    fn times_powers(self, scale: Self::Scalar, large: Self::Scalar) -> Self {
        if scale > Self::Scalar::ONE { self * scale * large } else { self * (scale * large) }
    }

    /// Whether no component is infinite or NaN.
    #[must_use]
    fn is_finite(self) -> bool;

    /// Four numbers side by side.
    #[doc(hidden)]
    type Four: Four<Scalar = Self::Scalar>;

    /// The x, the y and the z of four vectors.
    #[doc(hidden)]
    #[must_use]
    fn transposed(columns: [Self; 4]) -> [Self::Four; 3];
}

/// Four numbers side by side: of four vectors the same component, so that a kernel can compute with all
/// four at once.
#[doc(hidden)]
pub trait Four:
    sealed::Sealed
    + Copy
    + Debug
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
{
    /// The type of one number.
    type Scalar;

    /// The same number four times.
    #[must_use]
    fn splat(value: Self::Scalar) -> Self;

    /// (0, 1, 2, 3)
    #[must_use]
    fn to_array(self) -> [Self::Scalar; 4];

    /// (1, 2, 3, 0)
    #[must_use]
    fn rotated(self) -> Self;

    /// (2, 3, 0, 1)
    #[must_use]
    fn rotated_twice(self) -> Self;

    /// The absolute value of each.
    #[must_use]
    fn abs(self) -> Self;

    /// The greater of each two; either of them where one is NaN.
    #[must_use]
    fn max(self, other: Self) -> Self;
}

macro_rules! four {
    ($four:ident, $scalar:ident) => {
        impl Four for $four {
            type Scalar = $scalar;
            #[inline(always)]
            fn splat(value: $scalar) -> Self {
                $four::splat(value)
            }
            #[inline(always)]
            fn to_array(self) -> [$scalar; 4] {
                $four::to_array(&self)
            }
            #[inline(always)]
            fn rotated(self) -> Self {
                Vec4Swizzles::yzwx(self)
            }
            #[inline(always)]
            fn rotated_twice(self) -> Self {
                Vec4Swizzles::zwxy(self)
            }
            #[inline(always)]
            fn abs(self) -> Self {
                $four::abs(self)
            }
            #[inline(always)]
            fn max(self, other: Self) -> Self {
                $four::max(self, other)
            }
        }
    };
}

four!(Vec4, f32);
four!(DVec4, f64);

macro_rules! vector {
    ($v:ident, $scalar:ident, $mask:ident, $four:ident, $mat:ident, $extend:expr, $cross:expr) => {
        impl Coordinates for $v {
            type Scalar = $scalar;
            type Mask3 = $mask;

            #[inline(always)]
            fn new(x: $scalar, y: $scalar, z: $scalar) -> Self {
                $v::new(x, y, z)
            }
            #[inline(always)]
            fn splat(value: $scalar) -> Self {
                $v::splat(value)
            }
            #[inline(always)]
            fn x(self) -> $scalar {
                self.x
            }
            #[inline(always)]
            fn y(self) -> $scalar {
                self.y
            }
            #[inline(always)]
            fn z(self) -> $scalar {
                self.z
            }
            #[inline(always)]
            fn scaled(self, other: Self) -> Self {
                self * other
            }
            #[inline(always)]
            fn divided(self, other: Self) -> Self {
                self / other
            }
            #[inline(always)]
            fn dot(self, other: Self) -> $scalar {
                $v::dot(self, other)
            }
            #[inline(always)]
            fn cross(self, other: Self) -> Self {
                // glam's own would fuse one product of each pair where the processor can.
                $cross(self, other)
            }
            #[inline(always)]
            fn yzx(self) -> Self {
                Vec3Swizzles::yzx(self)
            }
            #[inline(always)]
            fn zxy(self) -> Self {
                Vec3Swizzles::zxy(self)
            }
            #[inline(always)]
            fn abs(self) -> Self {
                $v::abs(self)
            }
            // glam's min, max and max_element differ in what they do with a NaN from
            // one version and processor to the next: kernels that may meet one fold.
            #[inline(always)]
            fn min(self, other: Self) -> Self {
                $v::min(self, other)
            }
            #[inline(always)]
            fn max(self, other: Self) -> Self {
                $v::max(self, other)
            }
            #[inline(always)]
            fn max_element(self) -> $scalar {
                $v::max_element(self)
            }
            #[inline(always)]
            fn less(self, other: Self) -> $mask {
                self.cmplt(other)
            }
            #[inline(always)]
            fn all_le(self, other: Self) -> bool {
                self.cmple(other).all()
            }
            #[inline(always)]
            fn select(mask: $mask, if_true: Self, if_false: Self) -> Self {
                $v::select(mask, if_true, if_false)
            }
        }

        impl Vector for $v {
            const ZERO: Self = $v::ZERO;
            const INFINITY: Self = $v::INFINITY;
            const NEG_INFINITY: Self = $v::NEG_INFINITY;

            #[inline(always)]
            fn is_finite(self) -> bool {
                $v::is_finite(self)
            }

            type Four = $four;

            #[inline(always)]
            fn transposed(columns: [Self; 4]) -> [$four; 3] {
                let [a, b, c, d] = columns.map($extend);
                let rows = $mat::from_cols(a, b, c, d).transpose();
                [rows.x_axis, rows.y_axis, rows.z_axis]
            }
        }
    };
}

vector!(Vec3, f32, BVec3, Vec4, Mat4, |v: Vec3| v.extend(0.0), Vec3::cross);
vector!(DVec3, f64, BVec3, DVec4, DMat4, |v: DVec3| v.extend(0.0), DVec3::cross);
vector!(Vec3A, f32, BVec3A, Vec4, Mat4, |v: Vec3A| v.extend(v.z), |a: Vec3A, b: Vec3A| {
    let (a_zxy, b_zxy) = (Coordinates::zxy(a), Coordinates::zxy(b));
    Coordinates::zxy(a_zxy * b - a * b_zxy)
});

#[cfg(test)]
mod tests {
    use super::*;

    /// Kernels lean on which operand's NaN is dropped.
    #[test]
    fn min_and_max_drop_a_nan_in_the_first_operand_only() {
        fn check<T: Scalar>() {
            let (one, nan) = (T::ONE, T::NAN);
            assert!(Number::min(nan, one) == one && Number::max(nan, one) == one);
            let (low, high) = (Number::min(one, nan), Number::max(one, nan));
            assert!(low.partial_cmp(&low).is_none() && high.partial_cmp(&high).is_none());
        }
        check::<f32>();
        check::<f64>();
    }

    #[test]
    fn folding_drops_components_that_are_nan() {
        fn check<V: Vector>() {
            let [zero, one] = [V::Scalar::ZERO, V::Scalar::ONE];
            let nan = V::Scalar::NAN;
            for v in [V::new(nan, one, zero), V::new(one, nan, zero), V::new(one, zero, nan)] {
                assert_eq!((v.fold_min(one + one), v.fold_max(-one)), (zero, one));
                let (low, high) = (v.fold_min(nan), v.fold_max(nan));
                assert!(low.partial_cmp(&low).is_none() && high.partial_cmp(&high).is_none());
                assert!(!v.all_le(V::INFINITY) && !V::NEG_INFINITY.all_le(v));
            }
        }
        check::<Vec3>();
        check::<Vec3A>();
        check::<DVec3>();
    }

    #[test]
    fn a_cross_product_is_antisymmetric_to_the_last_bit() {
        fn check<V: Vector>() {
            let number = |x: f64| V::Scalar::ONE.lit(x);
            let a = V::new(number(0.1), number(0.7), number(-1.3));
            let b = V::new(number(2.3), number(-0.9), number(0.3));
            assert_eq!(a.cross(b), -b.cross(a));
            assert_eq!(a.cross(a), V::ZERO);
            let axes = [
                V::new(number(1.0), number(0.0), number(0.0)),
                V::new(number(0.0), number(1.0), number(0.0)),
            ];
            assert_eq!(axes[0].cross(axes[1]), V::new(number(0.0), number(0.0), number(1.0)));
            assert_eq!(
                (axes[0].yzx(), axes[0].zxy()),
                (V::new(number(0.0), number(0.0), number(1.0)), axes[1])
            );
        }
        check::<Vec3>();
        check::<Vec3A>();
        check::<DVec3>();
    }

    #[test]
    fn the_middle_half_of_the_exponents() {
        let pow = |e| f32::from_bits(((127 + e) as u32) << 23);
        for inside in [1.0, -1.0, pow(-63), pow(64), pow(64) * 1.5] {
            assert!(inside.is_mid_range(), "{inside}");
        }
        for outside in [0.0, -0.0, 1e-45, pow(-64), -pow(65), f32::INFINITY, f32::NAN] {
            assert!(!outside.is_mid_range(), "{outside}");
            assert!(!outside.are_mid_range(1.0) && !1.0_f32.are_mid_range(outside));
        }
        assert!(
            (1e-150_f64).is_mid_range() && !(1e-160_f64).is_mid_range() && !f64::NAN.is_mid_range()
        );
    }

    #[test]
    fn a_normalizer_is_a_power_of_two() {
        for x in [1.0_f32, -3.0, 1e-30, 1e30, f32::MIN_POSITIVE] {
            let scaled = (x * x.normalizer()).abs();
            assert!((1.0..2.0).contains(&scaled), "{x}");
            assert_eq!(x.normalizer().to_bits() << 9, 0, "{x}");
        }
        assert_eq!((f32::MAX * f32::MAX.normalizer()).floor(), 3.0);
        assert_eq!(0.0_f32.normalizer(), 2.0_f32.powi(127));
        assert!((1e-45_f32 * 1e-45_f32.normalizer()) > 0.0);
        assert_eq!(10.0_f64.normalizer(), 0.125);
    }

    #[test]
    fn ratios_that_are_no_floats() {
        let (large, small) = (2.0_f32.powi(127), 2.0_f32.powi(-126));
        assert_eq!(
            1.5e-38_f32.times_ratio(large, 2.0_f32.powi(-20)),
            1.5e-38 * large * 2.0_f32.powi(20)
        );
        assert_eq!(1.5_f32.times_ratio(small, large), 0.0);
        assert_eq!(3.0_f32.times_ratio(8.0, 2.0), 12.0);
    }

    #[test]
    fn sums_are_rounded_as_told() {
        let tiny = 2.0_f32.powi(-60);
        assert_eq!((1.0_f32.add_up(tiny), 1.0_f32.add_up(-tiny)), (1.0_f32.next_up(), 1.0));
        assert_eq!((1.0_f32.add_down(tiny), 1.0_f32.add_down(-tiny)), (1.0, 1.0_f32.next_down()));
        assert_eq!((1.5_f64.add_up(0.25), 1.5_f64.add_down(0.25)), (1.75, 1.75));
        assert_eq!(f32::NEG_INFINITY.add_down(1.0), f32::NEG_INFINITY);
    }

    #[test]
    fn a_product_and_its_error() {
        let (a, b) = (1.0 + f32::EPSILON, 1.0 + f32::EPSILON);
        assert_eq!(a.two_product(b), (1.0 + 2.0 * f32::EPSILON, f32::EPSILON * f32::EPSILON));
        let (a, b) = (1.0 + f64::EPSILON, 1.0 + f64::EPSILON);
        assert_eq!(a.two_product(b), (1.0 + 2.0 * f64::EPSILON, f64::EPSILON * f64::EPSILON));
    }

    #[test]
    fn lengths_of_any_size() {
        for scale in [1.0, 1e-38, 1e38, 1e-44] {
            let length = Coordinates::abs(Vec3::new(2.0, -1.0, 2.0) * scale).length();
            let exact = 3.0 * scale;
            assert!(
                (Vector::length(Vec3::new(2.0, -1.0, 2.0) * scale) - exact).abs()
                    <= 2e-7 * exact + 2e-45
            );
            assert!(length >= 0.0);
        }
        assert_eq!(Vector::length(Vec3A::ZERO), 0.0);
    }
}
