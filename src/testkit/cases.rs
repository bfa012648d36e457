//! Random hard cases of any vector type.
//!
//! They are those of [`super::generators`], in part multiplied by powers of two (up to 2^±60, or 2^±900 in double precision)
//! and in double precision by a third as well, which fills the mantissas. One number of one case in 32 is replaced by any at
//! all: NaN, an infinity, random bits.
//!
//! ```
//! use isect::glam::DVec3;
//! use isect::testkit::{Rng, cases, verdict};
//!
//! let mut rng = Rng::with_seed(1);
//! let hits = (0..1000).filter(|_| {
//!     let (ray, triangle) = cases::ray_triangle::<DVec3>(&mut rng);
//!     verdict::ray_triangle(&ray, &triangle).hits()
//! });
//! assert!((300..700).contains(&hits.count()));
//! ```

use fastrand::Rng;

use super::query::random;
use crate::{Aabb, Plane, Ray, Sphere, Triangle, Vector};

/// A ray and a plane in which it lies, or at a point of which it is aimed.
#[must_use]
pub fn ray_plane<V: Vector>(rng: &mut Rng) -> (Ray<V>, Plane<V>) {
    random(rng)
}

/// A ray and a sphere at whose centre, inside or silhouette it is aimed.
#[must_use]
pub fn ray_sphere<V: Vector>(rng: &mut Rng) -> (Ray<V>, Sphere<V>) {
    random(rng)
}

/// A ray and a box at whose faces, edges and corners it is aimed.
#[must_use]
pub fn ray_aabb<V: Vector>(rng: &mut Rng) -> (Ray<V>, Aabb<V>) {
    random(rng)
}

/// A ray and a triangle at whose inside, edges and vertices it is aimed.
#[must_use]
pub fn ray_triangle<V: Vector>(rng: &mut Rng) -> (Ray<V>, Triangle<V>) {
    random(rng)
}

/// A triangle and a box that it touches or nearly touches.
#[must_use]
pub fn triangle_aabb<V: Vector>(rng: &mut Rng) -> (Triangle<V>, Aabb<V>) {
    random(rng)
}
