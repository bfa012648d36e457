//! What kernels answer: yes or no, a t, or a hit of this crate's.

use crate::Scalar;
use crate::ray::aabb::AabbHit;
use crate::ray::plane::PlaneHit;
use crate::ray::sphere::SphereHit;
use crate::ray::triangle::TriangleHit;

/// A kernel's answer: `bool`, or `Option` of a [`Hit`].
pub trait Answer<T> {
    /// Whether it is a hit.
    fn is_hit(&self) -> bool;

    /// The hit's t, if the answer tells.
    fn t(&self) -> Option<T>;

    /// Whether any number of it is NaN.
    fn has_nan(&self) -> bool;
}

impl<T> Answer<T> for bool {
    fn is_hit(&self) -> bool {
        *self
    }

    fn t(&self) -> Option<T> {
        None
    }

    fn has_nan(&self) -> bool {
        false
    }
}

impl<T, H: Hit<T>> Answer<T> for Option<H> {
    fn is_hit(&self) -> bool {
        self.is_some()
    }

    fn t(&self) -> Option<T> {
        self.as_ref().and_then(Hit::t)
    }

    fn has_nan(&self) -> bool {
        self.as_ref().is_some_and(Hit::has_nan)
    }
}

/// What a kernel tells of a hit: nothing, its t as a scalar, or a hit of this crate's. Implement it for a hit of your own.
pub trait Hit<T> {
    /// The first t in the ray's range that both shapes have in common, if the hit tells.
    fn t(&self) -> Option<T>;

    /// Whether any number of it is NaN.
    fn has_nan(&self) -> bool;
}

impl<T> Hit<T> for () {
    fn t(&self) -> Option<T> {
        None
    }

    fn has_nan(&self) -> bool {
        false
    }
}

impl Hit<Self> for f32 {
    fn t(&self) -> Option<Self> {
        Some(*self)
    }

    fn has_nan(&self) -> bool {
        self.is_nan()
    }
}

impl Hit<Self> for f64 {
    fn t(&self) -> Option<Self> {
        Some(*self)
    }

    fn has_nan(&self) -> bool {
        self.is_nan()
    }
}

fn is_nan<T: Scalar>(x: T) -> bool {
    x.into().is_nan()
}

impl<T: Scalar> Hit<T> for TriangleHit<T> {
    fn t(&self) -> Option<T> {
        Some(self.t)
    }

    fn has_nan(&self) -> bool {
        [self.t, self.u, self.v].into_iter().any(is_nan)
    }
}

impl<T: Scalar> Hit<T> for SphereHit<T> {
    fn t(&self) -> Option<T> {
        Some(self.t)
    }

    fn has_nan(&self) -> bool {
        is_nan(self.t)
    }
}

impl<T: Scalar> Hit<T> for PlaneHit<T> {
    fn t(&self) -> Option<T> {
        match self {
            Self::At(t) => Some(*t),
            Self::Contained => None,
        }
    }

    fn has_nan(&self) -> bool {
        self.t().is_some_and(is_nan)
    }
}

impl<T: Scalar> Hit<T> for AabbHit<T> {
    fn t(&self) -> Option<T> {
        Some(self.t_enter)
    }

    fn has_nan(&self) -> bool {
        [self.t_enter, self.t_exit].into_iter().any(is_nan)
    }
}
