//! Ray against plane.

use fastrand::Rng;
use isect::ray::plane::{self, PlaneHit};
use isect::testkit::oracle::PlaneVerdict;
use isect::{Plane, Ray, Vector};

use super::lattice::{Point, Scale, Space, double, is_single, nudged, pick, step, sum};
use super::{Pair, Tally, source};
use crate::support::{array, oracle};

pub struct RayPlane;

impl Pair for RayPlane {
    const NAME: &'static str = "ray/plane";
    const KINDS: &'static [&'static str] = &["miss", "at", "contained"];

    fn check<V: Vector>(rng: &mut Rng, tally: &mut Tally) {
        check::<V>(rng, tally);
    }
}

fn check<V: Vector>(rng: &mut Rng, tally: &mut Tally) {
    let (ray, plane) = random::<V>(rng);
    let expected =
        oracle::plane(&oracle::Ray::from(&ray), array(plane.normal), plane.offset.into());
    let (kind, outcome) = match expected {
        PlaneVerdict::Miss => (0, 0),
        PlaneVerdict::At => (1, 1),
        PlaneVerdict::Contained => (2, 2),
    };
    tally.count(kind, || plane::stage(&ray, &plane));

    let hit = plane::intersect(&ray, &plane);
    let (found, is_in_range) = match hit {
        None => (0, true),
        Some(PlaneHit::At(t)) => (1, ray.t_min <= t && t <= ray.t_max),
        Some(PlaneHit::Contained) => (2, true),
    };
    if found != outcome || !is_in_range {
        tally.wrong(
            &format!("intersect, {hit:?}, {expected:?}"),
            &source::<V>(
                &[ray.origin, ray.direction, plane.normal],
                &[ray.t_min, ray.t_max, plane.offset],
            ),
        );
    }
}

fn random<V: Vector>(rng: &mut Rng) -> (Ray<V>, Plane<V>) {
    // The offset is exact too: a product of a normal and a point of half the bits.
    let half = if is_single::<V>() { 11 } else { 25 };
    let (normals, points) = (Space::random(rng, half - 1), Space::random(rng, half - 1));
    let normal = normals.point(rng);
    let base = points.point(rng);
    let mut offset: i64 = (0..3).map(|k| normal[k] * base[k]).sum();
    // Across the normal: as long as both together.
    let across = |rng: &mut Rng| {
        let v = points.vector(rng);
        let k = rng.usize(..3);
        match rng.u8(..3) {
            0 => [0, 1, 2].map(|k| {
                let (i, j) = ((k + 1) % 3, (k + 2) % 3);
                normal[i] * v[j] - normal[j] * v[i]
            }),
            1 => {
                let mut d = [0; 3];
                (d[k], d[(k + 1) % 3]) = (normal[(k + 1) % 3], -normal[k]);
                d
            }
            _ => v,
        }
    };
    let to = sum(base, across(rng), 1);
    let kind = rng.u8(..16);
    let (origin, mut direction) = match kind {
        // In the plane or parallel to it.
        0..=2 => (to, across(rng)),
        // From a point of it.
        3 => (to, sum(across(rng), points.vector(rng), 1)),
        // Through a point of it, after so many steps.
        4..=6 => {
            let steps: i64 = pick(rng, &[1, 2, 3, 5, 8, -1]);
            let direction: Point = points.vector(rng);
            (sum(to, direction, -steps), direction)
        }
        _ => {
            let origin = points.point(rng);
            (origin, sum(to, origin, -1))
        }
    };
    if kind > 2 || rng.bool() {
        direction = nudged(rng, direction, half);
    }
    let origin = if rng.u8(..4) == 0 { nudged(rng, origin, half) } else { origin };
    if rng.u8(..4) == 0 {
        offset += step(rng, half);
    }

    let dot = |p: Point| (0..3).map(|k| double(normal[k]) * double(p[k])).sum::<f64>();
    let t = (double(offset) - dot(origin)) / dot(direction);
    // Normals, and so offsets, are multiplied too.
    let scale = Scale::random::<V>(rng, 2 * half + 2);
    let is_short = !is_single::<V>() && 2 * normals.bits + points.bits > 64 && rng.u8(..32) != 0;
    let ray = scale.ray(rng, origin, direction, t, is_short);
    let (normal, offset) = scale.normal_and_offset(rng, normal, offset, half);
    (ray, Plane { normal, offset })
}
