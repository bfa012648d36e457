//! Ray against box.

use fastrand::Rng;
use isect::ray::aabb::{BoxRay, exact};
use isect::{Aabb, Ray, Scalar, Vector};

use super::lattice::{
    Point, Scale, Space, between, double, is_single, nudged, pick, step, sum, within,
};
use super::{Pair, Tally, source};
use crate::support::{array, oracle};

pub struct RayAabb;

impl Pair for RayAabb {
    const NAME: &'static str = "ray/box";
    const KINDS: &'static [&'static str] = &["miss", "hit"];

    fn check<V: Vector>(rng: &mut Rng, tally: &mut Tally) {
        check::<V>(rng, tally);
    }
}

fn check<V: Vector>(rng: &mut Rng, tally: &mut Tally) {
    let (ray, aabb) = random::<V>(rng);
    let expected = oracle::aabb(&oracle::Ray::from(&ray), array(aabb.min), array(aabb.max));
    let prepared = BoxRay::new(&ray);
    tally.count(usize::from(expected), || exact::stage(&prepared, &aabb));

    let mut fail = |what: &str| {
        let vectors = [ray.origin, ray.direction, aabb.min, aabb.max];
        tally.wrong(
            &format!("{what}, touches: {expected}"),
            &source::<V>(&vectors, &[ray.t_min, ray.t_max]),
        );
    };
    if exact::hits(&prepared, &aabb) != expected {
        fail("hits");
    }
    let hit = exact::intersect(&prepared, &aabb);
    if hit.is_some() != expected {
        fail("intersect");
    }
    if let Some(hit) = hit
        && !(ray.t_min <= hit.t_enter && hit.t_enter <= hit.t_exit && hit.t_exit <= ray.t_max)
    {
        fail("t of intersect");
    }
}

fn random<V: Vector>(rng: &mut Rng) -> (Ray<V>, Aabb<V>) {
    // The differences have a bit more, and two products of them and a direction fit in i128.
    let bits = if is_single::<V>() { 23 } else { 51 };
    let space = Space::random(rng, bits - 1);
    let bounds = bounds(rng, &space);
    let target = surface_point(rng, &bounds);
    let (origin, direction) = aimed(rng, &space, target);
    let direction = nudged(rng, direction, space.bits);

    let [mut min, mut max] = bounds;
    if rng.u8(..16) == 0 {
        let (corner, by) = (if rng.bool() { &mut min } else { &mut max }, step(rng, space.bits));
        corner[rng.usize(..3)] += by;
    }
    let axis = rng.usize(..3);
    let plane = pick(rng, &[min, max])[axis];
    let t = double(plane - origin[axis]) / double(direction[axis]);
    let scale = Scale::random::<V>(rng, bits + 1);
    let ray = scale.ray(rng, origin, direction, t, false);
    let mut aabb = Aabb::<V>::new(scale.point(min), scale.point(max));
    if rng.u8(..32) == 0 {
        unbounded(rng, &mut aabb);
    }
    (ray, aabb)
}

/// Opens the box on some sides.
pub fn unbounded<V: Vector>(rng: &mut Rng, aabb: &mut Aabb<V>) {
    let mut opened = |p: V, end: V::Scalar| {
        let sides = rng.u8(..8);
        let [x, y, z] = [p.x(), p.y(), p.z()];
        let side = |k: u8, x| if sides >> k & 1 == 1 { end } else { x };
        V::new(side(0, x), side(1, y), side(2, z))
    };
    *aabb =
        Aabb::new(opened(aabb.min, -V::Scalar::INFINITY), opened(aabb.max, V::Scalar::INFINITY));
}

/// Two corners, flat on some axes; about one box in fifty is a point.
pub fn bounds(rng: &mut Rng, space: &Space) -> [Point; 2] {
    let (a, mut b) = (space.point(rng), space.point(rng));
    let is_point = rng.u8(..64) == 0;
    for k in 0..3 {
        if is_point || rng.u8(..8) == 0 {
            b[k] = a[k];
        }
    }
    let ordered = |choose: fn(i64, i64) -> i64| [0, 1, 2].map(|k| choose(a[k], b[k]));
    [ordered(i64::min), ordered(i64::max)]
}

/// A corner of a box, or a point of an edge or a face.
pub fn surface_point(rng: &mut Rng, [min, max]: &[Point; 2]) -> Point {
    let free = rng.u8(..8);
    [0, 1, 2].map(|k| {
        // None is free in 5 of 8 cases, or one; two in one.
        if usize::from(free) == k || (free == 7 && k > 0) {
            between(rng, min[k], max[k])
        } else {
            pick(rng, &[min[k], max[k]])
        }
    })
}

/// A ray through a lattice point.
fn aimed(rng: &mut Rng, space: &Space, target: Point) -> (Point, Point) {
    match rng.u8(..8) {
        // After so many steps.
        0..=2 => {
            let steps: i64 = pick(rng, &[0, 1, 2, 3, 5, 8, -1]);
            let mut direction = space.vector(rng).map(|x| x / steps.abs().max(1));
            if rng.u8(..4) == 0 {
                direction = direction.map(i64::signum);
            }
            (sum(target, direction, -steps), direction)
        }
        // Along faces: some components are zero, or as small as can be.
        3..=4 => {
            let mut origin = space.point(rng);
            let mut direction = sum(target, origin, -1);
            for _ in 0..rng.u8(1..=2) {
                let axis = rng.usize(..3);
                direction[axis] = if rng.u8(..4) == 0 { within(rng, 1) } else { 0 };
                origin[axis] = target[axis] + if rng.u8(..4) == 0 { within(rng, 1) } else { 0 };
            }
            (origin, direction)
        }
        _ => {
            let origin = space.point(rng);
            (origin, sum(target, origin, -1))
        }
    }
}
