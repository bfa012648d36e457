//! Intersection kernels.
#![cfg_attr(not(feature = "std"), no_std)]

#[cfg(not(any(feature = "std", feature = "libm")))]
compile_error!("isect needs square roots: enable the feature `std` or the feature `libm`");

#[cfg(feature = "alloc")]
extern crate alloc;

pub use glam;

mod exact;
pub mod overlap;
pub mod ray;
mod shape;
mod vector;

pub use ray::Intersect;
pub use shape::{Aabb, Affine, Face, Plane, Ray, Sphere, Triangle};
pub use vector::{Coordinates, Mask, Number, Scalar, Vector};
