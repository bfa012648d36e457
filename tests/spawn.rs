//! Claim: a ray that starts where `spawn` puts it does not hit the surface that it leaves.
//!
//! After the tests of that name in pbrt: shapes of which every coordinate has its own magnitude, hit from anywhere,
//! and left in all directions. `cargo test --test suite spawn -- --ignored` runs them at full scale.

use isect::glam::{Affine3A, Vec3, Vec3A};
use isect::ray::aabb::{AabbHit, BoxRay, conservative, slab};
use isect::ray::plane::PlaneHit;
use isect::ray::sphere::SphereHit;
use isect::ray::triangle::TriangleHit;
use isect::{Aabb, Affine, Face, Plane, Ray, Scalar, Sphere, Triangle, Vector, spawn};
use num_bigint::BigInt;

use crate::support::bounds::unit_roundoff;
use crate::support::{
    aabb, array, for_every_vector, generators, name, oracle, ray, scalar, sphere, triangle, vector,
};

const SEED: u64 = 8;
/// Shapes of the default run, and of the run at full scale, for each vector type; rays from each.
const SHAPES: [u32; 2] = [200, 1_000];
const RAYS: u32 = 1_000;
/// Of so many rays one is shown to the oracle.
const SAMPLE: u32 = 10;
/// Rays from one hit.
const PER_HIT: u32 = 50;

/// 10^x of either sign, x uniform from −exponent to exponent.
fn magnitude(rng: &mut fastrand::Rng, exponent: f64) -> f64 {
    let size = 10_f64.powf((2.0 * rng.f64() - 1.0) * exponent);
    if rng.bool() { size } else { -size }
}

fn point<V: Vector>(rng: &mut fastrand::Rng, exponent: f64) -> V {
    vector([(); 3].map(|()| magnitude(rng, exponent)))
}

/// A direction of any length: uniform on the sphere.
fn direction<V: Vector>(rng: &mut fastrand::Rng) -> V {
    loop {
        let v = [(); 3].map(|()| 2.0 * rng.f64() - 1.0);
        let square: f64 = v.iter().map(|x| x * x).sum();
        if (1e-3..1.0).contains(&square) {
            let length = magnitude(rng, 3.0).abs() / square.sqrt();
            return vector(v.map(|x| x * length));
        }
    }
}

/// A direction to leave by: any, nearly in the tangent plane, along axes.
fn departure<V: Vector>(rng: &mut fastrand::Rng, normal: V) -> V {
    let any = direction::<V>(rng);
    match rng.u8(..4) {
        0 | 1 => any,
        2 => {
            // In the plane as computed, tilted by as little as 10^−20.
            let normal = normal * (V::Scalar::ONE / normal.length());
            let along = normal.cross(any);
            let tilt = 10_f64.powf(-20.0 * rng.f64()) * if rng.bool() { 1.0 } else { -1.0 };
            along + normal * (along.length() * scalar(tilt))
        }
        _ => {
            let axes = [(); 3].map(|()| f64::from(rng.i8(-1..=1)));
            if axes == [0.0; 3] { any } else { vector(axes) }
        }
    }
}

fn oracle_ray<V: Vector>(ray: &Ray<V>) -> oracle::Ray {
    oracle::Ray {
        origin: array(ray.origin),
        direction: array(ray.direction),
        t_min: ray.t_min.into(),
        t_max: ray.t_max.into(),
    }
}

fn vertices<V: Vector>(triangle: &Triangle<V>) -> [[f64; 3]; 3] {
    <[V; 3]>::from(*triangle).map(array)
}

/// Rays shown to a kernel and to the oracle, and what they hit that they should not have.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Tally {
    rays: u32,
    hits: u32,
    exact_rays: u32,
    exact_hits: u32,
}

impl Tally {
    fn count(&mut self, hit: bool, exactly: impl FnOnce() -> bool) {
        self.rays += 1;
        self.hits += u32::from(hit);
        if self.rays.is_multiple_of(SAMPLE) {
            self.exact_rays += 1;
            self.exact_hits += u32::from(exactly());
        }
    }
}

/// The rays that leave the hits of one shape.
type Campaign = fn(&mut fastrand::Rng, &mut Tally, share: f64);

/// A triangle of which every coordinate has a magnitude of 10^±8.
fn wild_triangle<V: Vector>(rng: &mut fastrand::Rng) -> Triangle<V> {
    [(); 3].map(|()| point(rng, 8.0)).into()
}

/// A sphere with a radius of 10^±4, the centre's coordinates likewise: some are points as far as floats can tell.
fn wild_sphere<V: Vector>(rng: &mut fastrand::Rng) -> Sphere<V> {
    let radius = magnitude(rng, 4.0).abs();
    Sphere::new(point(rng, 4.0), scalar(radius))
}

/// A sphere with a radius of only 32 to 300 roundings of its centre: few floats are on it, and none very near.
fn grain<V: Vector>(rng: &mut fastrand::Rng) -> Sphere<V> {
    let center = uniform(rng);
    let largest = center.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    let roundings = 32.0 * 10_f64.powf(rng.f64());
    let radius = roundings * unit_roundoff::<V::Scalar>() * largest;
    Sphere::new(vector(center), scalar(radius))
}

/// A box between coordinates of 10^±8, or zero; some are flat.
fn wild_box<V: Vector>(rng: &mut fastrand::Rng) -> Aabb<V> {
    let mut corner =
        || vector::<V>([(); 3].map(|()| if rng.u8(..4) == 0 { 0.0 } else { magnitude(rng, 8.0) }));
    Aabb::from_points([corner(), corner()])
}

/// A plane with a normal and a point of 10^±8.
fn wild_plane<V: Vector>(rng: &mut fastrand::Rng) -> Plane<V> {
    let normal = match rng.u8(..4) {
        0 => vector([0.0, magnitude(rng, 8.0), 0.0]),
        _ => point::<V>(rng, 8.0),
    };
    let through = if rng.u8(..4) == 0 { V::ZERO } else { point(rng, 8.0) };
    Plane::from_point_normal(through, normal).expect("the normal is not zero")
}

fn leave_triangle<V: Vector>(rng: &mut fastrand::Rng, tally: &mut Tally, share: f64) {
    let triangle = wild_triangle::<V>(rng);
    leave_from(rng, tally, share, &triangle, 8.0, |rng| {
        let (u, v) = (rng.f64(), rng.f64());
        if u + v > 1.0 { [1.0 - u, 1.0 - v] } else { [u, v] }
    });
}

/// A triangle around the origin, hit near a vertex: neither its own rounding nor its shape needs much room.
fn leave_corner<V: Vector>(rng: &mut fastrand::Rng, tally: &mut Tally, share: f64) {
    let triangle = Triangle::<V>::from([(); 3].map(|()| vector(uniform(rng))));
    let triangle = Triangle { v0: triangle.v0 * scalar(1e-3), ..triangle };
    leave_from(rng, tally, share, &triangle, 0.5, |rng| {
        [(); 2].map(|()| magnitude(rng, 3.0).abs() * 1e-5)
    });
}

/// Rays from hits with the given weights, seen from eyes with coordinates of 10^±exponent.
fn leave_from<V: Vector>(
    rng: &mut fastrand::Rng,
    tally: &mut Tally,
    share: f64,
    triangle: &Triangle<V>,
    exponent: f64,
    weights: impl Fn(&mut fastrand::Rng) -> [f64; 2],
) {
    let mut left = 0;
    for _ in 0..100 * RAYS / PER_HIT {
        let [u, v] = weights(rng);
        let aim = triangle.at(scalar(u), scalar(v));
        let origin = point::<V>(rng, exponent);
        let ray = Ray::new(origin, aim - origin);
        // Some are too narrow to be hit.
        let Some(hit) = ray.intersect(triangle) else { continue };
        let (point, error) = hit.point_and_error(triangle);
        let normal = triangle.normal();
        let unit = normal * (V::Scalar::ONE / normal.length());
        for _ in 0..PER_HIT {
            // Towards a vertex as well: flat, and over what there is of the triangle.
            let leaving = match rng.u8(..8) {
                vertex @ 0..3 => <[V; 3]>::from(*triangle)[usize::from(vertex)] - point,
                _ => departure(rng, normal),
            };
            let normal = if rng.bool() { normal } else { unit };
            let origin = spawn::offset_origin(point, error * scalar(share), normal, leaving);
            let ray = Ray::new(origin, leaving);
            tally.count(ray.hits(triangle), || {
                oracle::triangle(&oracle_ray(&ray), vertices(triangle)).hits()
            });
        }
        left += PER_HIT;
        if left == RAYS {
            return;
        }
    }
}

fn leave_sphere<V: Vector>(rng: &mut fastrand::Rng, tally: &mut Tally, share: f64) {
    let sphere = wild_sphere::<V>(rng);
    leave_ball(rng, tally, share, &sphere);
}

fn leave_grain<V: Vector>(rng: &mut fastrand::Rng, tally: &mut Tally, share: f64) {
    let sphere = grain::<V>(rng);
    leave_ball(rng, tally, share, &sphere);
}

fn leave_ball<V: Vector>(
    rng: &mut fastrand::Rng,
    tally: &mut Tally,
    share: f64,
    sphere: &Sphere<V>,
) {
    let mut left = 0;
    while left < RAYS {
        let origin = point::<V>(rng, 4.0);
        let aim = sphere.center + direction::<V>(rng) * (sphere.radius * scalar(1e-3));
        let ray = Ray::new(origin, aim - origin);
        let Some(hit) = ray.intersect(sphere) else { continue };
        let (point, error) = hit.point_and_error(&ray, sphere);
        let normal = sphere.normal_at(point);
        let covers = (0..3).all(|axis| error.component(axis) >= sphere.radius);
        for _ in 0..PER_HIT {
            let leaving = departure(rng, normal);
            let origin = spawn::offset_origin(point, error * scalar(share), normal, leaving);
            let ray = Ray::new(origin, leaving);
            if covers || !points_inward(normal, leaving) {
                tally.count(ray.hits(sphere), || {
                    oracle::sphere(&oracle_ray(&ray), array(sphere.center), sphere.radius.into())
                });
            } else {
                // From inside, the far side is hit and nothing else.
                let is_far = ray.intersect(sphere).is_some_and(|hit| hit.leaving);
                tally.count(!is_far, || {
                    let (ray, center) = (oracle_ray(&ray), array(sphere.center));
                    oracle::sphere_side(&ray, center, sphere.radius.into(), 0.0)
                        .is_none_or(std::cmp::Ordering::is_ge)
                });
            }
        }
        left += PER_HIT;
    }
}

/// Whether n·d < 0: the plane n·x = 0 is ahead of a ray from n.
fn points_inward<V: Vector>(normal: V, direction: V) -> bool {
    let (origin, direction) = (array(normal), array(direction));
    let ray = oracle::Ray { origin, direction, t_min: 0.0, t_max: f64::INFINITY };
    oracle::plane(&ray, origin, 0.0) == oracle::PlaneVerdict::At
}

fn leave_box<V: Vector>(rng: &mut fastrand::Rng, tally: &mut Tally, _: f64) {
    let aabb = wild_box::<V>(rng);
    let mut left = 0;
    while left < RAYS {
        let (origin, weights) = (point::<V>(rng, 8.0), [(); 3].map(|()| rng.f64()));
        let inside = aabb.min + (aabb.max - aabb.min).scaled(vector(weights));
        let ray = Ray::new(origin, inside - origin);
        let ray = if rng.bool() { Ray { origin: inside, ..ray } } else { ray };
        let Some(hit) = slab::intersect(&BoxRay::new(&ray), &aabb) else { continue };
        let Some((point, error)) = hit.point_and_error(&ray, &aabb) else { continue };
        assert!(aabb.contains(point) && error == V::ZERO);
        let (_, face) = hit.surface().expect("the point is on it");
        let normal: V = face.normal();
        for _ in 0..PER_HIT {
            let leaving = departure(rng, normal);
            let ray = Ray::new(spawn::offset_origin(point, error, normal, leaving), leaving);
            let outward = normal.dot(leaving) >= V::Scalar::ZERO;
            if outward || !aabb.contains(ray.origin) {
                let kernels = [slab::hits, conservative::hits];
                let hit = kernels.iter().any(|hits| hits(&BoxRay::new(&ray), &aabb));
                tally.count(hit, || {
                    oracle::aabb(&oracle_ray(&ray), array(aabb.min), array(aabb.max))
                });
            } else {
                // From inside, this face is not entered. (Another may be, from a point on an edge.)
                let hit = ray.intersect(&aabb);
                tally.count(hit.is_none_or(|hit| hit.enter_face == Some(face)), || {
                    let axis = face.axis();
                    let start = ray.origin.component(axis);
                    start <= aabb.min.component(axis) || start >= aabb.max.component(axis)
                });
            }
        }
        left += PER_HIT;
    }
}

fn leave_plane<V: Vector>(rng: &mut fastrand::Rng, tally: &mut Tally, share: f64) {
    let plane = wild_plane::<V>(rng);
    let normal = plane.normal;
    let mut left = 0;
    while left < RAYS {
        let ray = Ray::new(point::<V>(rng, 8.0), direction(rng));
        let Some(hit @ PlaneHit::At(_)) = ray.intersect(&plane) else { continue };
        let (point, error) = hit.point_and_error(&ray, &plane).expect("it is not contained");
        for _ in 0..PER_HIT {
            let leaving = departure(rng, normal);
            let origin = spawn::offset_origin(point, error * scalar(share), normal, leaving);
            let ray = Ray::new(origin, leaving);
            tally.count(ray.hits(&plane), || {
                oracle::plane(&oracle_ray(&ray), array(normal), plane.offset.into())
                    != oracle::PlaneVerdict::Miss
            });
        }
        left += PER_HIT;
    }
}

/// Runs a campaign over so many shapes, with a share of the error.
fn run(leave: Campaign, shapes: u32, share: f64) -> Tally {
    let mut rng = fastrand::Rng::with_seed(SEED);
    let mut tally = Tally::default();
    for _ in 0..shapes {
        leave(&mut rng, &mut tally, share);
    }
    tally
}

fn check<V: Vector>(shape: &str, leave: Campaign, shapes: u32) {
    let tally = run(leave, shapes, 1.0);
    println!("{:<6} {shape:<9} {tally:?}", name::<V>());
    assert!(tally.rays >= shapes * RAYS / 10 * 9, "{tally:?}");
    assert_eq!((tally.hits, tally.exact_hits), (0, 0), "{shape} {}: {tally:?}", name::<V>());
}

fn check_all<V: Vector>(shapes: u32) {
    check::<V>("triangles", leave_triangle::<V>, shapes);
    check::<V>("corners", leave_corner::<V>, shapes);
    check::<V>("spheres", leave_sphere::<V>, shapes);
    check::<V>("grains", leave_grain::<V>, shapes);
    check::<V>("boxes", leave_box::<V>, shapes);
    check::<V>("planes", leave_plane::<V>, shapes);
}

#[test]
fn no_ray_hits_what_it_leaves() {
    for_every_vector!(check_all, SHAPES[0]);
}

#[test]
#[ignore = "18,000,000 rays"]
fn no_ray_hits_what_it_leaves_at_full_scale() {
    for_every_vector!(check_all, SHAPES[1]);
}

/// The errors are no larger than they need to be: with a small part of them, rays do hit.
#[test]
fn a_fraction_of_the_error_is_not_enough() {
    fn check<V: Vector>() {
        let campaigns: [(&str, Campaign, f64); 3] = [
            ("triangles", leave_triangle::<V>, 16.0),
            ("spheres", leave_sphere::<V>, 8.0),
            ("planes", leave_plane::<V>, 16.0),
        ];
        for (shape, leave, fraction) in campaigns {
            let tally = run(leave, SHAPES[0], 1.0 / fraction);
            println!("{:<6} {shape:<9} 1/{fraction}: {tally:?}", name::<V>());
            assert!(tally.hits > 0, "{shape} {}", name::<V>());
        }
    }
    for_every_vector!(check);
}

/// A triangle of so large a size, about a point of the cube from −1 to 1, and not narrower than 1 to 8: the offset grows with
/// the aspect.
fn triangle_of_size<V: Vector>(rng: &mut fastrand::Rng, size: f64) -> Triangle<V> {
    loop {
        let [center, x, y, z] = [(); 4].map(|()| uniform(rng));
        let corner = |c: [f64; 3]| vector(std::array::from_fn(|i| center[i] + size * c[i]));
        let triangle = Triangle::<V>::from([x, y, z].map(corner));
        let edges =
            [triangle.v1 - triangle.v0, triangle.v2 - triangle.v1, triangle.v0 - triangle.v2];
        let longest: f64 = edges.iter().map(|e| e.length().into()).fold(0.0, f64::max);
        if 2.0 * triangle.area().into() >= longest * longest / 8.0 {
            return triangle;
        }
    }
}

/// The documentation's numbers, rounded up: ulps of the largest coordinate, by the triangle's size against its distance.
#[test]
fn offsets_are_a_few_ulps() {
    fn check<V: Vector>() {
        let mut rng = fastrand::Rng::with_seed(SEED + 1);
        for (size, median, most) in [(1.0, 3.0, 8.0), (0.1, 2.0, 4.0), (0.01, 2.0, 4.0)] {
            let mut offsets = Vec::new();
            while offsets.len() < 2_000 {
                let triangle = triangle_of_size::<V>(&mut rng, size);
                let origin = vector::<V>(uniform(&mut rng).map(|x| 3.0 * x));
                let aim = triangle.at(scalar(0.3), scalar(0.4));
                let Some(hit) = Ray::new(origin, aim - origin).intersect(&triangle) else {
                    continue;
                };
                let (point, error) = hit.point_and_error(&triangle);
                let normal = triangle.normal();
                let moved: V = spawn::offset_origin(point, error, normal, normal) - point;
                let largest =
                    vertices(&triangle).as_flattened().iter().fold(0.0, |m: f64, x| m.max(x.abs()));
                let ulp = 2.0 * unit_roundoff::<V::Scalar>() * largest;
                offsets.push(moved.length().into() / ulp);
            }
            offsets.sort_by(f64::total_cmp);
            let (middle, last) = (offsets[1_000], offsets[1_999]);
            println!("{:<6} size {size}: median {middle:.1} ulps, at most {last:.1}", name::<V>());
            assert!(middle < median && last < most, "{size}: {middle} {last}");
        }
    }
    for_every_vector!(check);
}

fn uniform(rng: &mut fastrand::Rng) -> [f64; 3] {
    [(); 3].map(|()| 2.0 * rng.f64() - 1.0)
}

/// A number times 2^400, of which it is to be an integer.
fn exact(x: f64) -> BigInt {
    let bits = x.abs().to_bits();
    let (exponent, fraction) = (bits >> 52, bits & ((1 << 52) - 1));
    assert!(exponent == 0 && fraction == 0 || (675..2047).contains(&exponent), "{x}");
    let magnitude = match exponent {
        0 => BigInt::ZERO,
        _ => BigInt::from(fraction | 1 << 52) << (exponent - 675),
    };
    if x < 0.0 { -magnitude } else { magnitude }
}

/// The components times 2^400.
fn exact_array<V: Vector>(v: V) -> [BigInt; 3] {
    array(v).map(exact)
}

fn exact_sub(a: &[BigInt; 3], b: &[BigInt; 3]) -> [BigInt; 3] {
    std::array::from_fn(|i| &a[i] - &b[i])
}

fn exact_dot(a: &[BigInt; 3], b: &[BigInt; 3]) -> BigInt {
    (0..3).map(|i| &a[i] * &b[i]).sum()
}

fn magnitudes(v: &[BigInt; 3]) -> [BigInt; 3] {
    v.each_ref().map(|x| x.magnitude().clone().into())
}

/// Exactly, in integers: both sides of each inequality have as many factors of 2^400.
#[test]
fn errors_are_bounds() {
    fn check<V: Vector>() {
        let mut rng = fastrand::Rng::with_seed(SEED + 2);
        let mut counts = [0; 3];
        let one = exact(1.0);
        for _ in 0..50_000 {
            let ray = Ray::new(point::<V>(&mut rng, 4.0), direction(&mut rng));

            let triangle = Triangle::<V>::from([(); 3].map(|()| point(&mut rng, 4.0)));
            let aim = triangle.at(scalar(rng.f64() / 2.0), scalar(rng.f64() / 2.0)) - ray.origin;
            if let Some(hit) = (Ray { direction: aim, ..ray }).intersect(&triangle) {
                counts[0] += 1;
                let (p, error) = hit.point_and_error(&triangle);
                let (p, error) = (exact_array(p), exact_array(error));
                let vertices = <[V; 3]>::from(triangle).map(exact_array);
                let [e1, e2] = [1, 2].map(|i| exact_sub(&vertices[i], &vertices[0]));
                let (u, v) = (exact(hit.u.into()), exact(hit.v.into()));
                for i in 0..3 {
                    let off = (&vertices[0][i] - &p[i]) * &one + &u * &e1[i] + &v * &e2[i];
                    assert!(
                        *off.magnitude() <= *(&error[i] * &one).magnitude(),
                        "{triangle:?} {hit:?}"
                    );
                }
                let normal = exact_array(triangle.normal());
                let reach = exact_dot(&magnitudes(&normal), &error);
                for vertex in &vertices {
                    let distance = exact_dot(&normal, &exact_sub(vertex, &p));
                    assert!(distance.magnitude() <= reach.magnitude(), "{triangle:?} {hit:?}");
                }
            }

            let radius = magnitude(&mut rng, 4.0).abs();
            let sphere = Sphere::new(point::<V>(&mut rng, 4.0), scalar(radius));
            let ray_at = Ray { direction: sphere.center - ray.origin, ..ray };
            if let Some(hit) = ray_at.intersect(&sphere) {
                counts[1] += 1;
                let (p, error) = hit.point_and_error(&ray_at, &sphere);
                let (arm, error) =
                    (exact_sub(&exact_array(p), &exact_array(sphere.center)), exact_array(error));
                let radius = exact(sphere.radius.into());
                let square = exact_dot(&arm, &arm);
                for (m, error) in arm.iter().zip(&error) {
                    if square == BigInt::ZERO {
                        // The nearest point of the sphere is any.
                        assert!(radius <= *error, "{ray_at:?} {sphere:?} {hit:?}");
                        continue;
                    }
                    // ||m| − r|·|m_i| ≤ δ·|m|, squared, and once more: (|m|² + r²)·m_i² − δ²·|m|² ≤ 2·r·m_i²·|m|.
                    let excess = (&square + &radius * &radius) * m * m - error * error * &square;
                    let half = &radius * m * m;
                    let is_within =
                        excess <= BigInt::ZERO || &excess * &excess <= &half * &half * &square * 4;
                    assert!(is_within, "{ray_at:?} {sphere:?} {hit:?}");
                }
            }

            let normal = point::<V>(&mut rng, 4.0);
            let plane = Plane::from_point_normal(point(&mut rng, 4.0), normal).expect("not zero");
            if let Some(hit @ PlaneHit::At(_)) = ray.intersect(&plane) {
                counts[2] += 1;
                let (p, error) = hit.point_and_error(&ray, &plane).expect("not contained");
                let (p, error, n) = (exact_array(p), exact_array(error), exact_array(normal));
                let above = exact_dot(&n, &p) - exact(plane.offset.into()) * &one;
                let reach = exact_dot(&magnitudes(&n), &error);
                assert!(above.magnitude() <= reach.magnitude(), "{ray:?} {plane:?} {hit:?}");
                let square = exact_dot(&n, &n);
                for i in 0..3 {
                    let off = &above * &n[i];
                    assert!(*off.magnitude() <= *(&error[i] * &square).magnitude());
                }
            }
        }
        println!("{:<6} {counts:?} triangles, spheres, planes", name::<V>());
        assert!(counts.iter().all(|&n| n > 15_000), "{counts:?}");
    }
    for_every_vector!(check);
}

/// Points within the error, its corners among them, have images within the image's error. In double precision, as above:
/// a map of single-precision numbers costs it 2⁻⁵⁰ of the magnitudes, and the margin is 2⁻²⁰ of their rounding errors.
#[test]
fn images_are_within_the_image_of_the_error() {
    fn check<V: Vector>()
    where
        Affine3A: Affine<V>,
    {
        let mut rng = fastrand::Rng::with_seed(SEED + 3);
        for case in 0..200_000 {
            let mut column = || point::<Vec3A>(&mut rng, 3.0);
            let linear = [column(), column(), column()];
            let p = column();
            // Half of them cancel: the image is near zero.
            let shift = if case % 2 == 0 {
                column()
            } else {
                -(linear[0] * p.x + linear[1] * p.y + linear[2] * p.z)
            };
            let map = Affine3A::from_cols(linear[0], linear[1], linear[2], shift);
            let error = column().abs() * 1e-6;
            let (image, image_error) =
                spawn::transform(vector::<V>(array(p)), vector(array(error)), &map);
            let weights = [(); 3].map(|()| [-1.0, 1.0, 2.0 * rng.f64() - 1.0][rng.usize(..3)]);
            let (p, error) = (array(p), array(error));
            let q: [f64; 3] = std::array::from_fn(|i| p[i] + weights[i] * error[i]);
            let [x, y, z] = linear.map(array);
            for i in 0..3 {
                let exact = x[i] * q[0] + y[i] * q[1] + z[i] * q[2] + array(shift)[i];
                let off = (exact - array(image)[i]).abs();
                assert!(off <= array(image_error)[i], "{map:?} {q:?} {i}");
            }
        }
    }
    check::<Vec3>();
    check::<Vec3A>();
}

/// What a shadow ray may start or end on.
enum Shape<V: Vector> {
    Triangle(Triangle<V>),
    Sphere(Sphere<V>),
    Box(Aabb<V>),
    Plane(Plane<V>),
}

impl<V: Vector> Shape<V> {
    fn random(rng: &mut fastrand::Rng) -> Self {
        let (center, size): (V, _) = (point(rng, 2.0), magnitude(rng, 1.0).abs());
        let kind = rng.u8(..4);
        let mut near = || center + vector(uniform(rng).map(|x| x * size));
        match kind {
            0 => Self::Sphere(Sphere::new(center, scalar(size))),
            1 => Self::Box(Aabb::from_points([near(), near()])),
            2 => Self::Plane(Plane::from_points(near(), near(), near()).expect("not collinear")),
            _ => Self::Triangle([near(), near(), near()].into()),
        }
    }

    /// A point on the side towards `from`, its error and normal.
    fn surface(&self, rng: &mut fastrand::Rng, from: V) -> Option<[V; 3]> {
        let (u, v) = (scalar(rng.f64() / 2.0), scalar(rng.f64() / 2.0));
        let towards = |target: V| Ray::new(from, target - from);
        match self {
            Self::Triangle(shape) => {
                let (point, error) =
                    towards(shape.at(u, v)).intersect(shape)?.point_and_error(shape);
                Some([point, error, shape.normal()])
            }
            Self::Sphere(shape) => {
                let inside = shape.center + vector::<V>(uniform(rng)) * (shape.radius * u);
                let ray = towards(inside);
                let (point, error) = ray.intersect(shape)?.point_and_error(&ray, shape);
                Some([point, error, shape.normal_at(point)])
            }
            Self::Box(shape) => {
                let ray = towards(shape.min * u + shape.max * (V::Scalar::ONE - u));
                let hit = ray.intersect(shape).filter(|hit| hit.enter_face.is_some())?;
                let (point, error) = hit.point_and_error(&ray, shape)?;
                Some([point, error, hit.surface()?.1.normal()])
            }
            Self::Plane(shape) => {
                let ray = Ray::new(from, direction(rng));
                let (point, error) = ray.intersect(shape)?.point_and_error(&ray, shape)?;
                Some([point, error, shape.normal])
            }
        }
    }

    /// Whether a way out of the surface leads off it: not into the inside, and not so flat that its end is in the plane
    /// of the surface as far as single precision can tell, with 32 roundings and the offsets of both ends.
    fn is_clear(&self, normal: V, way: V) -> bool {
        let products = array(normal.scaled(way));
        let magnitude: f64 = products.iter().map(|x| x.abs()).sum();
        let is_flat = products.iter().sum::<f64>().abs() < 1e-4 * magnitude;
        let has_inside = matches!(self, Self::Sphere(_) | Self::Box(_));
        !(is_flat || has_inside && points_inward(normal, way))
    }

    fn is_hit(&self, ray: &Ray<V>) -> bool {
        match self {
            Self::Triangle(shape) => ray.hits(shape),
            Self::Sphere(shape) => ray.hits(shape),
            Self::Box(shape) => ray.hits(shape),
            Self::Plane(shape) => ray.hits(shape),
        }
    }

    /// A direction to leave by: over what there is of a triangle, or as from any surface.
    fn departure(&self, rng: &mut fastrand::Rng, normal: V, origin: V) -> V {
        match self {
            Self::Triangle(Triangle { v0, v1, v2 }) if rng.bool() => {
                // To a vertex, or as close to one as 10⁻⁸ of an edge.
                let corners =
                    [[*v0, *v1, *v2], [*v1, *v2, *v0], [*v2, *v0, *v1]].map(Triangle::from);
                let [u, v] =
                    [(); 2].map(|()| if rng.bool() { 0.0 } else { 10_f64.powf(-8.0 * rng.f64()) });
                corners[rng.usize(..3)].at(scalar(u), scalar(v)) - origin
            }
            _ => departure(rng, normal),
        }
    }

    /// Whether a ray from a hit meets the surface that it leaves.
    fn is_hit_again(&self, ray: &Ray<V>, [point, error, normal]: [V; 3], is_outward: bool) -> bool {
        match self {
            // From inside, there is the far side.
            Self::Sphere(shape) if !is_outward && error.max_element() < shape.radius => {
                ray.intersect(shape).is_none_or(|hit| !hit.leaving)
            }
            Self::Box(_) if !is_outward => normal.dot(ray.origin - point) >= V::Scalar::ZERO,
            _ => self.is_hit(ray),
        }
    }

    /// The largest coordinate of the shape; of a plane, that of the point.
    fn largest(&self, point: V) -> f64 {
        let points = match self {
            Self::Triangle(shape) => vec![shape.v0, shape.v1, shape.v2],
            Self::Sphere(Sphere { center, radius }) => {
                vec![*center + V::splat(*radius), *center - V::splat(*radius)]
            }
            Self::Box(shape) => vec![shape.min, shape.max],
            Self::Plane(_) => vec![point],
        };
        points.iter().map(|p| p.abs().max_element().into()).fold(0.0, f64::max)
    }

    fn is_hit_exactly(&self, ray: &Ray<V>) -> bool {
        let ray = oracle_ray(ray);
        match self {
            Self::Triangle(shape) => oracle::triangle(&ray, vertices(shape)).hits(),
            Self::Sphere(shape) => oracle::sphere(&ray, array(shape.center), shape.radius.into()),
            Self::Box(shape) => oracle::aabb(&ray, array(shape.min), array(shape.max)),
            Self::Plane(Plane { normal, offset }) => {
                oracle::plane(&ray, array(*normal), (*offset).into()) != oracle::PlaneVerdict::Miss
            }
        }
    }
}

/// Between any two shapes, neither of which is in the other's way; and a triangle in the middle is hit.
#[test]
fn segments_hit_neither_end_but_what_is_between() {
    fn check<V: Vector>() {
        let mut rng = fastrand::Rng::with_seed(SEED + 4);
        let (mut tally, mut exact, mut occluded) = (Tally::default(), 0, 0);
        while tally.rays < 200_000 {
            let [a, b] = [(); 2].map(|()| Shape::<V>::random(&mut rng));
            let eye = point(&mut rng, 3.0);
            let Some([start, start_error, start_normal]) = a.surface(&mut rng, eye) else {
                continue;
            };
            let Some([end, end_error, end_normal]) = b.surface(&mut rng, start) else { continue };
            if !a.is_clear(start_normal, end - start) || !b.is_clear(end_normal, start - end) {
                continue;
            }
            let shadow =
                spawn::segment(start, start_error, start_normal, end, end_error, end_normal);
            let hit = a.is_hit(&shadow) || b.is_hit(&shadow);
            tally.count(hit, || a.is_hit_exactly(&shadow) || b.is_hit_exactly(&shadow));

            // Around the middle, facing the ray.
            let way = end - start;
            let side = way.cross(direction(&mut rng));
            let side = side * (way.length() / side.length());
            let other = way.cross(side);
            let other = other * (way.length() / other.length());
            let half = scalar(0.5);
            let middle = start * half + end * half;
            let occluder = Triangle::from([
                middle + side,
                middle - side * half + other,
                middle - side * half - other,
            ]);
            occluded += u32::from(shadow.hits(&occluder));
            exact += u32::from(oracle::triangle(&oracle_ray(&shadow), vertices(&occluder)).hits());
        }
        println!("{:<6} segments {tally:?}, occluded {occluded}", name::<V>());
        assert_eq!((tally.hits, tally.exact_hits), (0, 0), "{tally:?}");
        assert_eq!((occluded, exact), (tally.rays, tally.rays));
    }
    for_every_vector!(check);
}

/// Hits of one kind of shape, and by how many ulps their origins may be farther than needed: the median, 99 %, all.
struct Kind<V: Vector> {
    name: &'static str,
    shape: fn(&mut fastrand::Rng) -> Shape<V>,
    /// Rays to the shape start at coordinates of 10^±exponent.
    exponent: f64,
    limits: [f64; 3],
}

impl<V: Vector> Kind<V> {
    const fn new(
        name: &'static str,
        exponent: f64,
        limits: [f64; 3],
        shape: fn(&mut fastrand::Rng) -> Shape<V>,
    ) -> Self {
        Self { name, shape, exponent, limits }
    }

    /// In the order of the documentation's table.
    const ALL: [Self; 8] = [
        Self::new("small triangles", 0.5, [1.1, 2.5, 4.0], |rng| {
            Shape::Triangle(triangle_of_size(rng, 0.1))
        }),
        Self::new("large triangles", 0.5, [2.9, 6.5, 9.0], |rng| {
            Shape::Triangle(triangle_of_size(rng, 1.0))
        }),
        Self::new("any triangles", 8.0, [0.3, 3.5, 6.0], |rng| Shape::Triangle(wild_triangle(rng))),
        Self::new("spheres", 4.0, [0.9, 4.0, 5.0], |rng| {
            loop {
                let sphere = wild_sphere(rng);
                if !is_too_small(&sphere) {
                    return Shape::Sphere(sphere);
                }
            }
        }),
        Self::new("grains", 4.0, [0.5, 1.5, 2.0], |rng| Shape::Sphere(grain(rng))),
        Self::new("specks", 4.0, [1.5, 9.0, 13.0], |rng| {
            let Sphere { center, radius } = grain::<V>(rng);
            Shape::Sphere(Sphere::new(center, radius * scalar(rng.f64() / 10.0)))
        }),
        Self::new("boxes", 8.0, [0.1, 0.6, 0.6], |rng| Shape::Box(wild_box(rng))),
        Self::new("planes", 8.0, [0.9, 7.0, 7.5], |rng| Shape::Plane(wild_plane(rng))),
    ];
}

/// Whether floats may not tell the sphere from a point.
fn is_too_small<V: Vector>(sphere: &Sphere<V>) -> bool {
    let largest: f64 = (sphere.center.abs() + V::splat(sphere.radius)).max_element().into();
    sphere.radius.into() < 32.0 * unit_roundoff::<V::Scalar>() * largest
}

/// By how many ulps of the largest coordinate origins are farther from a hit than the least that works: than the
/// nearest on the way there, to 1/256 of it, from which no ray hits the surface, be it to the one side or the other.
fn excess<V: Vector>(rng: &mut fastrand::Rng, shape: &Shape<V>, hit: [V; 3]) -> f64 {
    let [point, error, normal] = hit;
    let away = |is_outward: bool| {
        let away = if is_outward { normal } else { -normal };
        spawn::offset_origin(point, error, normal, away) - point
    };
    let [inside, outside] = [away(false), away(true)];
    let seed = rng.u64(..);
    let works = |share: f64| {
        let mut rng = fastrand::Rng::with_seed(seed);
        (0..RAYS).all(|_| {
            let is_outward = rng.bool();
            let way = if is_outward { outside } else { inside };
            let origin = point + way * scalar(share);
            let leaving = shape.departure(&mut rng, normal, origin);
            let is_inward = points_inward(normal, leaving);
            let leaving = if is_inward == is_outward { -leaving } else { leaving };
            !shape.is_hit_again(&Ray::new(origin, leaving), hit, is_outward)
        })
    };
    assert!(works(1.0), "{}: {hit:?}", name::<V>());
    let (mut fails, mut least) = (0.0, if works(0.0) { 0.0 } else { 1.0 });
    while fails + 1.0 / 256.0 < least {
        let middle = f64::midpoint(fails, least);
        *if works(middle) { &mut least } else { &mut fails } = middle;
    }
    let [inside, outside]: [f64; 2] = [inside, outside].map(|way| way.length().into());
    let ulp = 2.0 * unit_roundoff::<V::Scalar>() * shape.largest(point);
    (1.0 - least) * inside.max(outside) / ulp
}

/// The documentation's table, each number rounded up.
fn check_excesses<V: Vector>(hits: usize) {
    for kind in Kind::<V>::ALL {
        let mut rng = fastrand::Rng::with_seed(SEED + 8);
        let mut excesses = Vec::new();
        while excesses.len() < hits {
            let shape = (kind.shape)(&mut rng);
            let eye = point(&mut rng, kind.exponent);
            // A point at the centre of a sphere has no side.
            let hit = shape.surface(&mut rng, eye).filter(|[_, _, normal]| *normal != V::ZERO);
            if let Some(hit) = hit {
                excesses.push(excess(&mut rng, &shape, hit));
            }
        }
        excesses.sort_by(f64::total_cmp);
        let found = [hits / 2, hits * 99 / 100, hits - 1].map(|index| excesses[index]);
        println!("{:<6} {:<16} {found:.2?} ulps too far, of {hits} hits", name::<V>(), kind.name);
        let is_within = found.iter().zip(kind.limits).all(|(found, limit)| *found <= limit);
        assert!(is_within, "{} {}: {found:?}", name::<V>(), kind.name);
    }
}

#[test]
fn an_origin_is_hardly_farther_than_the_least_that_works() {
    for_every_vector!(check_excesses, 100);
}

#[test]
#[ignore = "minutes: 24,000 hits for each vector type"]
fn an_origin_is_hardly_farther_than_the_least_that_works_at_full_scale() {
    for_every_vector!(check_excesses, 3_000);
}

/// Both ends on one triangle, or on the two halves of a quadrilateral that is flat but for rounding.
#[test]
fn segments_over_flat_ground_stay_on_one_side() {
    fn check<V: Vector>() {
        let mut rng = fastrand::Rng::with_seed(SEED + 5);
        let mut tallies = [Tally::default(); 2];
        for case in 0..100_000 {
            let [corner, x, y] = [(); 3].map(|()| vector::<V>(uniform(&mut rng)));
            let halves: [Triangle<V>; 2] = [[corner, x, y].into(), [y, x, x + y - corner].into()];
            let [a, b] = if case % 2 == 0 { [halves[0]; 2] } else { halves };
            let mut surface = |triangle: &Triangle<V>| {
                let hit = TriangleHit {
                    t: V::Scalar::ONE,
                    u: scalar(rng.f64() / 2.0),
                    v: scalar(rng.f64() / 2.0),
                    front: true,
                };
                hit.point_and_error(triangle)
            };
            let ((start, start_error), (end, end_error)) = (surface(&a), surface(&b));
            let shadow = spawn::segment(start, start_error, a.normal(), end, end_error, b.normal());
            tallies[case % 2].count(shadow.hits(&a) || shadow.hits(&b), || {
                [a, b].iter().any(|t| oracle::triangle(&oracle_ray(&shadow), vertices(t)).hits())
            });
        }
        println!("{:<6} one triangle {:?}, two {:?}", name::<V>(), tallies[0], tallies[1]);
        for tally in tallies {
            assert_eq!((tally.hits, tally.exact_hits), (0, 0), "{tally:?}");
        }
    }
    for_every_vector!(check);
}

/// The hits of the hard cases that the kernels are tested with: degenerate shapes, magnitudes from 2^−60 to 2^60.
#[test]
fn no_hard_case_is_hit_again_or_makes_a_nan() {
    fn is_number<V: Vector>(v: V) -> bool {
        array(v).iter().all(|x| !x.is_nan())
    }
    fn check<V: Vector>() {
        let mut rng = fastrand::Rng::with_seed(SEED + 6);
        let mut tallies = [Tally::default(); 4];
        for _ in 0..200_000 {
            let (case, corners) = generators::ray_triangle(&mut rng);
            let (case, shape) = (ray::<V>(&case), triangle::<V>(&corners));
            if let Some(hit) = case.intersect(&shape) {
                let ((p, error), normal) = (hit.point_and_error(&shape), shape.normal());
                assert!(is_number(p) && is_number(error), "{shape:?} {hit:?} {p:?} {error:?}");
                let leaving = departure(&mut rng, normal);
                let leaving = Ray::new(spawn::offset_origin(p, error, normal, leaving), leaving);
                tallies[0].count(leaving.hits(&shape), || {
                    oracle::triangle(&oracle_ray(&leaving), vertices(&shape)).hits()
                });
            }

            let (case, center, radius) = generators::ray_sphere(&mut rng);
            let (case, shape) = (ray::<V>(&case), sphere::<V>(&center, radius));
            if let Some(hit) = case.intersect(&shape) {
                let (p, error) = hit.point_and_error(&case, &shape);
                assert!(is_number(p) && is_number(error), "{shape:?} {hit:?} {p:?} {error:?}");
                let (normal, leaving) = (p - shape.center, departure(&mut rng, p - shape.center));
                let inward = points_inward(normal, leaving);
                let leaving = Ray::new(spawn::offset_origin(p, error, normal, leaving), leaving);
                if !inward {
                    tallies[1].count(leaving.hits(&shape), || {
                        oracle::sphere(&oracle_ray(&leaving), center, shape.radius.into())
                    });
                }
            }

            let (case, min, max) = generators::ray_aabb(&mut rng);
            let (case, shape) = (ray::<V>(&case), aabb::<V>(&min, &max));
            let hit = case.intersect(&shape);
            if let Some((p, error)) = hit.and_then(|hit| hit.point_and_error(&case, &shape)) {
                assert!(is_number(p) && is_number(error), "{shape:?} {hit:?} {p:?} {error:?}");
                let (_, face) = hit.and_then(|hit| hit.surface()).expect("it has a point");
                let normal: V = face.normal();
                let leaving = departure(&mut rng, normal);
                let outward = normal.dot(leaving) >= V::Scalar::ZERO;
                let leaving = Ray::new(spawn::offset_origin(p, error, normal, leaving), leaving);
                if outward {
                    tallies[2].count(leaving.hits(&shape), || {
                        oracle::aabb(&oracle_ray(&leaving), array(shape.min), array(shape.max))
                    });
                }
            }

            let (case, normal, offset) = generators::ray_plane(&mut rng);
            let (case, shape) =
                (ray::<V>(&case), Plane { normal: vector::<V>(normal), offset: scalar(offset) });
            let hit = case.intersect(&shape);
            if let Some((p, error)) = hit.and_then(|hit| hit.point_and_error(&case, &shape)) {
                assert!(is_number(p) && is_number(error), "{shape:?} {hit:?} {p:?} {error:?}");
                let away = shape.normal * (V::Scalar::ONE / shape.normal.length());
                let away = if rng.bool() { away } else { -away };
                let leaving = Ray::new(spawn::offset_origin(p, error, shape.normal, away), away);
                tallies[3].count(leaving.hits(&shape), || {
                    oracle::plane(&oracle_ray(&leaving), array(shape.normal), shape.offset.into())
                        != oracle::PlaneVerdict::Miss
                });
            }
        }
        println!("{:<6} hard cases {tallies:?}", name::<V>());
        for tally in tallies {
            assert!(tally.rays > 20_000 && tally.hits + tally.exact_hits == 0, "{tally:?}");
        }
    }
    for_every_vector!(check);
}

/// Numbers of every kind, and hits of other shapes: no panic, and NaN or infinity where nothing else makes sense.
#[test]
fn bad_input_does_not_panic() {
    fn check<V: Vector>() {
        let mut rng = fastrand::Rng::with_seed(SEED + 7);
        let numbers =
            [0.0, -0.0, 5e-324, 1e-45, 1e-30, 1.0, -3.0, 1e30, 3e38, 1e308, f64::INFINITY];
        for _ in 0..100_000 {
            let mut number = || match rng.usize(..numbers.len() + 1) {
                11 => scalar(f64::NAN),
                index => scalar::<V::Scalar>(numbers[index]),
            };
            let [t, u, v, radius] = [(); 4].map(|()| number());
            let [a, b, c, d, e] = [(); 5].map(|()| V::new(number(), number(), number()));
            let case = Ray::new(a, b);
            let face = Some(Face::PosY);
            let _ = TriangleHit { t, u, v, front: true }.point_and_error(&[a, b, c].into());
            let _ = SphereHit { t, leaving: false }.point_and_error(&case, &Sphere::new(c, radius));
            let _ = AabbHit { t_enter: t, t_exit: u, enter_face: face, exit_face: None }
                .point_and_error(&case, &Aabb::new(c, d));
            let _ = PlaneHit::At(t).point_and_error(&case, &Plane { normal: c, offset: u });
            let _ = spawn::segment(a, b, c, d, e, c);
            let origin = spawn::offset_origin(c, d, e, b);
            let bad = |v: V| array(v).iter().any(|x| !x.is_finite());
            // A bad point, or an error without bound along the normal, is not made good.
            let longest = array(e).into_iter().fold(0.0, |m: f64, x| m.max(x.abs()));
            let moves = (0..3).any(|i| {
                bad(V::splat(d.component(i))) && e.component(i).into().abs() > 1e-30 * longest
            });
            if bad(c) || (moves && !bad(e) && e != V::ZERO) {
                assert!(bad(origin), "{c:?} {d:?} {e:?} {b:?}: {origin:?}");
            }
        }
    }
    for_every_vector!(check);
}
