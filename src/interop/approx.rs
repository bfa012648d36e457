//! approx's comparisons, number by number.
//!
//! Not by way of glam's feature, which has one name in glam 0.33 and another in 0.34; and with equal infinities close to
//! each other, which approx's absolute difference of floats, a NaN, denies.

use approx::{AbsDiffEq, RelativeEq, UlpsEq};

use crate::overlap::ConeHit;
use crate::ray::aabb::AabbHit;
use crate::ray::plane::PlaneHit;
use crate::ray::polygon::PolygonHit;
use crate::ray::sphere::SphereHit;
use crate::ray::triangle::TriangleHit;
use crate::{Aabb, Beam, Cone, Plane, Polygon, Pyramid, Ray, Scalar, Sphere, Triangle, Vector};

/// What is compared number by number, by some comparison of numbers.
trait Alike<T> {
    fn is_alike(&self, other: &Self, close: &impl Fn(T, T) -> bool) -> bool;
}

fn number<T: Scalar>(a: &T, b: &T, close: &impl Fn(T, T) -> bool) -> bool {
    a == b || close(*a, *b)
}

fn vector<V: Vector>(a: &V, b: &V, close: &impl Fn(V::Scalar, V::Scalar) -> bool) -> bool {
    (0..3).all(|axis| number(&a.component(axis), &b.component(axis), close))
}

fn vectors<V: Vector>(a: &[V], b: &[V], close: &impl Fn(V::Scalar, V::Scalar) -> bool) -> bool {
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| vector(a, b, close))
}

fn alike<T, A: Alike<T>>(a: &A, b: &A, close: &impl Fn(T, T) -> bool) -> bool {
    a.is_alike(b, close)
}

fn same<T, A: PartialEq>(a: &A, b: &A, _: &impl Fn(T, T) -> bool) -> bool {
    a == b
}

/// The three traits of a type that is [`Alike`].
macro_rules! approx {
    ([$($generics:tt)+] $type:ty, $number:ty) => {
        impl<$($generics)+> AbsDiffEq for $type
        where
            $number: AbsDiffEq<Epsilon = $number>,
        {
            type Epsilon = $number;
            fn default_epsilon() -> Self::Epsilon {
                <$number>::default_epsilon()
            }
            fn abs_diff_eq(&self, other: &Self, epsilon: Self::Epsilon) -> bool {
                self.is_alike(other, &|a, b| a.abs_diff_eq(&b, epsilon))
            }
        }

        impl<$($generics)+> RelativeEq for $type
        where
            $number: RelativeEq<Epsilon = $number>,
        {
            fn default_max_relative() -> Self::Epsilon {
                <$number>::default_max_relative()
            }
            fn relative_eq(&self, other: &Self, epsilon: Self::Epsilon, max_relative: Self::Epsilon) -> bool {
                self.is_alike(other, &|a, b| a.relative_eq(&b, epsilon, max_relative))
            }
        }

        impl<$($generics)+> UlpsEq for $type
        where
            $number: UlpsEq<Epsilon = $number>,
        {
            fn default_max_ulps() -> u32 {
                <$number>::default_max_ulps()
            }
            fn ulps_eq(&self, other: &Self, epsilon: Self::Epsilon, max_ulps: u32) -> bool {
                self.is_alike(other, &|a, b| a.ulps_eq(&b, epsilon, max_ulps))
            }
        }
    };
}

/// The traits of a struct, with how each of its fields is compared. The pattern has them all.
macro_rules! fields {
    ([$($generics:tt)+] $name:ident<$($argument:ident),+>, $number:ty { $($field:ident: $compare:ident),+ }) => {
        impl<$($generics)+> Alike<$number> for $name<$($argument),+> {
            fn is_alike(&self, other: &Self, close: &impl Fn($number, $number) -> bool) -> bool {
                let Self { $($field),+ } = self;
                $($compare($field, &other.$field, close))&&+
            }
        }

        approx!([$($generics)+] $name<$($argument),+>, $number);
    };
}

fields!([V: Vector] Ray<V>, V::Scalar { origin: vector, direction: vector, t_min: number, t_max: number });
fields!([V: Vector] Plane<V>, V::Scalar { normal: vector, offset: number });
fields!([V: Vector] Sphere<V>, V::Scalar { center: vector, radius: number });
fields!([V: Vector] Aabb<V>, V::Scalar { min: vector, max: vector });
fields!([V: Vector] Triangle<V>, V::Scalar { v0: vector, v1: vector, v2: vector });
fields!([V: Vector] Pyramid<V>, V::Scalar { apex: vector, corners: vectors, normals: vectors });
fields!([V: Vector] Cone<V>, V::Scalar { ray: alike, radius: number, spread: number });
fields!([V: Vector, const N: usize] Beam<V, N>, V::Scalar { apex: vector, base: alike });
fields!([T: Scalar] SphereHit<T>, T { t: number, leaving: same });
fields!([T: Scalar] AabbHit<T>, T { t_enter: number, t_exit: number, enter_face: same, exit_face: same });
fields!([T: Scalar] TriangleHit<T>, T { t: number, u: number, v: number, front: same });
fields!([T: Scalar] PolygonHit<T>, T { t: number, triangle: same, u: number, v: number, front: same });
fields!([T: Scalar] ConeHit<T>, T { t: number, coverage: number });

impl<V: Vector, const N: usize> Alike<V::Scalar> for Polygon<V, N> {
    fn is_alike(&self, other: &Self, close: &impl Fn(V::Scalar, V::Scalar) -> bool) -> bool {
        vectors(self.vertices(), other.vertices(), close)
    }
}

approx!([V: Vector, const N: usize] Polygon<V, N>, V::Scalar);

impl<T: Scalar> Alike<T> for PlaneHit<T> {
    fn is_alike(&self, other: &Self, close: &impl Fn(T, T) -> bool) -> bool {
        match (self, other) {
            (Self::At(a), Self::At(b)) => number(a, b, close),
            (Self::Contained, Self::Contained) => true,
            _ => false,
        }
    }
}

approx!([T: Scalar] PlaneHit<T>, T);
