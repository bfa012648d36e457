//! Triangle against box by separating axes, decided exactly.
//!
//! The axes are those of [`super::sat`] (T. Akenine-Möller, "Fast 3D Triangle-Box Overlap Testing", 2001),
//! in stages: floats with an error bound, the same in `f64`, then integers of a fixed capacity.

use core::cmp::Ordering;

use glam::DVec3;

use super::sat::{Part, edge_margins, edges, plane_margin};
use crate::exact::grid::Grid;
use crate::exact::integer::{Capacity, Integer, Large, Narrow, Small, cross, sub};
use crate::exact::wide;
use crate::shape::{Aabb, Triangle};
use crate::vector::{Number, Scalar, Vector};

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
#[inline]
#[must_use]
pub fn overlaps<V: Vector>(triangle: &Triangle<V>, aabb: &Aabb<V>) -> bool {
    let Some(part) = Part::around(triangle, aabb) else { return false };
    certain::<V, false>(triangle, &part).unwrap_or_else(|| undecided(triangle, &part))
}

/// The later stages.
#[cold]
#[inline(never)]
fn undecided<V: Vector>(triangle: &Triangle<V>, part: &Part<V>) -> bool {
    let vertices: [V; 3] = (*triangle).into();
    if !vertices.iter().all(|v| v.is_finite()) {
        return false;
    }
    certain_in_f64(triangle, part).unwrap_or_else(|| {
        let [min, max] = [part.min, part.max].map(|p| wide(p).to_array());
        decide(vertices.map(|v| wide(v).to_array()), [min, max])
    })
}

/// The verdict with the bounds of `f64`, and without the axes that decide nothing.
fn certain_in_f64<V: Vector>(triangle: &Triangle<V>, part: &Part<V>) -> Option<bool> {
    let triangle = Triangle::from(<[V; 3]>::from(*triangle).map(wide));
    let part = Part::around(&triangle, &Aabb::new(wide(part.min), wide(part.max)))?;
    certain::<DVec3, true>(&triangle, &part)
}

/// Which stage decides a case, for measurements: 0 are floats, 1 is `f64`, 2 are integers.
#[doc(hidden)]
#[must_use]
pub fn stage<V: Vector>(triangle: &Triangle<V>, aabb: &Aabb<V>) -> usize {
    Part::around(triangle, aabb).map_or(0, |part| {
        if certain::<V, false>(triangle, &part).is_some() {
            0
        } else {
            1 + usize::from(certain_in_f64(triangle, &part).is_none())
        }
    })
}

/// The verdict of the ten axes that are not the box's own, if it is certain.
///
/// Let u be EPSILON/2 and s the longest side of the triangle's bounds, in which the part of the box lies
/// as well: all differences of coordinates are at most s. On the axes of an edge a margin has four
/// monomials of at most s², each with 5 roundings (of two differences, a product and two sums): it is off
/// by at most 20u·s². The normal has components of at most 2s², with 4 roundings; the plane's margin is
/// the sum of three products of them with a difference, with 4 more: at most 8u·6s³ = 48u·s³. Those are
/// taken as 32u·s² and 64u·s³, which covers terms of second order. Where s² lies in the middle half of
/// the range of exponents, nothing overflows, and what underflow loses is far below that.
#[inline(always)]
fn certain<V: Vector, const CROSSING: bool>(
    triangle: &Triangle<V>,
    part: &Part<V>,
) -> Option<bool> {
    let square = part.size * part.size;
    if !square.is_mid_range() {
        return None;
    }
    let edges = edges(triangle);
    let bound = square * (V::Scalar::EPSILON * square.lit(16.0));
    // The plane of a flat triangle is parallel to a face of the box.
    let flat = CROSSING && !V::splat(V::Scalar::ZERO.next_up()).all_le(part.extent);
    if !flat {
        let margin = plane_margin(triangle, &edges, part);
        if !is_positive(margin, bound * (part.size + part.size))? {
            return Some(false);
        }
    }
    let margins = edge_margins::<V, CROSSING>(triangle, &edges, part);
    let margin = margins.x().min(margins.y()).min(margins.z());
    is_positive(margin, bound)
}

/// Whether a number that is off by at most the bound is positive or negative, if that is certain; it never
/// is of a NaN.
#[inline(always)]
fn is_positive<T: Scalar>(computed: T, bound: T) -> Option<bool> {
    (computed.abs() > bound).then_some(computed > T::ZERO)
}

/// The ten axes that are not the box's own, for a box inside of the triangle's.
#[cold]
fn decide(vertices: [[f64; 3]; 3], [min, max]: [[f64; 3]; 2]) -> bool {
    // The bounds of the box are coordinates of the triangle, or lie between them.
    let grid = Grid::through(vertices.as_flattened())
        .joined(Grid::through(&min))
        .joined(Grid::through(&max));
    // The normal times a difference, and three of these.
    match Capacity::of(3 * grid.bits() + 6) {
        Capacity::Narrow => crossing_axes_overlap::<Narrow>(grid, vertices, min, max),
        Capacity::Small => crossing_axes_overlap::<Small>(grid, vertices, min, max),
        Capacity::Large => crossing_axes_overlap::<Large>(grid, vertices, min, max),
    }
}

fn crossing_axes_overlap<I: Integer>(
    grid: Grid,
    vertices: [[f64; 3]; 3],
    min: [f64; 3],
    max: [f64; 3],
) -> bool {
    let v = vertices.map(|v| grid.vector::<I>(v));
    let (min, max) = (grid.vector::<I>(min), grid.vector::<I>(max));
    let edges = [sub(&v[1], &v[0]), sub(&v[2], &v[1]), sub(&v[0], &v[2])];
    let normal = cross(&edges[0], &edges[1]);
    let boxes = v.each_ref().map(|v| [sub(&min, v), sub(&max, v)]);

    // The products of n with a corner, least and greatest.
    let [x, y, z] = [0, 1, 2].map(|k| products(&normal[k], &boxes[0], k));
    let zero = I::ZERO;
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
fn products<I: Integer>(factor: &I, [min, max]: &[[I; 3]; 2], k: usize) -> [I; 2] {
    let (at_min, at_max) = (factor.mul(&min[k]), factor.mul(&max[k]));
    if factor.sign() == Ordering::Less { [at_max, at_min] } else { [at_min, at_max] }
}

/// Whether two closed intervals overlap.
#[inline]
fn overlap<I: Integer>([first, last]: &[I; 2], low: &I, high: &I) -> bool {
    first.cmp(high) != Ordering::Greater && low.cmp(last) != Ordering::Greater
}
