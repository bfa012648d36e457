//! Claim: a ray that starts where `spawn` puts it does not hit the surface that it leaves.
//!
//! After the tests of that name in pbrt: shapes of which every coordinate has its own magnitude, hit from anywhere,
//! and left in all directions. `cargo test --test suite spawn -- --ignored` runs them at full scale.

use isect::ray::aabb::{BoxRay, conservative, slab};
use isect::ray::plane::PlaneHit;
use isect::{Aabb, Plane, Ray, Scalar, Sphere, Triangle, Vector, spawn};

use crate::support::bounds::unit_roundoff;
use crate::support::{array, for_every_vector, name, oracle, scalar, vector};

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
        if self.rays % SAMPLE == 0 {
            self.exact_rays += 1;
            self.exact_hits += u32::from(exactly());
        }
    }
}

/// The rays that leave the hits of one shape.
type Campaign = fn(&mut fastrand::Rng, &mut Tally, share: f64);

/// A triangle of which every coordinate has a magnitude of 10^±8.
fn leave_triangle<V: Vector>(rng: &mut fastrand::Rng, tally: &mut Tally, share: f64) {
    let triangle = Triangle::<V>::from([(); 3].map(|()| point(rng, 8.0)));
    let mut left = 0;
    for _ in 0..100 * RAYS / PER_HIT {
        let (u, v) = (rng.f64(), rng.f64());
        let [u, v] = if u + v > 1.0 { [1.0 - u, 1.0 - v] } else { [u, v] };
        let aim = triangle.at(scalar(u), scalar(v));
        let origin = point::<V>(rng, 8.0);
        let ray = Ray::new(origin, aim - origin);
        // Some are too narrow to be hit.
        let Some(hit) = ray.intersect(&triangle) else { continue };
        let (point, error) = hit.point_and_error(&triangle);
        let normal = triangle.normal();
        let unit = normal * (V::Scalar::ONE / normal.length());
        for _ in 0..PER_HIT {
            // Towards a vertex as well: flat, and over what there is of the triangle.
            let leaving = match rng.u8(..8) {
                vertex @ 0..3 => <[V; 3]>::from(triangle)[usize::from(vertex)] - point,
                _ => departure(rng, normal),
            };
            let normal = if rng.bool() { normal } else { unit };
            let origin = spawn::offset_origin(point, error * scalar(share), normal, leaving);
            let ray = Ray::new(origin, leaving);
            tally.count(ray.hits(&triangle), || {
                oracle::triangle(&oracle_ray(&ray), vertices(&triangle)).hits()
            });
        }
        left += PER_HIT;
        if left == RAYS {
            return;
        }
    }
}

/// A sphere with a radius of 10^±4, the centre's coordinates likewise: some are points as far as floats can tell.
fn leave_sphere<V: Vector>(rng: &mut fastrand::Rng, tally: &mut Tally, share: f64) {
    let radius = magnitude(rng, 4.0).abs();
    let sphere = Sphere::new(point::<V>(rng, 4.0), scalar(radius));
    let mut left = 0;
    while left < RAYS {
        let origin = point::<V>(rng, 4.0);
        let ray =
            Ray::new(origin, sphere.center + direction::<V>(rng) * scalar(radius / 1e3) - origin);
        let Some(hit) = ray.intersect(&sphere) else { continue };
        let (point, error) = hit.point_and_error(&ray, &sphere);
        let normal = sphere.normal_at(point);
        let covers = (0..3).all(|axis| error.component(axis) >= sphere.radius);
        for _ in 0..PER_HIT {
            let leaving = departure(rng, normal);
            let origin = spawn::offset_origin(point, error * scalar(share), normal, leaving);
            let ray = Ray::new(origin, leaving);
            if covers || !points_inward(normal, leaving) {
                tally.count(ray.hits(&sphere), || {
                    oracle::sphere(&oracle_ray(&ray), array(sphere.center), sphere.radius.into())
                });
            } else {
                // From inside, the far side is hit and nothing else.
                let is_far = ray.intersect(&sphere).is_some_and(|hit| hit.leaving);
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

/// A box between coordinates of 10^±8, or zero; some are flat.
fn leave_box<V: Vector>(rng: &mut fastrand::Rng, tally: &mut Tally, _: f64) {
    let mut corner =
        || vector::<V>([(); 3].map(|()| if rng.u8(..4) == 0 { 0.0 } else { magnitude(rng, 8.0) }));
    let aabb = Aabb::from_points([corner(), corner()]);
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

/// A plane with a normal and a point of 10^±8.
fn leave_plane<V: Vector>(rng: &mut fastrand::Rng, tally: &mut Tally, share: f64) {
    let normal = match rng.u8(..4) {
        0 => vector([0.0, magnitude(rng, 8.0), 0.0]),
        _ => point::<V>(rng, 8.0),
    };
    let through = if rng.u8(..4) == 0 { V::ZERO } else { point(rng, 8.0) };
    let plane = Plane::from_point_normal(through, normal).expect("the normal is not zero");
    let mut left = 0;
    while left < RAYS {
        let ray = Ray::new(point::<V>(rng, 8.0), direction(rng));
        let Some(hit @ PlaneHit::At(_)) = ray.intersect(&plane) else { continue };
        let (point, error) = hit.point_and_error(&ray, &plane).expect("it is not contained");
        for _ in 0..PER_HIT {
            let leaving = departure(rng, normal);
            let origin = spawn::offset_origin(point, error * scalar(share), normal, leaving);
            let ray = Ray::new(origin, leaving);
            // The kernel cannot tell the side of a direction within the rounding of three products and two sums.
            let products = array(normal.scaled(leaving));
            let certain = products.iter().sum::<f64>().abs()
                > 4.0
                    * unit_roundoff::<V::Scalar>()
                    * products.iter().map(|x| x.abs()).sum::<f64>();
            tally.count(certain && ray.hits(&plane), || {
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
    check::<V>("spheres", leave_sphere::<V>, shapes);
    check::<V>("boxes", leave_box::<V>, shapes);
    check::<V>("planes", leave_plane::<V>, shapes);
}

#[test]
fn no_ray_hits_what_it_leaves() {
    for_every_vector!(check_all, SHAPES[0]);
}

#[test]
#[ignore = "a minute or so"]
fn no_ray_hits_what_it_leaves_at_full_scale() {
    for_every_vector!(check_all, SHAPES[1]);
}

#[test]
#[ignore = "measure"]
fn measure_share() {
    fn go<V: Vector>() {
        for (n, c) in [("tri", leave_triangle::<V> as Campaign), ("sphere", leave_sphere::<V>), ("plane", leave_plane::<V>)] {
            for share in [1.0, 0.7, 0.5, 0.35, 0.25, 0.125, 0.06, 0.03, 0.015, 0.0] {
                println!("{} {n} {share}: {:?}", name::<V>(), run(c, 200, share));
            }
        }
    }
    for_every_vector!(go);
}
