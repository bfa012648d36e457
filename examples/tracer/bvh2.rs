//! A binary bounding volume hierarchy: built by obvhs, traversed here.
//!
//! obvhs builds with PLOC (D. Meister, J. Bittner, "Parallel Locally-Ordered Clustering for Bounding
//! Volume Hierarchy Construction", 2018). Its own traversal loses rays, because its box test is not
//! conservative; the loop below is the usual one, nearest child first, over its nodes with isect's
//! box.

use isect::glam::Vec3A;
use isect::ray::aabb::{BoxRay, conservative};
use isect::{Aabb, Ray, Triangle};
use obvhs::BvhBuildParams;
use obvhs::bvh2::node::Bvh2Node;
use obvhs::bvh2::{Bvh2 as Hierarchy, builder::build_bvh2};
use std::time::Duration;

use crate::accelerator::{Accelerator, MeshHit};
use crate::kernel::TriangleKernel;

/// The hierarchy with its triangles in the order of the leaves.
pub(crate) struct Bvh2<K: TriangleKernel> {
    /// The root is the first; empty for no triangles.
    nodes: Vec<Bvh2Node>,
    /// The prepared triangles, each with its place in the mesh.
    triangles: Vec<(u32, K::Triangle)>,
}

impl<K: TriangleKernel> Bvh2<K> {
    /// Builds the hierarchy, for rays that start within `reach` of the triangles.
    ///
    /// Conservative boxes alone do not keep a mesh tight, but with the exact kernel. Another decides for
    /// vertices that are off by its rounding errors, so of two triangles that share an edge it may see
    /// the ray in the one whose box the ray passes by. The boxes are wider by those errors: 6u times
    /// the distance for the edges of the watertight kernel, 9u for its t, u = EPSILON/2.
    pub(crate) fn new(triangles: &[Triangle<Vec3A>], reach: f32) -> Self {
        let margin = K::ROUNDINGS * (f32::EPSILON / 2.0) * reach;
        let boxes: Vec<_> = triangles
            .iter()
            .map(|triangle| {
                let Aabb { min, max } = triangle.aabb().inflated(margin);
                obvhs::aabb::Aabb { min, max }
            })
            .collect();
        let Hierarchy { nodes, primitive_indices, .. } =
            build_bvh2(&boxes, BvhBuildParams::medium_build(), &mut Duration::default());
        Self {
            nodes,
            triangles: primitive_indices
                .iter()
                .map(|&i| (i, K::triangle(&triangles[i as usize])))
                .collect(),
        }
    }

    /// Visits the triangles whose boxes, and those of the nodes above them, have something.
    pub(crate) fn visit(&self, has: impl Fn(&Aabb<Vec3A>) -> bool, mut visit: impl FnMut(u32)) {
        let mut stack = Vec::from_iter(self.nodes.first());
        while let Some(node) = stack.pop() {
            let obvhs::aabb::Aabb { min, max } = *node.aabb();
            if !has(&Aabb { min, max }) {
                continue;
            }
            let first = node.first_index as usize;
            if node.is_leaf() {
                let triangles = &self.triangles[first..first + node.prim_count as usize];
                triangles.iter().for_each(|&(triangle, _)| visit(triangle));
            } else {
                stack.extend(&self.nodes[first..first + 2]);
            }
        }
    }

    /// Visits the leaves whose boxes the ray may touch, roughly from near to far, until `visit`
    /// returns true. `visit` may lower the end of the ray's range.
    fn traverse(
        &self,
        ray: &Ray<Vec3A>,
        mut visit: impl FnMut(&[(u32, K::Triangle)], &mut BoxRay<Vec3A>) -> bool,
    ) {
        let mut ray = BoxRay::new(ray);
        let mut stack = Stack::new();
        let entry = |ray: &BoxRay<Vec3A>, index: u32| {
            let obvhs::aabb::Aabb { min, max } = *self.nodes[index as usize].aabb();
            let [t_enter, _] = conservative::interval(ray, &Aabb { min, max })?;
            Some(Entry { t_enter, index })
        };
        if !self.nodes.is_empty() {
            stack.extend(entry(&ray, 0));
        }
        while let Some(Entry { t_enter, index }) = stack.pop() {
            if t_enter > ray.t_max {
                continue; // something closer was hit since
            }
            let node = &self.nodes[index as usize];
            let first = node.first_index;
            if node.is_leaf() {
                let triangles = first as usize..(first + node.prim_count) as usize;
                if visit(&self.triangles[triangles], &mut ray) {
                    return;
                }
                continue;
            }
            let (left, right) = (entry(&ray, first), entry(&ray, first + 1));
            let right_is_nearer = matches!((&left, &right),
                (Some(left), Some(right)) if right.t_enter < left.t_enter);
            let (near, far) = if right_is_nearer { (right, left) } else { (left, right) };
            stack.extend(far);
            stack.extend(near);
        }
    }
}

impl<K: TriangleKernel> Accelerator for Bvh2<K> {
    fn closest(&self, ray: &Ray<Vec3A>) -> Option<MeshHit> {
        let mut prepared = K::ray(ray);
        let mut closest = None;
        self.traverse(ray, |triangles, boxes| {
            for &(triangle, ref corners) in triangles {
                if let Some(hit) = K::intersect(&prepared, corners) {
                    let found = MeshHit { triangle, hit };
                    if found.is_before(&closest) {
                        K::shorten(&mut prepared, hit.t);
                        boxes.t_max = hit.t.next_up().min(boxes.t_max);
                        closest = Some(found);
                    }
                }
            }
            false
        });
        closest
    }

    fn occluded(&self, ray: &Ray<Vec3A>) -> bool {
        let prepared = K::ray(ray);
        let mut occluded = false;
        self.traverse(ray, |triangles, _| {
            occluded = triangles.iter().any(|(_, triangle)| K::hits(&prepared, triangle));
            occluded
        });
        occluded
    }
}

/// A node to visit and where the ray enters its box.
#[derive(Clone, Copy)]
struct Entry {
    t_enter: f32,
    index: u32,
}

/// A stack that spills onto the heap in a hierarchy deeper than any sensible mesh gives.
struct Stack {
    fixed: [Entry; Self::FIXED],
    len: usize,
    spilled: Vec<Entry>,
}

impl Stack {
    const FIXED: usize = 64;

    fn new() -> Self {
        let unused = Entry { t_enter: 0.0, index: 0 };
        Self { fixed: [unused; Self::FIXED], len: 0, spilled: Vec::new() }
    }

    fn extend(&mut self, entry: Option<Entry>) {
        let Some(entry) = entry else { return };
        if let Some(free) = self.fixed.get_mut(self.len) {
            *free = entry;
            self.len += 1;
        } else {
            self.spilled.push(entry);
        }
    }

    fn pop(&mut self) -> Option<Entry> {
        self.spilled.pop().or_else(|| {
            self.len = self.len.checked_sub(1)?;
            Some(self.fixed[self.len])
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::accelerator::NaiveLoop;
    use crate::kernel::{Badouel, Exact, MollerTrumbore, Segura, Watertight};
    use crate::mesh::Obj;

    /// A point in the cube from −1 to 1.
    fn point(random: &mut fastrand::Rng) -> Vec3A {
        Vec3A::from([(); 3].map(|()| 2.0 * random.f32() - 1.0))
    }

    /// Compares with the naïve loop on rays that start around the mesh and in it.
    fn agrees<K: TriangleKernel>(triangles: &[Triangle<Vec3A>], rays: u32) {
        let hierarchy = Bvh2::<K>::new(triangles, 64.0);
        let naive = NaiveLoop::<K>::new(triangles);
        let mut random = fastrand::Rng::with_seed(1);
        let mut hits = 0;
        for _ in 0..rays {
            let (from, to) = (point(&mut random) * 2.0, point(&mut random));
            let ray = Ray::new(from, to - from);
            let closest = hierarchy.closest(&ray);
            assert_eq!(closest, naive.closest(&ray), "{ray:?}");
            let shadow = Ray::segment(from, to);
            assert_eq!(hierarchy.occluded(&shadow), naive.occluded(&shadow), "{shadow:?}");
            hits += u32::from(closest.is_some());
        }
        assert!(hits > rays / 10 && hits < rays);
    }

    #[test]
    fn it_finds_what_the_naive_loop_finds() {
        let mesh = Obj::bunny().standing(2.0, Vec3A::new(0.0, -1.0, 0.0));
        let triangles = mesh.triangles();
        agrees::<Exact>(&triangles, 400);
        agrees::<Watertight>(&triangles, 200);
        agrees::<MollerTrumbore>(&triangles, 200);
        agrees::<Badouel>(&triangles, 200);
        agrees::<Segura>(&triangles, 200);
    }

    #[test]
    fn no_triangles_are_no_trouble() {
        let ray = Ray::new(Vec3A::ZERO, Vec3A::Z);
        let hierarchy = Bvh2::<Watertight>::new(&[], 1.0);
        assert!(hierarchy.closest(&ray).is_none() && !hierarchy.occluded(&ray));
        let one = Triangle::new(
            Vec3A::new(-1.0, -1.0, 2.0),
            Vec3A::new(1.0, -1.0, 2.0),
            Vec3A::new(0.0, 1.0, 2.0),
        );
        let hierarchy = Bvh2::<Watertight>::new(&[one], 4.0);
        assert_eq!(hierarchy.closest(&ray).map(|found| found.hit.t), Some(2.0));
    }

    #[test]
    fn the_stack_spills_and_keeps_its_order() {
        let mut stack = Stack::new();
        for index in 0..100 {
            stack.extend(Some(Entry { t_enter: 0.0, index }));
        }
        let order = std::iter::from_fn(|| stack.pop().map(|entry| entry.index));
        assert!(order.eq((0..100).rev()));
    }
}
