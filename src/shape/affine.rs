//! glam's affine maps, as far as the shapes need them.

use glam::{Affine3, Affine3A, DAffine3, DMat4, DVec3, Mat4, Vec3, Vec3A};

use crate::vector::Vector;

/// An affine map of space: glam's `Affine3`, `Affine3A`, `Mat4` for `Vec3` and `Vec3A`, and
/// `DAffine3`, `DMat4` for `DVec3`.
///
/// The last row of a 4 × 4 matrix is taken to be (0, 0, 0, 1): a projection is not affine.
pub trait Affine<V: Vector> {
    /// The images of the three unit vectors, then the translation.
    #[must_use]
    fn columns(&self) -> [V; 4];

    /// The image of a point.
    #[must_use]
    #[inline]
    fn point(&self, point: V) -> V {
        self.vector(point) + self.columns()[3]
    }

    /// The image of a vector: of a difference of points, which a translation leaves alone.
    #[must_use]
    #[inline]
    fn vector(&self, vector: V) -> V {
        let [x, y, z, _] = self.columns();
        x * vector.x() + y * vector.y() + z * vector.z()
    }
}

macro_rules! affine {
    ($map:ident, [$($v:ident),+], $linear:ident) => {
        $(impl Affine<$v> for $map {
            #[inline]
            fn columns(&self) -> [$v; 4] {
                let m = self.$linear;
                [m.x_axis.into(), m.y_axis.into(), m.z_axis.into(), self.translation.into()]
            }
        })+
    };
    ($map:ident, [$($v:ident),+]) => {
        $(impl Affine<$v> for $map {
            #[inline]
            fn columns(&self) -> [$v; 4] {
                let column = |c: usize| self.col(c).truncate().into();
                [column(0), column(1), column(2), column(3)]
            }
        })+
    };
}

affine!(Affine3, [Vec3, Vec3A], matrix3);
affine!(Affine3A, [Vec3, Vec3A], matrix3);
affine!(DAffine3, [DVec3], matrix3);
affine!(Mat4, [Vec3, Vec3A]);
affine!(DMat4, [DVec3]);
