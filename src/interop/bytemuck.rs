//! bytemuck's traits for the shapes that are nothing but numbers.
//!
//! The traits are unsafe to implement, and their derives do not take generic types: this is the one file of the crate with
//! the word in it. Every shape here is `repr(C)`, `Copy` and made of floats, of which any bits are a value: what is left to show is
//! that there is no padding, and the compiler sees to that.
#![allow(unsafe_code)]

use bytemuck::{AnyBitPattern, Pod, Zeroable};
use glam::{DVec3, Vec3, Vec3A};

#[cfg(feature = "simd")]
use crate::simd::{AabbPack, TrianglePack};
use crate::vector::{Coordinates, Vector};
use crate::{Aabb, Cone, Plane, Polygon, Pyramid, Ray, Sphere, Triangle};

// SAFETY: the vertices are vectors, for which zero bytes are a value by the bound, and so is 0 for their number.
unsafe impl<V: Coordinates + Zeroable, const N: usize> Zeroable for Polygon<V, N> {}

macro_rules! vectors_only {
    ($($shape:ident of $count:literal),+) => {
        $(
            // SAFETY: its fields are vectors, for which zero bytes are a value by the bound.
            unsafe impl<V: Coordinates + Zeroable> Zeroable for $shape<V> {}
            // SAFETY: its fields are vectors of one type, `Pod` by the bound, one after the other as in an array: there is
            // no padding between them or behind them.
            unsafe impl<V: Vector + Pod> Pod for $shape<V> {}

            const _: () = {
                assert!(size_of::<$shape<Vec3>>() == $count * size_of::<Vec3>());
                assert!(size_of::<$shape<Vec3A>>() == $count * size_of::<Vec3A>());
                assert!(size_of::<$shape<DVec3>>() == $count * size_of::<DVec3>());
            };
        )+
    };
}

vectors_only!(Aabb of 2, Triangle of 3, Pyramid of 9);

macro_rules! numbers_only {
    ($($shape:ident of $count:literal),+) => {
        $(
            // SAFETY: its fields are vectors and scalars, for which zero bytes are a value by the bounds.
            unsafe impl<V: Coordinates<Scalar: Zeroable> + Zeroable> Zeroable for $shape<V> {}
            // SAFETY: its fields are `f32` and vectors of them, `Pod` all, as many as it has room for.
            unsafe impl Pod for $shape<Vec3> {}
            // SAFETY: the same with `f64`.
            unsafe impl Pod for $shape<DVec3> {}
            // SAFETY: its fields are `f32` and vectors of them of which any bits are a value. The scalars do not fill
            // the last vector's width: it is padded, which this trait allows.
            unsafe impl AnyBitPattern for $shape<Vec3A> {}

            const _: () = {
                assert!(size_of::<$shape<Vec3>>() == $count * size_of::<f32>());
                assert!(size_of::<$shape<DVec3>>() == $count * size_of::<f64>());
            };
        )+
    };
}

numbers_only!(Ray of 8, Plane of 4, Sphere of 4, Cone of 10);

#[cfg(feature = "simd")]
macro_rules! lanes_only {
    ($($pack:ident of $count:literal),+) => {
        $(
            // SAFETY: its one field is an array of numbers, for which zero bytes are a value by the bound.
            unsafe impl<T: Zeroable, const N: usize> Zeroable for $pack<T, N> {}
            // SAFETY: its one field is an array of numbers, `Pod` by the bound: there is no padding.
            unsafe impl<T: Pod, const N: usize> Pod for $pack<T, N> {}

            const _: () = {
                assert!(size_of::<$pack<f32, 4>>() == $count * 4 * size_of::<f32>());
                assert!(size_of::<$pack<f64, 2>>() == $count * 2 * size_of::<f64>());
            };
        )+
    };
}

#[cfg(feature = "simd")]
lanes_only!(TrianglePack of 9, AabbPack of 6);
