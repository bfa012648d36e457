//! Does a ray meet a box, and where?

use isect::glam::{Vec3, Vec3A};
use isect::ray::aabb::{BoxRay, conservative, exact, slab};
use isect::{Aabb, Ray};
use parry3d::query::RayCast;

use crate::data::{self, Pairs};
use crate::peer;
use crate::timing::{Contender, Question, stages};

/// Two hit rates.
pub fn questions() -> impl Iterator<Item = Question> {
    [0.1, 0.5].into_iter().map(|hit_rate| {
        let pairs = data::ray_box(data::FEW, hit_rate);
        Question {
        title: format!("ray/box, {:.0} % hits", 100.0 * hit_rate),
        note: "obvhs, parry3d answer with the t of the entry (obvhs for the whole line, without the \
               range), the bvh crate and `hits` with yes or no, `slab::intersect` with both ends \
               and their faces, `interval` with both ends. obvhs, the bvh crate and isect have \
               prepared the reciprocals in their rays; parry3d has not.",
        contenders: contenders(&pairs),
        stages: stages(&pairs, |ray, aabb| {
            exact::stage(&BoxRay::<Vec3A>::new(&(*ray).into()), &Aabb::<Vec3A>::from(*aabb))
        }),
    }})
}

fn contenders(pairs: &Pairs<Ray, Aabb>) -> Vec<Contender> {
    let vec3 = || pairs.map(BoxRay::<Vec3>::new, |_, aabb| *aabb);
    let vec3a = || {
        pairs.map(|ray| BoxRay::<Vec3A>::new(&(*ray).into()), |_, aabb| Aabb::<Vec3A>::from(*aabb))
    };
    vec![
        Contender::new(
            "obvhs `Aabb::intersect_ray`",
            pairs.map(peer::obvhs_ray, |_, aabb| peer::obvhs_aabb(aabb)),
            |ray, aabb| aabb.intersect_ray(ray),
            |t| t.is_finite(),
        )
        .reference(),
        Contender::new(
            "parry3d `Aabb::cast_local_ray`",
            pairs.map(peer::parry_ray, |_, aabb| peer::parry_aabb(aabb)),
            |ray, aabb| aabb.cast_local_ray(ray, f32::MAX, true),
            Option::is_some,
        ),
        Contender::new(
            "bvh `Ray::intersects_aabb`",
            pairs.map(peer::bvh_ray, |_, aabb| peer::bvh_aabb(aabb)),
            bvh::ray::Ray::intersects_aabb,
            |hit| *hit,
        ),
        Contender::new("isect `slab::hits`, Vec3A", vec3a(), slab::hits, |hit| *hit),
        Contender::new("isect `slab::hits`, Vec3", vec3(), slab::hits, |hit| *hit),
        Contender::new("isect `slab::intersect`, Vec3A", vec3a(), slab::intersect, Option::is_some),
        Contender::new("isect `slab::intersect`, Vec3", vec3(), slab::intersect, Option::is_some),
        Contender::new("isect `exact::hits`, Vec3A", vec3a(), exact::hits, |hit| *hit),
        Contender::new("isect `exact::hits`, Vec3", vec3(), exact::hits, |hit| *hit),
        Contender::new("isect `conservative::hits`, Vec3A", vec3a(), conservative::hits, |hit| {
            *hit
        }),
        Contender::new("isect `conservative::hits`, Vec3", vec3(), conservative::hits, |hit| *hit),
        Contender::new(
            "isect `conservative::interval`, Vec3A",
            vec3a(),
            conservative::interval,
            Option::is_some,
        ),
        Contender::new(
            "isect `conservative::interval`, Vec3",
            vec3(),
            conservative::interval,
            Option::is_some,
        ),
    ]
}
