//! A recipe: obvhs builds a hierarchy and traverses it, and isect's exact kernel is the test in its leaves.

use std::time::Duration;

use isect::glam::Vec3A;
use isect::ray::triangle::{TriangleHit, exact};
use isect::testkit::{Rng, meshes};
use isect::{Aabb, Ray, Triangle};
use obvhs::BvhBuildParams;
use obvhs::cwbvh::{CwBvh, builder::build_cwbvh};
use obvhs::ray::RayHit;

/// The hierarchy, for rays that start within `reach` of its triangles, along every axis.
///
/// obvhs's box test rounds: the inverse, the difference of plane and origin, two products, a sum. Together that moves
/// a plane by up to 6u times the distance, u = EPSILON/2, and the packing of a node into bytes by one u more. Boxes wider
/// by 8u·reach outweigh it, so that no leaf is missed (but those before t = 0.0001, where obvhs begins).
fn build(triangles: &[Triangle<Vec3A>], reach: f32) -> CwBvh {
    let boxes: Vec<_> = triangles
        .iter()
        .map(|triangle| {
            let Aabb { min, max } = triangle.aabb().inflated(4.0 * f32::EPSILON * reach);
            obvhs::aabb::Aabb { min, max }
        })
        .collect();
    build_cwbvh(&boxes, BvhBuildParams::medium_build(), &mut Duration::default())
}

/// The closest triangle that the ray hits, and where.
fn closest(
    bvh: &CwBvh,
    triangles: &[Triangle<Vec3A>],
    ray: &Ray<Vec3A>,
) -> Option<(u32, TriangleHit<f32>)> {
    let mut found = RayHit::none();
    let theirs = obvhs::ray::Ray::new(ray.origin, ray.direction, ray.t_min, ray.t_max);
    let hit = bvh.ray_traverse(theirs, &mut found, |theirs, place| {
        // Their range ends at the closest t so far. By the next float, as the exact t may be beyond the rounded one.
        let ray = ray.with_range(ray.t_min, theirs.tmax.next_up().min(ray.t_max));
        let triangle = &triangles[bvh.primitive_indices[place] as usize];
        // (Or `intersect`, where t within its bound is good enough.)
        if exact::hits(&ray, triangle) { exact::refine(&ray, triangle).t } else { f32::INFINITY }
    });
    hit.then(|| {
        let index = bvh.primitive_indices[found.primitive_id as usize];
        (index, exact::refine(ray, &triangles[index as usize]))
    })
}

fn main() {
    let triangles = meshes::Surface::new(&meshes::icosphere(4)).triangles;
    let bvh = build(&triangles, 5.0);
    let mut rng = Rng::with_seed(1);
    let (rays, mut hits) = (4000, 0);
    for number in 0..rays {
        // From the cube of size 8 about the sphere: at the middle of an edge, or wherever.
        let mut point = || Vec3A::from([(); 3].map(|()| 8.0 * rng.f32() - 4.0));
        let (origin, anywhere) = (point(), point());
        let Triangle { v0, v1, .. } = triangles[rng.usize(..triangles.len())];
        let target = if number % 2 == 0 { (v0 + v1) * 0.5 } else { anywhere };
        let ray = Ray::new(origin, target - origin);
        let found = closest(&bvh, &triangles, &ray).map(|(_, hit)| hit.t);
        let hit = triangles.iter().filter(|triangle| exact::hits(&ray, triangle));
        let t = hit.map(|triangle| exact::refine(&ray, triangle).t);
        assert_eq!(found, t.min_by(f32::total_cmp), "{ray:?}");
        hits += u32::from(found.is_some());
    }
    println!(
        "{hits} of {rays} rays hit the sphere; each found what brute force finds, to the last bit"
    );
}
