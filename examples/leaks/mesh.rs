//! Rays at the edges and vertices of a mesh, which cannot pass between its triangles.

use isect::glam::{Vec2, Vec3A};
use isect::ray::triangle::exact;
use isect::testkit::Rng;
use isect::testkit::meshes::{Surface, parse_obj};
use isect::{Ray, Triangle};
use rayon::prelude::*;

use crate::kernels::KERNELS;
use crate::picture::{Color, Picture};

/// The width of a panel.
const SIZE: usize = 320;
/// Rays to a pixel's length of an edge, and four times as many to a vertex.
const RAYS: usize = 24;

/// Rays by what they are aimed at.
#[derive(Clone, Copy, Default)]
pub(crate) struct Counts {
    pub(crate) at_edges: usize,
    pub(crate) at_vertices: usize,
}

pub(crate) struct Leaks {
    pub(crate) picture: Picture,
    /// How many were shot at each kernel.
    pub(crate) rays: Counts,
    /// How many met no triangle, by kernel.
    pub(crate) lost: [Counts; KERNELS.len()],
}

/// Where the rays come from: a lens before the bunny.
struct Camera {
    center: Vec3A,
    right: Vec3A,
    up: Vec3A,
    forward: Vec3A,
}

impl Camera {
    /// The radius of the lens.
    const LENS: f32 = 0.05;
    /// Half the width of a panel at distance 1.
    const TANGENT: f32 = 0.26;

    fn new() -> Self {
        let center = Vec3A::new(-3.0, 8.0, 21.0);
        let forward = (Vec3A::new(0.0, 4.6, 0.0) - center).normalize();
        let right = forward.cross(Vec3A::Y).normalize();
        Self { center, right, up: right.cross(forward), forward }
    }

    /// The ray through the middle of a pixel.
    fn primary(&self, x: usize, y: usize) -> Ray<Vec3A> {
        let [x, y] = [x, SIZE - 1 - y]
            .map(|pixel| Self::TANGENT * (2.0 * (pixel as f32 + 0.5) / SIZE as f32 - 1.0));
        Ray::new(self.center, self.forward + self.right * x + self.up * y)
    }

    /// Where a point is seen, in pixels.
    fn project(&self, point: Vec3A) -> Vec2 {
        let offset = point - self.center;
        let at = Vec2::new(offset.dot(self.right), -offset.dot(self.up))
            / (offset.dot(self.forward) * Self::TANGENT);
        (at + 1.0) * (0.5 * SIZE as f32)
    }

    /// From a random point of the lens, for another ray each time, to a point exactly, or to the next float.
    fn aimed(&self, target: Vec3A, rng: &mut Rng) -> Ray<Vec3A> {
        let mut offset = || Self::LENS * (2.0 * rng.f32() - 1.0);
        let origin = self.center + self.right * offset() + self.up * offset();
        Ray::new(origin, target - origin)
    }
}

/// A ray's pixel, and whether it was lost, by kernel.
struct Shot {
    pixel: usize,
    lost: [bool; KERNELS.len()],
}

struct Scene {
    camera: Camera,
    surface: Surface<Vec3A>,
}

impl Scene {
    /// Whether the camera sees the front of all of some triangles, and not at a grazing angle: then a ray to an inner point
    /// of what they cover, however rounded, meets one of them.
    fn faces_all<'a>(&self, mut triangles: impl Iterator<Item = &'a Triangle<Vec3A>>) -> bool {
        triangles.all(|triangle| {
            let sight = (self.camera.center - triangle.v0).normalize();
            triangle.normal().normalize_or_zero().dot(sight) > 0.1
        })
    }

    /// Whether nothing is between the camera and a point of the mesh.
    fn sees(&self, point: Vec3A) -> bool {
        let sight = Ray::segment(self.camera.center, point).with_range(0.0, 0.99);
        !self.surface.triangles.iter().any(|triangle| exact::hits(&sight, triangle))
    }

    /// Shoots at a point that the camera sees. The triangles around the `near` vertices are all that matter.
    fn shoot(&self, target: Vec3A, near: &[usize], rng: &mut Rng) -> Option<Shot> {
        let at = self.camera.project(target);
        let inside = 0.0..SIZE as f32;
        if !(inside.contains(&at.x) && inside.contains(&at.y)) {
            return None;
        }
        let ray = self.camera.aimed(target, rng);
        let around = || near.iter().flat_map(|&vertex| &self.surface.around[vertex]);
        let lost = KERNELS.map(|kernel| {
            !around().any(|&index| (kernel.hits)(&ray, &self.surface.triangles[index]))
        });
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "in the panel")]
        let pixel = at.y as usize * SIZE + at.x as usize;
        Some(Shot { pixel, lost })
    }

    fn at_edge(&self, number: usize) -> Vec<Shot> {
        let edge = self.surface.edges[number];
        let [a, b] = edge.map(|vertex| self.surface.vertices[vertex]);
        let both = self.surface.around[edge[0]]
            .iter()
            .filter(|triangle| self.surface.around[edge[1]].contains(triangle));
        if !self.faces_all(both.map(|&index| &self.surface.triangles[index])) {
            return Vec::new();
        }
        let mut rng = Rng::with_seed(number as u64);
        let length = self.camera.project(a).distance(self.camera.project(b)).ceil();
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "up to the diagonal"
        )]
        let steps = length as usize;
        let mut shots = Vec::new();
        for step in 0..steps {
            // Not at the ends themselves, around which a triangle may face away.
            let weight = |share: f32| 0.01 + 0.98 * (step as f32 + share) / steps as f32;
            let point = |share: f32| a + (b - a) * weight(share);
            if self.sees(point(0.5)) {
                shots.extend((0..RAYS).filter_map(|_| {
                    let target = point(rng.f32());
                    self.shoot(target, &edge, &mut rng)
                }));
            }
        }
        shots
    }

    fn at_vertex(&self, vertex: usize) -> Vec<Shot> {
        let around =
            self.surface.around[vertex].iter().map(|&index| &self.surface.triangles[index]);
        let target = self.surface.vertices[vertex];
        if !(self.faces_all(around) && self.sees(target)) {
            return Vec::new();
        }
        let mut rng = Rng::with_seed(vertex as u64);
        (0..4 * RAYS).filter_map(|_| self.shoot(target, &[vertex], &mut rng)).collect()
    }

    /// How bright the mesh is at a pixel; 0 where there is none.
    fn brightness(&self, x: usize, y: usize) -> f32 {
        let ray = self.camera.primary(x, y);
        let hits = self
            .surface
            .triangles
            .iter()
            .filter_map(|triangle| Some((exact::intersect(&ray, triangle)?.t, triangle)));
        hits.min_by(|(a, _), (b, _)| a.total_cmp(b)).map_or(0.0, |(_, triangle)| {
            let lamp = Vec3A::new(-0.5, 0.7, 0.6).normalize();
            0.6 + 0.4 * triangle.normal().normalize_or_zero().dot(lamp).max(0.0)
        })
    }
}

/// Shoots at every edge and vertex that is seen.
pub(crate) fn leaks() -> Leaks {
    let scene = Scene {
        camera: Camera::new(),
        surface: Surface::new(&parse_obj(include_str!("../tracer/bunny.obj"))),
    };
    let edges: Vec<Shot> = (0..scene.surface.edges.len())
        .into_par_iter()
        .flat_map_iter(|edge| scene.at_edge(edge))
        .collect();
    let vertices: Vec<Shot> = (0..scene.surface.vertices.len())
        .into_par_iter()
        .flat_map_iter(|vertex| scene.at_vertex(vertex))
        .collect();
    let brightness: Vec<f32> = (0..SIZE * SIZE)
        .into_par_iter()
        .map(|pixel| scene.brightness(pixel % SIZE, pixel / SIZE))
        .collect();

    let mut picture = Picture::new(SIZE);
    let lost = std::array::from_fn(|kernel| {
        // Rays and lost ones, by pixel.
        let mut shares = vec![(0, 0); SIZE * SIZE];
        for shot in edges.iter().chain(&vertices) {
            let (all, lost) = &mut shares[shot.pixel];
            *all += 1;
            *lost += u32::from(shot.lost[kernel]);
        }
        picture.draw(kernel, |x, y| {
            let pixel = y * SIZE + x;
            color(brightness[pixel], shares[pixel])
        });
        let count = |shots: &[Shot]| shots.iter().filter(|shot| shot.lost[kernel]).count();
        Counts { at_edges: count(&edges), at_vertices: count(&vertices) }
    });
    let rays = Counts { at_edges: edges.len(), at_vertices: vertices.len() };
    Leaks { picture, rays, lost }
}

/// White around the mesh; its edges darker; red where any of the rays at a pixel was lost, the stronger the more of them.
fn color(brightness: f32, (all, lost): (u32, u32)) -> Color {
    let mix = |from: [f32; 3], to: [f32; 3], share: f32| {
        [0, 1, 2].map(|k| from[k] + (to[k] - from[k]) * share)
    };
    let ground =
        if brightness == 0.0 { [255.0; 3] } else { [210.0, 214.0, 222.0].map(|x| x * brightness) };
    let color = match (all, lost) {
        (0, _) => ground,
        (_, 0) => mix(ground, [110.0, 118.0, 132.0], 0.35),
        (all, lost) => {
            mix(ground, [226.0, 10.0, 30.0], 0.3 + 0.7 * (4.0 * lost as f32 / all as f32).min(1.0))
        }
    };
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 255")]
    color.map(|x| x.round() as u8)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// And each of the others loses some: the aim is good enough to see a leak.
    #[test]
    fn nothing_is_lost_by_the_watertight_and_the_exact_kernel() {
        let leaks = leaks();
        assert!(leaks.rays.at_edges > 400_000 && leaks.rays.at_vertices > 40_000);
        for (kernel, lost) in KERNELS.iter().zip(&leaks.lost) {
            let tight = ["isect watertight", "isect exact"].contains(&kernel.name);
            assert_eq!(lost.at_edges == 0, tight, "{}", kernel.name);
            assert_eq!(lost.at_vertices == 0, tight, "{}", kernel.name);
        }
    }
}
