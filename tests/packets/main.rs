//! The claims of packets and collections, held against the scalar kernels: a binary of their own, as each level of the
//! processor is compiled for each of them.

#![allow(unreachable_pub)] // the modules of one binary are public to each other

#[path = "../support/levels.rs"]
mod levels;

mod collections;
mod packets;

use fearless_simd::{Level, dispatch};
use isect::ray::triangle::TriangleHit;
use isect::simd::{Lanes, TrianglePack};
use isect::{Ray, Triangle, Vector};

/// What a leaf with one triangle finds. (Not inlined: each copy is compiled for all levels.)
#[inline(never)]
fn in_leaf<V: Vector<Scalar: Lanes<N>>, const N: usize>(
    level: Level,
    ray: &Ray<V>,
    triangle: &Triangle<V>,
) -> Option<TriangleHit<V::Scalar>> {
    let leaf = TrianglePack::<V::Scalar, N>::from_triangles(&[*triangle]);
    dispatch!(level, simd => leaf.exact(simd, ray)).get(0)
}
