//! The shapes: data and constructors only. Their public path is the root of the crate.

mod aabb;
mod affine;
mod plane;
mod ray;
mod sphere;
mod triangle;

pub use aabb::{Aabb, Face};
pub use affine::Affine;
pub use plane::Plane;
pub use ray::Ray;
pub use sphere::Sphere;
pub use triangle::Triangle;

/// Conversions between `Vec3` and `Vec3A`, and from `f32` to `f64`: none of them loses a bit.
macro_rules! lossless {
    ($shape:ident { $($vector:ident),+ $(; $($scalar:ident),+)? }) => {
        lossless!(@ $shape, glam::Vec3, glam::Vec3A, glam::Vec3A::from, [$($vector)+] [$($($scalar)+)?]);
        lossless!(@ $shape, glam::Vec3A, glam::Vec3, glam::Vec3::from, [$($vector)+] [$($($scalar)+)?]);
        lossless!(@ $shape, glam::Vec3, glam::DVec3, |v: glam::Vec3| v.as_dvec3(), [$($vector)+] [$($($scalar)+)?]);
        lossless!(@ $shape, glam::Vec3A, glam::DVec3, |v: glam::Vec3A| v.as_dvec3(), [$($vector)+] [$($($scalar)+)?]);
    };
    (@ $shape:ident, $from:ty, $to:ty, $convert:expr, [$($vector:ident)+] [$($scalar:ident)*]) => {
        impl From<$shape<$from>> for $shape<$to> {
            #[inline]
            fn from(shape: $shape<$from>) -> Self {
                let convert = $convert;
                Self { $($vector: convert(shape.$vector),)+ $($scalar: shape.$scalar.into(),)* }
            }
        }
    };
}

lossless!(Ray { origin, direction; t_min, t_max });
lossless!(Plane { normal; offset });
lossless!(Sphere { center; radius });
lossless!(Aabb { min, max });
lossless!(Triangle { v0, v1, v2 });
