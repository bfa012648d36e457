//! Claim: separating axes and clipping agree with exact arithmetic on lattices, and beyond them except near a touch.

use isect::glam::{DVec3, Vec3, Vec3A};
use isect::overlap::triangle_aabb::{clip, sat};
use isect::{Aabb, Triangle, Vector};

use crate::support::bounds::unit_roundoff;
use crate::support::kernels::overlap_kernels;
use crate::support::{aabb, array, for_every_vector, generators, name, oracle, triangle, vector};

const SEED: u64 = 3;

/// A triangle and a box with integer coordinates up to `radius`.
fn lattice_case(rng: &mut fastrand::Rng, radius: i32) -> ([[f64; 3]; 3], [f64; 3], [f64; 3]) {
    let mut point = || [0; 3].map(|_| f64::from(rng.i32(-radius..=radius)));
    let (vertices, a, b) = ([point(), point(), point()], point(), point());
    let order = |f: fn(f64, f64) -> f64| std::array::from_fn(|i| f(a[i], b[i]));
    (vertices, order(f64::min), order(f64::max))
}

/// The same, where a corner of the box touches the triangle's inside or an edge, or is one unit from there.
fn touching_lattice_case(
    rng: &mut fastrand::Rng,
    radius: i32,
) -> ([[f64; 3]; 3], [f64; 3], [f64; 3]) {
    // Sums of three points are vertices where they are equal, and else points between those.
    let third = (radius - 1) / 3;
    let points = [(); 3].map(|()| [0; 3].map(|_| rng.i32(-third..=third)));
    let [p, q, r] = points;
    let sum = |a: [i32; 3], b: [i32; 3], c: [i32; 3]| -> [i32; 3] {
        std::array::from_fn(|i| a[i] + b[i] + c[i])
    };
    let mut corner = if rng.bool() { sum(p, q, r) } else { sum(p, p, q) };
    // From the corner along the normal on all axes: so the plane separates as well as it can.
    let difference = |a: [i32; 3]| [0, 1, 2].map(|i| i64::from(a[i] - p[i]));
    let (e1, e2) = (difference(q), difference(r));
    let side = rng.bool();
    let upward = [0, 1, 2].map(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        (e1[j] * e2[k] > e1[k] * e2[j]) == side
    });
    if rng.bool() {
        let axis = rng.usize(..3);
        corner[axis] += if upward[axis] { 1 } else { -1 };
    }
    let opposite = [0, 1, 2]
        .map(|i| rng.i32(if upward[i] { corner[i]..=radius } else { -radius..=corner[i] }));
    let order =
        |f: fn(i32, i32) -> i32| std::array::from_fn(|i| f64::from(f(corner[i], opposite[i])));
    (points.map(|v| v.map(|x| f64::from(3 * x))), order(i32::min), order(i32::max))
}

/// On integers up to R a component of the normal is at most (2R)², and its product with a difference at most (2R)³: three of
/// them add up exactly where 3·(2R)³ ≤ 2/EPSILON. That holds to R = 88 in f32, and to 72,000 in f64.
#[test]
fn kernels_are_exact_on_lattices() {
    fn check<V: Vector>(limit: i32) {
        let length = 2.0 * f64::from(limit);
        assert!(3.0 * length.powi(3) <= 1.0 / unit_roundoff::<V::Scalar>());
        for radius in [2, 4, 8, limit] {
            let mut rng = fastrand::Rng::with_seed(SEED);
            let (mut overlapping, cases) = (0, 250_000);
            for case in 0..cases {
                let random = if case % 2 == 0 { lattice_case } else { touching_lattice_case };
                let (vertices, min, max) = random(&mut rng, radius);
                let expected = oracle::triangle_aabb_sat(vertices, min, max);
                assert_eq!(
                    expected,
                    oracle::triangle_aabb_clip(vertices, min, max),
                    "two independent oracles"
                );
                let (triangle, aabb) = (triangle::<V>(&vertices), aabb::<V>(&min, &max));
                for (kernel, overlaps) in overlap_kernels::<V>() {
                    assert_eq!(
                        overlaps(&triangle, &aabb),
                        expected,
                        "{kernel} {}: {vertices:?} {min:?} {max:?}",
                        name::<V>()
                    );
                }
                overlapping += u32::from(expected);
            }
            println!("{:<6} radius {radius}: {cases} cases, {overlapping} overlap", name::<V>());
            assert!((cases / 4..cases - cases / 8).contains(&overlapping), "{overlapping}");
        }
    }
    check::<Vec3>(88);
    check::<Vec3A>(88);
    check::<DVec3>(72_000);
}

/// |e1||e2| / |n|, infinite for a triangle without area.
fn uncertainty(vertices: &[[f64; 3]; 3]) -> f64 {
    let [v0, v1, v2] = vertices.map(vector::<DVec3>);
    let (e1, e2) = (v1 - v0, v2 - v0);
    let area = DVec3::cross(e1, e2).length();
    if area > 0.0 { e1.length() * e2.length() / area } else { f64::INFINITY }
}

/// The largest magnitude of a coordinate.
fn largest(vertices: &[[f64; 3]; 3]) -> f64 {
    vertices.as_flattened().iter().fold(0.0, |m, x| x.abs().max(m))
}

/// Checks a kernel's wrong verdicts: `is_near` gets the case and the right one.
fn wrong_verdicts<V: Vector>(
    kernel: fn(&Triangle<V>, &Aabb<V>) -> bool,
    is_near: impl Fn([[f64; 3]; 3], [f64; 3], [f64; 3], bool) -> bool,
) {
    let mut rng = fastrand::Rng::with_seed(SEED + 1);
    let (cases, mut false_hits, mut false_misses) = (200_000, 0, 0);
    for _ in 0..cases {
        let (vertices, mut min, mut max) = generators::triangle_aabb(&mut rng);
        // From a touch to a few dozen of its roundings away.
        let step = rng.i32(-96..=96) * i32::from(rng.bool());
        let by = f64::from(step) * unit_roundoff::<V::Scalar>() * largest(&vertices);
        let axis = rng.usize(..3);
        for bound in [&mut min, &mut max] {
            bound[axis] += by;
            *bound = array(vector::<V>(*bound));
        }
        let expected = oracle::triangle_aabb_sat(vertices, min, max);
        if kernel(&triangle(&vertices), &aabb(&min, &max)) == expected {
            continue;
        }
        *if expected { &mut false_misses } else { &mut false_hits } += 1;
        let case = || format!("{} {expected}: {vertices:?} {min:?} {max:?}", name::<V>());
        assert!(is_near(vertices, min, max, expected), "{}", case());
    }
    println!(
        "{:<6} {cases} cases: {false_hits} false hits, {false_misses} false misses",
        name::<V>()
    );
    assert!(false_hits > 100 && false_misses > 100);
}

/// By separating axes: after a false hit each axis has triangle and box apart by no more than its error, and after a false
/// miss one has them overlap by no more than that: 16u·s, and κ = |e1||e2|/|n| times that for the normal.
#[test]
fn wrong_verdicts_of_sat_are_near_touches() {
    fn check<V: Vector>() {
        let unit = unit_roundoff::<V::Scalar>();
        wrong_verdicts::<V>(sat::overlaps, |vertices, min, max, touches| {
            let margin = 16.0 * unit * largest(&vertices);
            let normal_margin = margin * uncertainty(&vertices);
            // Nothing of the box counts but what lies in the triangle's own.
            let extent =
                |f: fn(f64, f64) -> f64, i: usize| vertices.map(|v| v[i]).into_iter().reduce(f);
            let low = std::array::from_fn(|i| extent(f64::min, i).expect("three").max(min[i]));
            let high = std::array::from_fn(|i| extent(f64::max, i).expect("three").min(max[i]));
            let apart = |sign: f64| {
                oracle::triangle_aabb_apart(
                    vertices,
                    low,
                    high,
                    sign * margin,
                    sign * normal_margin,
                )
            };
            if touches { apart(-1.0) } else { !apart(1.0) }
        });
    }
    for_every_vector!(check);
}

/// By clipping: a wrong verdict flips when the faces of the box are moved by 100u·s.
#[test]
fn wrong_verdicts_of_clip_are_near_touches() {
    fn check<V: Vector>() {
        let unit = unit_roundoff::<V::Scalar>();
        wrong_verdicts::<V>(clip::overlaps, |vertices, min, max, touches| {
            let margin = 100.0 * unit * largest(&vertices) * if touches { -1.0 } else { 1.0 };
            let (min, max) = (min.map(|x| x - margin), max.map(|x| x + margin));
            oracle::triangle_aabb_sat(vertices, min, max) != touches
        });
    }
    for_every_vector!(check);
}

#[test]
fn what_clip_leaves_lies_in_the_box_and_in_the_triangle() {
    fn check<V: Vector>() {
        let unit = unit_roundoff::<V::Scalar>();
        let mut rng = fastrand::Rng::with_seed(SEED + 2);
        let mut most = 0;
        for case in 0..100_000 {
            let (vertices, min, max) = if case % 2 == 0 {
                lattice_case(&mut rng, 16)
            } else {
                generators::triangle_aabb(&mut rng)
            };
            let aabb = aabb::<V>(&min, &max);
            let polygon = clip::clip(&triangle::<V>(&vertices), &aabb);
            most = most.max(polygon.vertices().len());
            assert!(polygon.vertices().iter().all(|&p| aabb.contains(p)));
            assert_eq!(polygon.aabb().is_empty(), polygon.vertices().is_empty());
            // A box of the bound's size around each vertex meets the triangle.
            let margin = 100.0 * unit * largest(&vertices) + f64::MIN_POSITIVE;
            for &p in polygon.vertices() {
                let p = array(p);
                let (low, high) = (p.map(|x| x - margin), p.map(|x| x + margin));
                assert!(
                    oracle::triangle_aabb_sat(vertices, low, high),
                    "{} {vertices:?} {min:?} {max:?}: {p:?}",
                    name::<V>()
                );
            }
        }
        assert!((7..=9).contains(&most), "{most}");
    }
    for_every_vector!(check);
}
