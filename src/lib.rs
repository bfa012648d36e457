//! Intersection kernels for renderers: a ray against a plane, sphere, box, triangle or polygon, a triangle against a box, and
//! cones, pyramids and beams against these, on [glam]'s vectors, in `f32` and `f64`.
//!
//! **Each kernel states what it promises, and an oracle in exact arithmetic holds it to that.** The defaults for rays and triangles are exact: their
//! hit or miss is that of exact arithmetic on the given floats. Other float kernels fray at edges and vertices, and lose
//! rays between the triangles of a mesh:
//!
#![doc = include_str!("doc/corner.svg")]
//!
//! (The corner of a triangle, in light, and rays from neighbouring floats, one to a pixel: orange is a hit that exact
//! arithmetic denies, red a miss that it denies.)
//!
//! ```
//! use isect::{Aabb, Ray, Triangle, glam::Vec3};
//!
//! let triangle = Triangle::new(Vec3::ZERO, Vec3::X, Vec3::Y);
//! let ray = Ray::new(Vec3::new(0.25, 0.25, 2.0), Vec3::NEG_Z);
//! let hit = ray.intersect(&triangle).expect("it is aimed at the inside");
//! assert_eq!((hit.t, hit.u, hit.v, hit.front), (2.0, 0.25, 0.25, true));
//! assert_eq!(ray.at(hit.t), triangle.at(hit.u, hit.v));
//! assert!(!ray.before(2.0).hits(&triangle)); // a shadow ray that ends there
//! assert!(triangle.overlaps(&Aabb::new(Vec3::ZERO, Vec3::ONE)));
//! ```
//!
//! # Which kernel do I want?
//!
//! [`Ray::intersect`], [`Ray::hits`] and [`Triangle::overlaps`] take the kernel that is recommended for
//! the shape. In a loop over many shapes call a kernel by its name, and prepare the ray once.
//!
//! * **The leaf of a hierarchy**: [`ray::triangle::exact`]. Nothing leaks, whatever the boxes.
//! * **Its node**: [`ray::aabb::conservative`], with a [`ray::aabb::BoxRay`]. No box that the ray touches is missed.
//! * **Path tracing**: [`ray::triangle::exact::refine`] gives the t, u and v of the hit that is kept to the last digit,
//!   and [`spawn`] the origins of the rays that leave it. `isect::simd` has packs for wide leaves and nodes.
//! * **Shadows**: [`ray::triangle::exact::hits`]; [`ray::triangle::segura::detects`] needs no division.
//! * **Few triangles and many rays**: [`ray::triangle::badouel::Prepared`].
//! * **Picking**: [`Ray::intersect`]. [`ray::triangle::exact::classify`] also tells whether an edge or a vertex is met.
//! * **CAD**: the same, in `f64`, on [`glam::DVec3`]. Whether a point is inside of a solid is a parity:
//!   [`ray::triangle::exact::crosses`].
//! * **Voxels**: [`overlap::triangle_aabb::exact`], and [`overlap::triangle_aabb::clip`] for the part inside of one.
//! * **Culling**: a [`Pyramid`] is a view, or a part of it: [`overlap::pyramid_aabb`] and its like.
//! * **Antialiasing**: a [`Cone`] is a pixel, or what a lamp is seen through: [`overlap::cone_triangle`] and its like tell
//!   what share of it a shape covers.
//!
//! | pair | kernel | grade | ns | prepared | paper |
//! |---|---|---|--:|---|---|
//! | ray, plane | [`ray::plane`], the default | exact | | | |
//! | ray, sphere | [`ray::sphere::robust`], the default | exact; t with errors ∝ distance | | | Haines et al. 2019 |
//! | | [`ray::sphere::geometric`] | fast, errors ∝ distance² | | | Glassner 1989 |
//! | | [`ray::sphere::algebraic`] | fast, errors ∝ distance² | | | Glassner 1989 |
//! | ray, box | [`ray::aabb::exact`], the default | exact | 3.9 | [`ray::aabb::BoxRay`] | Kay & Kajiya 1986 |
//! | | [`ray::aabb::slab`] | fast | 2.7 (full hit 7.2) | [`ray::aabb::BoxRay`] | Kay & Kajiya 1986 |
//! | | [`ray::aabb::conservative`] | conservative | 2.7 (interval 3.8) | [`ray::aabb::BoxRay`] | after Ize 2013 |
//! | ray, triangle | [`ray::triangle::exact`], the default | exact | 8.3 | | after Segura & Feito 1998 |
//! | | [`ray::triangle::watertight`] | watertight | 10.3 | [`ray::triangle::watertight::ShearedRay`] | Woop et al. 2013 |
//! | | [`ray::triangle::moller_trumbore`] | fast | 8.8 | | Möller & Trumbore 1997 |
//! | | [`ray::triangle::badouel::Prepared`] | fast | 8.2 | the triangle | Badouel 1990 |
//! | | [`ray::triangle::segura`] (`detects`) | fast | 14 (9.8) | | Segura & Feito 1998 |
//! | ray, polygon | [`ray::polygon`] | fast | | | Badouel 1990 |
//! | triangle, box | [`overlap::triangle_aabb::exact`], the default | exact | 2.6–15 | | Akenine-Möller 2001 |
//! | | [`overlap::triangle_aabb::sat`] | fast | 2.5–14 | | Akenine-Möller 2001 |
//! | | [`overlap::triangle_aabb::clip`] | fast, gives the polygon | 14–102 | | Sutherland & Hodgman 1974 |
//! | pyramid, triangle | [`overlap::pyramid_triangle`] | conservative | | | Genetti et al. 1998 |
//! | pyramid, sphere | [`overlap::pyramid_sphere`] | conservative | | | Genetti et al. 1998 |
//! | pyramid, box | [`overlap::pyramid_aabb`] | conservative | | | Assarsson & Möller 2000 |
//! | beam, polygon | [`overlap::beam_polygon`] | fast, gives what is lit and what goes on | | | Heckbert & Hanrahan 1984 |
//! | cone, plane | [`overlap::cone_plane`] | conservative; covered share of the section | | | Amanatides 1984 |
//! | cone, sphere | [`overlap::cone_sphere`] | conservative; covered share | | | Amanatides 1984 |
//! | cone, box | [`overlap::cone_aabb`] | conservative; covered share | | | Amanatides 1984 |
//! | cone, triangle | [`overlap::cone_triangle`] | conservative; covered share | | | Amanatides 1984 |
//!
//! Times on `Vec3A`, one AMD EPYC core (Zen 4), the default x86-64 target; the README tells how they were measured.
//!
//! # Grades
//!
//! * **Exact**: the verdict is that of exact arithmetic on the given floats, for every finite input, and at
//!   the speed of floats: these decide wherever an error bound lets them, and integers where not. t, u and v
//!   are within a stated error bound.
//! * **Watertight**: no ray slips between two triangles that share an edge or a vertex.
//!   **Conservative**: no box that the ray touches is missed, no shape that a cone touches is, and none that touches a pyramid is
//!   outside of it.
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
//! # In your renderer
//!
//! In the traversal of another library, here of [obvhs](https://docs.rs/obvhs), a leaf asks the exact kernel:
//!
//! ```
//! use std::time::Duration;
//!
//! use isect::{Ray, Triangle, glam::Vec3A, ray::triangle::exact};
//! use obvhs::{BvhBuildParams, bvh2::builder::build_bvh2, ray::RayHit};
//!
//! let at = |z: f32| Triangle::new(Vec3A::Z * z, Vec3A::X + Vec3A::Z * z, Vec3A::Y + Vec3A::Z * z);
//! let triangles = [3.0, 1.0, 2.0].map(at);
//! let boxes = triangles.map(|triangle| obvhs::aabb::Aabb::new(triangle.aabb().min, triangle.aabb().max));
//! let bvh = build_bvh2(&boxes, BvhBuildParams::medium_build(), &mut Duration::default());
//!
//! let ray = Ray::new(Vec3A::new(0.25, 0.25, 0.0), Vec3A::Z);
//! let mut closest = RayHit::none();
//! let theirs = obvhs::ray::Ray::new(ray.origin, ray.direction, ray.t_min, ray.t_max);
//! bvh.ray_traverse(theirs, &mut closest, |theirs, place| {
//!     // The range ends at the closest t so far: by the next float, as the exact t may be beyond the rounded one.
//!     let ray = ray.with_range(ray.t_min, theirs.tmax.next_up().min(ray.t_max));
//!     let triangle = &triangles[bvh.primitive_indices[place] as usize];
//!     exact::intersect(&ray, triangle).map_or(f32::INFINITY, |hit| hit.t)
//! });
//! assert_eq!((bvh.primitive_indices[closest.primitive_id as usize], closest.t), (1, 1.0));
//! ```
//!
//! In nodes of your own the conservative box orders the children, and both kernels' ranges end at what was found:
//!
//! ```
//! use isect::ray::aabb::{BoxRay, conservative};
//! use isect::ray::triangle::{TriangleHit, exact};
//! use isect::{Aabb, Ray, Triangle, glam::Vec3A};
//!
//! enum Node {
//!     Inner([(Aabb<Vec3A>, Box<Node>); 2]),
//!     Leaf(Vec<Triangle<Vec3A>>),
//! }
//!
//! impl Node {
//!     /// `boxes` is the same ray, made once.
//!     fn closest(&self, ray: &mut Ray<Vec3A>, boxes: &mut BoxRay<Vec3A>, closest: &mut Option<TriangleHit<f32>>) {
//!         match self {
//!             Self::Inner(children) => {
//!                 let entry = |(aabb, child)| Some((conservative::interval(boxes, aabb)?[0], child));
//!                 let mut met: Vec<_> = children.iter().map(|(aabb, child)| (aabb, child)).filter_map(entry).collect();
//!                 met.sort_by(|(a, _), (b, _)| a.total_cmp(b));
//!                 for (t_enter, child) in met {
//!                     if t_enter <= boxes.t_max {
//!                         child.closest(ray, boxes, closest);
//!                     }
//!                 }
//!             }
//!             Self::Leaf(triangles) => {
//!                 for hit in triangles.iter().filter_map(|triangle| exact::intersect(ray, triangle)) {
//!                     if closest.is_none_or(|closest| hit.t < closest.t) {
//!                         *closest = Some(hit);
//!                     }
//!                 }
//!                 if let Some(hit) = closest {
//!                     ray.t_max = hit.t.next_up().min(ray.t_max);
//!                     boxes.t_max = ray.t_max;
//!                 }
//!             }
//!         }
//!     }
//! }
//!
//! let leaf = |z: f32| {
//!     let triangle = Triangle::new(Vec3A::Z * z, Vec3A::X + Vec3A::Z * z, Vec3A::Y + Vec3A::Z * z);
//!     (triangle.aabb(), Box::new(Node::Leaf(vec![triangle])))
//! };
//! let root = Node::Inner([leaf(3.0), leaf(2.0)]);
//! let mut ray = Ray::new(Vec3A::new(0.25, 0.25, 0.0), Vec3A::Z);
//! let (mut boxes, mut closest) = (BoxRay::new(&ray), None);
//! root.closest(&mut ray, &mut boxes, &mut closest);
//! assert_eq!(closest.map(|hit| hit.t), Some(2.0));
//! ```
//!
//! The repository's examples `obvhs_leaf` and `bvh_nodes` are both in full, with what keeps obvhs's boxes from losing a ray.
//! With another kernel than the exact one, inflate the boxes as [`ray::triangle::watertight::intersect`] says.
//!
//! Wide nodes and leaves take the packs of `isect::simd`. Which instructions the processor has is found out at run
//! time: dispatch once, around the whole traversal, never in a leaf.
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
//! * `serde`, `bytemuck`, `approx`, `proptest`: the traits of these crates for the shapes and hits; `isect::interop` says which,
//!   what is written of an infinity, and what is drawn.
#![cfg_attr(not(feature = "std"), no_std)]

#[cfg(not(any(feature = "std", feature = "libm")))]
compile_error!("isect needs square roots: enable the feature `std` or the feature `libm`");

#[cfg(feature = "alloc")]
extern crate alloc;

pub use glam;

mod exact;
#[cfg(any(feature = "serde", feature = "bytemuck", feature = "approx", feature = "proptest"))]
pub mod interop;
pub mod overlap;
pub mod ray;
mod shape;
#[cfg(feature = "simd")]
pub mod simd;
pub mod spawn;
#[cfg(feature = "testkit")]
pub mod testkit;
mod vector;

/// The examples of the README are tests. (A published crate has not the dev-dependency that brings the testkit.)
#[cfg(all(doctest, feature = "simd", feature = "testkit"))]
#[doc = include_str!("../README.md")]
struct Readme;

pub use ray::Intersect;
pub use shape::{Aabb, Affine, Beam, Cone, Face, Plane, Polygon, Pyramid, Ray, Sphere, Triangle};
pub use vector::{Coordinates, Mask, Number, Scalar, Vector};
