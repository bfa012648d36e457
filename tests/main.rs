//! The claims of the library, one file each, held against exact arithmetic.
//!
//! `cargo test` runs them all; `cargo test --test suite watertight` runs one.

#![allow(unreachable_pub)] // the modules of one binary are public to each other

mod support;

mod bad_input;
mod beam;
mod bounds;
mod cone;
mod conservative;
mod docs;
mod exact;
mod hard_suites;
mod mass;
mod metamorphic;
mod obvhs;
mod overlap;
mod packs;
mod properties;
mod pyramid;
mod spawn;
mod watertight;
