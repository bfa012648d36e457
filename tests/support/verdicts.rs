//! What `classify` owes for each verdict of the oracle.

use isect::ray::triangle::exact::Verdict;
use isect::testkit::oracle::{self, TriangleVerdict};

/// Whether the kernel's verdict is the oracle's; for a segment or a point, which of its parts is to be named.
pub fn agrees(
    verdict: Verdict,
    expected: TriangleVerdict,
    ray: &oracle::Ray,
    vertices: &[[f64; 3]; 3],
) -> bool {
    match expected {
        TriangleVerdict::Miss => verdict == Verdict::Miss,
        TriangleVerdict::Interior => verdict == Verdict::Interior,
        TriangleVerdict::Edge(i) => verdict == Verdict::Edge(i),
        TriangleVerdict::Vertex(i) => verdict == Verdict::Vertex(i),
        TriangleVerdict::Coplanar => verdict == Verdict::Coplanar,
        TriangleVerdict::Degenerate => is_of_degenerate(ray, vertices, verdict),
    }
}

/// The kinds of the oracle's verdicts, for counts.
pub const KINDS: [&str; 6] = ["miss", "interior", "edge", "vertex", "coplanar", "degenerate"];

/// The index of a verdict's kind.
pub fn kind(verdict: TriangleVerdict) -> usize {
    match verdict {
        TriangleVerdict::Miss => 0,
        TriangleVerdict::Interior => 1,
        TriangleVerdict::Edge(_) => 2,
        TriangleVerdict::Vertex(_) => 3,
        TriangleVerdict::Coplanar => 4,
        TriangleVerdict::Degenerate => 5,
    }
}

/// What is to be reported of a segment or a point that is hit.
fn is_of_degenerate(ray: &oracle::Ray, v: &[[f64; 3]; 3], verdict: Verdict) -> bool {
    let line = oracle::Ray { t_min: f64::NEG_INFINITY, t_max: f64::INFINITY, ..*ray };
    let vertex = |i: usize| meets(&line, [v[i]; 2]);
    let edge = |i: usize| meets(ray, [v[i], v[(i + 1) % 3]]);
    let is_point = v[1] == v[0] && v[2] == v[0];
    let along = (0..3).all(vertex) && !is_point;
    match verdict {
        Verdict::Coplanar => along,
        Verdict::Vertex(i) => !along && (0..3).find(|&i| vertex(i)) == Some(i.into()),
        Verdict::Edge(i) => !(0..3).any(vertex) && (0..3).find(|&i| edge(i)) == Some(i.into()),
        Verdict::Miss | Verdict::Interior => false,
    }
}

/// Whether a ray meets the segment or the point between two vertices.
fn meets(ray: &oracle::Ray, [a, b]: [[f64; 3]; 2]) -> bool {
    oracle::triangle(ray, [a, b, b]).hits()
}
