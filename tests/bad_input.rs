//! Claim: bad input is a miss, never a panic, never a NaN in a hit.

use isect::ray::aabb::{BoxRay, conservative, slab};
use isect::ray::plane::{self, PlaneHit};
use isect::ray::sphere;
use isect::ray::triangle::segura;
use isect::ray::triangle::watertight::{self, ShearedRay};
use isect::{Aabb, Plane, Ray, Scalar, Sphere, Triangle, Vector};

use crate::support::kernels::{box_kernels, overlap_kernels, sphere_kernels, triangle_kernels};
use crate::support::{
    aabb, for_every_vector, generators, name, oracle, ray, scalar, sphere, triangle, vector,
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
                // A weight over the computed sum of them all, none negative, is at most 1; the reciprocal and the product
                // are rounded.
                let most = 1.0 + V::Scalar::EPSILON.into();
                let weights: [f64; 3] = hit.barycentric().map(Into::into);
                assert!(
                    weights.iter().all(|w| (0.0..=most).contains(w)),
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

/// The shapes that one ray meets, about as large as their distance.
struct Targets<V: Vector> {
    triangle: Triangle<V>,
    sphere: Sphere<V>,
    aabb: Aabb<V>,
    /// One that is crossed, and one that contains the ray.
    planes: [Plane<V>; 2],
}

impl<V: Vector> Targets<V> {
    /// Whether each kernel, by name, finds a hit: the prepared rays also with an end that is set later.
    fn verdicts(&self, ray: &Ray<V>) -> Vec<(&'static str, bool)> {
        let Self { triangle, sphere, aabb, planes } = self;
        let open = Ray { t_max: V::Scalar::INFINITY, ..*ray };
        let (mut late_box_ray, mut late_sheared_ray) = (BoxRay::new(&open), ShearedRay::new(&open));
        late_box_ray.t_max = ray.t_max;
        late_sheared_ray.t_max = ray.t_max;
        let late = watertight::intersect(&late_sheared_ray, triangle).is_some();
        let mut verdicts = vec![("detects", segura::detects(ray, triangle)), ("late end", late)];
        for kernel in triangle_kernels::<V>() {
            verdicts.push((kernel.name, (kernel.intersect)(ray, triangle).is_some()));
        }
        for kernel in sphere_kernels::<V>() {
            verdicts.push((kernel.name, (kernel.intersect)(ray, sphere).is_some()));
        }
        for (name, hits) in box_kernels::<V>() {
            verdicts.extend([&BoxRay::new(ray), &late_box_ray].map(|ray| (name, hits(ray, aabb))));
        }
        verdicts.extend(planes.map(|plane| ("plane", plane::intersect(ray, &plane).is_some())));
        verdicts
    }

    /// Every t at which a kernel sees the line cross a shape.
    fn crossings(&self, line: &Ray<V>) -> Vec<V::Scalar> {
        let triangles = triangle_kernels::<V>().map(|k| (k.intersect)(line, &self.triangle));
        let mut crossings: Vec<_> = triangles.iter().flatten().map(|hit| hit.t).collect();
        crossings.extend(sphere::roots(line, &self.sphere).into_iter().flatten());
        let hit = slab::intersect(&BoxRay::new(line), &self.aabb);
        crossings.extend(hit.into_iter().flat_map(|hit| [hit.t_enter, hit.t_exit]));
        if let Some(PlaneHit::At(t)) = plane::intersect(line, &self.planes[0]) {
            crossings.push(t);
        }
        crossings
    }
}

/// A range that is empty by one step is empty, also where its ends are scaled to the same number, or underflow.
#[test]
fn ranges_that_are_empty_by_one_step() {
    fn check<V: Vector>() {
        let smallest = V::Scalar::MIN_POSITIVE;
        let least = smallest * V::Scalar::EPSILON;
        let zero = V::Scalar::ZERO;
        // Powers of two whose products with numbers around 1 are normal.
        let limit = if smallest.into() < 1e-300 { 1016 } else { 120 };
        let mut rng = fastrand::Rng::with_seed(SEED + 4);
        let (mut normal, mut subnormal) = (0, 0);
        for case in 0..6_000 {
            // Half of the t are about 1, or of any magnitude; half are subnormal.
            let t_power = match case % 4 {
                0 => 0,
                1 => rng.i32(-limit..=limit),
                _ => -limit - rng.i32(6..26),
            };
            let length = rng.i32((-limit).max(t_power - limit)..=limit.min(t_power + limit));
            let point = |rng: &mut fastrand::Rng| [(); 3].map(|()| 2.0 * rng.f64() - 1.0);
            let times = |p: [f64; 3], power: i32| p.map(|x| x * 2f64.powi(power));
            let sum = |a: [f64; 3], b: [f64; 3], weight: f64| -> [f64; 3] {
                std::array::from_fn(|i| a[i] + weight * b[i])
            };
            let (target, mut origin, a, b) =
                (point(&mut rng), point(&mut rng), point(&mut rng), point(&mut rng));
            // All in a plane across z, which contains the ray.
            origin[2] = target[2];
            let direction = sum(target, origin, -1.0);
            if case % 8 == 1 {
                // From a vertex: t is zero, and the ends next to it underflow where the lengths are much larger than the direction.
                origin = a;
            }
            let c = sum(sum(target, sum(a, target, -1.0), -1.0), sum(b, target, -1.0), -1.0);
            let size = 2f64.powi(length);
            let normal_vector = [1.0, 0.5, 0.25];
            let offset = (0..3).map(|i| normal_vector[i] * target[i]).sum::<f64>() * size;
            let targets = Targets::<V> {
                triangle: triangle(&[a, b, c].map(|p| times(p, length))),
                sphere: sphere(&times(target, length), 0.25 * size),
                aabb: aabb(
                    &times(target.map(|x| x - 0.25), length),
                    &times(target.map(|x| x + 0.25), length),
                ),
                planes: [
                    Plane { normal: vector(normal_vector), offset: scalar(offset) },
                    Plane { normal: vector([0.0, 0.0, 1.0]), offset: scalar(target[2] * size) },
                ],
            };
            let line =
                Ray::new(vector(times(origin, length)), vector(times(direction, length - t_power)))
                    .with_range(-V::Scalar::INFINITY, V::Scalar::INFINITY);
            let crossings = targets.crossings(&line);
            let near_zero = [-smallest, -least, zero, least, smallest].map(|t| t.next_down());
            for t_max in crossings.into_iter().flat_map(|t| [t.next_down(), t]).chain(near_zero) {
                let t_min = t_max.next_up();
                for (name, hits) in targets.verdicts(&line.with_range(t_min, t_max)) {
                    assert!(!hits, "{name}: {line:?} {t_min:?} {t_max:?}");
                }
                // Where it is not empty, some of the kernels find a hit in it.
                let wide = targets.verdicts(&line.with_range(t_max, t_min));
                if wide.iter().any(|(name, hits)| *hits && *name != "plane") {
                    *if t_max < smallest && -t_max < smallest {
                        &mut subnormal
                    } else {
                        &mut normal
                    } += 1;
                }
            }
        }
        println!(
            "{:<6} {normal} normal and {subnormal} subnormal ranges around a hit",
            name::<V>()
        );
        assert!(normal > 10_000 && subnormal > 10_000);
    }
    for_every_vector!(check);
}
