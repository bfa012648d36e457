//! Triangle against box by separating axes, decided exactly.
//!
//! The axes are those of [`super::sat`]; integers of a fixed capacity hold the projections.

use core::cmp::Ordering;

use crate::exact::grid::Grid;
use crate::exact::integer::{Int, LARGE, SMALL, cross, is_small, sub};
use crate::shape::{Aabb, Triangle};
use crate::vector::Vector;

/// Whether the triangle and the box share a point: no axis of 13 separates them.
///
/// The axes are the box's three normals, the triangle's normal n, and the cross products of the
/// box's axes with the triangle's edges, as in [`super::sat::overlaps`].
///
/// **Grade: exact**, for every finite triangle and every box, whose bounds may be infinite.
///
/// An empty box, a NaN, an infinite vertex: `false`.
///
/// ```
/// use isect::{Aabb, Triangle, glam::Vec3, overlap::triangle_aabb::exact};
///
/// let aabb = Aabb::new(Vec3::ZERO, Vec3::ONE);
/// let triangle = Triangle::new(Vec3::X * 3.0, Vec3::Y * 3.0, Vec3::Z * 3.0);
/// assert!(exact::overlaps(&triangle, &aabb), "a corner of the box lies in its plane");
/// let shorter = Aabb::new(Vec3::ZERO, Vec3::new(1.0, 1.0, 1.0_f32.next_down()));
/// assert!(!exact::overlaps(&triangle, &shorter));
/// ```
#[must_use]
pub fn overlaps<V: Vector>(triangle: &Triangle<V>, aabb: &Aabb<V>) -> bool {
    let vertices: [V; 3] = (*triangle).into();
    if !vertices.iter().all(|v| v.is_finite()) {
        return false;
    }
    // Only the part of the box in that of the triangle matters, and it is finite.
    let bounds = triangle.aabb();
    let (min, max) = (bounds.min.max(aabb.min), bounds.max.min(aabb.max));
    // The bounds of an empty box may enclose the triangle's from outside.
    aabb.min.all_le(aabb.max)
        && min.all_le(max)
        && decide(vertices.map(array), [array(min), array(max)])
}

fn array<V: Vector>(v: V) -> [f64; 3] {
    [v.x().into(), v.y().into(), v.z().into()]
}

/// The ten axes that are not the box's own, for a box inside of the triangle's.
#[cold]
fn decide(vertices: [[f64; 3]; 3], [min, max]: [[f64; 3]; 2]) -> bool {
    // The bounds of the box are coordinates of the triangle, or lie between them.
    let grid = Grid::through(vertices.as_flattened())
        .joined(Grid::through(&min))
        .joined(Grid::through(&max));
    // The normal times a difference, and three of these.
    if is_small(3 * grid.bits() + 6) {
        crossing_axes_overlap::<SMALL>(grid, vertices, min, max)
    } else {
        crossing_axes_overlap::<LARGE>(grid, vertices, min, max)
    }
}

fn crossing_axes_overlap<const L: usize>(
    grid: Grid,
    vertices: [[f64; 3]; 3],
    min: [f64; 3],
    max: [f64; 3],
) -> bool {
    let v = vertices.map(|v| grid.vector::<L>(v));
    let (min, max) = (grid.vector::<L>(min), grid.vector::<L>(max));
    let edges = [sub(&v[1], &v[0]), sub(&v[2], &v[1]), sub(&v[0], &v[2])];
    let normal = cross(&edges[0], &edges[1]);
    let boxes = v.each_ref().map(|v| [sub(&min, v), sub(&max, v)]);

    // The products of n with a corner, least and greatest.
    let [x, y, z] = [0, 1, 2].map(|k| products(&normal[k], &boxes[0], k));
    let zero = Int::ZERO;
    if !overlap(&[x[0].add(&y[0]).add(&z[0]), x[1].add(&y[1]).add(&z[1])], &zero, &zero) {
        return false;
    }
    // On an axis across edge e, the triangle covers the interval between 0 and a component of n: the
    // component i of e × b is e_j·b_k − e_k·b_j.
    (0..3).all(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        let (low, high) = match normal[i].sign() {
            Ordering::Less => (&normal[i], &zero),
            _ => (&zero, &normal[i]),
        };
        edges.iter().zip(&boxes).all(|(edge, bounds)| {
            let (a, b) = (products(&edge[j], bounds, k), products(&edge[k], bounds, j));
            overlap(&[a[0].sub(&b[1]), a[1].sub(&b[0])], low, high)
        })
    })
}

/// A factor times a component of the box's corners: the least and the greatest product.
#[inline]
fn products<const L: usize>(
    factor: &Int<L>,
    [min, max]: &[[Int<L>; 3]; 2],
    k: usize,
) -> [Int<L>; 2] {
    let (at_min, at_max) = (factor.mul(&min[k]), factor.mul(&max[k]));
    if factor.sign() == Ordering::Less { [at_max, at_min] } else { [at_min, at_max] }
}

/// Whether two closed intervals overlap.
#[inline]
fn overlap<const L: usize>([first, last]: &[Int<L>; 2], low: &Int<L>, high: &Int<L>) -> bool {
    first.cmp(high) != Ordering::Greater && low.cmp(last) != Ordering::Greater
}
