//! What does a pack cost, per triangle or box?

use isect::glam::Vec3A;
use isect::ray::aabb::BoxRay;
use isect::ray::triangle::exact;
use isect::ray::triangle::watertight::ShearedRay;
use isect::simd::fearless_simd::{Level, dispatch};
use isect::simd::{AabbPack, TrianglePack};
use isect::{Aabb, Ray, Triangle};

use crate::data::{self, Pairs};
use crate::peer;
use crate::timing::{Contender, Question, ask_packs, stages};

/// How many shapes each ray is held against: those of a leaf, or many in a row; and whether it is one ray alone with its
/// shapes, which stay in the cache.
const PER_RAY: [(usize, bool, &str); 3] =
    [(8, false, "a pack"), (256, false, "a stream"), (256, true, "a cached stream")];

/// Two hit rates, two sizes, single packs and streams of them.
pub fn triangle_questions() -> impl Iterator<Item = Question> {
    let cases = [(0.1, 1.0), (0.5, 1.0), (0.1, 0.01), (0.5, 0.01)];
    PER_RAY.into_iter().flat_map(move |(per_ray, is_cached, what)| {
        cases.into_iter().map(move |(hit_rate, size)| {
            let pairs = data::ray_triangle(per_ray, hit_rate, size);
            let pairs = if is_cached { pairs.of_first() } else { pairs };
            Question {
                title: format!(
                    "1 ray and {what} of triangles, {:.0} % hits, size {size}",
                    100.0 * hit_rate
                ),
                note: "Per triangle: obvhs asks one by one and answers with t alone; the packs write out t, u, v, side \
                       and mask of all lanes, `closest` the closest hit.",
                contenders: triangle_contenders(&pairs),
                stages: stages(&pairs, |ray, triangle| {
                    exact::stage(&Ray::<Vec3A>::from(*ray), &Triangle::<Vec3A>::from(*triangle))
                }),
            }
        })
    })
}

fn triangle_contenders(pairs: &Pairs<Ray, Triangle>) -> Vec<Contender> {
    let (level, rounds) = (Level::new(), pairs.rounds());
    let ray = |ray: &Ray| Ray::<Vec3A>::from(*ray);
    let packs = || pairs.packed(8, ray, TrianglePack::<f32, 8>::from_triangles);
    let sheared =
        pairs.packed(8, |r| ShearedRay::new(&ray(r)), TrianglePack::<f32, 8>::from_triangles);
    let sixteen = pairs.packed(16, ray, TrianglePack::<f32, 16>::from_triangles);
    let [fast, certain, closest, any] = [(); 4].map(|()| packs());
    vec![
        Contender::new(
            "obvhs `Triangle::intersect`",
            pairs.map(peer::obvhs_ray, |_, triangle| peer::obvhs_triangle(triangle)),
            |ray, triangle| triangle.intersect(ray),
            |t| *t < f32::INFINITY,
        )
        .reference(),
        Contender::of_packs("isect `TrianglePack::moller_trumbore` × 8", fast, move |packs| {
            dispatch!(level, simd => ask_packs( packs,
                rounds,
                #[inline(always)]
                |ray, pack| pack.moller_trumbore(simd, ray),
                |hits| hits.mask.count_ones(),
            ))
        }),
        Contender::of_packs("isect `TrianglePack::watertight` × 8", sheared, move |packs| {
            dispatch!(level, simd => ask_packs( packs,
                rounds,
                #[inline(always)]
                |ray, pack| pack.watertight(simd, ray),
                |hits| hits.mask.count_ones(),
            ))
        }),
        Contender::of_packs("isect `TrianglePack::exact` × 8", certain, move |packs| {
            dispatch!(level, simd => ask_packs( packs,
                rounds,
                #[inline(always)]
                |ray, pack| pack.exact(simd, ray),
                |hits| hits.mask.count_ones(),
            ))
        }),
        Contender::of_packs("isect `TrianglePack::exact` × 16", sixteen, move |packs| {
            dispatch!(level, simd => ask_packs( packs,
                rounds,
                #[inline(always)]
                |ray, pack| pack.exact(simd, ray),
                |hits| hits.mask.count_ones(),
            ))
        }),
        Contender::of_packs(
            "isect `TrianglePack::closest` × 8 (hits: of packs)",
            closest,
            move |packs| {
                dispatch!(level, simd => ask_packs( packs,
                    rounds,
                    #[inline(always)]
                    |ray, pack| pack.closest(simd, ray),
                    |hit| u32::from(hit.is_some()),
                ))
            },
        ),
        Contender::of_packs("isect `TrianglePack::any` × 8 (hits: of packs)", any, move |packs| {
            dispatch!(level, simd => ask_packs( packs,
                rounds,
                #[inline(always)]
                |ray, pack| pack.any(simd, ray),
                |hit| u32::from(*hit),
            ))
        }),
    ]
}

/// Two hit rates, single packs and streams of them.
pub fn box_questions() -> impl Iterator<Item = Question> {
    PER_RAY.into_iter().flat_map(|(per_ray, is_cached, what)| {
        [0.1, 0.5].into_iter().map(move |hit_rate| {
            let pairs = data::ray_box(per_ray, hit_rate);
            let pairs = if is_cached { pairs.of_first() } else { pairs };
            Question {
                title: format!("1 ray and {what} of boxes, {:.0} % hits", 100.0 * hit_rate),
                note: "Per box: obvhs asks one by one and answers with the t of the entry; the packs write out that of all \
                       lanes, and the mask. Both have prepared the reciprocals in their rays.",
                contenders: box_contenders(&pairs),
                stages: stages(&pairs, |ray, aabb| {
                    isect::ray::aabb::exact::stage(
                        &BoxRay::<Vec3A>::new(&(*ray).into()),
                        &Aabb::<Vec3A>::from(*aabb),
                    )
                }),
            }
        })
    })
}

fn box_contenders(pairs: &Pairs<Ray, Aabb>) -> Vec<Contender> {
    let (level, rounds) = (Level::new(), pairs.rounds());
    let ray = |ray: &Ray| BoxRay::<Vec3A>::new(&(*ray).into());
    let eight = pairs.packed(8, ray, AabbPack::<f32, 8>::from_aabbs);
    let sixteen = pairs.packed(16, ray, AabbPack::<f32, 16>::from_aabbs);
    vec![
        Contender::new(
            "obvhs `Aabb::intersect_ray`",
            pairs.map(peer::obvhs_ray, |_, aabb| peer::obvhs_aabb(aabb)),
            |ray, aabb| aabb.intersect_ray(ray),
            |t| *t < f32::INFINITY,
        )
        .reference(),
        Contender::of_packs("isect `AabbPack::conservative` × 8", eight, move |packs| {
            dispatch!(level, simd => ask_packs( packs,
                rounds,
                #[inline(always)]
                |ray, pack| pack.conservative(simd, ray),
                |hits| hits.mask.count_ones(),
            ))
        }),
        Contender::of_packs("isect `AabbPack::conservative` × 16", sixteen, move |packs| {
            dispatch!(level, simd => ask_packs( packs,
                rounds,
                #[inline(always)]
                |ray, pack| pack.conservative(simd, ray),
                |hits| hits.mask.count_ones(),
            ))
        }),
    ]
}
