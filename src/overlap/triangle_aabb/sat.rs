//! Triangle against box by separating axes.
//!
//! T. Akenine-Möller, "Fast 3D Triangle-Box Overlap Testing", Journal of Graphics Tools 6.1, 2001.
//! With the box's bounds in place of centre and half extents, which would round.

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
/// that the verdict may be wrong. On a lattice on which the products of two differences are exact
/// (integers up to 1,024 in f32) it never is.
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
    // Only the part of the box around the triangle matters. With it the products below are as small
    // as the triangle, whatever the box.
    let (low, high) = (
        triangle.v0.min(triangle.v1.min(triangle.v2)),
        triangle.v0.max(triangle.v1.max(triangle.v2)),
    );
    let (min, max) = (low.max(aabb.min), high.min(aabb.max));
    if !(min.all_le(max) & aabb.min.all_le(aabb.max)) {
        return false;
    }
    let size = (high - low).max_element();
    if !(size * size).is_mid_range() {
        return extreme(triangle, min, max, size);
    }
    crossing_axes_overlap(triangle, min, max)
}

/// A triangle of extreme size, or a point, brought to a size of about 1 by a power of two.
#[cold]
fn extreme<V: Vector>(triangle: &Triangle<V>, min: V, max: V, size: V::Scalar) -> bool {
    let vertices: [V; 3] = (*triangle).into();
    if !vertices.iter().all(|v| v.is_finite()) {
        return false;
    }
    // Differences of coordinates, half as large so that they do not overflow.
    let scale = size.normalizer();
    let origin = min;
    let local = |p: V| (p * V::Scalar::ONE.lit(0.5) - origin * V::Scalar::ONE.lit(0.5)) * scale;
    let triangle = Triangle::from(vertices.map(local));
    crossing_axes_overlap(&triangle, local(min), local(max))
}

/// The ten axes that are not the box's own.
#[inline(always)]
fn crossing_axes_overlap<V: Vector>(triangle: &Triangle<V>, min: V, max: V) -> bool {
    let Triangle { v0, v1, v2 } = *triangle;
    let edges = [v1 - v0, v2 - v1, v0 - v2];
    let normal = edges[0].cross(-edges[2]);

    let (a, b) = (normal.scaled(min - v0), normal.scaled(max - v0));
    let (lowest, highest) = (a.min(b), a.max(b));
    let zero = V::Scalar::ZERO;
    let below = lowest.x() + lowest.y() + lowest.z();
    let above = highest.x() + highest.y() + highest.z();
    // False for NaN, which a NaN vertex brings.
    if !(below.le(zero) & zero.le(above)) {
        return false;
    }

    // The other two vertices of an edge's triangle project to 0 and to a component of its normal. That
    // is computed from each edge again: the axis is as long as the two components of the edge, and
    // so is then the error, where the one normal's would be that of the longest edges.
    let edge_overlaps = |edge: V, start: V, to_third: V| {
        // The component i of e × b is e_j·b_k − e_k·b_j.
        let (edge_yzx, edge_zxy) = (edge.yzx(), edge.zxy());
        let third = edge_yzx.scaled(to_third.zxy()) - edge_zxy.scaled(to_third.yzx());
        let (min, max) = (min - start, max - start);
        let (a, b) = (edge_yzx.scaled(min.zxy()), edge_yzx.scaled(max.zxy()));
        let (c, d) = (edge_zxy.scaled(min.yzx()), edge_zxy.scaled(max.yzx()));
        let (lowest, highest) = (a.min(b) - c.max(d), a.max(b) - c.min(d));
        lowest.all_le(third.max(V::ZERO)) & third.min(V::ZERO).all_le(highest)
    };
    edge_overlaps(edges[0], v0, -edges[2])
        & edge_overlaps(edges[1], v1, -edges[0])
        & edge_overlaps(edges[2], v2, -edges[1])
}
