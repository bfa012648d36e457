//! The tests of this crate as a library: exact answers, hard cases, closed meshes (feature `testkit`).

pub mod generators;
pub mod meshes;
pub mod oracle;
