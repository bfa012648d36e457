//! Closed triangle against closed box, decided twice: by separating axes and by clipping.

use num_bigint::BigInt;

use super::integer::{Grid, Integer, Ratio, Vector, cross, dot, sub};
use super::{fits_i128, is_box, is_finite};

/// Whether a closed triangle touches a closed box: no axis among the 13 candidates separates them.
///
/// Infinite bounds leave the box open on that side; an empty box or a vertex that is not finite gives `false`.
#[must_use]
pub fn triangle_aabb_sat(vertices: [[f64; 3]; 3], min: [f64; 3], max: [f64; 3]) -> bool {
    if !is_finite(&vertices) || !is_box(min, max) {
        return false;
    }
    let (min, max) = bounded(vertices, min, max);
    let grid = grid(vertices, min, max);
    // The normal has 2p + 3 bits, the projections on it p + 2 more.
    if fits_i128(3 * grid.bits + 5) {
        overlap_by_axes::<i128>(vertices, min, max, grid)
    } else {
        overlap_by_axes::<BigInt>(vertices, min, max, grid)
    }
}

/// Whether a closed triangle touches a closed box: something is left of the triangle after a cut at each face.
///
/// Infinite bounds leave the box open on that side; an empty box or a vertex that is not finite gives `false`.
#[must_use]
pub fn triangle_aabb_clip(vertices: [[f64; 3]; 3], min: [f64; 3], max: [f64; 3]) -> bool {
    if !is_finite(&vertices) || !is_box(min, max) {
        return false;
    }
    let grid = grid(vertices, min, max);
    // A cut corner has 2p + 3 bits, its distance to the next face p + 3 more.
    if fits_i128(3 * grid.bits + 6) {
        overlap_by_clipping::<i128>(vertices, min, max, grid)
    } else {
        overlap_by_clipping::<BigInt>(vertices, min, max, grid)
    }
}

/// Whether on some axis among the 13 candidates a closed triangle and a bounded closed box are further apart than its margin,
/// which is zero for the box's own axes. A negative margin asks whether they overlap by less than that.
#[must_use]
pub fn triangle_aabb_apart(
    vertices: [[f64; 3]; 3],
    min: [f64; 3],
    max: [f64; 3],
    edge_margin: f64,
    normal_margin: f64,
) -> bool {
    let grid = grid(vertices, min, max);
    let axes = Axes::<BigInt>::new(vertices, min, max, grid);
    let exceeds = |axis: &Vector<BigInt>, margin: f64| {
        // The gap is in proportion to the length of the axis: compared with signed squares.
        let margin = Ratio::<BigInt>::from_float(margin, -grid.exponent);
        let gap = axes.gap(axis) * &margin.den;
        let square = |x: &BigInt| x * x * x.signum();
        square(&gap) > square(&margin.num) * dot(axis, axis)
    };
    axes.own.iter().any(|axis| axes.gap(axis) > BigInt::from(0))
        || axes.crosses.iter().any(|axis| exceeds(axis, edge_margin))
        || exceeds(&axes.normal, normal_margin)
}

/// The grid through all finite coordinates.
fn grid([a, b, c]: [[f64; 3]; 3], min: [f64; 3], max: [f64; 3]) -> Grid {
    Grid::through([a, b, c, min, max].as_flattened())
}

/// The box with each infinite bound drawn in as far as the triangle, which overlaps it no less.
fn bounded(vertices: [[f64; 3]; 3], mut min: [f64; 3], mut max: [f64; 3]) -> ([f64; 3], [f64; 3]) {
    for k in 0..3 {
        let extent = vertices.map(|v| v[k]);
        if min[k].is_infinite() {
            min[k] = extent.into_iter().fold(max[k], f64::min);
        }
        if max[k].is_infinite() {
            max[k] = extent.into_iter().fold(min[k], f64::max);
        }
    }
    (min, max)
}

/// The unit vector of an axis.
fn unit<I: Integer>(axis: usize) -> Vector<I> {
    std::array::from_fn(|k| I::new(i64::from(k == axis), 0))
}

fn overlap_by_axes<I: Integer>(
    vertices: [[f64; 3]; 3],
    min: [f64; 3],
    max: [f64; 3],
    grid: Grid,
) -> bool {
    let axes = Axes::<I>::new(vertices, min, max, grid);
    // A zero axis projects everything to zero and separates nothing.
    let mut all = axes.crosses.iter().chain([&axes.normal]).chain(&axes.own);
    !all.any(|axis| axes.gap(axis).signum() > 0)
}

/// The candidates for a separating axis, and what they are to separate.
struct Axes<I> {
    vertices: [Vector<I>; 3],
    min: Vector<I>,
    max: Vector<I>,
    /// Each edge of the triangle times each of the box.
    crosses: [Vector<I>; 9],
    normal: Vector<I>,
    /// The box's own.
    own: [Vector<I>; 3],
}

impl<I: Integer> Axes<I> {
    fn new(vertices: [[f64; 3]; 3], min: [f64; 3], max: [f64; 3], grid: Grid) -> Self {
        let vertices = vertices.map(|v| grid.vector::<I>(v));
        let (min, max) = (grid.vector(min), grid.vector(max));
        let own = [0, 1, 2].map(unit::<I>);
        let edges = [0, 1, 2].map(|k| sub(&vertices[(k + 1) % 3], &vertices[k]));
        let crosses = std::array::from_fn(|k| cross(&edges[k / 3], &own[k % 3]));
        let normal = cross(&edges[0], &edges[1]);
        Self { vertices, min, max, crosses, normal, own }
    }

    /// The distance between the projections of triangle and box on an axis, times its length; negative where they overlap.
    fn gap(&self, axis: &Vector<I>) -> I {
        let [a, b, c] = self.vertices.each_ref().map(|v| dot(axis, v));
        let end = |last: bool| {
            let upper = axis.each_ref().map(|x| (x.signum() > 0) == last);
            let corner: Vector<I> = std::array::from_fn(|k| {
                if upper[k] { self.max[k].clone() } else { self.min[k].clone() }
            });
            dot(axis, &corner)
        };
        let (low, high) = ((&a).min(&b).min(&c), (&a).max(&b).max(&c));
        (end(false) - high).max(low.clone() - &end(true))
    }
}

/// A corner of the clipped polygon and the line of the edge that leaves it.
///
/// The corner is the weights of the triangle's vertices, up to a positive factor. A line is the coefficients of a linear
/// function of the weights that vanishes on it. Since new corners are products of two lines rather than sums over older
/// corners, numbers do not grow from cut to cut; and in weights even a degenerate triangle is a proper one.
#[derive(Clone)]
struct Corner<I> {
    weights: Vector<I>,
    line: Vector<I>,
}

fn overlap_by_clipping<I: Integer>(
    vertices: [[f64; 3]; 3],
    min: [f64; 3],
    max: [f64; 3],
    grid: Grid,
) -> bool {
    let mut polygon: Vec<_> =
        (0..3).map(|k| Corner { weights: unit(k), line: unit((k + 2) % 3) }).collect();
    for k in 0..3 {
        let heights = vertices.map(|v| grid.integer::<I>(v[k]));
        if min[k].is_finite() {
            let face = grid.integer::<I>(min[k]);
            polygon = clip(&polygon, heights.each_ref().map(|height| height.clone() - &face));
        }
        if max[k].is_finite() {
            let face = grid.integer::<I>(max[k]);
            polygon = clip(&polygon, heights.each_ref().map(|height| face.clone() - height));
        }
    }
    !polygon.is_empty()
}

/// The part of a convex polygon on which a linear function of the weights is not negative (Sutherland and Hodgman).
fn clip<I: Integer>(polygon: &[Corner<I>], inside: Vector<I>) -> Vec<Corner<I>> {
    let mut clipped = Vec::with_capacity(polygon.len() + 1);
    for (k, corner) in polygon.iter().enumerate() {
        let next = &polygon[(k + 1) % polygon.len()];
        let cut = || intersection(&corner.line, &inside);
        match (dot(&corner.weights, &inside).signum(), dot(&next.weights, &inside).signum()) {
            (1, -1) => {
                clipped.extend([corner.clone(), Corner { weights: cut(), line: inside.clone() }]);
            }
            (0, -1) => clipped.push(Corner { line: inside.clone(), ..corner.clone() }),
            (0 | 1, _) => clipped.push(corner.clone()),
            (_, 1) => clipped.push(Corner { weights: cut(), line: corner.line.clone() }),
            _ => {}
        }
    }
    clipped
}

/// The corner at which two lines meet, which is a point of the triangle: of its two signs, the one without negative weights.
fn intersection<I: Integer>(a: &Vector<I>, b: &Vector<I>) -> Vector<I> {
    let weights = cross(a, b);
    if weights.iter().any(|weight| weight.signum() < 0) {
        weights.map(|weight| -weight)
    } else {
        weights
    }
}

#[cfg(test)]
mod tests {
    use super::super::lattice_point;
    use super::*;

    const INF: f64 = f64::INFINITY;

    /// The answer of both oracles.
    fn overlaps(vertices: [[f64; 3]; 3], min: [f64; 3], max: [f64; 3]) -> bool {
        let by_axes = triangle_aabb_sat(vertices, min, max);
        assert_eq!(triangle_aabb_clip(vertices, min, max), by_axes, "{vertices:?} {min:?} {max:?}");
        by_axes
    }

    #[test]
    fn touching_is_overlapping() {
        let slanted = [[3.0, 0.0, 0.0], [0.0, 3.0, 0.0], [0.0, 0.0, 3.0]];
        assert!(overlaps(slanted, [0.0; 3], [1.0; 3]), "a corner in the interior");
        assert!(!overlaps(slanted, [0.0; 3], [1.0, 1.0, 1f64.next_down()]), "short of it");
        assert!(overlaps(slanted, [0.0; 3], [2.0; 3]));
        assert!(overlaps(slanted, [3.0, -1.0, -1.0], [4.0, 1.0, 1.0]), "a vertex in a face");
        assert!(overlaps(slanted, [3.0, 0.0, 0.0], [3.0, 0.0, 0.0]), "a vertex on a point");
        assert!(overlaps(slanted, [1.5, 1.5, -1.0], [2.0, 2.0, 0.0]), "an edge through a corner");
        assert!(overlaps(slanted, [-1.0, -1.0, -1.0], [5.0; 3]), "inside");
        assert!(!overlaps(slanted, [2.0, 2.0, -1.0], [3.0, 3.0, 1.0]), "beside an edge");
        assert!(overlaps([[0.5; 3]; 3], [0.0; 3], [1.0; 3]), "a point");
        assert!(
            overlaps([[0.0; 3], [0.0; 3], [2.0; 3]], [1.0; 3], [1.0; 3]),
            "a segment through a point"
        );
    }

    #[test]
    fn empty_boxes_and_bad_vertices_overlap_nothing() {
        let good = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        assert!(!overlaps(good, [1.0; 3], [-1.0; 3]));
        assert!(!overlaps(good, [INF; 3], [-INF; 3]));
        assert!(!overlaps(good, [-INF; 3], [-INF; 3]));
        assert!(!overlaps(good, [f64::NAN; 3], [1.0; 3]));
        assert!(!overlaps([good[0], [0.0, INF, 0.0], good[2]], [-INF; 3], [INF; 3]));
        assert!(overlaps(good, [-INF; 3], [INF; 3]));
    }

    #[test]
    fn the_two_oracles_agree() {
        let mut rng = fastrand::Rng::with_seed(6);
        let mut overlapping = 0;
        for _ in 0..250_000 {
            let radius = rng.i32(1..=4);
            let vertices = [(); 3].map(|()| lattice_point(&mut rng, radius));
            let (a, b) = (lattice_point(&mut rng, radius), lattice_point(&mut rng, radius));
            let mut min: [f64; 3] = std::array::from_fn(|k| a[k].min(b[k]));
            let mut max: [f64; 3] = std::array::from_fn(|k| a[k].max(b[k]));
            if rng.u8(..4) == 0 {
                min[rng.usize(..3)] = -INF;
                max[rng.usize(..3)] = INF;
            }
            overlapping += u32::from(overlaps(vertices, min, max));
        }
        assert!((50_000..200_000).contains(&overlapping), "{overlapping}");
    }

    #[test]
    fn distances_along_axes_are_measured() {
        // 3-4-5: the edge from (4, 0) to (0, 3) passes the origin at 2.4.
        let slanted = [[4.0, 0.0, -9.0], [0.0, 3.0, -9.0], [2.0, 1.5, 9.0]];
        let apart = |edge, normal| triangle_aabb_apart(slanted, [-1.0; 3], [0.0; 3], edge, normal);
        assert!(apart(2.375, 9.0) && apart(9.0, 2.375), "the normal has the same direction");
        assert!(!apart(2.5, 2.5));
        // On the normal and on the edge's axis the box [0, 1]³ overlaps that plane by 1.4, on the box's own axes by 1.
        let into = |edge, normal| triangle_aabb_apart(slanted, [1.0; 3], [2.0; 3], edge, normal);
        assert!(into(-1.5, 0.0) && into(0.0, -1.5) && !into(-0.125, -0.375));
    }

    #[test]
    fn tiers_agree_and_symmetries_change_nothing() {
        let mut rng = fastrand::Rng::with_seed(7);
        for k in 0..24_000 {
            let radius = if k % 2 == 0 { 3 } else { 1 << 23 };
            let vertices @ [a, b, c] = [(); 3].map(|()| lattice_point(&mut rng, radius));
            let (p, q) = (lattice_point(&mut rng, radius), lattice_point(&mut rng, radius));
            let min = std::array::from_fn(|k| p[k].min(q[k]));
            let max = std::array::from_fn(|k| p[k].max(q[k]));
            let expected = overlaps(vertices, min, max);
            let grid = grid(vertices, min, max);
            assert!(fits_i128(3 * grid.bits + 6));
            assert_eq!(overlap_by_axes::<BigInt>(vertices, min, max, grid), expected);
            assert_eq!(overlap_by_clipping::<BigInt>(vertices, min, max, grid), expected);
            let turn = |[x, y, z]: [f64; 3]| [z, x, y].map(|x| x * 2f64.powi(500));
            assert_eq!(overlaps([c, b, a].map(turn), turn(min), turn(max)), expected);
            let mirror = |p: [f64; 3]| p.map(|x| -x);
            assert_eq!(overlaps([b, c, a].map(mirror), mirror(max), mirror(min)), expected);
        }
    }

    #[test]
    fn the_fast_tier_holds_the_largest_numbers_it_admits() {
        let mut rng = fastrand::Rng::with_seed(10);
        for _ in 0..3_000 {
            let mut extreme =
                || [0; 3].map(|_| (2f64.powi(40) - 1.0) * if rng.bool() { 1.0 } else { -1.0 });
            let vertices = [extreme(), extreme(), extreme()];
            let (a, b) = (extreme(), extreme());
            let min = std::array::from_fn(|k| a[k].min(b[k]));
            let max = std::array::from_fn(|k| a[k].max(b[k]));
            let grid = grid(vertices, min, max);
            assert!(fits_i128(3 * grid.bits + 6) && !fits_i128(3 * (grid.bits + 1) + 5));
            let expected = overlaps(vertices, min, max);
            assert_eq!(overlap_by_axes::<BigInt>(vertices, min, max, grid), expected);
        }
    }
}
