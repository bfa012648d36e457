//! The shapes: data and constructors only. Their public path is the root of the crate.

mod aabb;
mod affine;
mod beam;
mod cone;
mod plane;
mod polygon;
mod pyramid;
mod ray;
mod sphere;
mod triangle;

pub use aabb::{Aabb, Face};
pub use affine::Affine;
pub use beam::Beam;
pub(crate) use beam::{Side, height_of};
pub use cone::Cone;
pub use plane::Plane;
pub use polygon::Polygon;
pub use pyramid::Pyramid;
pub use ray::Ray;
pub use sphere::Sphere;
pub use triangle::Triangle;

/// Conversions between `Vec3` and `Vec3A`, and from `f32` to `f64`: none of them loses a bit. The fields are vectors,
/// then scalars, then arrays of vectors.
macro_rules! lossless {
    ($shape:ident { $($vector:ident),+ $(; $($scalar:ident),* $(; $($array:ident),+)?)? }) => {
        lossless!(@ $shape, glam::Vec3, glam::Vec3A, glam::Vec3A::from, [$($vector)+] [$($($scalar)*)?] [$($($($array)+)?)?]);
        lossless!(@ $shape, glam::Vec3A, glam::Vec3, glam::Vec3::from, [$($vector)+] [$($($scalar)*)?] [$($($($array)+)?)?]);
        lossless!(@ $shape, glam::Vec3, glam::DVec3, |v: glam::Vec3| v.as_dvec3(), [$($vector)+] [$($($scalar)*)?] [$($($($array)+)?)?]);
        lossless!(@ $shape, glam::Vec3A, glam::DVec3, |v: glam::Vec3A| v.as_dvec3(), [$($vector)+] [$($($scalar)*)?] [$($($($array)+)?)?]);
    };
    (@ $shape:ident, $from:ty, $to:ty, $convert:expr, [$($vector:ident)+] [$($scalar:ident)*] [$($array:ident)*]) => {
        impl From<$shape<$from>> for $shape<$to> {
            #[inline]
            fn from(shape: $shape<$from>) -> Self {
                let convert = $convert;
                Self {
                    $($vector: convert(shape.$vector),)+
                    $($scalar: shape.$scalar.into(),)*
                    $($array: shape.$array.map(convert),)*
                }
            }
        }
    };
}

lossless!(Ray { origin, direction; t_min, t_max });
lossless!(Plane { normal; offset });
lossless!(Sphere { center; radius });
lossless!(Aabb { min, max });
lossless!(Triangle { v0, v1, v2 });
lossless!(Pyramid { apex;; corners, normals });

/// The same for a cone, of which the ray converts by itself.
macro_rules! lossless_cone {
    ($($from:ty => $to:ty),+) => {
        $(impl From<Cone<$from>> for Cone<$to> {
            #[inline]
            fn from(Cone { ray, radius, spread }: Cone<$from>) -> Self {
                Self { ray: ray.into(), radius: radius.into(), spread: spread.into() }
            }
        })+
    };
}

lossless_cone!(
    glam::Vec3 => glam::Vec3A,
    glam::Vec3A => glam::Vec3,
    glam::Vec3 => glam::DVec3,
    glam::Vec3A => glam::DVec3
);
