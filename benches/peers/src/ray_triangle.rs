//! Where does a ray meet a triangle?

use isect::glam::{DVec3, Vec3, Vec3A};
use isect::ray::triangle::watertight::ShearedRay;
use isect::ray::triangle::{badouel, exact, moller_trumbore, segura, watertight};
use isect::{Ray, Triangle};
use parry3d::query::RayCast;

use crate::data::{self, Pairs};
use crate::peer;
use crate::timing::{Contender, Question, stages};

/// Two hit rates and two sizes.
pub fn questions() -> impl Iterator<Item = Question> {
    let cases = [(0.1, 1.0), (0.5, 1.0), (0.1, 0.01), (0.5, 0.01)];
    cases.into_iter().map(|(hit_rate, size)| {
        let pairs = data::ray_triangle(data::FEW, hit_rate, size);
        Question {
        title: format!(
            "ray/triangle, {:.0} % hits, triangles of size {size} at a distance of 1 to 3",
            100.0 * hit_rate
        ),
        note: "obvhs answers with t alone, parry3d with t and a unit normal, the bvh crate with t, u \
               and v of front faces only (its triangles are turned to the ray), isect with t, u, v \
               and the side; `detects` with yes or no.",
        contenders: contenders(&pairs),
        stages: stages(&pairs, |ray, triangle| {
            exact::stage(&Ray::<Vec3A>::from(*ray), &Triangle::<Vec3A>::from(*triangle))
        }),
    }})
}

fn contenders(pairs: &Pairs<Ray, Triangle>) -> Vec<Contender> {
    let vec3 = || pairs.map(|ray| *ray, |_, triangle| *triangle);
    let vec3a = || {
        pairs.map(|ray| Ray::<Vec3A>::from(*ray), |_, triangle| Triangle::<Vec3A>::from(*triangle))
    };
    let dvec3 = || {
        pairs.map(|ray| Ray::<DVec3>::from(*ray), |_, triangle| Triangle::<DVec3>::from(*triangle))
    };
    vec![
        Contender::new(
            "obvhs `Triangle::intersect`",
            pairs.map(peer::obvhs_ray, |_, triangle| peer::obvhs_triangle(triangle)),
            |ray, triangle| triangle.intersect(ray),
            |t| t.is_finite(),
        )
        .reference(),
        Contender::new(
            "obvhs `RtTriangle::intersect` (normal prepared)",
            pairs.map(peer::obvhs_ray, |_, triangle| {
                obvhs::rt_triangle::RtTriangle::from(&peer::obvhs_triangle(triangle))
            }),
            |ray, triangle| triangle.intersect(ray),
            |t| t.is_finite(),
        ),
        Contender::new(
            "parry3d `cast_local_ray_and_get_normal`",
            pairs.map(peer::parry_ray, |_, triangle| peer::parry_triangle(triangle)),
            |ray, triangle| triangle.cast_local_ray_and_get_normal(ray, f32::MAX, false),
            Option::is_some,
        ),
        Contender::new(
            "bvh `Ray::intersects_triangle`",
            pairs.map(peer::bvh_ray, peer::bvh_triangle),
            |ray, [a, b, c]| ray.intersects_triangle(a, b, c),
            |hit| hit.distance.is_finite(),
        ),
        Contender::new(
            "isect `moller_trumbore::intersect`, Vec3A",
            vec3a(),
            moller_trumbore::intersect,
            Option::is_some,
        ),
        Contender::new(
            "isect `moller_trumbore::intersect`, Vec3",
            vec3(),
            moller_trumbore::intersect,
            Option::is_some,
        ),
        Contender::new(
            "isect `moller_trumbore::intersect`, DVec3",
            dvec3(),
            moller_trumbore::intersect,
            Option::is_some,
        ),
        Contender::new(
            "isect `exact::intersect`, Vec3A",
            vec3a(),
            exact::intersect,
            Option::is_some,
        ),
        Contender::new("isect `exact::intersect`, Vec3", vec3(), exact::intersect, Option::is_some),
        Contender::new(
            "isect `exact::intersect`, DVec3",
            dvec3(),
            exact::intersect,
            Option::is_some,
        ),
        Contender::new("isect `segura::detects`, Vec3A", vec3a(), segura::detects, |hit| *hit),
        Contender::new(
            "isect `segura::intersect`, Vec3A",
            vec3a(),
            segura::intersect,
            Option::is_some,
        ),
        Contender::new(
            "isect `badouel::Prepared::intersect`, Vec3A",
            pairs.map(
                |ray| Ray::<Vec3A>::from(*ray),
                |_, triangle| badouel::Prepared::<Vec3A>::new(&(*triangle).into()),
            ),
            |ray, prepared| prepared.intersect(ray),
            Option::is_some,
        ),
        Contender::new(
            "isect `badouel::intersect`, Vec3A",
            vec3a(),
            badouel::intersect,
            Option::is_some,
        ),
        Contender::new(
            "isect `watertight::intersect`, `ShearedRay` per ray, Vec3A",
            pairs.map(
                |ray| ShearedRay::<Vec3A>::new(&(*ray).into()),
                |_, triangle| Triangle::<Vec3A>::from(*triangle),
            ),
            watertight::intersect,
            Option::is_some,
        ),
        Contender::new(
            "isect `watertight::intersect`, `ShearedRay` per ray, Vec3",
            pairs.map(ShearedRay::<Vec3>::new, |_, triangle| *triangle),
            watertight::intersect,
            Option::is_some,
        ),
        Contender::new(
            "isect `watertight::intersect`, `ShearedRay` per test, Vec3A",
            vec3a(),
            |ray, triangle| watertight::intersect(&ShearedRay::new(ray), triangle),
            Option::is_some,
        ),
        Contender::new(
            "isect `Ray::intersect`, the default, Vec3A",
            vec3a(),
            Ray::intersect::<Triangle<Vec3A>>,
            Option::is_some,
        ),
        Contender::new(
            "isect `Ray::intersect`, the default, Vec3",
            vec3(),
            Ray::intersect::<Triangle>,
            Option::is_some,
        ),
    ]
}
