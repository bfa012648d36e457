//! Claim: what may not matter does not: the order of vertices, the unit of length, the names of the axes, the length of
//! the direction, where the lattice lies.
//!
//! Relations that hold to the last bit are asserted for every kernel; those that rounding can break are asserted on
//! lattices, where the products are exact, for the verdict.

use isect::overlap::triangle_aabb::sat;
use isect::ray::aabb::{BoxRay, conservative, slab};
use isect::ray::triangle::{TriangleHit, segura};
use isect::{Face, Ray, Scalar, Triangle, Vector};

use crate::support::kernels::{overlap_kernels, sphere_kernels, triangle_kernels};
use crate::support::{
    aabb, for_every_vector, generators, name, oracle, ray, scalar, sphere, triangle, vector,
};

const SEED: u64 = 6;

fn lattice_point(rng: &mut fastrand::Rng) -> [f64; 3] {
    [0; 3].map(|_| f64::from(rng.i32(-6..=6)))
}

fn lattice_ray(rng: &mut fastrand::Rng) -> oracle::Ray {
    let (origin, direction) = (lattice_point(rng), lattice_point(rng));
    oracle::Ray { origin, direction, t_min: 0.0, t_max: f64::INFINITY }
}

/// On a lattice the fast kernels' signs are exact: off the degenerate cases, and off the ends of the range, they agree
/// with the oracle, and then all relations follow that hold for it.
#[test]
fn triangle_kernels_are_exact_on_a_lattice() {
    fn check<V: Vector>() {
        let mut rng = fastrand::Rng::with_seed(SEED);
        let (mut counted, mut hit) = (0, 0);
        for _ in 0..300_000 {
            let exact_ray = lattice_ray(&mut rng);
            let vertices = [(); 3].map(|()| lattice_point(&mut rng));
            let expected = oracle::triangle(&exact_ray, vertices);
            if matches!(
                expected,
                oracle::TriangleVerdict::Coplanar | oracle::TriangleVerdict::Degenerate
            ) {
                continue;
            }
            let (ray, triangle) = (ray::<V>(&exact_ray), triangle(&vertices));
            counted += 1;
            hit += u32::from(expected.hits());
            // Weights that are quotients may round across zero only where they are zero.
            let on_edge = !matches!(
                expected,
                oracle::TriangleVerdict::Miss | oracle::TriangleVerdict::Interior
            );
            // And t, where it is a weighted mean, only near an end of the range.
            let at_end = oracle::triangle_t_in(&exact_ray, vertices, -1e-4, 1e-4) == Some(true);
            for kernel in triangle_kernels::<V>() {
                let divides_first =
                    matches!(kernel.name, "badouel" | "watertight" | "moller_trumbore");
                let weighs_t = matches!(kernel.name, "segura" | "watertight");
                if on_edge && divides_first || at_end && weighs_t {
                    continue;
                }
                let found = (kernel.intersect)(&ray, &triangle).is_some();
                assert_eq!(
                    found,
                    expected.hits(),
                    "{} {}: {exact_ray:?} {vertices:?}",
                    kernel.name,
                    name::<V>()
                );
            }
            assert_eq!(segura::detects(&ray, &triangle), expected.hits());
        }
        println!("{:<6} {counted} lattice cases, {hit} hits", name::<V>());
        assert!(hit > 3_000);
    }
    for_every_vector!(check);
}

/// The other winding gives the same point with u and v swapped, seen from the other side.
#[test]
fn the_winding_only_turns_the_side() {
    fn check<V: Vector>() {
        let mut rng = fastrand::Rng::with_seed(SEED + 1);
        let mut hits = 0;
        for _ in 0..200_000 {
            let (exact_ray, vertices) = generators::ray_triangle(&mut rng);
            // (Not so far that t overflows for one and not for the other.)
            let line = oracle::Ray { t_min: -1e37, t_max: 1e37, ..exact_ray };
            if exact_ray.direction.iter().any(|&x| x != 0.0 && x.abs() < 1e-30) {
                continue;
            }
            let (ray, triangle) = (ray::<V>(&line), triangle::<V>(&vertices));
            let turned = Triangle::new(triangle.v0, triangle.v2, triangle.v1);
            for kernel in triangle_kernels::<V>() {
                let turned_back = |hit: TriangleHit<_>| TriangleHit {
                    u: hit.v,
                    v: hit.u,
                    front: !hit.front,
                    ..hit
                };
                let a = (kernel.intersect)(&ray, &triangle);
                let b = (kernel.intersect)(&ray, &turned).map(turned_back);
                let case = || format!("{} {exact_ray:?} {vertices:?}", kernel.name);
                let front = a.map(|hit| hit.front);
                if kernel.name == "exact" && front == Some(false) {
                    // Without area, or with the ray in its plane, neither winding has its front there.
                    assert!(b.is_some(), "{}", case());
                } else if matches!(kernel.name, "segura" | "watertight" | "exact") {
                    // Three weights in another order add up to another last bit, and another stage may decide.
                    assert_eq!(a.map(|hit| hit.front), b.map(|hit| hit.front), "{}", case());
                } else {
                    assert_eq!(a, b, "{}", case());
                }
                hits += u32::from(a.is_some());
            }
        }
        assert!(hits > 100_000);
    }
    for_every_vector!(check);
}

/// A power of two changes nothing but the exponents of t: neither one on all coordinates nor one on the direction.
/// (Where it takes no number out of the normal ones.)
#[test]
fn the_unit_of_length_does_not_matter() {
    fn check<V: Vector>() {
        let mut rng = fastrand::Rng::with_seed(SEED + 2);
        let mut hits = 0;
        for _ in 0..200_000 {
            // Full mantissas of moderate size; the shift goes far beyond the square root of the exponent range.
            let random = |rng: &mut fastrand::Rng| -> [f64; 3] {
                [(); 3].map(|()| f64::from(2.0 * rng.f32() - 1.0))
            };
            let vertices = [(); 3].map(|()| random(&mut rng));
            let direction = random(&mut rng);
            let origin = random(&mut rng);
            let exact_ray =
                oracle::Ray { origin, direction, t_min: f64::NEG_INFINITY, t_max: f64::INFINITY };
            let shift = rng.i32(-90..=90);
            // So that t, which is at most about 2^24 before it is scaled, remains a float.
            let length = rng.i32((shift - 90).max(-90)..=(shift + 90).min(90));
            let (scale, stretch) = (2f64.powi(shift), 2f64.powi(length));
            let times = |p: [f64; 3], by: f64| p.map(|x| x * by);
            let scaled_ray = oracle::Ray {
                origin: times(origin, scale),
                direction: times(direction, stretch),
                ..exact_ray
            };
            let t_scale = 2f64.powi(shift - length);
            let representable = |t: f64| (1e-30..1e30).contains(&(t * t_scale).abs());
            let (ray_a, ray_b) = (ray::<V>(&exact_ray), ray::<V>(&scaled_ray));
            let case =
                || format!("{} {exact_ray:?} {vertices:?} 2^{shift} 2^{length}", name::<V>());
            let same = |a: Option<f64>, b: Option<f64>, what: &str| {
                if a.is_some_and(|t| !representable(t)) {
                    return 0;
                }
                if matches!(what, "exact" | "robust") {
                    // Another stage may decide, and give another last bit.
                    assert_eq!(a.is_some(), b.is_some(), "{what} {}", case());
                } else {
                    assert_eq!(a.map(|t| t * t_scale), b, "{what} {}", case());
                }
                u32::from(a.is_some())
            };
            let scaled_vertices = vertices.map(|v| times(v, scale));
            for kernel in triangle_kernels::<V>() {
                let a = (kernel.intersect)(&ray_a, &triangle(&vertices)).map(|hit| hit.t.into());
                let b =
                    (kernel.intersect)(&ray_b, &triangle(&scaled_vertices)).map(|hit| hit.t.into());
                hits += same(a, b, kernel.name);
            }
            let [center, ..] = vertices;
            for kernel in sphere_kernels::<V>() {
                let a = (kernel.intersect)(&ray_a, &sphere(&center, 0.5)).map(|hit| hit.t.into());
                let b = (kernel.intersect)(&ray_b, &sphere(&times(center, scale), 0.5 * scale))
                    .map(|hit| hit.t.into());
                hits += same(a, b, kernel.name);
            }
            let [a, b, _] = vertices;
            let (min, max) =
                (std::array::from_fn(|i| a[i].min(b[i])), std::array::from_fn(|i| a[i].max(b[i])));
            let small = aabb::<V>(&min, &max);
            let large = aabb::<V>(&times(min, scale), &times(max, scale));
            let enter = |ray: &Ray<V>, aabb| {
                slab::intersect(&BoxRay::new(ray), aabb).map(|hit| hit.t_enter.into())
            };
            hits += same(enter(&ray_a, &small), enter(&ray_b, &large), "slab");
            let may_hit = |ray: &Ray<V>, aabb| conservative::hits(&BoxRay::new(ray), aabb);
            assert_eq!(may_hit(&ray_a, &small), may_hit(&ray_b, &large), "{}", case());
            for (kernel, overlaps) in overlap_kernels::<V>() {
                let other = Triangle::new(vector(vertices[2]), vector(origin), vector(direction));
                let scaled_other = [vertices[2], origin, direction].map(|p| times(p, scale));
                assert_eq!(
                    overlaps(&other, &small),
                    overlaps(&triangle(&scaled_other), &large),
                    "{kernel} {}",
                    case()
                );
            }
        }
        assert!(hits > 100_000);
    }
    for_every_vector!(check);
}

/// Boxes and separating axes treat the axes alike: permuted and mirrored they give the same numbers.
#[test]
fn the_names_of_the_axes_do_not_matter_to_a_box() {
    fn check<V: Vector>() {
        let mut rng = fastrand::Rng::with_seed(SEED + 3);
        for _ in 0..200_000 {
            let (exact_ray, min, max) = generators::ray_aabb(&mut rng);
            let (axis, mirrored) = (rng.usize(..3), [(); 3].map(|()| rng.bool()));
            let map = |p: [f64; 3]| -> [f64; 3] {
                std::array::from_fn(|i| {
                    if mirrored[i] { -p[(i + axis) % 3] } else { p[(i + axis) % 3] }
                })
            };
            let (a, b) = (map(min), map(max));
            let order =
                |f: fn(f64, f64) -> f64| -> [f64; 3] { std::array::from_fn(|i| f(a[i], b[i])) };
            let (new_min, new_max) = (order(f64::min), order(f64::max));
            let moved_ray = oracle::Ray {
                origin: map(exact_ray.origin),
                direction: map(exact_ray.direction),
                ..exact_ray
            };
            let (ray_a, ray_b) =
                (BoxRay::<V>::new(&ray(&exact_ray)), BoxRay::new(&ray(&moved_ray)));
            let (box_a, box_b) = (aabb::<V>(&min, &max), aabb::<V>(&new_min, &new_max));
            let interval =
                |ray, aabb| slab::intersect(ray, aabb).map(|hit| (hit.t_enter, hit.t_exit));
            assert_eq!(
                interval(&ray_a, &box_a),
                interval(&ray_b, &box_b),
                "{exact_ray:?} {min:?} {max:?}"
            );
            assert_eq!(
                conservative::interval(&ray_a, &box_a),
                conservative::interval(&ray_b, &box_b)
            );
        }
    }
    for_every_vector!(check);
}

/// The faces that a hit names are those on which the entry and the exit lie, and the first of equals.
#[test]
fn faces_are_where_the_ray_crosses() {
    fn check<V: Vector>() {
        let mut rng = fastrand::Rng::with_seed(SEED + 4);
        let mut faces = 0;
        for _ in 0..300_000 {
            let exact_ray = lattice_ray(&mut rng);
            let (a, b) = (lattice_point(&mut rng), lattice_point(&mut rng));
            let order =
                |f: fn(f64, f64) -> f64| -> [f64; 3] { std::array::from_fn(|i| f(a[i], b[i])) };
            let (min, max) = (order(f64::min), order(f64::max));
            let Some(hit) = slab::intersect(&BoxRay::<V>::new(&ray(&exact_ray)), &aabb(&min, &max))
            else {
                continue;
            };
            let check = |face: Option<Face>, t: V::Scalar, entering: bool| {
                let Some(face) = face else { return 0 };
                let (axis, outward) = (face.axis(), f64::from(face.sign()));
                // The direction goes against the normal where it enters, with it where it leaves.
                assert!(
                    exact_ray.direction[axis] * outward * if entering { -1.0 } else { 1.0 } > 0.0
                );
                let plane = if outward < 0.0 { min[axis] } else { max[axis] };
                let t: f64 = t.into();
                let distance = exact_ray.origin[axis] + t * exact_ray.direction[axis] - plane;
                // Three roundings of t, times the direction, on coordinates of at most 12.
                assert!(
                    distance.abs() <= 12.0 * 4.0 * f64::from(f32::EPSILON),
                    "{exact_ray:?} {hit:?}"
                );
                1
            };
            faces +=
                check(hit.enter_face, hit.t_enter, true) + check(hit.exit_face, hit.t_exit, false);
            let contains = |x: f64| min[0] <= x && x <= max[0];
            let origin_inside = contains(exact_ray.origin[0])
                && (1..3).all(|i| min[i] <= exact_ray.origin[i] && exact_ray.origin[i] <= max[i]);
            if !origin_inside {
                assert!(
                    hit.enter_face.is_some() && hit.t_enter > V::Scalar::ZERO,
                    "{exact_ray:?} {hit:?}"
                );
            }
        }
        assert!(faces > 10_000);
    }
    for_every_vector!(check);
}

/// Backwards through the same range: the same hits, at −t.
#[test]
fn a_ray_can_be_reversed() {
    fn check<V: Vector>() {
        let mut rng = fastrand::Rng::with_seed(SEED + 5);
        for _ in 0..200_000 {
            let (exact_ray, vertices) = generators::ray_triangle(&mut rng);
            let forward = ray::<V>(&exact_ray);
            let backward = Ray {
                direction: -forward.direction,
                t_min: -forward.t_max,
                t_max: -forward.t_min,
                ..forward
            };
            for kernel in triangle_kernels::<V>() {
                let [a, b] =
                    [forward, backward].map(|ray| (kernel.intersect)(&ray, &triangle(&vertices)));
                // (Of a triangle in whose plane the ray lies the exact kernel reports the first point.)
                let t = |hit: TriangleHit<V::Scalar>| {
                    if kernel.name == "exact" { V::Scalar::ZERO } else { hit.t }
                };
                assert_eq!(
                    a.map(t),
                    b.map(|hit| -t(hit)),
                    "{} {exact_ray:?} {vertices:?}",
                    kernel.name
                );
            }
            let (_, min, max) = generators::ray_aabb(&mut rng);
            let [a, b] =
                [forward, backward].map(|ray| slab::hits(&BoxRay::new(&ray), &aabb(&min, &max)));
            assert_eq!(a, b);
        }
    }
    for_every_vector!(check);
}

/// On the grid a translation is exact, and so the kernels see the same differences.
#[test]
fn a_translation_on_the_grid_changes_nothing() {
    fn check<V: Vector>() {
        let mut rng = fastrand::Rng::with_seed(SEED + 6);
        for _ in 0..100_000 {
            let exact_ray = lattice_ray(&mut rng);
            let vertices = [(); 3].map(|()| lattice_point(&mut rng));
            let by = [0; 3].map(|_| f64::from(rng.i32(-1000..=1000)));
            let moved = |p: [f64; 3]| -> [f64; 3] { std::array::from_fn(|i| p[i] + by[i]) };
            let moved_ray = oracle::Ray { origin: moved(exact_ray.origin), ..exact_ray };
            let moved_vertices = vertices.map(moved);
            for kernel in triangle_kernels::<V>() {
                let a = (kernel.intersect)(&ray(&exact_ray), &triangle(&vertices));
                let b = (kernel.intersect)(&ray(&moved_ray), &triangle(&moved_vertices));
                assert_eq!(a, b, "{} {exact_ray:?} {vertices:?} {by:?}", kernel.name);
            }
            let [a, b] = [lattice_point(&mut rng), lattice_point(&mut rng)];
            let order =
                |f: fn(f64, f64) -> f64| -> [f64; 3] { std::array::from_fn(|i| f(a[i], b[i])) };
            let (min, max) = (order(f64::min), order(f64::max));
            assert_eq!(
                sat::overlaps(&triangle::<V>(&vertices), &aabb(&min, &max)),
                sat::overlaps(&triangle::<V>(&moved_vertices), &aabb(&moved(min), &moved(max)))
            );
        }
    }
    for_every_vector!(check);
}

/// `detects` may differ from `intersect` only where an exact tie with the range decides.
#[test]
fn detecting_is_intersecting() {
    fn check<V: Vector>() {
        let mut rng = fastrand::Rng::with_seed(SEED + 7);
        let mut compared = 0;
        for _ in 0..300_000 {
            let (exact_ray, vertices) = generators::ray_triangle(&mut rng);
            // The two scale a problem in different ways, and so lose different products to underflow.
            let moderate = |x: &f64| *x == 0.0 || (1e-9..1e9).contains(&x.abs());
            let numbers = vertices.as_flattened().iter().chain(&exact_ray.origin);
            if !numbers.chain(&exact_ray.direction).all(moderate) {
                continue;
            }
            compared += 1;
            let (ray, triangle) = (ray::<V>(&exact_ray), triangle::<V>(&vertices));
            let line = ray.with_range(scalar(f64::NEG_INFINITY), scalar(f64::INFINITY));
            let hit = segura::intersect(&line, &triangle);
            if hit.is_some_and(|hit| {
                let (t, margin): (f64, f64) = (hit.t.into(), <V::Scalar as Scalar>::EPSILON.into());
                [exact_ray.t_min, exact_ray.t_max]
                    .iter()
                    .any(|end| (t - end).abs() <= 16.0 * margin * t.abs())
            }) {
                continue;
            }
            assert_eq!(
                segura::detects(&ray, &triangle),
                segura::intersect(&ray, &triangle).is_some(),
                "{} {exact_ray:?} {vertices:?}",
                name::<V>()
            );
        }
        assert!(compared > 100_000);
    }
    for_every_vector!(check);
}
