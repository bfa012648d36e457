//! A recipe: a hierarchy of one's own, with isect's conservative box in its nodes and its exact triangle in its leaves.

use isect::glam::Vec3A;
use isect::ray::aabb::{BoxRay, conservative};
use isect::ray::triangle::{TriangleHit, exact};
use isect::testkit::{Rng, meshes};
use isect::{Aabb, Ray, Triangle};

/// A leaf with the triangles from `first` on, or without any, and then its children are the nodes `first` and `first + 1`.
struct Node {
    aabb: Aabb<Vec3A>,
    first: usize,
    count: usize,
}

/// Puts the triangles in the order of the leaves: each node parts its own at the median, along its longest axis.
fn build(triangles: &mut [Triangle<Vec3A>]) -> Vec<Node> {
    let node = |triangles: &[Triangle<Vec3A>], first| {
        let aabb =
            triangles.iter().map(Triangle::aabb).fold(Aabb::EMPTY, |all, one| all.union(&one));
        Node { aabb, first, count: triangles.len() }
    };
    let mut nodes = vec![node(triangles, 0)];
    let mut next = 0;
    while let Some(&Node { aabb, first, count }) = nodes.get(next) {
        if count > 4 {
            let (part, axis, half) =
                (&mut triangles[first..first + count], aabb.longest_axis(), count / 2);
            let center = |triangle: &Triangle<Vec3A>| triangle.aabb().center()[axis];
            part.select_nth_unstable_by(half, |a, b| center(a).total_cmp(&center(b)));
            let children = [node(&part[..half], first), node(&part[half..], first + half)];
            nodes[next] = Node { aabb, first: nodes.len(), count: 0 };
            nodes.extend(children);
        }
        next += 1;
    }
    nodes
}

/// The place of the closest triangle that the ray hits, and where.
fn closest(
    nodes: &[Node],
    triangles: &[Triangle<Vec3A>],
    ray: &Ray<Vec3A>,
) -> Option<(usize, TriangleHit<f32>)> {
    let (mut ray, mut found) = (*ray, None::<(usize, TriangleHit<f32>)>);
    let mut boxes = BoxRay::new(&ray); // once per ray
    let entry = |boxes: &BoxRay<Vec3A>, index: usize| {
        let [t_enter, _] = conservative::interval(boxes, &nodes[index].aabb)?;
        Some((t_enter, index))
    };
    let mut stack = Vec::from_iter(entry(&boxes, 0));
    while let Some((t_enter, index)) = stack.pop() {
        let Node { first, count, .. } = nodes[index];
        if t_enter > boxes.t_max {
            continue; // something closer was hit since
        }
        if count == 0 {
            let mut children = [entry(&boxes, first), entry(&boxes, first + 1)];
            // The nearer one on top of the stack. (No entry is a NaN.)
            children.sort_by(|a, b| b.partial_cmp(a).expect("numbers"));
            stack.extend(children.into_iter().flatten());
        }
        for (place, triangle) in (first..).zip(&triangles[first..first + count]) {
            // (Or `intersect`, where t, u and v within its bounds are good enough.)
            let hit = exact::hits(&ray, triangle).then(|| exact::refine(&ray, triangle));
            if let Some(hit) = hit.filter(|hit| found.is_none_or(|(_, closest)| hit.t < closest.t))
            {
                // By the next float, as the exact t may be beyond the rounded one.
                ray.t_max = hit.t.next_up().min(ray.t_max);
                boxes.t_max = ray.t_max;
                found = Some((place, hit));
            }
        }
    }
    found
}

fn main() {
    let mut triangles = meshes::Surface::new(&meshes::icosphere(4)).triangles;
    let nodes = build(&mut triangles);
    let mut rng = Rng::with_seed(1);
    let (rays, mut hits) = (4000, 0);
    for number in 0..rays {
        // From the cube of size 8 about the sphere: at the middle of an edge, or wherever.
        let mut point = || Vec3A::from([(); 3].map(|()| 8.0 * rng.f32() - 4.0));
        let (origin, anywhere) = (point(), point());
        let Triangle { v0, v1, .. } = triangles[rng.usize(..triangles.len())];
        let target = if number % 2 == 0 { (v0 + v1) * 0.5 } else { anywhere };
        let ray = Ray::new(origin, target - origin);
        let found = closest(&nodes, &triangles, &ray).map(|(_, hit)| hit.t);
        let hit = triangles.iter().filter(|triangle| exact::hits(&ray, triangle));
        let t = hit.map(|triangle| exact::refine(&ray, triangle).t);
        assert_eq!(found, t.min_by(f32::total_cmp), "{ray:?}");
        hits += u32::from(found.is_some());
    }
    println!(
        "{hits} of {rays} rays hit the sphere; each found what brute force finds, to the last bit"
    );
}
