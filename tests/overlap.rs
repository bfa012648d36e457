//! Claim: separating axes and clipping agree with exact arithmetic on lattices, and beyond them except near a touch.

use isect::Vector;
use isect::glam::DVec3;
use isect::overlap::triangle_aabb::clip;

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

#[test]
fn kernels_are_exact_on_lattices() {
    fn check<V: Vector>() {
        for radius in [2, 4, 8, 64] {
            let mut rng = fastrand::Rng::with_seed(SEED);
            let mut overlapping = 0;
            let cases = 250_000;
            for _ in 0..cases {
                let (vertices, min, max) = lattice_case(&mut rng, radius);
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
        }
    }
    for_every_vector!(check);
}

/// |e1||e2| / |n|, infinite for a triangle without area.
fn uncertainty(vertices: &[[f64; 3]; 3]) -> f64 {
    let [v0, v1, v2] = vertices.map(vector::<DVec3>);
    let (e1, e2) = (v1 - v0, v2 - v0);
    e1.length() * e2.length() / DVec3::cross(e1, e2).length()
}

/// A wrong verdict flips back when the faces of the box are moved a little: by 16u·κ of the coordinates that meet, where
/// κ = |e1||e2|/|n| tells how uncertain the normal is, which a needle's is.
#[test]
fn wrong_verdicts_are_near_touches() {
    fn check<V: Vector>() {
        let unit = crate::support::bounds::unit_roundoff::<V::Scalar>();
        let mut rng = fastrand::Rng::with_seed(SEED + 1);
        let mut wrong = [0; 2];
        let cases = 200_000;
        for _ in 0..cases {
            let (vertices, min, max) = generators::triangle_aabb(&mut rng);
            let expected = oracle::triangle_aabb_sat(vertices, min, max);
            let (triangle, aabb) = (triangle::<V>(&vertices), aabb::<V>(&min, &max));
            for (count, (kernel, overlaps)) in wrong.iter_mut().zip(overlap_kernels::<V>()) {
                if overlaps(&triangle, &aabb) == expected {
                    continue;
                }
                *count += 1;
                let largest = vertices.as_flattened().iter().fold(0.0_f64, |m, x| m.max(x.abs()));
                let margin =
                    16.0 * unit * largest * uncertainty(&vertices) + f64::from(f32::MIN_POSITIVE);
                if !margin.is_finite() {
                    continue;
                }
                let sign = if expected { -1.0 } else { 1.0 };
                let moved = |p: [f64; 3], by: f64| p.map(|x| x + by);
                let (near_min, near_max) = (moved(min, -sign * margin), moved(max, sign * margin));
                let near = oracle::triangle_aabb_sat(vertices, near_min, near_max);
                assert_ne!(
                    near,
                    expected,
                    "{kernel} {}: {vertices:?} {min:?} {max:?}",
                    name::<V>()
                );
            }
        }
        println!(
            "{:<6} {cases} cases: sat {} wrong, clip {} wrong",
            name::<V>(),
            wrong[0],
            wrong[1]
        );
    }
    for_every_vector!(check);
}

#[test]
fn what_clip_leaves_lies_in_the_box_and_in_the_triangle() {
    fn check<V: Vector>() {
        let unit = crate::support::bounds::unit_roundoff::<V::Scalar>();
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
            let largest = vertices.as_flattened().iter().fold(0.0_f64, |m, x| m.max(x.abs()));
            // A box of the bound's size around each vertex meets the triangle.
            let margin = 100.0 * unit * largest + f64::MIN_POSITIVE;
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
