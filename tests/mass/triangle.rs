//! Ray against triangle.

use fastrand::Rng;
use isect::ray::triangle::exact;
use isect::testkit::oracle::TriangleVerdict;
use isect::{Ray, Scalar, Triangle, Vector};

use super::lattice::{Point, Scale, Space, between, double, is_single, nudged, pick, step, sum};
use super::{Pair, Tally, source};
use crate::support::{array, oracle, verdicts};

pub struct RayTriangle;

impl Pair for RayTriangle {
    const NAME: &'static str = "ray/triangle";
    const KINDS: &'static [&'static str] = &verdicts::KINDS;

    fn check<V: Vector>(rng: &mut Rng, tally: &mut Tally) {
        check::<V>(rng, tally);
    }
}

/// The bits of a coordinate. With p and d bits for differences and the direction, i128 has 127 − (3p + d + 6) left for
/// an end of the range.
fn bits<V: Vector>() -> u32 {
    if is_single::<V>() { 23 } else { 27 }
}

fn check<V: Vector>(rng: &mut Rng, tally: &mut Tally) {
    let (ray, triangle, apex) = random::<V>(rng);
    let (exact_ray, vertices) =
        (oracle::Ray::from(&ray), [triangle.v0, triangle.v1, triangle.v2].map(array));
    let expected = oracle::triangle(&exact_ray, vertices);
    tally.count(verdicts::kind(expected), || exact::stage(&ray, &triangle));

    let mut fail = |what: &str| {
        let [v0, v1, v2] = [triangle.v0, triangle.v1, triangle.v2];
        tally.wrong(
            &format!("{what}, {expected:?}"),
            &source::<V>(&[ray.origin, ray.direction, v0, v1, v2], &[ray.t_min, ray.t_max]),
        );
    };
    if exact::hits(&ray, &triangle) != expected.hits() {
        fail("hits");
    }
    let hit = exact::intersect(&ray, &triangle);
    if hit.is_some() != expected.hits() {
        fail("intersect");
    }
    let verdict = exact::classify(&ray, &triangle);
    if !verdicts::agrees(verdict, expected, &exact_ray, &vertices) {
        fail(&format!("classify, {verdict:?}"));
    }
    let crossing = exact::crosses(&ray, &triangle);
    let is_line = !(ray.t_min.is_finite() || ray.t_max.is_finite());
    let agrees = match (expected, hit) {
        (TriangleVerdict::Interior, Some(hit)) if is_line => crossing == Some(hit.front),
        // Moved, it may be off the triangle or the range.
        (TriangleVerdict::Interior | TriangleVerdict::Edge(_) | TriangleVerdict::Vertex(_), _) => {
            true
        }
        _ => crossing.is_none(),
    };
    if !agrees {
        fail(&format!("crosses, {crossing:?}"));
    }
    if let Some(hit) = hit {
        let is_finite = hit.t.is_finite() && hit.u.is_finite() && hit.v.is_finite();
        if !(is_finite && ray.t_min <= hit.t && hit.t <= ray.t_max) {
            fail("t of intersect");
        }
    }
    if let Some(apex) = apex
        && !is_closed(&ray, &triangle, apex)
    {
        fail(&format!("crosses, with {apex:?}"));
    }
}

/// Whether the line crosses the tetrahedron over a triangle as often from the front as from the back, and the ray as often as
/// its parts.
fn is_closed<V: Vector>(ray: &Ray<V>, triangle: &Triangle<V>, apex: V) -> bool {
    let Triangle { v0, v1, v2 } = *triangle;
    let faces = [[v0, v1, v2], [v0, apex, v1], [v1, apex, v2], [v2, apex, v0]].map(Triangle::from);
    let line = ray.with_range(-V::Scalar::INFINITY, V::Scalar::INFINITY);
    let sum: i32 = faces
        .iter()
        .filter_map(|face| exact::crosses(&line, face))
        .map(|front| if front { 1 } else { -1 })
        .sum();
    let count = |ray: &Ray<V>| faces.iter().filter_map(|face| exact::crosses(ray, face)).count();
    let split = if ray.t_min.is_finite() { ray.t_min } else { V::Scalar::ONE };
    let parts = [Ray { t_max: split, ..line }, Ray { t_min: split, ..line }];
    sum == 0 && count(&line) == count(&parts[0]) + count(&parts[1])
}

/// A ray and a triangle, and of some cases an apex above that.
fn random<V: Vector>(rng: &mut Rng) -> (Ray<V>, Triangle<V>, Option<V>) {
    let bits = bits::<V>();
    // The sums and differences below are up to four times as long.
    let space = Space::random(rng, bits - 2);
    let (origin, direction, mut vertices) = match rng.u8(..16) {
        0 => along_a_unit(rng, &space),
        1 => at_a_lattice_point(rng, &space),
        2..=3 => along_an_axis(rng, &space),
        _ => weighted(rng, &space),
    };
    let direction = nudged(rng, direction, space.bits);
    if rng.u8(..4) == 0 {
        let k = rng.usize(..3);
        vertices[k] = nudged(rng, vertices[k], 4);
    }
    vertices.rotate_left(rng.usize(..3));
    if rng.bool() {
        vertices.swap(1, 2);
    }

    let scale = Scale::random::<V>(rng, bits + 1);
    let is_short = !is_single::<V>() && space.bits > 14 && rng.u8(..32) != 0;
    let t = approximate_t(rng, origin, direction, &vertices);
    let ray = scale.ray(rng, origin, direction, t, is_short);
    let apex = (rng.u8(..64) == 0).then(|| scale.point(space.point(rng)));
    (ray, vertices.map(|v| scale.point(v)).into(), apex)
}

/// Where the line meets the plane, or comes closest to a vertex along its longest axis.
fn approximate_t(rng: &mut Rng, origin: Point, direction: Point, vertices: &[Point; 3]) -> f64 {
    let [a, b, c] = vertices.map(|v| sum(v, origin, -1).map(double));
    let d = direction.map(double);
    let difference = |p: [f64; 3], q: [f64; 3]| [p[0] - q[0], p[1] - q[1], p[2] - q[2]];
    let (e1, e2) = (difference(b, a), difference(c, a));
    let normal = [
        e1[1] * e2[2] - e1[2] * e2[1],
        e1[2] * e2[0] - e1[0] * e2[2],
        e1[0] * e2[1] - e1[1] * e2[0],
    ];
    let dot = |p: [f64; 3]| p[0] * normal[0] + p[1] * normal[1] + p[2] * normal[2];
    let slope = dot(d);
    if slope == 0.0 {
        let k = (0..3).fold(0, |k, i| if d[i].abs() > d[k].abs() { i } else { k });
        return pick(rng, &[a, b, c])[k] / d[k];
    }
    dot(a) / slope
}

/// A proper triangle, a needle, a segment or a point.
fn vertices(rng: &mut Rng, space: &Space) -> [Point; 3] {
    let [a, b, mut c] = [(); 3].map(|()| space.point(rng));
    match rng.u8(..32) {
        // Between the others, beyond them, or at one of them.
        0 => {
            let half = sum(b, a, -1).map(|x| x / 2);
            let b = sum(a, half, 2);
            return [a, b, sum(a, half, pick(rng, &[0, 1, 2, -1, 3]))];
        }
        1 => return [a, a, if rng.bool() { a } else { b }],
        // A needle.
        2 => {
            for k in 0..3 {
                c[k] = b[k] + step(rng, 2);
            }
        }
        // In a plane across an axis.
        3 => {
            let axis = rng.usize(..3);
            let mut points = [a, b, c];
            for p in &mut points {
                p[axis] = a[axis];
            }
            return points;
        }
        _ => {}
    }
    [a, b, c]
}

/// A direction that is a sum of the vertices as seen from the origin: the weights are those of the point that is hit, so that zeros
/// aim at edges and vertices, and t is one over their sum.
fn weighted(rng: &mut Rng, space: &Space) -> (Point, Point, [Point; 3]) {
    let v = vertices(rng, space);
    let origin = match rng.u8(..32) {
        // In the plane of the triangle, or on it.
        0..=1 => {
            let (i, j) = (pick(rng, &[0, 1, -1]), pick(rng, &[0, 1, -1]));
            sum(sum(v[0], sum(v[1], v[0], -1), i), sum(v[2], v[0], -1), j)
        }
        2 => pick(rng, &v),
        3 => sum(v[0], v[1], 1).map(|x| x / 2),
        _ => space.point(rng),
    };
    const WEIGHTS: [i64; 8] = [0, 1, 1, 1, 2, -1, 3, -2];
    let weights = [(); 3].map(|()| pick(rng, &WEIGHTS));
    let mut direction = [0; 3];
    for (v, weight) in v.iter().zip(weights) {
        direction = sum(direction, sum(*v, origin, -1), weight);
    }
    if direction == [0; 3] {
        direction = space.vector(rng);
    }
    (origin, direction, v)
}

/// A volume of a few units between directions of any length: two vertices as seen from the origin, and a direction that is a
/// sum of these and a few units.
fn along_a_unit(rng: &mut Rng, space: &Space) -> (Point, Point, [Point; 3]) {
    let axis = rng.usize(..3);
    let [p, q] = space.unimodular(rng, axis);
    let origin = space.point(rng);
    let mut direction = sum([0; 3], p, pick(rng, &[0, 1, 1, 2]));
    direction = sum(direction, q, pick(rng, &[0, 1, 1, -1]));
    direction[axis] += step(rng, space.bits);
    let third = space.point(rng);
    (origin, direction, [sum(origin, p, 1), sum(origin, q, 1), third])
}

/// A ray that comes to a lattice point of the triangle, or next to it, after so many steps.
fn at_a_lattice_point(rng: &mut Rng, space: &Space) -> (Point, Point, [Point; 3]) {
    let parts = between(rng, 1, 4);
    let corner = space.point(rng);
    let [f1, f2] = [(); 2].map(|()| space.vector(rng).map(|x| x / parts));
    let (i, j) = (between(rng, -1, parts), between(rng, 0, parts));
    let target = sum(sum(corner, f1, i), f2, j);
    let steps: i64 = pick(rng, &[0, 1, 2, 3, 4, 8, -1]);
    let direction = space.vector(rng).map(|x| x / steps.abs().max(1));
    let vertices = [corner, sum(corner, f1, parts), sum(corner, f2, parts)];
    (sum(target, direction, -steps), direction, vertices)
}

/// A ray along an axis or across one, from a point that shares coordinates with a vertex.
fn along_an_axis(rng: &mut Rng, space: &Space) -> (Point, Point, [Point; 3]) {
    let v = vertices(rng, space);
    let target = match rng.u8(..4) {
        0 => sum(v[0], v[1], 1).map(|x| x / 2),
        1 => space.point(rng),
        _ => pick(rng, &v),
    };
    let mut origin = space.point(rng);
    let mut direction = sum(target, origin, -1);
    for _ in 0..rng.u8(1..=2) {
        let axis = rng.usize(..3);
        origin[axis] = target[axis];
        direction[axis] = 0;
    }
    if rng.u8(..4) == 0 {
        direction = direction.map(i64::signum);
    }
    (origin, direction, v)
}
