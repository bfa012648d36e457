//! A bounding volume hierarchy of eight boxes to a node: built by obvhs, made wide and traversed here, with
//! packs for nodes and leaves.
//!
//! obvhs builds a binary hierarchy, as for `bvh2`. Which of its nodes stay, and which triangles make a leaf, is
//! chosen for the least expected cost: H. Ylitie, T. Karras, S. Laine, "Efficient Incoherent Ray Traversal on
//! GPUs Through Compressed Wide BVHs", HPG 2017, section 3.1. Here a leaf costs the same whether its lanes
//! are full or not. Boxes are unions of boxes of triangles, which takes no rounding: so with conservative boxes
//! and exact leaves no ray is lost.

mod packets;

use std::cell::RefCell;
use std::time::Duration;

use isect::glam::Vec3A;
use isect::ray::aabb::BoxRay;
use isect::ray::triangle::{TriangleHit, exact};
use isect::simd::fearless_simd::{Level, Simd, dispatch};
use isect::simd::{AabbPack, TriangleHits, TrianglePack};
use isect::{Aabb, Ray, Triangle};
use obvhs::BvhBuildParams;
use obvhs::bvh2::Bvh2 as Binary;
use obvhs::bvh2::builder::build_bvh2;

use crate::accelerator::{Accelerator, MeshHit, lanes};

pub(crate) use packets::{InPackets, PacketStack};

/// How obvhs builds.
pub(crate) const BUILD: BvhBuildParams =
    BvhBuildParams { pre_split: false, max_prims_per_leaf: 1, ..BvhBuildParams::slow_build() };

/// The children of a node.
const WIDTH: usize = 8;

/// The triangles of a leaf at most: with four the nodes and leaves of a large mesh take longer to fetch.
const LEAF: usize = 8;

/// The hierarchy with exact leaves.
pub(crate) struct Bvh8 {
    level: Level,
    /// `None` for no triangles.
    root: Option<Child>,
    nodes: Vec<Node>,
    leaves: Vec<TrianglePack<f32, LEAF>>,
    /// By leaf and lane, the triangle's place in the mesh.
    places: Vec<[u32; LEAF]>,
}

/// Eight boxes and what is in them, in four lines of the cache.
#[derive(Clone, Debug, Default)]
#[repr(C, align(64))]
struct Node {
    bounds: AabbPack<f32, WIDTH>,
    children: [Child; WIDTH],
}

/// A node or a leaf: its index, and which it is in the lowest bit.
#[derive(Clone, Copy, Debug, Default)]
struct Child(u32);

/// A node or a leaf to visit, and where the ray enters its box.
#[derive(Clone, Copy)]
pub(crate) struct Entry {
    t_enter: f32,
    child: Child,
}

/// The hit of a triangle, with t as the pack has it, and the range in which the exact t is.
#[derive(Clone, Copy)]
pub(crate) struct Candidate {
    leaf: usize,
    lane: usize,
    pub(crate) hit: TriangleHit<f32>,
    least: f32,
    greatest: f32,
}

impl Bvh8 {
    /// Builds the hierarchy.
    pub(crate) fn new(triangles: &[Triangle<Vec3A>]) -> Self {
        let boxes: Vec<_> = triangles
            .iter()
            .map(|triangle| {
                let Aabb { min, max } = triangle.aabb();
                obvhs::aabb::Aabb { min, max }
            })
            .collect();
        let binary = build_bvh2(&boxes, BUILD, &mut Duration::default());
        let mut hierarchy = Self {
            level: Level::new(),
            root: None,
            nodes: Vec::new(),
            leaves: Vec::new(),
            places: Vec::new(),
        };
        if !binary.nodes.is_empty() {
            let plans = plans(&binary);
            hierarchy.root = Some(hierarchy.add(triangles, &binary, &plans, 0));
        }
        hierarchy
    }

    /// Adds what is below a node of the binary hierarchy.
    fn add(
        &mut self,
        triangles: &[Triangle<Vec3A>],
        binary: &Binary,
        plans: &[Plan],
        index: usize,
    ) -> Child {
        if plans[index].is_leaf {
            let places = places(binary, index);
            let of_leaf: Vec<_> = places.iter().map(|&place| triangles[place as usize]).collect();
            self.leaves.push(TrianglePack::from_triangles(&of_leaf));
            let mut lanes = [u32::MAX; LEAF];
            lanes[..places.len()].copy_from_slice(&places);
            self.places.push(lanes);
            return Child::leaf(self.leaves.len() - 1);
        }
        let mut kept = Vec::with_capacity(WIDTH);
        share(binary, plans, index, WIDTH, &mut kept);
        let bounds: Vec<_> = kept
            .iter()
            .map(|&child| {
                let obvhs::aabb::Aabb { min, max } = *binary.nodes[child].aabb();
                Aabb::new(min, max)
            })
            .collect();
        let place = self.nodes.len();
        self.nodes.push(Node { bounds: AabbPack::from_aabbs(&bounds), ..Node::default() });
        for (lane, child) in kept.into_iter().enumerate() {
            self.nodes[place].children[lane] = self.add(triangles, binary, plans, child);
        }
        Child::node(place)
    }

    /// The instructions that this processor has.
    pub(crate) fn level(&self) -> Level {
        self.level
    }

    /// The closest hit, and of equally close ones that of the first triangle in the mesh; `stack` is scratch
    /// space. To be called where the level is known.
    #[inline(always)]
    pub(crate) fn closest_at<S: Simd>(
        &self,
        simd: S,
        full: &Ray<Vec3A>,
        stack: &mut Vec<Entry>,
    ) -> Option<Candidate> {
        self.closest_below(simd, self.root?, full, None, stack)
    }

    /// The closest one of a hit that is known and of those below a node or a leaf.
    #[inline(always)]
    fn closest_below<S: Simd>(
        &self,
        simd: S,
        mut child: Child,
        full: &Ray<Vec3A>,
        mut closest: Option<Candidate>,
        stack: &mut Vec<Entry>,
    ) -> Option<Candidate> {
        let mut ray = *full;
        let mut boxes = BoxRay::new(full);
        if let Some(closest) = closest {
            ray.t_max = closest.greatest;
            boxes.t_max = closest.greatest;
        }
        stack.clear();
        loop {
            if let Some(leaf) = child.as_leaf() {
                let pack = &self.leaves[leaf];
                let hits = pack.exact(simd, &ray);
                for lane in lanes(hits.mask) {
                    let found = Candidate::of_lane(full, pack, &hits, leaf, lane);
                    let best = self.closest_of(full, closest, found);
                    ray.t_max = best.greatest;
                    boxes.t_max = best.greatest;
                    closest = Some(best);
                }
            } else {
                self.nodes[child.index()].enter(simd, &boxes, stack);
            }
            // What is closer than the box of an entry has made it void.
            child = loop {
                let Some(entry) = stack.pop() else { return closest };
                if entry.t_enter <= boxes.t_max {
                    break entry.child;
                }
            };
        }
    }

    /// Whether there is any hit; otherwise as [`Self::closest_at`].
    #[inline(always)]
    pub(crate) fn occluded_at<S: Simd>(
        &self,
        simd: S,
        ray: &Ray<Vec3A>,
        stack: &mut Vec<Entry>,
    ) -> bool {
        self.root.is_some_and(|root| self.occluded_below(simd, root, ray, stack))
    }

    /// Whether there is any hit below a node or a leaf.
    #[inline(always)]
    fn occluded_below<S: Simd>(
        &self,
        simd: S,
        mut child: Child,
        ray: &Ray<Vec3A>,
        stack: &mut Vec<Entry>,
    ) -> bool {
        let boxes = BoxRay::new(ray);
        stack.clear();
        loop {
            if let Some(leaf) = child.as_leaf() {
                if self.leaves[leaf].any(simd, ray) {
                    return true;
                }
            } else {
                self.nodes[child.index()].enter(simd, &boxes, stack);
            }
            let Some(entry) = stack.pop() else { return false };
            child = entry.child;
        }
    }

    /// The closer one of a hit and the closest so far, if any.
    #[inline(always)]
    fn closest_of(
        &self,
        ray: &Ray<Vec3A>,
        closest: Option<Candidate>,
        found: Candidate,
    ) -> Candidate {
        match closest {
            None => found,
            Some(closest) => self.closer(ray, closest, found),
        }
    }

    /// The closer one of two hits.
    #[inline(always)]
    fn closer(&self, ray: &Ray<Vec3A>, a: Candidate, b: Candidate) -> Candidate {
        if b.greatest < a.least {
            b
        } else if a.greatest < b.least {
            a
        } else {
            self.closer_by_refined(ray, a, b)
        }
    }

    /// The same where the ranges overlap, as at an edge that the two triangles share.
    #[cold]
    #[inline(never)]
    fn closer_by_refined(&self, ray: &Ray<Vec3A>, a: Candidate, b: Candidate) -> Candidate {
        let [of_a, of_b] = [&a, &b].map(|candidate| self.refined(ray, candidate));
        let (chosen, hit) = if of_b.is_before(&Some(of_a)) { (b, of_b.hit) } else { (a, of_a.hit) };
        let greatest = hit.t.next_up().min(ray.t_max);
        Candidate { hit, least: hit.t.next_down(), greatest, ..chosen }
    }

    /// A hit with t, u and v to the last digit.
    fn refined(&self, ray: &Ray<Vec3A>, &Candidate { leaf, lane, .. }: &Candidate) -> MeshHit {
        let hit = exact::refine(ray, &self.leaves[leaf].get(lane));
        MeshHit { triangle: self.places[leaf][lane], hit }
    }
}

thread_local! {
    /// The stack of a thread's traversals, so that each finds it allocated.
    static STACK: RefCell<Vec<Entry>> = const { RefCell::new(Vec::new()) };
}

impl Accelerator for Bvh8 {
    fn closest(&self, ray: &Ray<Vec3A>) -> Option<MeshHit> {
        let closest = STACK.with_borrow_mut(
            |stack| dispatch!(self.level, simd => self.closest_at(simd, ray, stack)),
        )?;
        Some(self.refined(ray, &closest))
    }

    fn occluded(&self, ray: &Ray<Vec3A>) -> bool {
        STACK.with_borrow_mut(
            |stack| dispatch!(self.level, simd => self.occluded_at(simd, ray, stack)),
        )
    }
}

impl Node {
    /// Puts the children that the ray may hit onto the stack, sorted by insertion, the nearest on top.
    #[inline(always)]
    fn enter<S: Simd>(&self, simd: S, ray: &BoxRay<Vec3A>, stack: &mut Vec<Entry>) {
        let hits = self.bounds.conservative(simd, ray);
        let first = stack.len();
        for lane in lanes(hits.mask) {
            let lane = lane % WIDTH;
            let entry = Entry { t_enter: hits.t_enter[lane], child: self.children[lane] };
            stack.push(entry);
            let mut at = stack.len() - 1;
            while at > first && stack[at - 1].t_enter < entry.t_enter {
                stack[at] = stack[at - 1];
                at -= 1;
            }
            stack[at] = entry;
        }
    }
}

impl Child {
    fn node(index: usize) -> Self {
        Self(u32::try_from(2 * index).expect("fewer than 2^31 nodes"))
    }

    fn leaf(index: usize) -> Self {
        Self(u32::try_from(2 * index + 1).expect("fewer than 2^31 leaves"))
    }

    #[inline(always)]
    fn index(self) -> usize {
        (self.0 / 2) as usize
    }

    #[inline(always)]
    fn as_leaf(self) -> Option<usize> {
        (self.0 & 1 == 1).then_some(self.index())
    }
}

impl Candidate {
    /// The hit of a lane of a leaf.
    #[inline(always)]
    fn of_lane(
        ray: &Ray<Vec3A>,
        pack: &TrianglePack<f32, LEAF>,
        hits: &TriangleHits<f32, LEAF>,
        leaf: usize,
        lane: usize,
    ) -> Self {
        let lane = lane % LEAF;
        let front = (hits.front >> lane) & 1 == 1;
        let hit = TriangleHit { t: hits.t[lane], u: hits.u[lane], v: hits.v[lane], front };
        Self::new(ray, &pack.get(lane), hit, leaf, lane)
    }

    /// The hit of the triangle in a lane of a leaf.
    ///
    /// With P(a, b, c) the sum of the magnitudes of the six terms of a·(b × c), t is off by at most
    /// 10u·(P(s, e1, e2) + |t|·P(d, e1, e2))/|d·n|, to first order, as the pack's documentation says, u =
    /// EPSILON/2. With k the largest magnitude of a component, P(a, b, c) ≤ 6·ka·kb·kc: twice that much,
    /// 64·EPSILON·k1·k2·(ks + |t|·kd)/|d·n|, allows for all else.
    #[inline(always)]
    fn new(
        ray: &Ray<Vec3A>,
        &Triangle { v0, v1, v2 }: &Triangle<Vec3A>,
        hit: TriangleHit<f32>,
        leaf: usize,
        lane: usize,
    ) -> Self {
        let (edge1, edge2, offset) = (v1 - v0, v2 - v0, ray.origin - v0);
        let [k1, k2, ks, kd] =
            [edge1, edge2, offset, ray.direction].map(|vector| vector.abs().max_element());
        let volume = k1 * k2 * (ks + hit.t.abs() * kd);
        let den = ray.direction.dot(edge1.cross(edge2)).abs();
        // Of numbers in the middle of the exponents' range, over- and underflow have left the quotient right.
        let middle = f32::MIN_POSITIVE / f32::EPSILON..f32::MAX * f32::EPSILON;
        let error = if middle.contains(&volume) && middle.contains(&den) {
            64.0 * f32::EPSILON * (volume / den)
        } else {
            f32::INFINITY
        };
        let (least, greatest) = (hit.t - error, (hit.t + error).min(ray.t_max));
        Self { leaf, lane, hit, least, greatest }
    }
}

/// What to make of a node of the binary hierarchy, by how many slots of a wide node it may take.
#[derive(Clone, Copy)]
struct Plan {
    /// By slots less one, the least cost of all that is below, in up to so many slots: expected tests, times
    /// the area of the whole. (Nobody asks for the cost in all slots.)
    costs: [f32; WIDTH - 1],
    /// By slots less one, how many of them go to the first child; none where the node itself takes one.
    to_first: [u8; WIDTH],
    /// How many triangles are below.
    triangles: u32,
    /// Whether they become a leaf, else a wide node, where the node itself takes a slot.
    is_leaf: bool,
}

/// The best plan of every node.
fn plans(binary: &Binary) -> Vec<Plan> {
    let mut order = Vec::with_capacity(binary.nodes.len());
    let mut waiting = vec![0];
    while let Some(index) = waiting.pop() {
        order.push(index);
        waiting.extend(children(binary, index).into_iter().flatten());
    }
    let leaf = Plan { costs: [0.0; _], to_first: [0; _], triangles: 0, is_leaf: true };
    let mut plans = vec![leaf; binary.nodes.len()];
    for index in order.into_iter().rev() {
        let area = binary.nodes[index].aabb().half_area();
        let Some([first, second]) = children(binary, index) else {
            plans[index].triangles = binary.nodes[index].prim_count;
            plans[index].costs = [area; _];
            continue;
        };
        let [first, second] = [plans[first], plans[second]];
        let shared = |slots: usize| {
            let shares = (1..)
                .zip(first.costs[..slots - 1].iter().zip(second.costs[..slots - 1].iter().rev()));
            shares
                .map(|(to_first, (a, b))| (a + b, to_first))
                .min_by(|(a, _), (b, _)| a.total_cmp(b))
                .expect("there are two slots to share")
        };
        let plan = &mut plans[index];
        plan.triangles = first.triangles + second.triangles;
        let below;
        (below, plan.to_first[WIDTH - 1]) = shared(WIDTH);
        plan.is_leaf = plan.triangles as usize <= LEAF;
        plan.costs[0] = if plan.is_leaf { area } else { area + below };
        for slots in 2..WIDTH {
            let (cost, to_first) = shared(slots);
            (plan.costs[slots - 1], plan.to_first[slots - 1]) = if cost < plan.costs[slots - 2] {
                (cost, to_first)
            } else {
                (plan.costs[slots - 2], plan.to_first[slots - 2])
            };
        }
    }
    plans
}

/// The children of a node of the binary hierarchy.
fn children(binary: &Binary, index: usize) -> Option<[usize; 2]> {
    let node = &binary.nodes[index];
    let first = node.first_index as usize;
    (!node.is_leaf()).then_some([first, first + 1])
}

/// The nodes that take the slots.
fn share(binary: &Binary, plans: &[Plan], index: usize, slots: usize, kept: &mut Vec<usize>) {
    let to_first = usize::from(plans[index].to_first[slots - 1]);
    match children(binary, index) {
        Some([first, second]) if to_first > 0 => {
            share(binary, plans, first, to_first, kept);
            share(binary, plans, second, slots - to_first, kept);
        }
        _ => kept.push(index),
    }
}

/// The places in the mesh of the triangles below a node of the binary hierarchy.
fn places(binary: &Binary, index: usize) -> Vec<u32> {
    match children(binary, index) {
        Some([first, second]) => [places(binary, first), places(binary, second)].concat(),
        None => {
            let node = &binary.nodes[index];
            let first = node.first_index as usize;
            binary.primitive_indices[first..first + node.prim_count as usize].to_vec()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::accelerator::NaiveLoop;
    use crate::kernel::Exact;
    use crate::mesh::Obj;

    /// A point in the cube from −1 to 1.
    fn point(random: &mut fastrand::Rng) -> Vec3A {
        Vec3A::from([(); 3].map(|()| 2.0 * random.f32() - 1.0))
    }

    #[test]
    fn it_finds_what_the_naive_loop_finds() {
        let mesh = Obj::bunny().standing(2.0, Vec3A::new(0.0, -1.0, 0.0));
        let triangles = mesh.triangles();
        let hierarchy = Bvh8::new(&triangles);
        let naive = NaiveLoop::<Exact>::new(&triangles);
        let mut random = fastrand::Rng::with_seed(1);
        let mut hits = 0;
        for i in 0..600 {
            let (from, mut to) = (point(&mut random) * 2.0, point(&mut random));
            if i % 3 == 0 {
                to = random.choice(&triangles).expect("there are some").v1;
            }
            let ray = Ray::new(from, to - from);
            let closest = hierarchy.closest(&ray);
            assert_eq!(closest, naive.closest(&ray), "{ray:?}");
            // Short of what lies before the point, and of what may lie on it.
            for shadow in [Ray::segment(from, to), Ray::segment(from, to).before(1.0)] {
                assert_eq!(hierarchy.occluded(&shadow), naive.occluded(&shadow), "{shadow:?}");
            }
            hits += u32::from(closest.is_some());
        }
        assert!((300..500).contains(&hits), "{hits}");
    }

    #[test]
    fn no_triangles_are_no_trouble_and_one_is_a_leaf() {
        let ray = Ray::new(Vec3A::ZERO, Vec3A::Z);
        let hierarchy = Bvh8::new(&[]);
        assert!(hierarchy.closest(&ray).is_none() && !hierarchy.occluded(&ray));
        let one = Triangle::new(
            Vec3A::new(-1.0, -1.0, 2.0),
            Vec3A::new(1.0, -1.0, 2.0),
            Vec3A::new(0.0, 1.0, 2.0),
        );
        let hierarchy = Bvh8::new(&[one]);
        assert_eq!(hierarchy.closest(&ray).map(|found| found.hit.t), Some(2.0));
        assert!(hierarchy.occluded(&ray) && !hierarchy.occluded(&ray.before(2.0)));
    }

    /// All at one place: the boxes tell nothing apart, and the first is the one to find.
    #[test]
    fn of_equal_triangles_the_first_is_found() {
        let one = Triangle::new(Vec3A::ZERO, Vec3A::X, Vec3A::Y);
        let hierarchy = Bvh8::new(&[one; 100]);
        for z in [1.0, -1e-3, 1e-30, 1e30] {
            let ray = Ray::new(Vec3A::new(0.25, 0.25, z), Vec3A::new(0.0, 0.0, -z));
            let found = hierarchy.closest(&ray).expect("it is aimed at them");
            assert_eq!((found.triangle, found.hit.t), (0, 1.0));
        }
    }

    /// Every triangle, in the order of the mesh, by packs that do not depend on the hierarchy.
    struct BruteForce {
        level: Level,
        packs: Vec<TrianglePack<f32, 8>>,
    }

    impl BruteForce {
        fn hits(&self, ray: &Ray<Vec3A>) -> Vec<u32> {
            #[inline(always)]
            fn hits<S: Simd>(
                simd: S,
                packs: &[TrianglePack<f32, 8>],
                ray: &Ray<Vec3A>,
            ) -> Vec<u32> {
                let mut found = Vec::new();
                for (first, pack) in (0..).step_by(8).zip(packs) {
                    let mask = pack.exact(simd, ray).mask;
                    if mask != 0 {
                        found.extend((0..8).filter(|k| (mask >> k) & 1 == 1).map(|k| first + k));
                    }
                }
                found
            }
            dispatch!(self.level, simd => hits(simd, &self.packs, ray))
        }
    }

    /// Rays at the vertices and edges of a sphere, as exactly as floats allow, from inside and outside. Each is
    /// held against every triangle: the hierarchy has to find the same first hit, and to tell the same of
    /// the way to the target. From inside, none may find nothing: the mesh is closed.
    fn no_ray_is_lost(level: u32, rays: u32) {
        let mesh = Obj::icosphere(level).standing(2.0, Vec3A::new(0.0, -1.0, 0.0));
        let triangles = mesh.triangles();
        assert_eq!(triangles.len(), 20 << (2 * level));
        let hierarchy = Bvh8::new(&triangles);
        let packs = triangles.chunks(8).map(TrianglePack::from_triangles).collect();
        let brute_force = BruteForce { level: Level::new(), packs };
        let mut random = fastrand::Rng::with_seed(2);
        let mut hits = 0;
        for i in 0..rays {
            let Triangle { v0, v1, .. } = *random.choice(&triangles).expect("there are some");
            let target = if i % 2 == 0 { v0 } else { (v0 + v1) / 2.0 };
            let from_inside = i % 4 < 2;
            let from = point(&mut random) * if from_inside { 0.5 } else { 3.0 };
            let ray = Ray::new(from, target - from);

            let expected = brute_force.hits(&ray).into_iter().fold(None, |closest, triangle| {
                let hit = exact::refine(&ray, &triangles[triangle as usize]);
                let found = MeshHit { triangle, hit };
                if found.is_before(&closest) { Some(found) } else { closest }
            });
            assert_eq!(hierarchy.closest(&ray), expected, "{ray:?}");
            assert!(expected.is_some() || !from_inside, "{ray:?}");
            let shadow = Ray::segment(from, target).before(0.999);
            let occluded = !brute_force.hits(&shadow).is_empty();
            assert_eq!(hierarchy.occluded(&shadow), occluded, "{shadow:?}");
            hits += u32::from(expected.is_some());
        }
        // From outside, almost all: only at the outline does a rounded direction miss.
        assert!(hits > rays - rays / 50, "{hits} of {rays}");
    }

    #[test]
    fn no_ray_is_lost_at_edges_and_vertices() {
        no_ray_is_lost(6, 1_000);
    }

    #[test]
    #[ignore = "1,310,720 triangles: about a minute with --release"]
    fn no_ray_is_lost_among_more_than_a_million_triangles() {
        no_ray_is_lost(8, 4_000);
    }
}
