//! Beam against polygon: what of the polygon is lit, and what of the beam goes on.
//!
//! P. S. Heckbert, P. Hanrahan, "Beam Tracing Polygonal Objects", SIGGRAPH 1984, with their concave remainders taken
//! apart into convex ones, as K. Weiler, P. Atherton, "Hidden Surface Removal Using Polygon Area Sorting", SIGGRAPH 1977,
//! would have them: everything is cut by planes through the apex (I. E. Sutherland, G. W. Hodgman, "Reentrant Polygon
//! Clipping", 1974).
//!
//! A vertex that is as close to a cutting plane as its own rounding counts as on it. So the edge that two polygons share
//! leaves no sliver between them.

use crate::shape::{Beam, Polygon, Side, height_of};
use crate::vector::{Number, Scalar, Vector};

/// A beam that is divided by what a polygon hides.
#[derive(Clone, Copy, Debug)]
pub struct Division<V: Vector, const N: usize, const M: usize> {
    /// The part that meets the polygon, with its base in the base of the whole; `None` if there is none.
    pub stopped: Option<Beam<V, N>>,
    /// Those from `len` on mean nothing.
    passing: [Beam<V, N>; M],
    len: usize,
}

impl<V: Vector, const N: usize, const M: usize> Division<V, N, M> {
    /// The parts that pass the polygon by, no more than it has edges.
    #[inline]
    #[must_use]
    pub fn passing(&self) -> &[Beam<V, N>] {
        &self.passing[..self.len]
    }
}

/// The part of the polygon that lies in the beam: what is lit. It is empty if they do not overlap, or touch along an edge at
/// the most. `None` if it has more than `M` vertices, which is more than those of the polygon and the base and one together.
///
/// The polygon is cut by the base's plane and by those through the apex and the base's edges, one after the other.
///
/// **Grade: fast.** Let s be the largest magnitude of a coordinate, u = EPSILON/2, and k the greatest |M|/|n| of the planes that cut,
/// n their normals and M the sums of the magnitudes of the terms of n's components. With a base of m vertices each
/// vertex lies within 4u·s·(m + 1) of the polygon, and no farther outside of a plane than 60u·k·s. A part of the polygon that is narrower
/// than that may be missing. Coordinates whose squares leave the range of exponents (10^±19 in `f32`, 10^±154 in `f64`) are not
/// provided for.
///
/// A NaN or infinite vertex: the empty polygon.
///
/// ```
/// use isect::{Beam, Polygon, glam::Vec3, overlap::beam_polygon};
///
/// let square = |size: f32, z: f32| {
///     let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
///     Polygon::<Vec3, 8>::new(&corners.map(|(x, y)| Vec3::new(x * size, y * size, z))).expect("four of eight")
/// };
/// let beam = Beam::new(Vec3::ZERO, square(1.0, 1.0)).expect("it has a volume");
/// let lit = beam_polygon::clip(&beam, &square(5.0, 2.0)).expect("there is room");
/// assert_eq!(lit.aabb(), square(2.0, 2.0).aabb());
/// ```
#[must_use]
pub fn clip<V: Vector, const N: usize, const M: usize>(
    beam: &Beam<V, N>,
    polygon: &Polygon<V, M>,
) -> Option<Polygon<V, M>> {
    let Some(&first) = beam.base.vertices().first() else { return Some(Polygon::EMPTY) };
    if !polygon.vertices().iter().all(|v| v.is_finite()) {
        return Some(Polygon::EMPTY);
    }
    let terms = beam.base.triangles().map(|t| Side::terms(t.v1 - t.v0, t.v2 - t.v0));
    let floor = Side::new(beam.base.normal(), terms.fold(V::ZERO, |sum, terms| sum + terms));
    let [mut lit, _] = polygon.divided(|p| floor.height(first, p))?;
    // What lies in the base itself is not lit: the beam meets it edge-on, or comes from it.
    if lit.vertices().iter().all(|&p| floor.height(first, p) <= V::Scalar::ZERO) {
        return Some(Polygon::EMPTY);
    }
    for side in beam.sides() {
        if lit.vertices().is_empty() {
            break;
        }
        [lit, _] = lit.divided(|p| side.height(beam.apex, p))?;
    }
    Some(lit)
}

/// Divides the beam by a polygon in it, the part that [`clip`] leaves of one: into the part that meets the polygon, and convex parts
/// that pass it by. `None` if a part has more than `N` vertices; that is more than those of the base and
/// the polygon together.
///
/// For each edge of the polygon, the plane through it and the apex cuts off what lies beyond; what no edge cuts off meets the
/// polygon.
///
/// **Grade: fast.** The parts of the base share their edges to the last bit: **nothing is lost or twice there**, but that each new
/// vertex may lie 4u·s beside the edge that it divides, u = EPSILON/2, s the largest magnitude of a coordinate of the
/// base. The cuts are off as [`clip`]'s vertices are. A polygon that is seen edge-on stops nothing.
///
/// A NaN or infinite vertex: nothing is stopped.
///
/// ```
/// use isect::{Beam, Polygon, glam::Vec3, overlap::beam_polygon};
///
/// let square = |size: f32, z: f32| {
///     let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
///     Polygon::<Vec3, 8>::new(&corners.map(|(x, y)| Vec3::new(x * size, y * size, z))).expect("four of eight")
/// };
/// let beam = Beam::new(Vec3::ZERO, square(1.0, 1.0)).expect("it has a volume");
/// let lit = beam_polygon::clip(&beam, &square(1.0, 2.0)).expect("there is room");
/// let division = beam_polygon::divide(&beam, &lit).expect("there is room");
/// assert_eq!(division.stopped.map(|part| part.base.area()), Some(1.0));
/// assert_eq!(division.passing().iter().map(|part| part.base.area()).sum::<f32>(), 3.0);
/// ```
#[must_use]
pub fn divide<V: Vector, const N: usize, const M: usize>(
    beam: &Beam<V, N>,
    lit: &Polygon<V, M>,
) -> Option<Division<V, N, M>> {
    let mut division = Division { stopped: None, passing: [*beam; M], len: 0 };
    let zero = V::Scalar::ZERO;
    let apex = beam.apex;
    let height = height_of(apex, lit);
    let is_seen = height.abs() > zero; // and is no NaN
    if !is_seen {
        division.len = usize::from(M > 0);
        return (M > 0).then_some(division);
    }
    let mut rest = beam.base;
    for [from, to] in lit.edges() {
        // To the left of an edge, as seen from beyond, is the polygon.
        let side = Side::through(apex, if height > zero { [from, to] } else { [to, from] });
        let [inside, outside] = rest.divided(|p| side.height(apex, p))?;
        if !outside.vertices().is_empty() {
            division.passing[division.len] = Beam { apex, base: outside };
            division.len += 1;
        }
        rest = inside;
        if rest.vertices().is_empty() {
            break;
        }
    }
    division.stopped = (!rest.vertices().is_empty()).then_some(Beam { apex, base: rest });
    Some(division)
}
