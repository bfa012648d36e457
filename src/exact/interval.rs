//! Intervals of t of which the ends are floats or fractions.

use core::cmp::Ordering;

use super::grid::Parts;
use super::integer::Integer;

/// A value of t: a float, which may be infinite but not NaN, or `num / den` in the unit of the case,
/// `den` positive.
#[derive(Clone, Debug)]
pub(crate) enum Parameter<I: Integer> {
    Float(f64),
    Fraction { num: I, den: I },
}

impl<I: Integer> Parameter<I> {
    /// `num / den`; the denominator may have any sign, but is not zero.
    #[inline]
    pub(crate) fn fraction(num: I, den: I) -> Self {
        if den.sign() == Ordering::Less {
            Self::Fraction { num: num.neg(), den: den.neg() }
        } else {
            Self::Fraction { num, den }
        }
    }

    /// How the two compare, fractions being in units of 2^`unit`.
    #[inline]
    pub(crate) fn cmp(&self, other: &Self, unit: i32) -> Ordering {
        match (self, other) {
            (Self::Float(a), Self::Float(b)) => a.partial_cmp(b).unwrap_or(Ordering::Equal),
            (Self::Float(t), Self::Fraction { num, den }) => compare(*t, num, den, unit),
            (Self::Fraction { num, den }, Self::Float(t)) => compare(*t, num, den, unit).reverse(),
            (Self::Fraction { num: a, den: b }, Self::Fraction { num: c, den: d }) => {
                a.mul(d).cmp(&c.mul(b))
            }
        }
    }

    /// The nearest float or a neighbour of it: see [`Integer::quotient`].
    pub(crate) fn to_float(&self, unit: i32) -> f64 {
        match self {
            Self::Float(t) => *t,
            Self::Fraction { num, den } => num.quotient(den, unit),
        }
    }
}

/// How t compares with `num / den · 2^unit`, `den` positive.
#[inline]
fn compare<I: Integer>(t: f64, num: &I, den: &I, unit: i32) -> Ordering {
    if t.is_infinite() {
        return if t > 0.0 { Ordering::Greater } else { Ordering::Less };
    }
    let Parts { negative, mantissa, exponent } = Parts::new(t);
    I::from_limb(mantissa, negative).mul(den).cmp_shifted(exponent - unit, num)
}

/// A closed interval of t.
#[derive(Clone, Debug)]
pub(crate) struct Interval<I: Integer> {
    pub(crate) enter: Parameter<I>,
    pub(crate) exit: Parameter<I>,
    /// Fractions are in units of two to this power.
    unit: i32,
    /// Empty, whatever the ends.
    void: bool,
}

impl<I: Integer> Interval<I> {
    #[inline]
    pub(crate) fn new(t_min: f64, t_max: f64, unit: i32) -> Self {
        let (enter, exit) = (Parameter::Float(t_min), Parameter::Float(t_max));
        Self { enter, exit, unit, void: false }
    }

    #[inline]
    pub(crate) fn is_empty(&self) -> bool {
        self.void || self.enter.cmp(&self.exit, self.unit) == Ordering::Greater
    }

    #[inline]
    pub(crate) fn contains(&self, t: &Parameter<I>) -> bool {
        !self.void
            && self.enter.cmp(t, self.unit) != Ordering::Greater
            && t.cmp(&self.exit, self.unit) != Ordering::Greater
    }

    /// Keeps the t with `at_zero + t · slope ≥ 0`.
    #[inline]
    pub(crate) fn clip(&mut self, at_zero: &I, slope: &I) {
        match slope.sign() {
            Ordering::Greater => {
                let root = Parameter::fraction(at_zero.neg(), slope.clone());
                if root.cmp(&self.enter, self.unit) == Ordering::Greater {
                    self.enter = root;
                }
            }
            Ordering::Less => {
                let root = Parameter::fraction(at_zero.neg(), slope.clone());
                if root.cmp(&self.exit, self.unit) == Ordering::Less {
                    self.exit = root;
                }
            }
            Ordering::Equal => self.void |= at_zero.sign() == Ordering::Less,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::integer::Narrow;
    use super::*;

    fn int(x: f64) -> Narrow {
        Narrow::from_float(x, 0)
    }

    #[test]
    fn floats_and_fractions_are_ordered() {
        let line = [f64::NEG_INFINITY, -2.0, -0.375, 0.0, 1e-3, 7.0, f64::INFINITY];
        for a in line {
            for b in line {
                let expected = a.partial_cmp(&b).expect("no NaN");
                let as_fraction = |x: f64| {
                    // In units of 1/4.
                    let parts = Parts::new(x).reduced();
                    let (up, down) = (parts.exponent + 2, -parts.exponent - 2);
                    Parameter::<Narrow>::fraction(
                        Narrow::from_limb(parts.mantissa, !parts.negative)
                            .shl(up.max(0).unsigned_abs()),
                        int(-1.0).shl(down.max(0).unsigned_abs()),
                    )
                };
                let (p, q) = (Parameter::Float(a), Parameter::Float(b));
                assert_eq!(p.cmp(&q, -2), expected);
                if b.is_finite() {
                    assert_eq!(p.cmp(&as_fraction(b), -2), expected, "{a} {b}");
                    assert_eq!(as_fraction(b).cmp(&p, -2), expected.reverse(), "{a} {b}");
                    assert_eq!(as_fraction(b).to_float(-2), b);
                }
                if a.is_finite() && b.is_finite() {
                    assert_eq!(as_fraction(a).cmp(&as_fraction(b), -2), expected, "{a} {b}");
                }
            }
        }
    }

    #[test]
    fn clipping_keeps_a_closed_interval() {
        let whole = Interval::<Narrow>::new(f64::NEG_INFINITY, f64::INFINITY, 0);
        let mut point = whole.clone();
        point.clip(&int(-6.0), &int(4.0));
        point.clip(&int(6.0), &int(-4.0));
        assert!(!point.is_empty() && point.contains(&Parameter::Float(1.5)));
        assert!(!point.contains(&Parameter::Float(1.5_f64.next_up())));
        point.clip(&int(-3.0), &int(2.0));
        assert!(!point.is_empty());
        point.clip(&int(-4.0), &int(2.0));
        assert!(point.is_empty());
        let mut nothing = whole;
        nothing.clip(&int(0.0), &int(0.0));
        assert!(!nothing.is_empty());
        nothing.clip(&int(-1.0), &int(0.0));
        assert!(nothing.is_empty() && !nothing.contains(&Parameter::Float(0.0)));
    }
}
