//! Traits of other crates for the shapes and hits, each behind a feature of that crate's name; none is on by default.
//!
//! | feature | traits | for |
//! |---|---|---|
//! | `serde` | `Serialize`, `Deserialize` | all shapes and hits, `Face`, `Containment`, `Verdict` |
//! | `bytemuck` | `Zeroable`, and `Pod` or `AnyBitPattern` | the shapes of a fixed layout, `TrianglePack`, `AabbPack` |
//! | `approx` | `AbsDiffEq`, `RelativeEq`, `UlpsEq` | all shapes and hits |
//! | `proptest` | `Arbitrary` | all shapes, `Face` |
//!
//! # `serde`
//!
//! A shape or hit is a struct of its public fields, a vector a sequence of three numbers, as glam has it, a polygon the
//! sequence of its vertices.
//!
//! **Infinities and NaN survive.** A ray without an end, an unbounded box and the empty one hold infinities, for which JSON has no number.
//! In the formats that people read such a number is a string, `"Infinity"`, `"-Infinity"` or `"NaN"`, as in
//! the JSON of Protocol Buffers; in the others it is a float like any other. (A number that may be a string cannot be
//! read with serde_json's feature `arbitrary_precision`. And to the last bit serde_json reads an `f64` only with its feature
//! `float_roundtrip`.)
//!
//! What is read need not make sense: a zero direction, a negative radius, a NaN are accepted, as they are everywhere, and
//! are never hit. An error is
//! - a number beyond those of the scalar (1e40 for an `f32`), a missing field, a vector of other than three numbers;
//! - a [`Polygon`](crate::Polygon) of more than N vertices;
//! - a [`Beam`](crate::Beam) that [`Beam::new`](crate::Beam::new) refuses. The sides of a [`Pyramid`](crate::Pyramid) are read as
//!   they stand, as they define it.
#![cfg_attr(
    feature = "serde",
    doc = r##"
```
use isect::{Ray, glam::Vec3};

let ray = Ray::new(Vec3::ZERO, Vec3::Z);
let text = serde_json::to_string(&ray).expect("it has four fields");
assert_eq!(text, r#"{"origin":[0.0,0.0,0.0],"direction":[0.0,0.0,1.0],"t_min":0.0,"t_max":"Infinity"}"#);
assert_eq!(serde_json::from_str::<Ray>(&text).expect("it is a ray"), ray);
```
"##
)]
//!
//! # `bytemuck`
//!
//! | shape | `Vec3`, `DVec3` | `Vec3A` |
//! |---|---|---|
//! | `Aabb`, `Triangle`, `Pyramid` | `Pod` | `Pod` where glam's vector is: not in glam 0.33 where there is no SIMD |
//! | `Ray`, `Cone`, `Plane`, `Sphere` | `Pod` | `AnyBitPattern`: bytes can be read as one, but it has padding |
//!
//! `simd::TrianglePack` and `simd::AabbPack` are `Pod`. In an `AabbPack` that is made of bytes, a box of which a minimum exceeds
//! the maximum may be hit: an empty lane is one from ∞ to −∞. All of these are `Zeroable`, and so is `Polygon`, which is empty then. The
//! numbers follow each other in the order of the fields, in the byte order of the processor.
//!
//! # `approx`
//!
//! Two values are close if each number of the one is close to that of the other, by the comparison that approx has for the scalar; equal
//! numbers always are, so that two rays without an end can be. What is not a number (`front`, a face, the number of
//! vertices) has to be equal. A NaN is close to nothing.
//!
//! # `proptest`
//!
//! `any::<Ray>()` and the like draw one shape, finite and such that it can be hit; `Extent` says how far it reaches.
#![cfg_attr(
    feature = "testkit",
    doc = "\nPairs of shapes that are hard on a kernel are in [`testkit::strategies`](crate::testkit::strategies)."
)]

#[cfg(feature = "approx")]
mod approx;
#[cfg(feature = "bytemuck")]
mod bytemuck;
#[cfg(feature = "proptest")]
mod proptest;
#[cfg(feature = "serde")]
mod serde;

#[cfg(feature = "proptest")]
pub use proptest::Extent;
