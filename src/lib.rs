//! Intersection kernels for renderers: a ray or a cone against a plane, sphere, box or triangle, and a triangle
//! against a box, on [glam]'s vectors, in `f32` and `f64`.
//!
//! **Each kernel states what it promises, and an oracle in exact arithmetic holds it to that.**
//!
//! ```
//! use isect::{Ray, Triangle, glam::Vec3};
//!
//! let triangle = Triangle::new(Vec3::ZERO, Vec3::X, Vec3::Y);
//! let ray = Ray::new(Vec3::new(0.25, 0.25, 2.0), Vec3::NEG_Z);
//! let hit = ray.intersect(&triangle).expect("it is aimed at the inside");
//! assert_eq!((hit.t, hit.u, hit.v, hit.front), (2.0, 0.25, 0.25, true));
//! assert_eq!(ray.at(hit.t), triangle.at(hit.u, hit.v));
//! ```
//!
//! # Which kernel
//!
//! [`Ray::intersect`], [`Ray::hits`] and [`Triangle::overlaps`] take the kernel that is recommended for
//! the shape. In a loop over many shapes call a kernel by its name, and prepare the ray once.
//!
//! | pair | kernel | grade | prepared | paper |
//! |---|---|---|---|---|
//! | ray, plane | [`ray::plane`], the default | exact | | |
//! | ray, sphere | [`ray::sphere::robust`], the default | exact; t with errors ∝ distance | | Haines et al. 2019 |
//! | | [`ray::sphere::geometric`] | fast, errors ∝ distance² | | Glassner 1989 |
//! | | [`ray::sphere::algebraic`] | fast, errors ∝ distance² | | Glassner 1989 |
//! | ray, box | [`ray::aabb::exact`], the default | exact | [`ray::aabb::BoxRay`] | Kay & Kajiya 1986 |
//! | | [`ray::aabb::slab`] | fast | [`ray::aabb::BoxRay`] | Kay & Kajiya 1986 |
//! | | [`ray::aabb::conservative`] | conservative | [`ray::aabb::BoxRay`] | after Ize 2013 |
//! | ray, triangle | [`ray::triangle::exact`], the default | exact | | after Segura & Feito 1998 |
//! | | [`ray::triangle::watertight`] | watertight | [`ray::triangle::watertight::ShearedRay`] | Woop et al. 2013 |
//! | | [`ray::triangle::moller_trumbore`] | fast | | Möller & Trumbore 1997 |
//! | | [`ray::triangle::badouel`] | fast | [`ray::triangle::badouel::Prepared`] | Badouel 1990 |
//! | | [`ray::triangle::segura`] | fast, without a division | | Segura & Feito 1998 |
//! | ray, polygon | [`ray::polygon`] | fast | | Badouel 1990 |
//! | triangle, box | [`overlap::triangle_aabb::exact`], the default | exact | | Akenine-Möller 2001 |
//! | | [`overlap::triangle_aabb::sat`] | fast | | Akenine-Möller 2001 |
//! | | [`overlap::triangle_aabb::clip`] | fast, gives the polygon | | Sutherland & Hodgman 1974 |
//! | pyramid, triangle | [`overlap::pyramid_triangle`] | conservative | | Genetti et al. 1998 |
//! | pyramid, sphere | [`overlap::pyramid_sphere`] | conservative | | Genetti et al. 1998 |
//! | pyramid, box | [`overlap::pyramid_aabb`] | conservative | | Assarsson & Möller 2000 |
//! | beam, polygon | [`overlap::beam_polygon`] | fast, gives what is lit and what goes on | | Heckbert & Hanrahan 1984 |
//! | cone, plane | [`overlap::cone_plane`] | conservative; covered share of the section | | Amanatides 1984 |
//! | cone, sphere | [`overlap::cone_sphere`] | conservative; covered share | | Amanatides 1984 |
//! | cone, box | [`overlap::cone_aabb`] | conservative; covered share | | Amanatides 1984 |
//! | cone, triangle | [`overlap::cone_triangle`] | conservative; covered share | | Amanatides 1984 |
//!
//! # Grades
//!
//! * **Exact**: the verdict is that of exact arithmetic on the given floats, for every finite input, and at
//!   the speed of floats: these decide wherever an error bound lets them, and integers where not. t, u and v
//!   are within a stated error bound.
//! * **Watertight**: no ray slips between two triangles that share an edge or a vertex.
//!   **Conservative**: no box that the ray touches is missed, no shape that touches a pyramid is outside of it.
//! * **Fast**: t, u and v are within a stated error bound of the exact ones; near an edge, within that
//!   bound, the verdict may be wrong, and a ray may slip between two triangles.
//!
//! # Conventions
//!
//! * All sets are closed: a ray along a face, through an edge or at a vertex hits. So is the range of
//!   t: a ray that starts on a surface hits it at t = 0 (see [`spawn`]), and with `t_max` set to the closest t
//!   so far a later shape may win a tie (compare with `<`, or use [`Ray::before`]).
//! * The exact kernels compare the exact t with the ends of the range, not the rounded one that they
//!   report: a hit may lie just outside of a range that begins or ends at its own t. The others compare
//!   the t that they report.
//! * Shapes have two sides. [`ray::triangle::TriangleHit::front`] tells which one; to cull, filter on it.
//! * Directions have any length but zero, and t counts in units of it.
//! * No tolerance is absolute: with all coordinates multiplied by a power of two every verdict is the
//!   same, up to the ends of the range of exponents. Kernels whose products leave its middle start
//!   again with a scaled problem; what the stated error bounds do not count is underflow within it, of
//!   components that are smaller than the others by many powers of ten.
//! * Bad input is a miss: a zero direction, an empty box, a NaN or infinite coordinate (but the bounds
//!   of a box may be infinite), an empty range. Nothing panics, and no hit holds a NaN.
//! * A triangle without area is the segment or the point that it is to [`ray::triangle::exact`] and the
//!   kernels of [`overlap`]. The other ray kernels miss it (the watertight one may still hit one that is not
//!   flat as it sees it, so that it closes the gap between its neighbours).
//!
//! # Generic code
//!
//! Shapes and kernels are generic over [`Vector`]: `Vec3`, `Vec3A` or `DVec3`; `Vec3` is the default.
//! `Vec3A` is the fastest. The numbers of a vector are its [`Scalar`].
//!
//! # Features
//!
//! * `std` (default): square roots from the standard library, and `alloc`.
//! * `alloc`: [`Intersect`] for `Box` and `Arc`, and the collections of `isect::simd`.
//! * `libm`: square roots without the standard library.
//! * `simd` (default): `isect::simd`, packs of triangles and boxes, packets of rays, and collections, for the width of
//!   the processor, which is found out at run time.
//! * `testkit`: `isect::testkit`, the exact oracle, hard cases and a runner, to test kernels with.
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
#[cfg(feature = "simd")]
pub mod simd;
pub mod spawn;
#[cfg(feature = "testkit")]
pub mod testkit;
mod vector;

/// The examples of the README are tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

pub use ray::Intersect;
pub use shape::{Aabb, Affine, Beam, Cone, Face, Plane, Polygon, Pyramid, Ray, Sphere, Triangle};
pub use vector::{Coordinates, Mask, Number, Scalar, Vector};
