//! What the tests share: the list of kernels, their error bounds, what `classify` owes, and the testkit.

pub mod bounds;
pub mod kernels;
pub mod levels;
pub mod verdicts;

pub use isect::testkit::shapes::{aabb, array, name, ray, scalar, sphere, triangle, vector};
pub use isect::testkit::{generators, meshes, oracle};

/// Runs a generic check with all three vector types.
macro_rules! for_every_vector {
    ($check:ident $(, $argument:expr)*) => {
        $check::<isect::glam::Vec3>($($argument),*);
        $check::<isect::glam::Vec3A>($($argument),*);
        $check::<isect::glam::DVec3>($($argument),*);
    };
}
pub(crate) use for_every_vector;
