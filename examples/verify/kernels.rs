//! The kernels of isect, and those of obvhs.

use isect::glam::Vec3A;
use isect::overlap::triangle_aabb;
use isect::ray::aabb::{self, BoxRay};
use isect::ray::triangle::watertight::ShearedRay;
use isect::ray::triangle::{badouel, exact, moller_trumbore, segura, watertight};
use isect::ray::{plane, sphere};
use isect::testkit::{Answer, Campaign, Report};
use isect::{Aabb, Plane, Ray, Sphere, Triangle, Vector};

use crate::contender::{Contender, Promise};

/// A kernel that answers about a ray and a triangle: verdicts, then leaks.
fn ray_triangle<V: Vector, A: Answer<V::Scalar> + 'static>(
    name: &str,
    promise: Promise,
    kernel: fn(&Ray<V>, &Triangle<V>) -> A,
) -> Contender {
    Contender::new(name, promise, move |campaign, name| {
        campaign.ray_triangle(name, kernel).merged(campaign.leaks(name, kernel))
    })
}

fn ray_aabb<V: Vector, A: Answer<V::Scalar> + 'static>(
    name: &str,
    promise: Promise,
    kernel: fn(&BoxRay<V>, &Aabb<V>) -> A,
) -> Contender {
    let run = move |campaign: Campaign, name: &str| -> Report {
        campaign.ray_aabb(name, |ray, aabb| kernel(&BoxRay::new(ray), aabb))
    };
    Contender::new(name, promise, run)
}

fn ray_sphere<V: Vector, A: Answer<V::Scalar> + 'static>(
    name: &str,
    promise: Promise,
    kernel: fn(&Ray<V>, &Sphere<V>) -> A,
) -> Contender {
    Contender::new(name, promise, move |campaign, name| campaign.ray_sphere(name, kernel))
}

fn ray_plane<V: Vector, A: Answer<V::Scalar> + 'static>(
    name: &str,
    promise: Promise,
    kernel: fn(&Ray<V>, &Plane<V>) -> A,
) -> Contender {
    Contender::new(name, promise, move |campaign, name| campaign.ray_plane(name, kernel))
}

fn overlap<V: Vector>(
    name: &str,
    promise: Promise,
    kernel: fn(&Triangle<V>, &Aabb<V>) -> bool,
) -> Contender {
    Contender::new(name, promise, move |campaign, name| campaign.triangle_aabb(name, kernel))
}

/// The kernels of isect on one vector type.
pub(crate) fn of_isect<V: Vector>() -> Vec<Contender> {
    use Promise::{Conservative, Exact, Refined, Sound, Watertight};
    vec![
        ray_triangle::<V, _>("triangle::moller_trumbore", Sound, moller_trumbore::intersect),
        ray_triangle::<V, _>("triangle::badouel", Sound, badouel::intersect),
        ray_triangle::<V, _>("triangle::badouel::Prepared", Sound, |ray, triangle| {
            badouel::Prepared::new(triangle).intersect(ray)
        }),
        ray_triangle::<V, _>("triangle::segura", Sound, segura::intersect),
        ray_triangle::<V, _>("triangle::segura::detects", Sound, segura::detects),
        ray_triangle::<V, _>("triangle::watertight", Watertight, |ray, triangle| {
            watertight::intersect(&ShearedRay::new(ray), triangle)
        }),
        ray_triangle::<V, _>("triangle::exact", Exact, exact::intersect),
        ray_triangle::<V, _>("triangle::exact::hits", Exact, exact::hits),
        ray_triangle::<V, _>("triangle::exact::refine", Refined, |ray, triangle| {
            exact::hits(ray, triangle).then(|| exact::refine(ray, triangle))
        }),
        ray_triangle::<V, _>("triangle::exact::classify", Exact, |ray, triangle| {
            exact::classify(ray, triangle) != exact::Verdict::Miss
        }),
        ray_aabb::<V, _>("aabb::slab", Sound, aabb::slab::intersect),
        ray_aabb::<V, _>("aabb::slab::hits", Sound, aabb::slab::hits),
        ray_aabb::<V, _>("aabb::conservative", Conservative, aabb::conservative::hits),
        ray_aabb::<V, _>("aabb::conservative::interval", Conservative, |ray, aabb| {
            aabb::conservative::interval(ray, aabb).is_some()
        }),
        ray_aabb::<V, _>("aabb::exact", Exact, aabb::exact::intersect),
        ray_aabb::<V, _>("aabb::exact::hits", Exact, aabb::exact::hits),
        ray_sphere::<V, _>("sphere::algebraic", Sound, sphere::algebraic::intersect),
        ray_sphere::<V, _>("sphere::geometric", Sound, sphere::geometric::intersect),
        ray_sphere::<V, _>("sphere::robust", Exact, sphere::robust::intersect),
        ray_plane::<V, _>("plane", Exact, plane::intersect),
        overlap::<V>("triangle_aabb::sat", Sound, triangle_aabb::sat::overlaps),
        overlap::<V>("triangle_aabb::clip", Sound, triangle_aabb::clip::overlaps),
        overlap::<V>("triangle_aabb::exact", Exact, triangle_aabb::exact::overlaps),
    ]
}

fn obvhs_ray(ray: &Ray<Vec3A>) -> obvhs::ray::Ray {
    obvhs::ray::Ray::new(ray.origin, ray.direction, ray.t_min, ray.t_max)
}

/// The kernels of obvhs; its box test takes no range.
pub(crate) fn of_obvhs() -> Vec<Contender> {
    vec![
        ray_triangle("obvhs Triangle::intersect", Promise::Unknown, |ray, triangle| {
            let Triangle { v0, v1, v2 } = *triangle;
            let t = obvhs::triangle::Triangle { v0, v1, v2 }.intersect(&obvhs_ray(ray));
            (t != f32::INFINITY).then_some(t)
        }),
        Contender::new(
            "obvhs Aabb::intersect_ray, half-lines",
            Promise::Unknown,
            |campaign, name| {
                campaign.with_half_lines().ray_aabb(name, |ray, aabb: &Aabb<Vec3A>| {
                    let t =
                        obvhs::aabb::Aabb::new(aabb.min, aabb.max).intersect_ray(&obvhs_ray(ray));
                    (t != f32::INFINITY).then_some(t.max(0.0))
                })
            },
        ),
    ]
}
