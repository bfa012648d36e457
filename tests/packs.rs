//! Claim: at every level of the processor, a lane of a pack has the verdict of the scalar kernel.

use fearless_simd::{Level, dispatch};
use isect::glam::{DVec3, Vec3, Vec3A};
use isect::ray::aabb::{BoxRay, conservative};
use isect::ray::triangle::watertight::{self, ShearedRay};
use isect::ray::triangle::{TriangleHit, exact, moller_trumbore};
use isect::simd::{AabbHits, AabbPack, Lanes, TriangleHits, TrianglePack};
use isect::{Aabb, Ray, Scalar, Triangle, Vector};

use crate::bounds::check_triangle;
use crate::support::bounds::{self, unit_roundoff};
use crate::support::kernels::{Intersect, TriangleKernel};
use crate::support::levels::levels;
use crate::support::{aabb, generators, name, oracle, ray, triangle};

const SEED: u64 = 31;

#[test]
fn the_levels_are_those_of_the_processor() {
    // A baseline above SSE2 takes over from the levels below it, but the list stays.
    let levels = levels();
    assert!(levels[0].is_fallback() && levels.len() > 1);
    let best = std::mem::discriminant(&Level::new());
    assert!(levels.iter().any(|level| std::mem::discriminant(level) == best), "{levels:?}");
}

/// Runs a check with each kind of pack.
macro_rules! for_every_pack {
    ($check:ident) => {
        $check::<Vec3, 4>();
        $check::<Vec3A, 8>();
        $check::<Vec3A, 16>();
        $check::<DVec3, 2>();
        $check::<DVec3, 4>();
        $check::<DVec3, 8>();
    };
}

/// A hard case, and some more triangles for the same ray: with its vertices turned, exchanged, nudged, on a line, with a
/// NaN or an infinity, and those of other cases.
fn triangles<V: Vector>(rng: &mut fastrand::Rng, lanes: usize) -> (Ray<V>, Vec<Triangle<V>>) {
    let (exact_ray, vertices) = generators::ray_triangle(rng);
    let some = (0..rng.usize(0..=lanes)).map(|lane| {
        let mut vertices =
            if lane > 0 && rng.u8(..4) == 0 { generators::ray_triangle(rng).1 } else { vertices };
        if lane > 0 {
            vertices.rotate_left(rng.usize(..3));
            let place = (rng.usize(..3), rng.usize(..3));
            let number = &mut vertices[place.0][place.1];
            match rng.u8(..12) {
                0 => vertices.swap(0, 1),
                1 => *number = f64::NAN,
                2 => *number = f64::INFINITY,
                3 => vertices[0] = vertices[1],
                4..=7 => *number = generators::single(*number * (1.0 + 2f64.powi(-23))),
                _ => {}
            }
        }
        triangle(&vertices)
    });
    let some = some.collect();
    (ray(&exact_ray), some)
}

/// What a pack says, asked in every way.
struct Answers<T, const N: usize> {
    moller_trumbore: TriangleHits<T, N>,
    watertight: TriangleHits<T, N>,
    exact: TriangleHits<T, N>,
    closest: Option<(usize, TriangleHit<T>)>,
    any: bool,
}

/// Compiled once for each kind of pack, for all the tests.
fn answers<V: Vector<Scalar: Lanes<N>>, const N: usize>(
    level: Level,
    ray: &Ray<V>,
    triangles: &[Triangle<V>],
) -> Answers<V::Scalar, N> {
    let pack = TrianglePack::<V::Scalar, N>::from_triangles(triangles);
    dispatch!(level, simd => Answers {
        moller_trumbore: pack.moller_trumbore(simd, ray),
        watertight: pack.watertight(simd, &ShearedRay::new(ray)),
        exact: pack.exact(simd, ray),
        closest: pack.closest(simd, ray),
        any: pack.any(simd, ray),
    })
}

/// What the scalar kernel says of each triangle, and of the lanes without one.
fn scalar_hits<V: Vector, const N: usize>(
    kernel: impl Fn(&Ray<V>, &Triangle<V>) -> Option<TriangleHit<V::Scalar>>,
    ray: &Ray<V>,
    triangles: &[Triangle<V>],
) -> [Option<TriangleHit<V::Scalar>>; N] {
    std::array::from_fn(|lane| kernel(ray, triangles.get(lane)?))
}

fn lanes_of<T: Scalar, const N: usize>(hits: &TriangleHits<T, N>) -> [Option<TriangleHit<T>>; N] {
    std::array::from_fn(|lane| hits.get(lane))
}

/// Holds what a pack says of one case against the scalar kernels; returns how many lanes each of them hits.
fn check_triangles<V: Vector<Scalar: Lanes<N>>, const N: usize>(
    level: Level,
    ray: &Ray<V>,
    triangles: &[Triangle<V>],
) -> [usize; 3] {
    let Answers { moller_trumbore: fast, watertight: closed, exact: certain, closest, any } =
        answers::<V, N>(level, ray, triangles);
    let case = || format!("{level:?} {ray:?} {triangles:?}");
    let expected_fast = scalar_hits(moller_trumbore::intersect, ray, triangles);
    assert_eq!(lanes_of(&fast), expected_fast, "{}", case());
    let sheared = ShearedRay::new(ray);
    let by_shear = |_: &Ray<V>, triangle: &Triangle<V>| watertight::intersect(&sheared, triangle);
    let expected_closed = scalar_hits(by_shear, ray, triangles);
    assert_eq!(lanes_of(&closed), expected_closed, "{}", case());
    let expected = scalar_hits(exact::intersect, ray, triangles);
    let sides =
        |hits: [Option<TriangleHit<V::Scalar>>; N]| hits.map(|hit| hit.map(|hit| hit.front));
    assert_eq!(sides(lanes_of(&certain)), sides(expected), "{}", case());
    assert_eq!(closest, certain.closest(), "{}", case());
    assert_eq!(any, certain.mask != 0, "{}", case());
    if let Some((lane, closest)) = closest {
        let earlier = |(other, hit): (usize, Option<TriangleHit<V::Scalar>>)| {
            hit.is_some_and(|hit| hit.t < closest.t || (hit.t == closest.t && other < lane))
        };
        assert!(!lanes_of(&certain).into_iter().enumerate().any(earlier), "{}", case());
    }
    [expected_fast, expected_closed, expected].map(|hits| hits.iter().flatten().count())
}

/// The verdicts of all three kernels; t, u and v of the fast and of the watertight one to the last bit.
#[test]
fn a_lane_has_the_verdict_of_the_scalar_kernel() {
    fn check<V: Vector<Scalar: Lanes<N>>, const N: usize>() {
        for level in levels() {
            let mut rng = fastrand::Rng::with_seed(SEED);
            let (mut hits, mut certain) = ([0; 3], 0);
            for _ in 0..80_000 / N {
                let (ray, triangles) = triangles::<V>(&mut rng, N);
                let counts = check_triangles::<V, N>(level, &ray, &triangles);
                hits = std::array::from_fn(|kernel| hits[kernel] + counts[kernel]);
                certain += triangles.iter().filter(|t| exact::stage(&ray, t) == 0).count();
            }
            println!("{:<6} × {N:<2} {level:?}: {hits:?} hits, {certain} certain", name::<V>());
            assert!(hits.iter().all(|hits| *hits > 3_000) && certain > 8_000);
        }
    }
    for_every_pack!(check);
}

/// The same where the filter's bound ends: lengths about its floor and its cap, directions down to subnormal ones, edges
/// that pass the ray by a rounding.
#[test]
fn the_ends_of_the_filter() {
    fn check<V: Vector<Scalar: Lanes<N>>, const N: usize>() {
        let is_single = size_of::<V::Scalar>() == 4;
        let (floor, cap, least) = if is_single { (-36, 37, -149) } else { (-300, 301, -1074) };
        let power = |exponent: i32| 2f64.powi(exponent.max(least));
        for level in levels() {
            let mut rng = fastrand::Rng::with_seed(SEED + 4);
            let mut hits = [0; 3];
            for _ in 0..40_000 / N {
                let size = if rng.bool() { floor } else { cap } + rng.i32(-8..8);
                let distance = size + rng.i32(0..6);
                let speed = match rng.u8(..3) {
                    0 => size + rng.i32(-8..8),
                    1 => floor - rng.i32(0..60),
                    _ => rng.i32(-40..40),
                };
                let mut number = |exponent: i32| {
                    let mantissa = f64::from(rng.i32(-64..=64)) / 64.0;
                    let nudge = 1.0 + f64::from(rng.i32(-1..=1)) * 2f64.powi(-22);
                    mantissa * nudge * power(exponent)
                };
                let mut point = |exponent| [(); 3].map(|()| number(exponent));
                let shapes: Vec<[[f64; 3]; 3]> =
                    (0..N).map(|_| [(); 3].map(|()| point(size))).collect();
                let direction = point(speed);
                // From the middle of an edge, or a point inside, of one of them.
                let [a, b, c] = shapes[0];
                let weights = if hits[0] % 2 == 0 { [0.5, 0.5, 0.0] } else { [0.25, 0.5, 0.25] };
                let steps = power(distance) / power(speed);
                let origin = std::array::from_fn(|i| {
                    let target = a[i] * weights[0] + b[i] * weights[1] + c[i] * weights[2];
                    target - direction[i] * steps
                });
                let exact_ray = oracle::Ray { origin, direction, t_min: 0.0, t_max: f64::INFINITY };
                let triangles: Vec<Triangle<V>> = shapes.iter().map(triangle).collect();
                let counts = check_triangles::<V, N>(level, &ray(&exact_ray), &triangles);
                hits = std::array::from_fn(|kernel| hits[kernel] + counts[kernel]);
            }
            println!("{:<6} × {N:<2} {level:?}: {hits:?} hits", name::<V>());
            assert!(hits.iter().all(|hits| *hits > 500), "{hits:?}");
        }
    }
    for_every_pack!(check);
}

/// The same against the oracle, and t, u, v within the bounds of the documentation, which are those of Möller–Trumbore.
#[test]
fn exact_is_within_its_bounds() {
    fn check<V: Vector>(
        name: &'static str,
        intersect: Intersect<V, Triangle<V>, TriangleHit<V::Scalar>>,
    ) {
        let bound = bounds::packed_exact;
        let kernel = TriangleKernel { name, intersect, bound };
        let mut rng = fastrand::Rng::with_seed(SEED + 2);
        let (mut hits, mut misses) = (0, 0);
        for _ in 0..100_000 {
            let (exact_ray, vertices) = generators::ray_triangle(&mut rng);
            let verdict = intersect(&ray(&exact_ray), &triangle(&vertices)).is_some();
            assert_eq!(verdict, oracle::triangle(&exact_ray, vertices).hits(), "{exact_ray:?}");
            let unit = unit_roundoff::<V::Scalar>();
            let bound = bound(unit, &exact_ray, &vertices).filter(|bound| {
                crate::bounds::in_exponent_range::<V>(&exact_ray, &vertices, bound)
            });
            if let Some(bound) = bound {
                if check_triangle(&kernel, &exact_ray, vertices, bound) {
                    hits += 1;
                } else {
                    misses += 1;
                }
            }
        }
        println!("{name}: {hits} hits and {misses} misses within bounds");
        assert!(hits > 13_000 && misses > 13_000, "{hits} {misses}");
    }
    check::<Vec3>("Vec3 × 8", |ray, triangle| {
        let pack = TrianglePack::<f32, 8>::from_triangles(&[*triangle]);
        pack.dispatch_closest(Level::new(), ray).map(|(_, hit)| hit)
    });
    check::<DVec3>("DVec3 × 4", |ray, triangle| {
        let pack = TrianglePack::<f64, 4>::from_triangles(&[*triangle]);
        pack.dispatch_closest(Level::new(), ray).map(|(_, hit)| hit)
    });
    check::<Vec3>("Vec3 × 4, without SIMD", |ray, triangle| {
        let pack = TrianglePack::<f32, 4>::from_triangles(&[*triangle]);
        pack.dispatch_closest(Level::fallback(), ray).map(|(_, hit)| hit)
    });
}

/// A hard case, and some more boxes for the same ray: flat, empty, with a NaN, unbounded, nudged, and those of other cases.
fn boxes<V: Vector>(rng: &mut fastrand::Rng, lanes: usize) -> (Ray<V>, Vec<Aabb<V>>) {
    let (exact_ray, min, max) = generators::ray_aabb(rng);
    let some = (0..rng.usize(0..=lanes)).map(|lane| {
        let (mut min, mut max) = (min, max);
        if lane > 0 {
            if rng.u8(..4) == 0 {
                (_, min, max) = generators::ray_aabb(rng);
            }
            let axis = rng.usize(..3);
            match rng.u8(..12) {
                0 => min[axis] = f64::NAN,
                1 => max[axis] = f64::NAN,
                2 => max[axis] = min[axis],
                3 => (min[axis], max[axis]) = (max[axis], min[axis]),
                4 => min[axis] = f64::NEG_INFINITY,
                5 => max[axis] = f64::INFINITY,
                6..=8 => max[axis] = generators::single(max[axis] * (1.0 + 2f64.powi(-23))),
                _ => {}
            }
        }
        aabb(&min, &max)
    });
    let some = some.collect();
    (ray(&exact_ray), some)
}

fn entries<T: Scalar, const N: usize>(hits: &AabbHits<T, N>) -> Vec<Option<T>> {
    (0..N).map(|lane| ((hits.mask >> lane) & 1 == 1).then_some(hits.t_enter[lane])).collect()
}

#[test]
fn boxes_have_the_verdict_and_the_entry_of_the_scalar_kernel() {
    fn check<V: Vector<Scalar: Lanes<N>>, const N: usize>() {
        for level in levels() {
            let mut rng = fastrand::Rng::with_seed(SEED + 3);
            let (mut hits, mut misses) = (0, 0);
            for _ in 0..50_000 {
                let (ray, boxes) = boxes::<V>(&mut rng, N);
                let ray = BoxRay::new(&ray);
                let pack = AabbPack::<V::Scalar, N>::from_aabbs(&boxes);
                let answer = dispatch!(level, simd => pack.conservative(simd, &ray));
                let interval = |aabb| conservative::interval(&ray, aabb).map(|[enter, _]| enter);
                let mut expected: Vec<_> = boxes.iter().map(interval).collect();
                hits += expected.iter().flatten().count();
                misses += expected.iter().filter(|enter| enter.is_none()).count();
                expected.resize(N, None);
                assert_eq!(entries(&answer), expected, "{level:?} {ray:?} {boxes:?}");
            }
            println!("{:<6} × {N:<2} {level:?}: {hits} hits, {misses} misses", name::<V>());
            assert!(hits > 15_000 && misses > 15_000, "{hits} {misses}");
        }
    }
    for_every_pack!(check);
}

#[test]
fn packs_give_back_what_they_hold() {
    let corner = Aabb::new(Vec3::ZERO, Vec3::ONE);
    let boxes = AabbPack::<f32, 4>::from_aabbs(&[corner, Aabb::new(Vec3::ONE, Vec3::ZERO)]);
    assert_eq!(
        [0, 1, 2, 4].map(|lane| boxes.get(lane)),
        [corner, Aabb::EMPTY, Aabb::EMPTY, Aabb::EMPTY]
    );
    let shape = Triangle::new(Vec3::X, Vec3::Y, Vec3::Z);
    let leaf = TrianglePack::<f32, 4>::from_triangles(&[shape]);
    assert_eq!(leaf.get::<Vec3>(0), shape);
    assert!([1, 3, 4].iter().all(|&lane| leaf.get::<Vec3>(lane).v2.is_nan()));
}
