//! Ray against sphere.

use std::cmp::Ordering;

use fastrand::Rng;
use isect::ray::sphere::robust;
use isect::{Ray, Scalar, Sphere, Vector};

use super::lattice::{
    Point, Scale, Space, between, double, is_single, nudged, pick, step, sum, within,
};
use super::{Pair, Tally, source};
use crate::support::{array, oracle};

pub struct RaySphere;

impl Pair for RaySphere {
    const NAME: &'static str = "ray/sphere";
    const KINDS: &'static [&'static str] = &["miss", "near root", "far root"];

    fn check<V: Vector>(rng: &mut Rng, tally: &mut Tally) {
        check::<V>(rng, tally);
    }
}

fn check<V: Vector>(rng: &mut Rng, tally: &mut Tally) {
    let (ray, sphere) = random::<V>(rng);
    let (exact_ray, center, radius) =
        (oracle::Ray::from(&ray), array(sphere.center), sphere.radius.into());
    let expected = oracle::sphere(&exact_ray, center, radius);
    let hit = robust::intersect(&ray, &sphere);
    let kind = if expected { 1 + usize::from(hit.is_some_and(|hit| hit.leaving)) } else { 0 };
    tally.count(kind, || robust::stage(&ray, &sphere));

    let mut fail = |what: &str| {
        tally.wrong(
            &format!("{what}, {hit:?}, touches: {expected}"),
            &source::<V>(
                &[ray.origin, ray.direction, sphere.center],
                &[ray.t_min, ray.t_max, sphere.radius],
            ),
        );
    };
    if hit.is_some() != expected {
        fail("intersect");
    }
    let Some(hit) = hit else { return };
    if !(ray.t_min <= hit.t && hit.t <= ray.t_max && hit.t.is_finite()) {
        fail("t of intersect");
    }
    // The far root is the nearest in range exactly if the range begins inside; at a root, the other one tells which it is.
    if exact_ray.t_min.is_finite() {
        match oracle::sphere_side(&exact_ray, center, radius, exact_ray.t_min) {
            Some(Ordering::Less) if !hit.leaving => fail("leaving"),
            Some(Ordering::Greater) if hit.leaving => fail("leaving"),
            Some(Ordering::Equal) => {
                let (t_min, t_max) = if hit.leaving {
                    (exact_ray.t_min.next_up(), f64::INFINITY)
                } else {
                    (f64::NEG_INFINITY, exact_ray.t_min.next_down())
                };
                if oracle::sphere(&oracle::Ray { t_min, t_max, ..exact_ray }, center, radius) {
                    fail("leaving");
                }
            }
            _ => {}
        }
    } else if hit.leaving {
        fail("leaving");
    }
}

fn random<V: Vector>(rng: &mut Rng) -> (Ray<V>, Sphere<V>) {
    // 2p + 2d + 8 bits, and less for a range of 30.
    let bits = if is_single::<V>() { 23 } else { 28 };
    let space = Space::random(rng, bits - 2);
    let center = space.point(rng);
    let (origin, direction, mut radius) = match rng.u8(..8) {
        0..=1 => rotated(rng, &space, center),
        2 => through_axis_points(rng, &space, center),
        3 => (space.point(rng), space.vector(rng), between(rng, 0, space.radius)),
        // At a point inside.
        _ => {
            let (origin, radius) = (space.point(rng), between(rng, 0, space.radius));
            let target = center.map(|x| x + within(rng, radius));
            (origin, sum(target, origin, -1), radius)
        }
    };
    let direction = nudged(rng, direction, space.bits);
    if rng.u8(..4) == 0 {
        radius = (radius + step(rng, space.bits)).abs();
    }

    let f = sum(center, origin, -1).map(double);
    let d = direction.map(double);
    let dot = |p: [f64; 3], q: [f64; 3]| p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
    let (a, b, c) = (dot(d, d), dot(f, d), dot(f, f) - double(radius) * double(radius));
    let root = (b * b - a * c).max(0.0).sqrt();
    let t = if rng.bool() { (b - root) / a } else { (b + root) / a };
    let scale = Scale::random::<V>(rng, bits + 1);
    let is_short = !is_single::<V>() && space.bits > 12 && rng.u8(..32) != 0;
    let ray = scale.ray(rng, origin, direction, t, is_short);
    (ray, Sphere::new(scale.point(center), scale.length(double(radius))))
}

/// The columns of a rotation times an integer, and that.
fn rotation(rng: &mut Rng) -> ([Point; 3], i64) {
    let [a, b, c, d] = [(); 4].map(|()| between(rng, -5, 5));
    let (aa, bb, cc, dd) = (a * a, b * b, c * c, d * d);
    let columns = [
        [aa + bb - cc - dd, 2 * (b * c + a * d), 2 * (b * d - a * c)],
        [2 * (b * c - a * d), aa - bb + cc - dd, 2 * (c * d + a * b)],
        [2 * (b * d + a * c), 2 * (c * d - a * b), aa - bb - cc + dd],
    ];
    (columns, aa + bb + cc + dd)
}

/// A tangent in any direction, a chord through points of the lattice, or a ray at the centre.
fn rotated(rng: &mut Rng, space: &Space, center: Point) -> (Point, Point, i64) {
    let ([outward, along, across], length) = rotation(rng);
    let times = between(rng, 0, (space.radius / 100).max(1));
    let on_surface = sum(center, outward, times);
    let steps = between(rng, -1, (space.radius / 100).max(1));
    let direction = match rng.u8(..4) {
        0 => along,
        1 => sum(along, across, pick(rng, &[1, -1, 2])),
        2 => sum(along.map(|x| 3 * x), across, 4),
        _ => sum(outward, along, pick(rng, &[1, -1, 0])),
    };
    let steps = if rng.u8(..4) == 0 { pick(rng, &[0, 1, 2, 4]) } else { steps / 4 };
    (sum(on_surface, direction, -steps), direction, times * length)
}

/// A ray through the ends of axes, or along one, as far from the centre as the radius or as the nearest integer.
fn through_axis_points(rng: &mut Rng, space: &Space, center: Point) -> (Point, Point, i64) {
    let radius = between(rng, 0, space.radius);
    let axis = rng.usize(..3);
    let mut target = center;
    target[axis] += if rng.bool() { radius } else { -radius };
    if rng.u8(..4) == 0 {
        target[axis] += step(rng, 2);
    }
    let mut origin = space.point(rng);
    if rng.bool() {
        origin[axis] = target[axis];
    }
    if rng.u8(..8) == 0 {
        origin = target;
        let mut direction = space.vector(rng);
        direction[axis] = if rng.bool() { 0 } else { direction[axis] };
        return (origin, direction, radius);
    }
    (origin, sum(target, origin, -1), radius)
}
