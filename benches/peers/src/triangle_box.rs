//! Do a triangle and a box overlap?

use isect::glam::Vec3A;
use isect::overlap::triangle_aabb::{clip, exact, sat};
use isect::{Aabb, Triangle};
use parry3d::query::details::intersection_test_aabb_triangle;

use crate::data::{self, Pairs};
use crate::peer;
use crate::timing::{Contender, Question, stages};

/// Two overlap rates.
pub fn questions() -> impl Iterator<Item = Question> {
    [0.02, 0.33].into_iter().map(|overlap_rate| {
        let pairs = data::triangle_box(overlap_rate);
        Question {
            title: format!("triangle/box, {:.0} % overlaps", 100.0 * overlap_rate),
            note: "All answer with yes or no.",
            contenders: contenders(&pairs),
            stages: stages(&pairs, |aabb, triangle| {
                exact::stage(&Triangle::<Vec3A>::from(*triangle), &Aabb::<Vec3A>::from(*aabb))
            }),
        }
    })
}

fn contenders(pairs: &Pairs<Aabb, Triangle>) -> Vec<Contender> {
    let vec3 = || pairs.map(|aabb| *aabb, |_, triangle| *triangle);
    let vec3a = || {
        pairs.map(
            |aabb| Aabb::<Vec3A>::from(*aabb),
            |_, triangle| Triangle::<Vec3A>::from(*triangle),
        )
    };
    vec![
        Contender::new(
            "parry3d `intersection_test_aabb_triangle`",
            pairs.map(peer::parry_aabb, |_, triangle| peer::parry_triangle(triangle)),
            intersection_test_aabb_triangle,
            |hit| *hit,
        )
        .reference(),
        Contender::new(
            "the 2001 test, centre and half extents, Vec3A",
            pairs.map(
                |aabb| {
                    let aabb = Aabb::<Vec3A>::from(*aabb);
                    (aabb.center(), aabb.size() * 0.5)
                },
                |_, triangle| Triangle::<Vec3A>::from(*triangle),
            ),
            |(center, half), triangle| peer::akenine_moller(*center, *half, triangle),
            |hit| *hit,
        ),
        Contender::new(
            "isect `sat::overlaps`, Vec3A",
            vec3a(),
            |aabb, triangle| sat::overlaps(triangle, aabb),
            |hit| *hit,
        ),
        Contender::new(
            "isect `sat::overlaps`, Vec3",
            vec3(),
            |aabb, triangle| sat::overlaps(triangle, aabb),
            |hit| *hit,
        ),
        Contender::new(
            "isect `exact::overlaps`, Vec3A",
            vec3a(),
            |aabb, triangle| exact::overlaps(triangle, aabb),
            |hit| *hit,
        ),
        Contender::new(
            "isect `exact::overlaps`, Vec3",
            vec3(),
            |aabb, triangle| exact::overlaps(triangle, aabb),
            |hit| *hit,
        ),
        Contender::new(
            "isect `clip::overlaps`, Vec3A",
            vec3a(),
            |aabb, triangle| clip::overlaps(triangle, aabb),
            |hit| *hit,
        ),
        Contender::new(
            "isect `clip::overlaps`, Vec3",
            vec3(),
            |aabb, triangle| clip::overlaps(triangle, aabb),
            |hit| *hit,
        ),
    ]
}
