//! Claim: at every level of the processor, a ray of a packet has the verdict of the scalar kernel, and what is not
//! active, or not hit, stays as it was, to the last bit.

use fearless_simd::dispatch;
use isect::glam::{DVec3, Vec3, Vec3A};
use isect::ray::aabb::{BoxRay, conservative};
use isect::ray::plane::{self, PlaneHit};
use isect::ray::sphere::robust;
use isect::ray::triangle::{TriangleHit, exact, moller_trumbore};
use isect::simd::{ClosestSpheres, ClosestTriangles, Lanes, RayPack};
use isect::testkit::shapes::{self, aabb, name, ray, sphere, triangle};
use isect::testkit::{generators, oracle};
use isect::{Ray, Scalar, Vector};

use crate::in_leaf;
use crate::levels::levels;

const SEED: u64 = 37;

/// Runs a check with each kind of packet.
macro_rules! for_every_packet {
    ($check:ident) => {
        $check::<Vec3A, 8>();
        $check::<DVec3, 4>();
    };
}

/// The ray of a hard case, and some more: nudged, those of other cases, with another range, with a zero direction, a NaN or an
/// infinity.
fn rays<V: Vector>(
    rng: &mut fastrand::Rng,
    first: &oracle::Ray,
    other: impl Fn(&mut fastrand::Rng) -> oracle::Ray,
    lanes: usize,
) -> Vec<Ray<V>> {
    let count = if rng.u8(..4) == 0 { rng.usize(0..=lanes) } else { lanes };
    let some = (0..count).map(|lane| {
        let mut next = if lane > 0 && rng.u8(..6) == 0 { other(rng) } else { *first };
        if lane > 0 {
            let axis = rng.usize(..3);
            match rng.u8(..24) {
                0 => next.origin[axis] = f64::NAN,
                1 => next.direction[axis] = f64::INFINITY,
                2 => next.direction = [0.0; 3],
                3 => next.t_max = f64::NAN,
                4 => (next.t_min, next.t_max) = (next.t_max, next.t_min),
                5 => next.t_min = f64::NEG_INFINITY,
                6 => next.direction[axis] *= -1.0,
                7 => next.direction[axis] = 0.0,
                8 => next.direction = next.direction.map(|x| x * 2f64.powi(-90)),
                9..=13 => {
                    let x = &mut next.origin[axis];
                    *x = generators::single(*x * (1.0 + 2f64.powi(-23)));
                }
                14..=18 => {
                    let x = &mut next.direction[axis];
                    *x = generators::single(*x * (1.0 + 2f64.powi(-23)));
                }
                _ => {}
            }
        }
        ray(&next)
    });
    some.collect()
}

/// A NaN that bears a number.
fn marked<T: Scalar>(mark: usize) -> T {
    f32::from_bits(0x7fc0_0000 + u32::try_from(mark).expect("a small number")).into()
}

fn bits<T: Scalar>(number: T) -> u64 {
    let number: f64 = number.into();
    number.to_bits()
}

fn bit(mask: u32, lane: usize) -> bool {
    (mask >> lane) & 1 == 1
}

/// The rays that count in a lane, and how they are now.
fn snapshot<V: Vector<Scalar: Lanes<N>>, const N: usize>(
    packet: &RayPack<V::Scalar, N>,
) -> [Ray<V>; N] {
    core::array::from_fn(|lane| packet.get(lane))
}

fn bits_of<V: Vector>(ray: &Ray<V>) -> [u64; 8] {
    let Ray { origin: o, direction: d, t_min, t_max } = *ray;
    [o.x(), o.y(), o.z(), d.x(), d.y(), d.z(), t_min, t_max].map(bits)
}

/// The same ray, after a hit or none.
fn check_ray<V: Vector>(before: &Ray<V>, after: &Ray<V>, hit: Option<V::Scalar>) {
    let mut expected = *before;
    if let Some(t) = hit {
        expected.t_max = t;
    }
    assert_eq!(bits_of(after), bits_of(&expected), "{before:?} {hit:?}");
}

/// Nothing hit yet, and marks wherever something may be written.
fn unhit<T: Scalar, const N: usize>() -> ClosestTriangles<T, N> {
    let numbers = |start: usize| core::array::from_fn(|lane| marked(start + lane));
    let index = [u32::MAX; N];
    ClosestTriangles { t: numbers(1), u: numbers(50), v: numbers(99), index, front: 0, mask: 0 }
}

fn lane_of<T: Scalar, const N: usize>(
    closest: &ClosestTriangles<T, N>,
    lane: usize,
) -> ([u64; 3], u32, [bool; 2]) {
    let &ClosestTriangles { t, u, v, index, front, mask } = closest;
    let flags = [bit(front, lane), bit(mask, lane)];
    ([bits(t[lane]), bits(u[lane]), bits(v[lane])], index[lane], flags)
}

/// Holds a call against what each active lane should have found.
fn check_triangles<V: Vector<Scalar: Lanes<N>>, const N: usize>(
    [before, after]: [&[Ray<V>; N]; 2],
    [closest_before, closest]: [&ClosestTriangles<V::Scalar, N>; 2],
    (index, active, hit_lanes): (u32, u32, u32),
    expected: impl Fn(usize) -> Option<TriangleHit<V::Scalar>>,
) -> usize {
    let mut hits = 0;
    for lane in 0..N {
        let hit = if bit(active, lane) { expected(lane) } else { None };
        assert_eq!(bit(hit_lanes, lane), hit.is_some(), "{:?} {hit:?}", before[lane]);
        check_ray(&before[lane], &after[lane], hit.map(|hit| hit.t));
        match hit {
            Some(hit) => assert_eq!(closest.get(lane), Some((index, hit)), "{:?}", before[lane]),
            None => assert_eq!(lane_of(closest, lane), lane_of(closest_before, lane)),
        }
        hits += usize::from(hit.is_some());
    }
    hits
}

/// Three triangles in turn, so that the ranges shrink, with Möller–Trumbore, and with the exact kernel.
#[test]
fn triangles() {
    fn check<V: Vector<Scalar: Lanes<N>>, const N: usize>() {
        for level in levels() {
            let mut rng = fastrand::Rng::with_seed(SEED);
            let [mut fast, mut found, mut certain, mut open] = [0; 4];
            for _ in 0..8_000 {
                let (first, vertices) = generators::ray_triangle(&mut rng);
                let other = |rng: &mut fastrand::Rng| generators::ray_triangle(rng).0;
                let rays = rays::<V>(&mut rng, &first, other, N);
                let mut packets = [RayPack::<V::Scalar, N>::from_rays(&rays); 2];
                let mut closest = [unhit(); 2];
                for index in 0..3 {
                    let mut vertices = vertices;
                    let number = &mut vertices[rng.usize(..3)][rng.usize(..3)];
                    match rng.u8(..8) {
                        0 if index > 0 => *number = f64::NAN,
                        1..=4 => *number = generators::single(*number * (1.0 + 2f64.powi(-23))),
                        _ => {}
                    }
                    let triangle = triangle::<V>(&vertices);
                    let (active, all) = (rng.u32(..) | rng.u32(..), packets[0].active());
                    let (before, closest_before) = (packets.map(|p| snapshot::<V, N>(&p)), closest);
                    let (hit, any) = dispatch!(level, simd => {
                        let [packet, exact_packet] = &mut packets;
                        let [closest, exact_closest] = &mut closest;
                        let any = exact_packet.exact_hits(simd, &triangle, active);
                        let hit = [
                            packet.moller_trumbore(simd, &triangle, index, active, closest),
                            exact_packet.exact(simd, &triangle, index, active, exact_closest),
                        ];
                        (hit, any)
                    });
                    let after = packets.map(|packet| snapshot::<V, N>(&packet));
                    fast += check_triangles(
                        [&before[0], &after[0]],
                        [&closest_before[0], &closest[0]],
                        (index, active, hit[0]),
                        |lane| moller_trumbore::intersect(&before[0][lane], &triangle),
                    );
                    let leaves = before[1].map(|ray| in_leaf::<V, N>(level, &ray, &triangle));
                    // To the last bit what a leaf finds, and with the verdict of the scalar kernel.
                    found += check_triangles(
                        [&before[1], &after[1]],
                        [&closest_before[1], &closest[1]],
                        (index, active, hit[1]),
                        |lane| leaves[lane],
                    );
                    assert_eq!(any, hit[1]);
                    for (lane, ray) in
                        before[1].iter().enumerate().filter(|(lane, _)| bit(active & all, *lane))
                    {
                        let front = exact::intersect(ray, &triangle).map(|hit| hit.front);
                        assert_eq!(
                            leaves[lane].map(|hit| hit.front),
                            front,
                            "{ray:?} {triangle:?}"
                        );
                        *(if exact::stage(ray, &triangle) == 0 {
                            &mut certain
                        } else {
                            &mut open
                        }) += 1;
                    }
                }
            }
            println!(
                "{:<6} × {N} {level:?}: {fast} and {found} hits, {certain} certain, {open} open",
                name::<V>()
            );
            assert!(fast > 3_000 && found > 5_000 && certain > 8_000 && open > 8_000);
        }
    }
    for_every_packet!(check);
}

#[test]
fn boxes() {
    fn check<V: Vector<Scalar: Lanes<N>>, const N: usize>() {
        for level in levels() {
            let mut rng = fastrand::Rng::with_seed(SEED + 1);
            let (mut hits, mut misses) = (0, 0);
            for _ in 0..30_000 {
                let (first, mut min, mut max) = generators::ray_aabb(&mut rng);
                let axis = rng.usize(..3);
                match rng.u8(..12) {
                    0 => min[axis] = f64::NAN,
                    1 => (min[axis], max[axis]) = (max[axis], min[axis]),
                    2 => max[axis] = f64::INFINITY,
                    _ => {}
                }
                let aabb = aabb::<V>(&min, &max);
                let rays = rays::<V>(&mut rng, &first, |rng| generators::ray_aabb(rng).0, N);
                let packet = RayPack::<V::Scalar, N>::from_rays(&rays);
                let active = rng.u32(..) | rng.u32(..);
                let answer = dispatch!(level, simd => packet.conservative(simd, &aabb, active));
                for lane in 0..N {
                    let ray = rays.get(lane).filter(|_| bit(active, lane));
                    let enter =
                        ray.and_then(|ray| conservative::interval(&BoxRay::new(ray), &aabb));
                    let found = bit(answer.mask, lane).then_some(answer.t_enter[lane]);
                    assert_eq!(found, enter.map(|[enter, _]| enter), "{ray:?} {aabb:?}");
                    *(if enter.is_some() { &mut hits } else { &mut misses }) += 1;
                }
                assert_eq!(answer.mask >> N, 0);
            }
            println!("{:<6} × {N} {level:?}: {hits} hits, {misses} misses", name::<V>());
            assert!(hits > 10_000 && misses > 10_000, "{hits} {misses}");
        }
    }
    for_every_packet!(check);
}

#[test]
fn spheres() {
    fn check<V: Vector<Scalar: Lanes<N>>, const N: usize>() {
        for level in levels() {
            let mut rng = fastrand::Rng::with_seed(SEED + 2);
            let (mut hits, mut leaving, mut misses) = (0, 0, 0);
            for _ in 0..20_000 {
                let (first, mut center, radius) = generators::ray_sphere(&mut rng);
                let rays = rays::<V>(&mut rng, &first, |rng| generators::ray_sphere(rng).0, N);
                let mut packet = RayPack::<V::Scalar, N>::from_rays(&rays);
                let mut closest = ClosestSpheres {
                    t: core::array::from_fn(marked),
                    index: [u32::MAX; N],
                    leaving: 0,
                    mask: 0,
                };
                for (index, factor) in [(0, 1.0), (1, 0.75), (2, -1.0), (3, f64::NAN)] {
                    center[rng.usize(..3)] *= 1.0 + 2f64.powi(-23);
                    let sphere = sphere::<V>(&center.map(generators::single), radius * factor);
                    let active = rng.u32(..) | rng.u32(..);
                    let (before, closest_before) = (snapshot::<V, N>(&packet), closest);
                    let hit_lanes = dispatch!(level, simd => {
                        packet.robust(simd, &sphere, index, active, &mut closest)
                    });
                    for (lane, ray) in before.iter().enumerate() {
                        let hit =
                            if bit(active, lane) { robust::intersect(ray, &sphere) } else { None };
                        assert_eq!(bit(hit_lanes, lane), hit.is_some(), "{ray:?} {sphere:?}");
                        check_ray(ray, &packet.get(lane), hit.map(|hit| hit.t));
                        let lane_of = |c: &ClosestSpheres<V::Scalar, N>| {
                            let flags = [bit(c.leaving, lane), bit(c.mask, lane)];
                            (bits(c.t[lane]), c.index[lane], flags)
                        };
                        match hit {
                            Some(hit) => assert_eq!(closest.get(lane), Some((index, hit))),
                            None => assert_eq!(lane_of(&closest), lane_of(&closest_before)),
                        }
                        hits += u32::from(hit.is_some());
                        leaving += u32::from(hit.is_some_and(|hit| hit.leaving));
                        misses += u32::from(hit.is_none());
                    }
                }
            }
            println!(
                "{:<6} × {N} {level:?}: {hits} hits, {leaving} leaving, {misses} misses",
                name::<V>()
            );
            assert!(
                hits > 10_000 && leaving > 2_000 && misses > 10_000,
                "{hits} {leaving} {misses}"
            );
        }
    }
    for_every_packet!(check);
}

#[test]
fn planes() {
    fn check<V: Vector<Scalar: Lanes<N>>, const N: usize>() {
        for level in levels() {
            let mut rng = fastrand::Rng::with_seed(SEED + 3);
            let (mut crossing, mut contained, mut misses) = (0, 0, 0);
            for _ in 0..30_000 {
                let (first, mut normal, offset) = generators::ray_plane(&mut rng);
                match rng.u8(..20) {
                    0 => normal[rng.usize(..3)] = f64::NAN,
                    1 => normal = [0.0; 3],
                    _ => {}
                }
                let plane = shapes::plane::<V>(&normal, offset);
                let rays = rays::<V>(&mut rng, &first, |rng| generators::ray_plane(rng).0, N);
                let mut packet = RayPack::<V::Scalar, N>::from_rays(&rays);
                let active = rng.u32(..) | rng.u32(..);
                let before = snapshot::<V, N>(&packet);
                let hits = dispatch!(level, simd => packet.plane(simd, &plane, active));
                packet.shorten(hits.mask, &hits.t);
                for (lane, ray) in before.iter().enumerate() {
                    let hit = if bit(active, lane) { plane::intersect(ray, &plane) } else { None };
                    assert_eq!(hits.get(lane), hit, "{ray:?} {plane:?}");
                    let t = if let Some(PlaneHit::At(t)) = hit { Some(t) } else { None };
                    check_ray(ray, &packet.get(lane), t);
                    match hit {
                        Some(PlaneHit::At(_)) => crossing += 1,
                        Some(PlaneHit::Contained) => contained += 1,
                        None => misses += 1,
                    }
                }
                assert_eq!((hits.mask | hits.contained) >> N, 0);
            }
            println!(
                "{:<6} × {N} {level:?}: {crossing} crossing, {contained} contained, {misses} misses",
                name::<V>()
            );
            assert!(crossing > 10_000 && contained > 500 && misses > 10_000);
        }
    }
    for_every_packet!(check);
}

#[test]
fn packets_give_back_what_they_hold() {
    let rays = [Vec3::X, Vec3::ZERO, Vec3::Y].map(|direction| Ray::new(Vec3::ONE, direction));
    let packet = RayPack::<f32, 4>::from_rays(&[rays[0], rays[1], rays[2].with_range(2.0, 1.0)]);
    assert_eq!((packet.active(), packet.get(0)), (0b001, rays[0]));
    assert_eq!(packet.get(2), rays[2].with_range(2.0, 1.0));
    assert!([3, 4].iter().all(|&lane| packet.get::<Vec3>(lane).direction == Vec3::ZERO));
    assert_eq!(RayPack::<f32, 4>::default().active(), 0);
}

#[test]
#[should_panic(expected = "5 rays for 4 lanes")]
fn more_rays_than_lanes_are_refused() {
    let _ = RayPack::<f32, 4>::from_rays(&[Ray::new(Vec3::ZERO, Vec3::X); 5]);
}
