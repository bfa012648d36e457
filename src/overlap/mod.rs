//! A shape against a shape: do they share a point?
//!
//! A cone also asks where, and how much of it is covered: [`ConeHit`].

pub mod beam_polygon;
mod cone;
pub mod cone_aabb;
pub mod cone_plane;
pub mod cone_sphere;
pub mod cone_triangle;
mod pyramid;
pub mod pyramid_aabb;
pub mod pyramid_sphere;
pub mod pyramid_triangle;
pub mod triangle_aabb;

pub use cone::ConeHit;

/// Where a shape lies with respect to a solid one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Containment {
    /// They share no point.
    Outside,
    /// Neither of the others, or too close to one to be certain.
    Partial,
    /// Every point of the shape is one of the solid's.
    Inside,
}
