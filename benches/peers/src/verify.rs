//! The peers' answers against exact arithmetic.

use std::process::ExitCode;

use isect::glam::{Vec3, Vec3A};
use isect::testkit::{Answer, Campaign};
use isect::{Aabb, Ray, Triangle};
use parry3d::query::RayCast;
use parry3d::query::details::intersection_test_aabb_triangle;

use crate::contender::{self, Contender, Promise};
use crate::{kernels, peer};

/// Runs all whose name contains the filter; fails if a kernel of isect breaks its promise, or if there is none of that name.
///
/// All rays are half-lines: not every peer takes a range.
pub fn run(filter: &str, campaign: Campaign, with_examples: bool) -> ExitCode {
    let mut contenders = kernels::of_isect::<Vec3A>();
    contenders.extend(kernels::of_obvhs());
    contenders.extend(of_parry3d());
    contenders.extend(of_bvh());
    contenders.push(overlap("the 2001 triangle/box test", |triangle, aabb| {
        let aabb = Aabb::<Vec3A>::from(*aabb);
        peer::akenine_moller(aabb.center(), aabb.size() * 0.5, &(*triangle).into())
    }));
    contenders.retain(|contender| contender.name.contains(filter));
    if contenders.is_empty() {
        eprintln!("peers: no kernel has a name with {filter:?}");
        return ExitCode::from(2);
    }
    let reports = contender::run(&contenders, campaign.with_half_lines());
    if contender::print(&contenders, &reports, with_examples) {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    }
}

fn ray_triangle<A: Answer<f32> + 'static>(
    name: &str,
    kernel: fn(&Ray, &Triangle) -> A,
) -> Contender {
    Contender::new(name, Promise::Unknown, move |campaign, name| {
        campaign.ray_triangle(name, kernel).merged(campaign.leaks(name, kernel))
    })
}

fn ray_aabb<A: Answer<f32> + 'static>(name: &str, kernel: fn(&Ray, &Aabb) -> A) -> Contender {
    Contender::new(name, Promise::Unknown, move |campaign, name| campaign.ray_aabb(name, kernel))
}

fn overlap(name: &str, kernel: fn(&Triangle, &Aabb) -> bool) -> Contender {
    Contender::new(name, Promise::Unknown, move |campaign, name| {
        campaign.triangle_aabb::<Vec3>(name, kernel)
    })
}

fn of_parry3d() -> [Contender; 3] {
    [
        ray_triangle("parry3d Triangle::cast_local_ray_and_get_normal", |ray, triangle| {
            let hit = peer::parry_triangle(triangle).cast_local_ray_and_get_normal(
                &peer::parry_ray(ray),
                f32::MAX,
                false,
            );
            hit.map(|hit| hit.time_of_impact)
        }),
        ray_aabb("parry3d Aabb::cast_local_ray", |ray, aabb| {
            peer::parry_aabb(aabb).cast_local_ray(&peer::parry_ray(ray), f32::MAX, true)
        }),
        overlap("parry3d intersection_test_aabb_triangle", |triangle, aabb| {
            intersection_test_aabb_triangle(
                &peer::parry_aabb(aabb),
                &peer::parry_triangle(triangle),
            )
        }),
    ]
}

fn of_bvh() -> [Contender; 2] {
    [
        ray_triangle("bvh Ray::intersects_triangle", |ray, triangle| {
            let [a, b, c] = peer::bvh_triangle(ray, triangle);
            let hit = peer::bvh_ray(ray).intersects_triangle(&a, &b, &c);
            (hit.distance != f32::INFINITY).then_some(hit.distance)
        }),
        ray_aabb("bvh Ray::intersects_aabb", |ray, aabb| {
            peer::bvh_ray(ray).intersects_aabb(&peer::bvh_aabb(aabb))
        }),
    ]
}
