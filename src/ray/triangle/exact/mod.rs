//! Ray against triangle, decided exactly.
//!
//! The verdict is that of exact arithmetic on the given floats, for every finite input: whether the
//! closed ray and the closed triangle, as sets of points, have one in common, and where on the
//! triangle. Signs of volumes decide, as in [`super::segura`], in stages: floats with an error bound
//! (`filter`), for `f32` the same in `f64`, then integers of a fixed capacity (`decide`).
//!
//! H. Edelsbrunner, E. P. Mücke, "Simulation of Simplicity", ACM Transactions on Graphics 9.1, 1990,
//! gave [`crosses`] its idea.

mod decide;
mod filter;

use glam::DVec3;

use super::TriangleHit;
use crate::exact::wide;
use crate::shape::{Ray, Triangle};
use crate::vector::{Number, Scalar, Vector};
use decide::{Location, Problem};
use filter::Undecided;

/// Where a ray meets a triangle. Edge i joins vertex i to vertex i + 1 (modulo 3).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Verdict {
    /// They have no point in common.
    Miss,
    /// In one point inside, off the edges.
    Interior,
    /// In one point of this edge, off the vertices.
    Edge(u8),
    /// In this vertex.
    Vertex(u8),
    /// The ray lies in the plane of the triangle (along it, if the triangle is a segment) and touches
    /// it.
    Coplanar,
}

/// Where the ray meets the triangle, in the closed range of the ray.
///
/// With e1 = v1 − v0, e2 = v2 − v0, s = o − v0: t = −s·n/d·n with n = e1 × e2, u = det(s, e2, d)/d·n and
/// v = det(e1, s, d)/d·n, if the signs of the three weights, and t in the range, are certain. If not, see
/// [`classify`] and [`refine`].
///
/// **Grade: exact**: a hit exactly if the closed ray and the closed triangle have a point in common,
/// for every finite input; a triangle without area is the segment or the point that it is.
/// Let P(a, b, c) be the sum of the magnitudes of the six terms of a·(b × c) and u' = EPSILON/2. To
/// first order u is off by at most 8u'·(P(s, d, e2) + |u|·P(d, e1, e2))/|d·n|, v by
/// 8u'·(P(s, d, e1) + |v|·P(d, e1, e2))/|d·n|, and t by 9u'·(P(s, e1, e2) + |t|·P(d, e1, e2))/|d·n|. Where
/// the bound leaves the verdict open they come from `f64`, with its u' and rounded once more, or are those
/// of [`refine`]. t is in the range, and the largest float where it is beyond that.
///
/// A zero direction, a NaN or infinite field, an empty range: a miss.
///
/// ```
/// use isect::{Ray, Triangle, glam::Vec3, ray::triangle::exact};
///
/// let triangle = Triangle::new(Vec3::ZERO, Vec3::X, Vec3::Y);
/// let ray = Ray::new(Vec3::new(0.25, 0.5, 3.0), Vec3::NEG_Z);
/// let hit = exact::intersect(&ray, &triangle).expect("it is aimed at the inside");
/// assert_eq!((hit.t, hit.u, hit.v, hit.front), (3.0, 0.25, 0.5, true));
/// // The vertex is of the triangle, the next float is not.
/// let at = |x| Ray::new(Vec3::new(x, 0.0, 1.0), Vec3::NEG_Z);
/// assert!(exact::intersect(&at(1.0), &triangle).is_some());
/// assert!(exact::intersect(&at(1.0_f32.next_up()), &triangle).is_none());
/// ```
#[inline]
#[must_use]
pub fn intersect<V: Vector>(
    ray: &Ray<V>,
    triangle: &Triangle<V>,
) -> Option<TriangleHit<V::Scalar>> {
    filter::decide(ray, triangle).unwrap_or_else(|Undecided| undecided(ray, triangle))
}

/// The later stages, which decide any case.
#[cold]
#[inline(never)]
pub(crate) fn undecided<V: Vector>(
    ray: &Ray<V>,
    triangle: &Triangle<V>,
) -> Option<TriangleHit<V::Scalar>> {
    if let Ok(hit) = decide_in_f64(ray, triangle) {
        return hit
            .map(|TriangleHit { t, u, v, front }| rounded(ray, &Location { t, u, v, front }));
    }
    let location = Problem::new(ray, triangle)?.locate()?;
    Some(rounded(ray, &location))
}

/// The filter in `f64`, for a case that is not in `f64` anyway.
fn decide_in_f64<V: Vector>(
    ray: &Ray<V>,
    triangle: &Triangle<V>,
) -> Result<Option<TriangleHit<f64>>, Undecided> {
    if size_of::<V::Scalar>() < size_of::<f64>() {
        filter::decide(&wide_ray(ray), &wide_triangle(triangle))
    } else {
        Err(Undecided)
    }
}

/// The side of a hit that a filter is certain of.
#[inline]
fn decide_front<V: Vector>(
    ray: &Ray<V>,
    triangle: &Triangle<V>,
) -> Result<Option<bool>, Undecided> {
    match filter::decide(ray, triangle) {
        Ok(hit) => Ok(hit.map(|hit| hit.front)),
        Err(Undecided) => decide_in_f64(ray, triangle).map(|hit| hit.map(|hit| hit.front)),
    }
}

/// Which stage decides a case, for measurements: 0 is the filter, 1 the one in `f64`, 2 are the
/// integers.
#[doc(hidden)]
#[must_use]
pub fn stage<V: Vector>(ray: &Ray<V>, triangle: &Triangle<V>) -> usize {
    if filter::decide(ray, triangle).is_ok() {
        0
    } else {
        1 + usize::from(decide_in_f64(ray, triangle).is_err())
    }
}

fn wide_ray<V: Vector>(ray: &Ray<V>) -> Ray<DVec3> {
    let (t_min, t_max) = (ray.t_min.into(), ray.t_max.into());
    Ray { origin: wide(ray.origin), direction: wide(ray.direction), t_min, t_max }
}

fn wide_triangle<V: Vector>(triangle: &Triangle<V>) -> Triangle<DVec3> {
    Triangle::new(wide(triangle.v0), wide(triangle.v1), wide(triangle.v2))
}

/// The hit at a point of the ray's range.
fn rounded<V: Vector>(ray: &Ray<V>, location: &Location) -> TriangleHit<V::Scalar> {
    let Location { t, u, v, front } = *location;
    let zero = V::Scalar::ZERO;
    TriangleHit { t: ray.nearest_in_range(t), u: zero.lit(u), v: zero.lit(v), front }
}

/// Where the ray meets the triangle, in the closed range of the ray: on which part of it.
///
/// With a_i = v_i − o and s_i = (a_(i+1) × a_(i+2))·d, the line passes inside if no two of the s_i
/// have opposite signs, through the edge across from vertex i if s_i = 0; t = (a_0·n) / Σ s_i is
/// compared as a fraction. If Σ s_i = d·n = 0 but n ≠ 0, the line lies in the plane if a_0·n = 0, and
/// the three edges clip its range there.
///
/// A triangle without area is the segment or the point that it is. Of a segment, a crossing at
/// the place of a vertex is the [`Verdict::Vertex`] of the lowest index there, another the
/// [`Verdict::Edge`] of the lowest index that contains it; a ray along the segment is
/// [`Verdict::Coplanar`]. A point is [`Verdict::Vertex`] 0.
///
/// **Grade: exact**, for every finite input.
///
/// A zero direction, a NaN or infinite field, an empty range: [`Verdict::Miss`].
///
/// ```
/// use isect::{Ray, Triangle, glam::Vec3, ray::triangle::exact::{Verdict, classify}};
///
/// let triangle = Triangle::new(Vec3::ZERO, Vec3::X, Vec3::Y);
/// let down = |x, y| classify(&Ray::new(Vec3::new(x, y, 1.0), Vec3::NEG_Z), &triangle);
/// assert_eq!(down(0.25, 0.25), Verdict::Interior);
/// assert_eq!(down(0.5, 0.5), Verdict::Edge(1));
/// assert_eq!(down(0.0, 1.0), Verdict::Vertex(2));
/// assert_eq!(down(0.5, 0.500_000_06), Verdict::Miss);
/// ```
#[must_use]
pub fn classify<V: Vector>(ray: &Ray<V>, triangle: &Triangle<V>) -> Verdict {
    match filter::decide(ray, triangle) {
        Ok(Some(_)) => Verdict::Interior,
        Ok(None) => Verdict::Miss,
        Err(Undecided) => undecided_verdict(ray, triangle),
    }
}

/// Hit or miss by the later stages.
#[inline(always)]
pub(crate) fn undecided_hits<V: Vector>(ray: &Ray<V>, triangle: &Triangle<V>) -> bool {
    undecided_verdict(ray, triangle) != Verdict::Miss
}

/// The later stages, without t, u and v.
#[cold]
#[inline(never)]
fn undecided_verdict<V: Vector>(ray: &Ray<V>, triangle: &Triangle<V>) -> Verdict {
    match decide_in_f64(ray, triangle) {
        Ok(Some(_)) => Verdict::Interior,
        Ok(None) => Verdict::Miss,
        Err(Undecided) => Problem::new(ray, triangle).map_or(Verdict::Miss, |p| p.classify()),
    }
}

/// Whether the ray meets the triangle, in the closed range of the ray: the verdict of [`intersect`].
///
/// **Grade: exact**; and like it false for a zero direction, a NaN or infinite field, an empty range.
///
/// ```
/// use isect::{Ray, Triangle, glam::Vec3, ray::triangle::exact};
///
/// let triangle = Triangle::new(Vec3::ZERO, Vec3::X, Vec3::Y);
/// let ray = Ray::new(Vec3::new(0.5, 0.5, 1.0), Vec3::NEG_Z);
/// assert!(exact::hits(&ray, &triangle) && exact::hits(&ray.with_range(1.0, 1.0), &triangle));
/// assert!(!exact::hits(&ray.before(1.0), &triangle));
/// ```
#[must_use]
pub fn hits<V: Vector>(ray: &Ray<V>, triangle: &Triangle<V>) -> bool {
    match filter::decide(ray, triangle) {
        Ok(hit) => hit.is_some(),
        Err(Undecided) => undecided_hits(ray, triangle),
    }
}

/// Where a ray that hits a triangle does so, to the last digits: for the closest hit, once it is found.
///
/// t = (a_0·n) / (d·n), u = s_1 / Σ s, v = s_2 / Σ s, as in [`classify`], divided but once. A ray in the
/// triangle's plane, or a triangle without area, has the first common point in the range: its t, and
/// weights with which the vertices make that point; `front` is false.
///
/// **Grade: exact**: t is within an ulp of the exact one (0.51, but for subnormal numbers), u and v within
/// an ulp of theirs; where the exact one is a float, it is that. A t beyond the largest float is that, and none
/// lies outside of the range.
///
/// A ray that misses: zeros.
///
/// ```
/// use isect::{Ray, Triangle, glam::Vec3, ray::triangle::exact};
///
/// let triangle = Triangle::new(Vec3::ZERO, Vec3::X * 3.0, Vec3::Y * 3.0);
/// let ray = Ray::new(Vec3::new(1.0, 1.0, 7.0), Vec3::new(0.0, 0.0, -0.7));
/// let hit = exact::refine(&ray, &triangle);
/// assert_eq!((hit.t, hit.u, hit.v, hit.front), (10.0, 1.0 / 3.0, 1.0 / 3.0, true));
/// ```
#[must_use]
pub fn refine<V: Vector>(ray: &Ray<V>, triangle: &Triangle<V>) -> TriangleHit<V::Scalar> {
    let zero = V::Scalar::ZERO;
    let location = Problem::new(ray, triangle).and_then(|problem| problem.locate());
    let none = TriangleHit { t: zero, u: zero, v: zero, front: false };
    location.map_or(none, |location| rounded(ray, &location))
}

/// Whether the ray crosses the triangle, for counting: each edge and vertex of a closed mesh belongs to
/// exactly one of the triangles around it. `Some(true)` is a crossing against the normal, from the front,
/// `Some(false)` one along it.
///
/// The ray is moved by δ = (ε, ε², ε³), with an ε > 0 below any number that could matter: the same δ for all
/// triangles and rays. Then no line goes through an edge or a vertex, and none lies in a triangle's plane:
/// s_i becomes s_i − δ·(e_i × d), e_i the edge, and where s_i is zero the first component of e_i × d that
/// is not decides. The range moves along: t becomes t − δ·n/(d·n), so that no crossing is at an
/// end of it. (Simulation of simplicity.)
///
/// **Grade: exact.** Of a closed mesh, of which each edge joins two triangles that run along it in opposite
/// directions, a line crosses as many triangles from the front as from the back; a ray from a point
/// off the mesh crosses, in all, an odd number of times exactly if the point is inside; so does one from a
/// point on it, which counts as the moved point, and one through edges, vertices or along faces. Two
/// ranges that end and begin at the same t share no crossing and lose none.
///
/// A ray parallel to the triangle's plane, a triangle without area, a zero direction, a NaN or infinite
/// field, an empty range: `None`.
///
/// ```
/// use isect::{Ray, Triangle, glam::Vec3, ray::triangle::exact::crosses};
///
/// // Two halves of a square, and a ray at the edge between them.
/// let [a, b, c, d] = [Vec3::ZERO, Vec3::X, Vec3::new(1.0, 1.0, 0.0), Vec3::Y];
/// let ray = Ray::new(Vec3::new(0.5, 0.5, 1.0), Vec3::NEG_Z);
/// let halves = [Triangle::new(a, b, c), Triangle::new(a, c, d)];
/// let crossings: Vec<bool> = halves.iter().filter_map(|half| crosses(&ray, half)).collect();
/// assert_eq!(crossings, [true]);
/// ```
#[must_use]
pub fn crosses<V: Vector>(ray: &Ray<V>, triangle: &Triangle<V>) -> Option<bool> {
    match decide_front(ray, triangle) {
        Ok(front) => front,
        Err(Undecided) => Problem::new(ray, triangle)?.crosses(),
    }
}
