//! Triangle against box by separating axes.
//!
//! T. Akenine-Möller, "Fast 3D Triangle-Box Overlap Testing", Journal of Graphics Tools 6.1, 2001.
//! With the box's bounds in place of centre and half extents, which would round. Two convex shapes are apart exactly if
//! their shadows on some axis are; of a triangle and a box 13 axes are enough to ask.
//!
#![doc = include_str!("../../doc/axes.svg")]

use crate::shape::{Aabb, Triangle};
use crate::vector::{Number, Scalar, Vector};

/// Whether the triangle and the box share a point: no axis of 13 separates them.
///
/// The axes are the box's three normals, the triangle's normal n, and the cross products of the
/// box's axes with the triangle's edges. Relative to an edge's first vertex, the triangle covers
/// [min(0, n), max(0, n)] on that edge's axes (each component for one axis), and the box covers
/// the interval of e × b, b from `min` to `max`.
///
/// **Grade: fast.** The box's axes are decided exactly. On the nine of the edges the distance between
/// triangle and box is off by at most 16u·s, u = EPSILON/2, s the largest magnitude of a coordinate of
/// the triangle; on the normal by 16u·s·|e1||e2|/|n|, which is large for a needle. Nearer to a touch than
/// that the verdict may be wrong. On a lattice on which sums of products of three differences are exact
/// (integers up to 88 in f32, up to 72,000 in f64) it never is.
///
/// An empty box, a NaN, an infinite vertex: `false`. Infinite bounds of the box are fine.
///
/// ```
/// use isect::{Aabb, Triangle, glam::Vec3, overlap::triangle_aabb::sat};
///
/// let aabb = Aabb::new(Vec3::ZERO, Vec3::ONE);
/// let touching = Triangle::new(Vec3::ONE, Vec3::new(2.0, 1.0, 1.0), Vec3::new(1.0, 2.0, 3.0));
/// let past_the_edge = Triangle::new(Vec3::X * 2.5, Vec3::Y * 2.5, Vec3::new(2.5, 2.5, 1.0));
/// assert!(sat::overlaps(&touching, &aabb));
/// assert!(!sat::overlaps(&past_the_edge, &aabb));
/// ```
#[inline]
#[must_use]
pub fn overlaps<V: Vector>(triangle: &Triangle<V>, aabb: &Aabb<V>) -> bool {
    let Some(part) = Part::around(triangle, aabb) else { return false };
    if !(part.size * part.size).is_mid_range() {
        return extreme(triangle, &part);
    }
    crossing_axes_overlap(triangle, &part)
}

/// The part of a box that lies in the bounds of the triangle. Only that part matters, and with it the
/// products below are as small as the triangle, whatever the box.
pub(super) struct Part<V: Vector> {
    pub(super) min: V,
    pub(super) max: V,
    /// The sides of the triangle's bounds.
    pub(super) extent: V,
    /// The longest of them.
    pub(super) size: V::Scalar,
}

impl<V: Vector> Part<V> {
    /// `None` if one of the box's own axes separates it from the triangle, which is decided exactly, or
    /// if the box is empty.
    #[inline(always)]
    pub(super) fn around(triangle: &Triangle<V>, aabb: &Aabb<V>) -> Option<Self> {
        let (low, high) = (
            triangle.v0.min(triangle.v1.min(triangle.v2)),
            triangle.v0.max(triangle.v1.max(triangle.v2)),
        );
        let (min, max) = (low.max(aabb.min), high.min(aabb.max));
        if !(min.all_le(max) & aabb.min.all_le(aabb.max)) {
            return None;
        }
        let extent = high - low;
        Some(Self { min, max, extent, size: extent.max_element() })
    }
}

/// A triangle of extreme size, or a point, brought to a size of about 1 by a power of two.
#[cold]
fn extreme<V: Vector>(triangle: &Triangle<V>, part: &Part<V>) -> bool {
    let vertices: [V; 3] = (*triangle).into();
    if !vertices.iter().all(|v| v.is_finite()) {
        return false;
    }
    // Differences of coordinates, half as large so that they do not overflow.
    let scale = part.size.normalizer();
    let half = V::Scalar::ONE.lit(0.5);
    let local = |p: V| (p * half - part.min * half) * scale;
    let triangle = Triangle::from(vertices.map(local));
    let part = Part { min: local(part.min), max: local(part.max), ..*part };
    crossing_axes_overlap(&triangle, &part)
}

/// The ten axes that are not the box's own.
#[inline(always)]
fn crossing_axes_overlap<V: Vector>(triangle: &Triangle<V>, part: &Part<V>) -> bool {
    let edges = edges(triangle);
    // False for NaN, which a NaN vertex brings.
    V::Scalar::ZERO.le(plane_margin(triangle, &edges, part))
        && V::ZERO.all_le(edge_margins::<V, false>(triangle, &edges, part))
}

/// From each vertex to the next.
#[inline(always)]
pub(super) fn edges<V: Vector>(triangle: &Triangle<V>) -> [V; 3] {
    let Triangle { v0, v1, v2 } = *triangle;
    [v1 - v0, v2 - v1, v0 - v2]
}

/// How far the box reaches across the triangle's plane, times the normal's length; negative if it
/// lies on one side.
#[inline(always)]
pub(super) fn plane_margin<V: Vector>(
    triangle: &Triangle<V>,
    edges: &[V; 3],
    part: &Part<V>,
) -> V::Scalar {
    let normal = edges[0].cross(-edges[2]);
    let (a, b) = (normal.scaled(part.min - triangle.v0), normal.scaled(part.max - triangle.v0));
    let (lowest, highest) = (a.min(b), a.max(b));
    let below = lowest.x() + lowest.y() + lowest.z();
    let above = highest.x() + highest.y() + highest.z();
    (-below).min(above)
}

/// How far triangle and box reach into each other on the axes that are the cross products of an edge
/// with x, with y and with z, times the length of that axis: the least of the three edges' margins.
/// Negative if an axis separates them.
///
/// `CROSSING` leaves out (with the largest float for a margin) those axes that are parallel to one of
/// the box's own, or zero: the part of the box overlaps the triangle on them.
#[inline(always)]
pub(super) fn edge_margins<V: Vector, const CROSSING: bool>(
    triangle: &Triangle<V>,
    edges: &[V; 3],
    part: &Part<V>,
) -> V {
    // The edge itself projects to 0, the vertex across to a component of the triangle's normal. That is
    // computed from each edge again: the axis is as long as the two components of the edge, and so
    // is then the error, where the one normal's would be that of the longest edges.
    let margins = |edge: V, start: V, to_third: V| {
        // The component i of e × b is e_j·b_k − e_k·b_j.
        let (edge_yzx, edge_zxy) = (edge.yzx(), edge.zxy());
        let third = edge_yzx.scaled(to_third.zxy()) - edge_zxy.scaled(to_third.yzx());
        let (min, max) = (part.min - start, part.max - start);
        let (a, b) = (edge_yzx.scaled(min.zxy()), edge_yzx.scaled(max.zxy()));
        let (c, d) = (edge_zxy.scaled(min.yzx()), edge_zxy.scaled(max.yzx()));
        let (lowest, highest) = (a.min(b) - c.max(d), a.max(b) - c.min(d));
        let margins = (third.max(V::ZERO) - lowest).min(highest - third.min(V::ZERO));
        if CROSSING {
            let crossing = edge_yzx.abs().min(edge_zxy.abs());
            V::select(V::ZERO.less(crossing), margins, V::splat(V::Scalar::MAX))
        } else {
            margins
        }
    };
    margins(edges[0], triangle.v0, -edges[2])
        .min(margins(edges[1], triangle.v1, -edges[0]))
        .min(margins(edges[2], triangle.v2, -edges[1]))
}
