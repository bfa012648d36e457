//! A shape against a shape: do they share a point?

pub mod triangle_aabb;
