//! Claim: at every level of the processor, a collection answers as a loop of the scalar kernels does.

use std::fmt::Debug;

use fearless_simd::Level;
use isect::glam::{DVec3, Vec3, Vec3A};
use isect::ray::aabb::{BoxRay, exact as box_exact};
use isect::ray::sphere::robust;
use isect::ray::triangle::{TriangleHit, exact};
use isect::simd::{Aabbs, Lanes, Spheres, Triangles};
use isect::testkit::generators;
use isect::testkit::shapes::{aabb, name, ray, sphere, triangle};
use isect::{Aabb, Ray, Sphere, Triangle, Vector};

use crate::in_leaf;
use crate::levels::levels;

const SEED: u64 = 41;

/// Runs a check with each kind of collection.
macro_rules! for_every_collection {
    ($check:ident) => {
        $check::<Vec3A, 8>();
        $check::<DVec3, 4>();
    };
}

/// None, one, a pack, one more, and more than are asked about at once.
fn some_length(rng: &mut fastrand::Rng, lanes: usize) -> usize {
    match rng.u8(..8) {
        0 => 0,
        1 => 1,
        2 => lanes,
        3 => lanes + 1,
        4 => 64 + rng.usize(..20),
        _ => rng.usize(..3 * lanes),
    }
}

/// The least of some, with its index; the first of equals.
fn least<H: Copy, K: PartialOrd>(
    hits: impl Iterator<Item = Option<H>>,
    key: impl Fn(&H) -> K,
) -> Option<(usize, H)> {
    let hits = hits.enumerate().filter_map(|(index, hit)| Some((index, hit?)));
    hits.reduce(|best, next| if key(&next.1) < key(&best.1) { next } else { best })
}

/// What a collection says of a ray: the closest hit, whether there is any, and the indices of all.
type Answer<H> = (Option<(usize, H)>, bool, Vec<usize>);

/// Holds what a collection says of two rays, by themselves and as many at once, against the hits of each shape; returns how many
/// rays hit, and how often.
fn check_answers<H: Copy + Debug + PartialEq, K: PartialOrd>(
    answers: [Answer<H>; 2],
    many: [Option<(usize, H)>; 2],
    expected: &[Vec<Option<H>>; 2],
    key: impl Fn(&H) -> K,
    case: impl Fn() -> String,
) -> [usize; 2] {
    let mut counts = [0; 2];
    for (((closest, any, hits), closest_of_many), expected) in
        answers.into_iter().zip(many).zip(expected)
    {
        let least = least(expected.iter().copied(), &key);
        assert_eq!(closest_of_many, least, "{}", case());
        assert_eq!(closest, least, "{}", case());
        assert_eq!(any, least.is_some(), "{}", case());
        let indices = (0..expected.len()).filter(|&index| expected[index].is_some());
        assert!(hits.iter().copied().eq(indices), "{}", case());
        counts = [counts[0] + usize::from(any), counts[1] + hits.len()];
    }
    counts
}

/// Two rays: that of a hard case, and one that hits nothing.
fn two_rays<V: Vector>(first: Ray<V>) -> [Ray<V>; 2] {
    [first, Ray { direction: V::ZERO, ..first }]
}

/// What the packs say of each triangle by itself: the verdict of the scalar kernel, and the t, u and v of a leaf.
fn each_triangle<V: Vector<Scalar: Lanes<N>>, const N: usize>(
    level: Level,
    ray: &Ray<V>,
    triangles: &[Triangle<V>],
) -> Vec<Option<TriangleHit<V::Scalar>>> {
    let hits: Vec<_> =
        triangles.iter().map(|triangle| in_leaf::<V, N>(level, ray, triangle)).collect();
    for (triangle, hit) in triangles.iter().zip(&hits) {
        assert_eq!(exact::hits(ray, triangle), hit.is_some(), "{ray:?} {triangle:?}");
    }
    hits
}

#[test]
fn triangles() {
    fn check<V: Vector<Scalar: Lanes<N>>, const N: usize>() {
        for level in levels() {
            let mut rng = fastrand::Rng::with_seed(SEED);
            let (mut rays_that_hit, mut hits) = (0, 0);
            for _ in 0..1_000 {
                let (exact_ray, vertices) = generators::ray_triangle(&mut rng);
                let mut some = Vec::new();
                for index in 0..some_length(&mut rng, N) {
                    let mut vertices = vertices;
                    if rng.bool() {
                        vertices = generators::ray_triangle(&mut rng).1;
                    } else if index > 0 {
                        vertices.rotate_left(rng.usize(..3));
                        let x = &mut vertices[rng.usize(..3)][rng.usize(..3)];
                        *x = generators::single(*x * (1.0 + 2f64.powi(-20)));
                    }
                    some.push(triangle::<V>(&vertices));
                }
                rng.shuffle(&mut some);
                let all: Triangles<V::Scalar, N> = some.iter().copied().collect();
                let all = all.with_level(level);
                let rays = two_rays(ray::<V>(&exact_ray));
                let expected = rays.map(|ray| each_triangle::<V, N>(level, &ray, &some));
                let answers =
                    rays.map(|ray| (all.closest(&ray), all.any(&ray), all.hits(&ray).collect()));
                let mut many = [None; 2];
                all.closest_of(&rays, &mut many);
                let case = || format!("{level:?} {rays:?} {some:?}");
                let counts = check_answers(answers, many, &expected, |hit| hit.t, case);
                rays_that_hit += counts[0];
                hits += counts[1];
            }
            println!("{:<6} × {N} {level:?}: {hits} hits of {rays_that_hit} rays", name::<V>());
            assert!(rays_that_hit > 300 && hits > 1_500, "{rays_that_hit} {hits}");
        }
    }
    for_every_collection!(check);
}

#[test]
fn spheres() {
    fn check<V: Vector<Scalar: Lanes<N>>, const N: usize>() {
        for level in levels() {
            let mut rng = fastrand::Rng::with_seed(SEED + 1);
            let (mut rays_that_hit, mut hits) = (0, 0);
            for _ in 0..2_000 {
                let (exact_ray, center, radius) = generators::ray_sphere(&mut rng);
                let mut some = Vec::new();
                for _ in 0..some_length(&mut rng, N) {
                    let (mut center, mut radius) = (center, radius);
                    match rng.u8(..8) {
                        0 => radius = -radius,
                        1 => radius = f64::NAN,
                        2 => center[rng.usize(..3)] = f64::INFINITY,
                        3 => radius = 0.0,
                        4 | 5 => {
                            let x = &mut center[rng.usize(..3)];
                            *x = generators::single(*x * (1.0 + 2f64.powi(-20)));
                        }
                        _ => (_, center, radius) = generators::ray_sphere(&mut rng),
                    }
                    some.push(sphere::<V>(&center, radius));
                }
                let all: Spheres<V::Scalar, N> = some.iter().copied().collect();
                let all = all.with_level(level);
                let rays = two_rays(ray::<V>(&exact_ray));
                let expected = rays
                    .map(|ray| some.iter().map(|sphere| robust::intersect(&ray, sphere)).collect());
                let answers =
                    rays.map(|ray| (all.closest(&ray), all.any(&ray), all.hits(&ray).collect()));
                let mut many = [None; 2];
                all.closest_of(&rays, &mut many);
                let case = || format!("{level:?} {rays:?} {some:?}");
                let counts = check_answers(answers, many, &expected, |hit| hit.t, case);
                rays_that_hit += counts[0];
                hits += counts[1];
            }
            println!("{:<6} × {N} {level:?}: {hits} hits of {rays_that_hit} rays", name::<V>());
            assert!(rays_that_hit > 300 && hits > 1_000, "{rays_that_hit} {hits}");
        }
    }
    for_every_collection!(check);
}

#[test]
fn boxes() {
    fn check<V: Vector<Scalar: Lanes<N>>, const N: usize>() {
        for level in levels() {
            let mut rng = fastrand::Rng::with_seed(SEED + 2);
            let (mut rays_that_hit, mut hits) = (0, 0);
            for _ in 0..2_000 {
                let (mut exact_ray, min, max) = generators::ray_aabb(&mut rng);
                if rng.u8(..4) == 0 {
                    exact_ray.t_min = f64::NEG_INFINITY;
                }
                let mut some = Vec::new();
                for _ in 0..some_length(&mut rng, N) {
                    let (mut min, mut max) = (min, max);
                    let axis = rng.usize(..3);
                    match rng.u8(..8) {
                        0 => min[axis] = f64::NAN,
                        1 => (min[axis], max[axis]) = (max[axis], min[axis]),
                        2 => max[axis] = f64::INFINITY,
                        3 | 4 => max[axis] = generators::single(max[axis] * (1.0 + 2f64.powi(-23))),
                        5 => min[axis] = generators::single(min[axis] * (1.0 - 2f64.powi(-23))),
                        _ => (_, min, max) = generators::ray_aabb(&mut rng),
                    }
                    some.push(aabb::<V>(&min, &max));
                }
                let all: Aabbs<V::Scalar, N> = some.iter().copied().collect();
                let all = all.with_level(level);
                let rays = two_rays(ray::<V>(&exact_ray));
                let expected = rays.map(|ray| {
                    let ray = BoxRay::new(&ray);
                    let hit = |aabb| {
                        let hit = box_exact::intersect(&ray, aabb);
                        assert_eq!(box_exact::hits(&ray, aabb), hit.is_some(), "{ray:?} {aabb:?}");
                        hit
                    };
                    some.iter().map(hit).collect()
                });
                let answers =
                    rays.map(|ray| (all.closest(&ray), all.any(&ray), all.hits(&ray).collect()));
                let mut many = [None; 2];
                all.closest_of(&rays, &mut many);
                let case = || format!("{level:?} {rays:?} {some:?}");
                let counts = check_answers(answers, many, &expected, |hit| hit.t_enter, case);
                rays_that_hit += counts[0];
                hits += counts[1];
            }
            println!("{:<6} × {N} {level:?}: {hits} hits of {rays_that_hit} rays", name::<V>());
            assert!(rays_that_hit > 500 && hits > 2_000, "{rays_that_hit} {hits}");
        }
    }
    for_every_collection!(check);
}

/// In several steps, so that a pack is filled up later.
#[test]
fn collections_grow_and_give_back_what_they_hold() {
    let at = |x: f32| Triangle::new(Vec3::X * x, Vec3::Y, Vec3::Z);
    let around = |x: f32| Sphere::new(Vec3::X * x, x);
    let from = |x: f32| Aabb::new(Vec3::splat(x), Vec3::splat(x + 1.0));
    let (mut triangles, mut spheres, mut boxes) =
        (Triangles::<f32, 4>::default(), Spheres::<f32, 4>::default(), Aabbs::<f32, 4>::default());
    assert!(triangles.is_empty() && spheres.is_empty() && boxes.is_empty());
    let numbers: Vec<f32> = (0..11_u8).map(f32::from).collect();
    for step in [0..3, 3..3, 3..4, 4..11] {
        let step = &numbers[step];
        triangles.extend(step.iter().map(|&x| at(x)));
        spheres.extend(step.iter().map(|&x| around(x)));
        boxes.extend(step.iter().map(|&x| from(x)));
    }
    assert_eq!([triangles.len(), spheres.len(), boxes.len()], [11; 3]);
    for (index, &x) in numbers.iter().enumerate() {
        assert_eq!(triangles.get(index), Some(at(x)));
        assert_eq!(spheres.get(index), Some(around(x)));
        assert_eq!(boxes.get(index), Some(from(x)));
    }
    assert_eq!((triangles.get::<Vec3>(11), spheres.get::<Vec3>(11)), (None, None));
    assert_eq!(boxes.get::<Vec3>(11), None);
}

#[test]
#[should_panic(expected = "a place for the hit of each ray")]
fn too_few_places_for_hits_are_refused() {
    let triangles = Triangles::<f32>::default();
    triangles.closest_of(&[Ray::new(Vec3::ZERO, Vec3::X)], &mut []);
}
