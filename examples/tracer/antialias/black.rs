//! For tests: pictures of black things before a sky of one colour, in which a pixel tells how much of it they cover.

use isect::Triangle;
use isect::glam::Vec3A;

use super::{Eye, Method};
use crate::bvh2::Bvh2;
use crate::camera::{Camera, View};
use crate::kernel::Exact;
use crate::mesh::{Mesh, Obj};
use crate::render::Tile;
use crate::scene::{Scene, SceneName, Shape};
use crate::shade::{RayCounts, Tracer};

/// The picture's width and height.
pub(super) const SIZE: u32 = 16;

/// Down at the sky below the horizon, which has one colour.
const VIEW: View =
    View { from: Vec3A::new(0.5, 4.0, 1.0), at: Vec3A::new(0.0, 0.0, 0.25), field_of_view: 20.0 };

pub(super) fn camera() -> Camera {
    Camera::new(&VIEW, SIZE, SIZE)
}

/// A place in the picture, in pixels, so far ahead.
pub(super) fn ahead([x, y]: [f32; 2], depth: f32) -> Vec3A {
    let ray = camera().ray(x, y);
    ray.at(depth / camera().depth(ray.at(1.0)))
}

pub(super) fn triangle(corners: [[f32; 2]; 3], depth: f32) -> Triangle<Vec3A> {
    corners.map(|corner| ahead(corner, depth)).into()
}

/// Black triangles and shapes, and no lamp.
pub(super) fn scene(triangles: &[Triangle<Vec3A>], shapes: &[Shape]) -> Scene {
    let mut scene = SceneName::Spheres.build(Obj::icosphere(0));
    scene.lights.clear();
    scene.mesh = Mesh::of(triangles);
    scene.mesh_material.diffuse = 0.0;
    let material = scene.mesh_material;
    scene.shapes = shapes.iter().map(|&shape| (shape, material)).collect();
    scene
}

/// How black pixels are, and how many rays that took.
pub(super) fn black(scene: &Scene, method: Method, tile: Tile) -> (Vec<f32>, u64) {
    let triangles = scene.mesh.triangles();
    let hierarchy = Bvh2::<Exact>::new(&triangles, 16.0);
    let tracer = Tracer::new(scene, &hierarchy, 2);
    let eye = Eye { tracer: &tracer, camera: &camera(), hierarchy: Some(&hierarchy) };
    let mut counts = RayCounts::default();
    let colors = method.colors(&eye, &tile, &mut counts);
    let sky = scene.sky(Vec3A::NEG_Y);
    (colors.into_iter().map(|color| 1.0 - color.x / sky.x).collect(), counts.primary)
}

pub(super) fn pixel(x: u32, y: u32) -> Tile {
    Tile { x: x..x + 1, y: y..y + 1 }
}
