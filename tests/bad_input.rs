//! Claim: bad input is a miss, never a panic, never a NaN in a hit.

use isect::ray::aabb::{BoxRay, conservative, slab};
use isect::ray::plane::{self, PlaneHit};
use isect::ray::sphere;
use isect::ray::triangle::segura;
use isect::{Plane, Vector};

use crate::support::kernels::{box_kernels, overlap_kernels, sphere_kernels, triangle_kernels};
use crate::support::{
    aabb, for_every_vector, generators, oracle, ray, scalar, sphere, triangle, vector,
};

const SEED: u64 = 5;
const CASES: u32 = 300_000;

/// A ray with any numbers in it, and whether it can hit anything.
fn any_ray(rng: &mut fastrand::Rng) -> (oracle::Ray, bool) {
    let mut number = || generators::hostile(rng);
    let ray = oracle::Ray {
        origin: [number(), number(), number()],
        direction: [number(), number(), number()],
        t_min: number(),
        t_max: number(),
    };
    let ray =
        if rng.bool() { oracle::Ray { t_min: 0.0, t_max: f64::INFINITY, ..ray } } else { ray };
    let finite = ray.origin.iter().chain(&ray.direction).all(|x| x.is_finite());
    let good = finite && ray.direction != [0.0; 3] && ray.t_min <= ray.t_max;
    (ray, good)
}

fn any_point(rng: &mut fastrand::Rng) -> [f64; 3] {
    [(); 3].map(|()| generators::hostile(rng))
}

fn in_range(t: f64, ray: &oracle::Ray) -> bool {
    t.is_finite() && ray.t_min <= t && t <= ray.t_max
}

#[test]
fn triangles() {
    fn check<V: Vector>() {
        let mut rng = fastrand::Rng::with_seed(SEED);
        for _ in 0..CASES {
            let (exact_ray, good) = any_ray(&mut rng);
            let vertices = [(); 3].map(|()| any_point(&mut rng));
            let good = good && vertices.as_flattened().iter().all(|x| x.is_finite());
            let (ray, triangle) = (ray::<V>(&exact_ray), triangle(&vertices));
            for kernel in triangle_kernels() {
                let Some(hit) = (kernel.intersect)(&ray, &triangle) else { continue };
                assert!(good, "{} {exact_ray:?} {vertices:?} {hit:?}", kernel.name);
                assert!(in_range(hit.t.into(), &exact_ray), "{} {hit:?}", kernel.name);
                let weights: [f64; 3] = hit.barycentric().map(Into::into);
                assert!(
                    weights.iter().all(|w| (0.0..=1.0001).contains(w)),
                    "{} {hit:?}",
                    kernel.name
                );
            }
            assert!(good || !segura::detects(&ray, &triangle), "{exact_ray:?} {vertices:?}");
            assert!(good || !ray.hits(&triangle));
        }
    }
    for_every_vector!(check);
}

#[test]
fn boxes() {
    fn check<V: Vector>() {
        let mut rng = fastrand::Rng::with_seed(SEED + 1);
        for _ in 0..CASES {
            let (exact_ray, good) = any_ray(&mut rng);
            let (min, max) = (any_point(&mut rng), any_point(&mut rng));
            let good = good && (0..3).all(|i| min[i] <= max[i]);
            let box_ray = BoxRay::new(&ray::<V>(&exact_ray));
            let aabb = aabb::<V>(&min, &max);
            for (name, hits) in box_kernels() {
                assert!(good || !hits(&box_ray, &aabb), "{name} {exact_ray:?} {min:?} {max:?}");
            }
            let hit = slab::intersect(&box_ray, &aabb);
            assert_eq!(hit.is_some(), slab::hits(&box_ray, &aabb));
            if let Some(hit) = hit {
                let (enter, exit) = (hit.t_enter.into(), hit.t_exit.into());
                assert!(
                    exact_ray.t_min <= enter && enter <= exit && exit <= exact_ray.t_max,
                    "{hit:?}"
                );
                assert!(hit.surface().is_none_or(|(t, _)| t.into().is_finite()), "{hit:?}");
            }
            if let Some([enter, exit]) = conservative::interval(&box_ray, &aabb) {
                assert!(
                    exact_ray.t_min <= enter.into()
                        && enter <= exit
                        && exit.into() <= exact_ray.t_max
                );
            }
        }
    }
    for_every_vector!(check);
}

#[test]
fn spheres_and_planes() {
    fn check<V: Vector>() {
        let mut rng = fastrand::Rng::with_seed(SEED + 2);
        for _ in 0..CASES {
            let (exact_ray, good_ray) = any_ray(&mut rng);
            let (p, x) = (any_point(&mut rng), generators::hostile(&mut rng));
            let finite = x.is_finite() && p.iter().all(|x| x.is_finite());
            let ray = ray::<V>(&exact_ray);

            let good = good_ray && finite && x >= 0.0;
            for kernel in sphere_kernels() {
                if let Some(hit) = (kernel.intersect)(&ray, &sphere(&p, x)) {
                    assert!(
                        good && in_range(hit.t.into(), &exact_ray),
                        "{} {exact_ray:?} {p:?} {x}",
                        kernel.name
                    );
                }
            }
            if let Some(roots) = sphere::roots(&ray, &sphere(&p, x)) {
                assert!(roots[0] <= roots[1] && roots.iter().all(|&t| t.into().is_finite()));
            }

            let good = good_ray && finite && p != [0.0; 3];
            let plane = Plane { normal: vector::<V>(p), offset: scalar(x) };
            match plane::intersect(&ray, &plane) {
                Some(PlaneHit::At(t)) => {
                    assert!(good && in_range(t.into(), &exact_ray), "{exact_ray:?} {p:?} {x}");
                }
                Some(PlaneHit::Contained) => assert!(good),
                None => {}
            }
        }
    }
    for_every_vector!(check);
}

#[test]
fn triangles_and_boxes() {
    fn check<V: Vector>() {
        let mut rng = fastrand::Rng::with_seed(SEED + 3);
        for _ in 0..CASES {
            let vertices = [(); 3].map(|()| any_point(&mut rng));
            let (min, max) = (any_point(&mut rng), any_point(&mut rng));
            let good = vertices.as_flattened().iter().all(|x| x.is_finite())
                && (0..3).all(|i| min[i] <= max[i]);
            for (name, overlaps) in overlap_kernels() {
                let overlap = overlaps(&triangle::<V>(&vertices), &aabb(&min, &max));
                assert!(good || !overlap, "{name} {vertices:?} {min:?} {max:?}");
            }
        }
    }
    for_every_vector!(check);
}
