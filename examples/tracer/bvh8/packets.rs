//! The same hierarchy for rays that go together: its nodes and leaves are fetched once for eight of them.
//!
//! I. Wald, P. Slusallek, C. Benthin, M. Wagner, "Interactive Rendering with Coherent Ray Tracing", Computer
//! Graphics Forum 20.3, 2001. Where few of the rays are left they go on one by one, with packs, which take as
//! long for one ray as a packet does for one box or triangle: C. Benthin, I. Wald, S. Woop, M. Ernst, W. R. Mark,
//! "Combining Single and Packet-Ray Tracing for Arbitrary Ray Distributions on the Intel MIC Architecture",
//! IEEE TVCG 18.9, 2012.

use std::cell::RefCell;

use isect::glam::Vec3A;
use isect::simd::fearless_simd::{Simd, dispatch};
use isect::simd::{ClosestTriangles, RayPack};
use isect::{Aabb, Ray, Triangle};

use super::{Bvh8, Candidate, Child, Entry, Node, WIDTH};
use crate::accelerator::{Accelerator, MeshHit, PACKET, lanes};

/// So many rays go on one by one: half a packet, by measurement. With two, packets are slower by up to a fifth;
/// if all stay together, random ones by more than half.
const FEW: u32 = 4;

/// Rays that go together.
type Packet = RayPack<f32, PACKET>;

/// The scratch space of a traversal.
#[derive(Default)]
pub(crate) struct PacketStack {
    entries: Vec<PacketEntry>,
    /// Of rays that go on alone.
    single: Vec<Entry>,
}

/// A node or a leaf to visit, and the rays that enter its box.
#[derive(Clone, Copy)]
struct PacketEntry {
    /// Where each of them does.
    t_enter: [f32; PACKET],
    /// The least of these.
    nearest: f32,
    active: u32,
    child: Child,
}

impl Bvh8 {
    /// [`Self::closest_at`] for each of at most [`PACKET`] rays.
    #[inline(always)]
    pub(crate) fn closest_of_packet_at<S: Simd>(
        &self,
        simd: S,
        full: &[Ray<Vec3A>],
        stack: &mut PacketStack,
    ) -> [Option<Candidate>; PACKET] {
        let mut closest = [None; PACKET];
        let Some(mut child) = self.root else { return closest };
        let mut rays = Packet::from_rays(full);
        let mut active = rays.active();
        let PacketStack { entries, single } = stack;
        entries.clear();
        loop {
            if active.count_ones() <= FEW {
                for lane in lanes(active) {
                    let best = self.closest_below(simd, child, &full[lane], closest[lane], single);
                    if let Some(best) = best {
                        rays.t_max[lane] = best.greatest;
                    }
                    closest[lane] = best;
                }
            } else if let Some(leaf) = child.as_leaf() {
                let mut hits = ClosestTriangles::default();
                for (place, triangle) in self.triangles_of(leaf) {
                    for lane in lanes(rays.exact(simd, &triangle, 0, active, &mut hits)) {
                        let Some((_, hit)) = hits.get(lane) else { continue };
                        let ray = &full[lane];
                        let found = Candidate::new(ray, &triangle, hit, leaf, place);
                        let best = self.closest_of(ray, closest[lane], found);
                        // Not as computed: what is closer by less than the error is not to be missed.
                        rays.t_max[lane] = best.greatest;
                        closest[lane] = Some(best);
                    }
                }
            } else {
                self.nodes[child.index()].enter_in_packet(simd, &rays, active, entries);
            }
            // What is closer than the box of an entry has made it void.
            (child, active) = loop {
                let Some(entry) = entries.pop() else { return closest };
                let not_void = (0..PACKET).fold(0, |bits, lane| {
                    bits | u32::from(entry.t_enter[lane] <= rays.t_max[lane]) << lane
                });
                if entry.active & not_void != 0 {
                    break (entry.child, entry.active & not_void);
                }
            };
        }
    }

    /// [`Self::occluded_at`] for those of at most [`PACKET`] rays that are bits of `active`.
    #[inline(always)]
    pub(crate) fn occluded_of_packet_at<S: Simd>(
        &self,
        simd: S,
        full: &[Ray<Vec3A>],
        active: u32,
        stack: &mut PacketStack,
    ) -> u32 {
        let mut occluded = 0;
        let Some(mut child) = self.root else { return occluded };
        let rays = Packet::from_rays(full);
        let mut active = rays.active() & active;
        let PacketStack { entries, single } = stack;
        entries.clear();
        loop {
            if active.count_ones() <= FEW {
                for lane in lanes(active) {
                    let is_hit = self.occluded_below(simd, child, &full[lane], single);
                    occluded |= u32::from(is_hit) << lane;
                }
            } else if let Some(leaf) = child.as_leaf() {
                for (_, triangle) in self.triangles_of(leaf) {
                    occluded |= rays.exact_hits(simd, &triangle, active & !occluded);
                }
            } else {
                self.nodes[child.index()].enter_in_packet(simd, &rays, active, entries);
            }
            (child, active) = loop {
                let Some(entry) = entries.pop() else { return occluded };
                if entry.active & !occluded != 0 {
                    break (entry.child, entry.active & !occluded);
                }
            };
        }
    }

    /// The triangles of a leaf, and their lanes.
    #[inline(always)]
    fn triangles_of(&self, leaf: usize) -> impl Iterator<Item = (usize, Triangle<Vec3A>)> {
        let (pack, places) = (&self.leaves[leaf], &self.places[leaf]);
        let present = places.iter().take_while(|&&place| place != u32::MAX);
        present.enumerate().map(|(lane, _)| (lane, pack.get(lane)))
    }
}

impl Node {
    /// Puts the children that any of some rays may hit onto the stack, sorted by insertion, the one that is
    /// nearest to any on top.
    #[inline(always)]
    fn enter_in_packet<S: Simd>(
        &self,
        simd: S,
        rays: &Packet,
        active: u32,
        stack: &mut Vec<PacketEntry>,
    ) {
        let first = stack.len();
        for lane in 0..WIDTH {
            let bounds: Aabb<Vec3A> = self.bounds.get(lane);
            let hits = rays.conservative(simd, &bounds, active);
            if hits.mask == 0 {
                continue;
            }
            let nearest =
                lanes(hits.mask).map(|lane| hits.t_enter[lane]).fold(f32::INFINITY, f32::min);
            let (child, t_enter) = (self.children[lane], hits.t_enter);
            let entry = PacketEntry { t_enter, nearest, active: hits.mask, child };
            stack.push(entry);
            let mut at = stack.len() - 1;
            while at > first && stack[at - 1].nearest < nearest {
                stack[at] = stack[at - 1];
                at -= 1;
            }
            stack[at] = entry;
        }
    }
}

/// The hierarchy for a picture of which the rays that go together are traced in packets.
pub(crate) struct InPackets(Bvh8);

impl InPackets {
    pub(crate) fn new(hierarchy: Bvh8) -> Self {
        Self(hierarchy)
    }
}

thread_local! {
    /// The stack of a thread's traversals, so that each finds it allocated.
    static STACK: RefCell<PacketStack> = RefCell::default();
}

impl Accelerator for InPackets {
    fn closest(&self, ray: &Ray<Vec3A>) -> Option<MeshHit> {
        self.0.closest(ray)
    }

    fn occluded(&self, ray: &Ray<Vec3A>) -> bool {
        self.0.occluded(ray)
    }

    fn closest_of_packet(&self, rays: &[Ray<Vec3A>]) -> [Option<MeshHit>; PACKET] {
        let Self(hierarchy) = self;
        let closest = STACK.with_borrow_mut(
            |stack| dispatch!(hierarchy.level, simd => hierarchy.closest_of_packet_at(simd, rays, stack)),
        );
        let mut hits = [None; PACKET];
        for (lane, ray) in rays.iter().enumerate() {
            hits[lane] = closest[lane].map(|candidate| hierarchy.refined(ray, &candidate));
        }
        hits
    }

    fn occluded_of_packet(&self, rays: &[Ray<Vec3A>], active: u32) -> u32 {
        let Self(hierarchy) = self;
        STACK.with_borrow_mut(
            |stack| dispatch!(hierarchy.level, simd => hierarchy.occluded_of_packet_at(simd, rays, active, stack)),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Obj;

    /// A point in the cube from −1 to 1.
    fn point(random: &mut fastrand::Rng) -> Vec3A {
        Vec3A::from([(); 3].map(|()| 2.0 * random.f32() - 1.0))
    }

    /// What packets find is what each of their rays finds alone, to the last bit; returns how many hit, and how
    /// many were occluded.
    fn compare(hierarchy: &InPackets, rays: &[Ray<Vec3A>], active: u32) -> [usize; 2] {
        let closest = hierarchy.closest_of_packet(rays);
        let mut alone = [None; PACKET];
        for (alone, ray) in alone.iter_mut().zip(rays) {
            *alone = hierarchy.closest(ray);
        }
        assert_eq!(closest, alone, "{rays:?}");
        // Short of what is hit, and as far as what may be.
        let mut occluded = 0;
        for shorten in [|ray: &Ray<Vec3A>| ray.before(1.0), |ray: &Ray<Vec3A>| ray.before(2.0)] {
            let shadows: Vec<_> = rays.iter().map(shorten).collect();
            let found = hierarchy.occluded_of_packet(&shadows, active);
            let alone = lanes(active).filter(|&lane| hierarchy.occluded(&shadows[lane]));
            assert_eq!(found, alone.fold(0, |bits, lane| bits | 1 << lane), "{shadows:?}");
            occluded += lanes(found).count();
        }
        [closest.iter().flatten().count(), occluded]
    }

    /// The rays start in one point or in many, and end beside each other, at vertices and edges of neighbours,
    /// or anywhere; packets have one ray to eight.
    fn packets_find_what_single_rays_find(obj: Obj, count: u32) {
        let mesh = obj.standing(2.0, Vec3A::new(0.0, -1.0, 0.0));
        let triangles = mesh.triangles();
        let hierarchy = InPackets::new(Bvh8::new(&triangles));
        let mut random = fastrand::Rng::with_seed(3);
        let (mut rays, mut found) = (0, [0; 2]);
        for i in 0..count {
            let eye = point(&mut random) * 3.0;
            let first = random.usize(..triangles.len());
            let packet: Vec<_> = (0..1 + random.usize(..PACKET))
                .map(|lane| {
                    let Triangle { v0, v1, .. } = triangles[(first + lane) % triangles.len()];
                    let from = if i % 2 == 0 { eye } else { point(&mut random) * 3.0 };
                    let to = match i % 5 {
                        0 => triangles[first].v0 + point(&mut random) * 0.02,
                        1 => v0,
                        2 => (v0 + v1) / 2.0,
                        3 => triangles[first].v1,
                        _ => point(&mut random),
                    };
                    Ray::new(from, to - from)
                })
                .collect();
            let active = random.u32(..) & ((1 << packet.len()) - 1);
            let [hits, occluded] = compare(&hierarchy, &packet, active);
            found = [found[0] + hits, found[1] + occluded];
            rays += packet.len();
        }
        // Most rays are aimed at the mesh. Half of them count for the two questions of shadows.
        assert!(found[0] > rays / 2 && found[1] > rays / 2, "{found:?} of {rays}");
    }

    #[test]
    fn packets_find_what_single_rays_find_on_the_bunny() {
        packets_find_what_single_rays_find(Obj::bunny(), 2_000);
    }

    #[test]
    fn packets_find_what_single_rays_find_on_a_sphere() {
        packets_find_what_single_rays_find(Obj::icosphere(5), 2_000);
    }

    #[test]
    fn packets_of_nothing_and_rays_that_hit_nothing_are_no_trouble() {
        let one = Triangle::new(Vec3A::ZERO, Vec3A::X, Vec3A::Y);
        let ray = |z: f32| Ray::new(Vec3A::new(0.25, 0.25, z), Vec3A::NEG_Z);
        let none = InPackets::new(Bvh8::new(&[]));
        assert_eq!(compare(&none, &[ray(1.0); PACKET], 0xff), [0, 0]);
        // All at one place: the first is the one to find.
        let hundred = InPackets::new(Bvh8::new(&[one; 100]));
        assert_eq!(compare(&hundred, &[], 0), [0, 0]);
        assert_eq!(compare(&hundred, &[ray(0.5); PACKET], 0xff), [8, 16]);
        let zero = Ray::new(Vec3A::ONE, Vec3A::ZERO);
        let mixed = [ray(0.5), zero, ray(f32::NAN), ray(-1.0), ray(0.75), ray(1e30), ray(0.0)];
        assert_eq!(compare(&hundred, &mixed, 0x7f), [4, 6]);
    }
}
