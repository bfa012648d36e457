//! How fast rays find the triangles of a mesh, on one thread and without shading: the wide hierarchy against
//! obvhs's own, H. Ylitie, T. Karras, S. Laine's compressed wide one.

use std::fmt::Write as _;
use std::hint::black_box;
use std::time::{Duration, Instant};

use isect::glam::Vec3A;
use isect::simd::fearless_simd::{Simd, dispatch};
use isect::{Ray, Triangle, spawn};
use obvhs::cwbvh::{CwBvh, builder::build_cwbvh_from_tris};
use obvhs::ray::RayHit;

use crate::accelerator::{Accelerator, MeshHit, PACKET};
use crate::bvh8::{BUILD, Bvh8, PacketStack};
use crate::camera::{Camera, View};
use crate::scene::Scene;

/// How often everyone takes a turn.
const ROUNDS: usize = 11;

/// How many rays found a triangle, and the sum of their t: so that no work is left out.
type Found = (u32, f32);

/// Traces as many rays of each kind as the picture has pixels, and makes a table of how fast that was.
///
/// Primary rays are those of the picture's pixels, row by row. Rays to the lamp, the first, start where these hit
/// and face it, so that there are fewer; they ask for any hit. Random rays start in the box around the mesh, made
/// half as large again, and pass through another point there. Shadow rays end at that point, and ask for any hit.
/// Packets are made of rays that follow each other, also of random ones.
pub(crate) fn bench(
    scene: &Scene,
    triangles: &[Triangle<Vec3A>],
    [width, height]: [u32; 2],
) -> String {
    let mut table = String::new();
    let mut line = |text: String| writeln!(table, "{text}").expect("a string takes any text");

    let start = Instant::now();
    let ours = Bvh8::new(triangles);
    let our_build = start.elapsed();
    let peer = Peer::new(triangles);
    let peer_build = start.elapsed() - our_build;
    line(format!("triangles         {}", triangles.len()));
    let [our_build, peer_build] = [our_build, peer_build].map(|time| time.as_secs_f64());
    line(format!("build             {our_build:.3} s, obvhs's CWBVH {peer_build:.3} s"));
    line(format!("rays of each kind {}", width * height));
    line(format!(
        "{:<10}{:>10}{:>10}{:>10}{:>10}{:>10}{:>14}",
        "Mrays/s", "bvh8", "packets", "refined", "CWBVH", "ratio", "hits"
    ));

    let [primary, random, shadow] = rays(scene, [width, height]);
    let lamp = rays_to_lamp(scene, triangles, &ours, &primary);
    for (kind, rays, any) in [
        ("primary", primary, false),
        ("lamp", lamp, true),
        ("random", random, false),
        ("shadow", shadow, true),
    ] {
        let rays_of_peer: Vec<_> = rays
            .iter()
            .map(|r| obvhs::ray::Ray::new(r.origin, r.direction, r.t_min, r.t_max))
            .collect();
        let mut best = [f64::INFINITY; 4];
        let mut ratios = Vec::with_capacity(ROUNDS);
        let mut hits = [0; 4];
        for _ in 0..ROUNDS {
            let round: [(Found, f64); 4] = [
                timed(
                    || dispatch!(ours.level(), simd => if any { occluded(simd, &ours, &rays) } else { closest(simd, &ours, &rays) }),
                ),
                timed(
                    || dispatch!(ours.level(), simd => if any { occluded_in_packets(simd, &ours, &rays) } else { closest_in_packets(simd, &ours, &rays) }),
                ),
                timed(|| as_in_a_picture(&ours, &rays, any)),
                timed(|| peer.trace(&rays_of_peer, any)),
            ];
            for (best, (_, time)) in best.iter_mut().zip(round) {
                *best = best.min(time);
            }
            ratios.push(round[3].1 / round[0].1);
            hits = round.map(|((hits, _), _)| hits);
        }
        assert_eq!(hits[..3], [hits[0]; 3], "the same hierarchy");
        ratios.sort_by(f64::total_cmp);
        let [ours, packets, refined, theirs] = best.map(|time| rays.len() as f64 / 1e6 / time);
        let ratio = ratios[ROUNDS / 2];
        line(format!(
            "{kind:<10}{ours:>10.2}{packets:>10.2}{refined:>10.2}{theirs:>10.2}{ratio:>10.2}{:>14}",
            hits[0]
        ));
        if hits[3] != hits[0] {
            line(format!("{:<50}{:>24}", "", format!("CWBVH: {}", hits[3])));
        }
    }
    table
}

fn timed(trace: impl FnOnce() -> Found) -> (Found, f64) {
    let start = Instant::now();
    let found = black_box(trace());
    (found, start.elapsed().as_secs_f64())
}

/// The rays of each kind.
fn rays(scene: &Scene, [width, height]: [u32; 2]) -> [Vec<Ray<Vec3A>>; 3] {
    let bounds = scene.mesh.bounds();
    // From where the camera of the scene stands, but narrower: a ball of the size of the mesh fills the height.
    let View { from, at, .. } = scene.view;
    let sine = 0.5 * bounds.size().max_element() / (from - at).length();
    let field_of_view = 2.0 * sine.min(0.5).asin().to_degrees();
    let camera = Camera::new(&View { from, at, field_of_view }, width, height);
    let pixels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    let primary =
        pixels.map(|(x, y)| camera.ray(x as f32 + 0.5, y as f32 + 0.5)).collect::<Vec<_>>();

    let mut random = fastrand::Rng::with_seed(1);
    let mut point = || {
        let offset = Vec3A::from([(); 3].map(|()| 1.5 * (random.f32() - 0.5)));
        bounds.center() + offset * bounds.size()
    };
    let shadow: Vec<_> = primary.iter().map(|_| Ray::segment(point(), point())).collect();
    let whole = |ray: &Ray<Vec3A>| Ray::new(ray.origin, ray.direction.normalize());
    [primary, shadow.iter().map(whole).collect(), shadow]
}

/// The shadow rays from the primary hits to the first lamp.
fn rays_to_lamp(
    scene: &Scene,
    triangles: &[Triangle<Vec3A>],
    hierarchy: &Bvh8,
    primary: &[Ray<Vec3A>],
) -> Vec<Ray<Vec3A>> {
    let lamp = scene.lights[0].position;
    let shadow = |ray: &Ray<Vec3A>| {
        let MeshHit { triangle, hit } = hierarchy.closest(ray)?;
        let triangle = &triangles[triangle as usize];
        let normal = if hit.front { triangle.normal() } else { -triangle.normal() };
        let (point, error) = hit.point_and_error(triangle);
        let from = spawn::offset_origin(point, error, normal, normal);
        (normal.dot(lamp - from) > 0.0).then(|| Ray::segment(from, lamp))
    };
    primary.iter().filter_map(shadow).collect()
}

/// The closest hits, the level found out once for all rays.
#[inline(always)]
fn closest<S: Simd>(simd: S, hierarchy: &Bvh8, rays: &[Ray<Vec3A>]) -> Found {
    let (mut stack, mut found) = (Vec::new(), (0, 0.0));
    for ray in rays {
        if let Some(candidate) = hierarchy.closest_at(simd, ray, &mut stack) {
            found = (found.0 + 1, found.1 + candidate.hit.t);
        }
    }
    found
}

/// Any hits, likewise.
#[inline(always)]
fn occluded<S: Simd>(simd: S, hierarchy: &Bvh8, rays: &[Ray<Vec3A>]) -> Found {
    let (mut stack, mut hits) = (Vec::new(), 0);
    for ray in rays {
        hits += u32::from(hierarchy.occluded_at(simd, ray, &mut stack));
    }
    (hits, 0.0)
}

/// The closest hits of rays that follow each other, in packets.
#[inline(always)]
fn closest_in_packets<S: Simd>(simd: S, hierarchy: &Bvh8, rays: &[Ray<Vec3A>]) -> Found {
    let (mut stack, mut found) = (PacketStack::default(), (0, 0.0));
    for packet in rays.chunks(PACKET) {
        let closest = hierarchy.closest_of_packet_at(simd, packet, &mut stack);
        for candidate in closest.iter().flatten() {
            found = (found.0 + 1, found.1 + candidate.hit.t);
        }
    }
    found
}

/// Any hits, likewise.
#[inline(always)]
fn occluded_in_packets<S: Simd>(simd: S, hierarchy: &Bvh8, rays: &[Ray<Vec3A>]) -> Found {
    let (mut stack, mut hits) = (PacketStack::default(), 0);
    for packet in rays.chunks(PACKET) {
        hits += hierarchy.occluded_of_packet_at(simd, packet, u32::MAX, &mut stack).count_ones();
    }
    (hits, 0.0)
}

/// Ray by ray, and the closest hit to the last digit.
fn as_in_a_picture(accelerator: &dyn Accelerator, rays: &[Ray<Vec3A>], any: bool) -> Found {
    let mut found = (0, 0.0);
    for ray in rays {
        if any {
            found.0 += u32::from(accelerator.occluded(ray));
        } else if let Some(MeshHit { hit, .. }) = accelerator.closest(ray) {
            found = (found.0 + 1, found.1 + hit.t);
        }
    }
    found
}

/// obvhs's hierarchy with its own triangles, in the order of the leaves.
struct Peer {
    hierarchy: CwBvh,
    triangles: Vec<obvhs::triangle::Triangle>,
}

impl Peer {
    fn new(triangles: &[Triangle<Vec3A>]) -> Self {
        let triangles: Vec<_> = triangles
            .iter()
            .map(|&Triangle { v0, v1, v2 }| obvhs::triangle::Triangle { v0, v1, v2 })
            .collect();
        let build = obvhs::BvhBuildParams { max_prims_per_leaf: 3, ..BUILD };
        let hierarchy = build_cwbvh_from_tris(&triangles, build, &mut Duration::default());
        let places = &hierarchy.primitive_indices;
        let triangles = places.iter().map(|&place| triangles[place as usize]).collect();
        Self { hierarchy, triangles }
    }

    fn trace(&self, rays: &[obvhs::ray::Ray], any: bool) -> Found {
        let mut found = (0, 0.0);
        let intersect = |ray: &obvhs::ray::Ray, index: usize| self.triangles[index].intersect(ray);
        for &ray in rays {
            let mut hit = RayHit::none();
            if any {
                found.0 += u32::from(!self.hierarchy.ray_traverse_miss(ray, intersect));
            } else if self.hierarchy.ray_traverse(ray, &mut hit, intersect) {
                found = (found.0 + 1, found.1 + hit.t);
            }
        }
        found
    }
}
