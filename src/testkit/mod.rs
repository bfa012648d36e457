//! What this crate is tested with, for a kernel of your own: an exact oracle, hard cases, and a runner that compares
//! the two (feature `testkit`, which needs `std`).
//!
//! [`Campaign`] runs a kernel over random hard cases, and over rays out of closed meshes; its [`Report`] counts the faults
//! and has a [`Case`] of each, in Rust, for a regression test.
//!
//! ```
//! use isect::glam::Vec3;
//! use isect::testkit::{Campaign, table};
//! use isect::{Ray, Triangle};
//!
//! /// Möller and Trumbore's test, with an epsilon that hides small triangles.
//! fn mine(ray: &Ray, triangle: &Triangle) -> Option<f32> {
//!     let (e1, e2) = (triangle.v1 - triangle.v0, triangle.v2 - triangle.v0);
//!     let p = ray.direction.cross(e2);
//!     let det = e1.dot(p);
//!     if det.abs() < 1e-6 {
//!         return None;
//!     }
//!     let s = ray.origin - triangle.v0;
//!     let q = s.cross(e1);
//!     let (u, v, t) = (s.dot(p) / det, ray.direction.dot(q) / det, e2.dot(q) / det);
//!     (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t >= ray.t_min && t <= ray.t_max).then_some(t)
//! }
//!
//! let campaign = Campaign::new(10_000, 1);
//! let report = campaign.ray_triangle("mine", mine).merged(campaign.leaks("mine", mine));
//! println!("{}", table(&[report.clone()]));
//! for case in &report.examples {
//!     println!("{case}\n");
//! }
//! assert!(report.false_misses > 1000 && report.leaks.at_edges.lost > 0);
//! ```
//!
//! | module | what it has |
//! |---|---|
//! | [`verdict`] | exact answers about shapes of any vector type |
//! | [`oracle`] | the same about arrays of doubles, and questions about t, u, v and sides |
//! | [`cases`] | random hard cases of any vector type |
//! | [`strategies`] | the same for proptest, with shrinking |
//! | [`generators`] | random hard cases of single-precision numbers, as arrays of doubles |
//! | [`meshes`] | closed meshes |
//! | [`shapes`] | the way from arrays of doubles to shapes and back |
//!
//! The oracle is independent of the crate's exact kernels: it counts in `i128` where a bound on the bit lengths rules
//! overflow out and in big integers elsewhere, and imports nothing of theirs.

mod answer;
mod campaign;
pub mod cases;
pub mod generators;
pub mod meshes;
pub mod oracle;
mod query;
mod report;
pub mod shapes;
pub mod strategies;
pub mod verdict;

pub use answer::{Answer, Hit};
pub use campaign::Campaign;
pub use fastrand::Rng;
pub use report::{Case, Fault, Leaks, Loss, Report, TErrors, table};
