//! Triangle against box.

use fastrand::Rng;
use isect::overlap::triangle_aabb::exact;
use isect::{Aabb, Triangle, Vector};

use super::aabb::{bounds, surface_point};
use super::lattice::{Point, Scale, Space, is_single, nudged, pick, step, sum};
use super::{Pair, Tally, source};
use crate::support::{array, oracle};

pub struct TriangleAabb;

impl Pair for TriangleAabb {
    const NAME: &'static str = "triangle/box";
    const KINDS: &'static [&'static str] = &["apart", "overlap"];

    fn check<V: Vector>(rng: &mut Rng, tally: &mut Tally) {
        check::<V>(rng, tally);
    }
}

fn check<V: Vector>(rng: &mut Rng, tally: &mut Tally) {
    let (triangle, aabb) = random::<V>(rng);
    let vertices = [triangle.v0, triangle.v1, triangle.v2];
    let (points, min, max) = (vertices.map(array), array(aabb.min), array(aabb.max));
    let expected = oracle::triangle_aabb_sat(points, min, max);
    tally.count(usize::from(expected), || exact::stage(&triangle, &aabb));

    let mut fail = |what: &str| {
        let [v0, v1, v2] = vertices;
        tally.wrong(
            &format!("{what}, overlaps: {expected}"),
            &source::<V>(&[v0, v1, v2, aabb.min, aabb.max], &[]),
        );
    };
    if exact::overlaps(&triangle, &aabb) != expected {
        fail("overlaps");
    }
    // The other oracle, which shares nothing with the first.
    if rng.u8(..16) == 0 && oracle::triangle_aabb_clip(points, min, max) != expected {
        fail("the oracles");
    }
}

fn random<V: Vector>(rng: &mut Rng) -> (Triangle<V>, Aabb<V>) {
    // Three differences, and the sums below, are what i128 holds of products.
    let bits = if is_single::<V>() { 23 } else { 39 };
    let space = Space::random(rng, bits - 3);
    let mut aabb = bounds(rng, &space);
    let target = surface_point(rng, &aabb);
    let mut vertices = match rng.u8(..8) {
        0..=1 => plane_beside(rng, &space, &mut aabb),
        2..=3 => edge_beside(rng, &space, target),
        4 => [(); 3].map(|()| space.point(rng)),
        _ => through(rng, &space, target),
    };
    if rng.u8(..4) == 0 {
        let k = rng.usize(..3);
        vertices[k] = nudged(rng, vertices[k], space.bits);
    }
    vertices.rotate_left(rng.usize(..3));
    if rng.bool() {
        vertices.swap(1, 2);
    }
    let scale = Scale::random::<V>(rng, bits + 1);
    let mut found = Aabb::new(scale.point(aabb[0]), scale.point(aabb[1]));
    if rng.u8(..64) == 0 {
        super::aabb::unbounded(rng, &mut found);
    }
    (vertices.map(|v| scale.point(v)).into(), found)
}

/// A triangle with a point of the box inside of it, on an edge or at a vertex, or flat.
fn through(rng: &mut Rng, space: &Space, target: Point) -> [Point; 3] {
    let a = space.vector(rng);
    let mut b = space.vector(rng);
    if rng.u8(..8) == 0 {
        b = match rng.u8(..3) {
            0 => a,
            1 => [0; 3],
            _ => a.map(|x| 2 * x),
        };
    }
    let times = |v: Point, k: i64| v.map(|x| k * x);
    // As seen from the target: their positive combinations are zero.
    let around = match rng.u8(..6) {
        0 => [[0; 3], a, b],
        1 => [a, times(a, -1), b],
        2 => [a, times(a, -2), b],
        3 => [a, b, sum(times(a, -1), b, -2)],
        _ => [a, b, sum(times(a, -1), b, -1)],
    };
    around.map(|v| sum(target, v, 1))
}

/// A triangle of which an edge passes a point of the box at a distance of a few units of area, as seen along an axis.
fn edge_beside(rng: &mut Rng, space: &Space, target: Point) -> [Point; 3] {
    let axis = rng.usize(..3);
    let [p, q] = space.unimodular(rng, axis);
    let other = space.vector(rng);
    // The edge from p to q, or to its far side, so that it passes the target beside.
    let far = q.map(|x| -x);
    [sum(target, p, 1), sum(target, far, 1), sum(target, other, 1)]
}

/// A triangle of which the plane passes a corner of the box at a distance of a few units of volume, and a box that lies on the
/// far side of that.
fn plane_beside(rng: &mut Rng, space: &Space, aabb: &mut [Point; 2]) -> [Point; 3] {
    let axis = rng.usize(..3);
    let [p, q] = space.unimodular(rng, axis);
    // Weights of one each make it the corner that is about the middle.
    let mut r = sum(p.map(|x| -x), q, -1);
    r[axis] += if rng.u8(..4) == 0 { 0 } else { step(rng, space.bits) };
    let cross = |j: usize, k: usize| {
        let (e1, e2) = (sum(q, p, -1), sum(r, p, -1));
        i128::from(e1[j]) * i128::from(e2[k]) - i128::from(e1[k]) * i128::from(e2[j])
    };
    let side = if rng.bool() { 1 } else { -1 };
    let corner = pick(rng, aabb);
    // From the corner upwards along the normal on all axes.
    for k in 0..3 {
        let length = (aabb[1][k] - aabb[0][k]).min(space.radius);
        let is_up = (cross((k + 1) % 3, (k + 2) % 3) > 0) == (side > 0);
        aabb[0][k] = if is_up { corner[k] } else { corner[k] - length };
        aabb[1][k] = if is_up { corner[k] + length } else { corner[k] };
    }
    [p, q, r].map(|v| sum(corner, v, 1))
}
