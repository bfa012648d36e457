//! The point that a ray sees, and whether a point sees a light.

use std::array;

use isect::glam::Vec3A;
use isect::{Ray, spawn};

use crate::accelerator::{Accelerator, MeshHit, PACKET};
use crate::mesh::interpolated;
use crate::scene::{Material, Scene, ShapeHit};

/// The share of the light that gets through a transparent surface on its straight way to a shadow
/// ray's start: a stand-in for the light that refraction would bring there.
const THROUGH_TRANSPARENT: f32 = 0.75;

/// It stands in the lanes without a ray, and hits nothing.
const NO_RAY: Ray<Vec3A> =
    Ray { origin: Vec3A::ZERO, direction: Vec3A::ZERO, t_min: 0.0, t_max: 0.0 };

/// A point of a surface as the ray that found it sees it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Surface<'a> {
    /// The point itself.
    pub(crate) point: Vec3A,
    /// By how much it may be off the surface, in each component.
    pub(crate) error: Vec3A,
    /// The normal to shade with, of length 1, on the ray's side.
    pub(crate) normal: Vec3A,
    /// The normal of the surface as it is, of any length, on the ray's side.
    pub(crate) geometric_normal: Vec3A,
    /// Where shadow rays start: the point, or above it where a flat triangle stands for a round
    /// surface.
    pub(crate) shadow_point: Vec3A,
    /// Whether the ray comes from inside.
    pub(crate) leaving: bool,
    /// What the surface is made of.
    pub(crate) material: &'a Material,
}

impl<'a> Surface<'a> {
    /// The closest surface that the ray meets in its range.
    pub(crate) fn closest(
        scene: &'a Scene,
        accelerator: &dyn Accelerator,
        ray: &Ray<Vec3A>,
    ) -> Option<Self> {
        let (ray, shape) = closest_shape(scene, ray);
        let in_mesh = accelerator.closest(&ray);
        Self::of_closer(scene, &ray, in_mesh, shape)
    }

    /// The same for rays that go together.
    pub(crate) fn closest_of_packet(
        scene: &'a Scene,
        accelerator: &dyn Accelerator,
        rays: &[Ray<Vec3A>],
    ) -> [Option<Self>; PACKET] {
        let (mut shortened, mut shapes) = ([NO_RAY; PACKET], [None; PACKET]);
        for (lane, ray) in rays.iter().enumerate() {
            (shortened[lane], shapes[lane]) = closest_shape(scene, ray);
        }
        let in_mesh = accelerator.closest_of_packet(&shortened[..rays.len()]);
        array::from_fn(|lane| Self::of_closer(scene, &shortened[lane], in_mesh[lane], shapes[lane]))
    }

    /// The ray that leaves the surface in `direction`, to either side.
    pub(crate) fn spawn(&self, direction: Vec3A) -> Ray<Vec3A> {
        let Self { point, error, geometric_normal, .. } = *self;
        Ray::new(spawn::offset_origin(point, error, geometric_normal, direction), direction)
    }

    /// Where shadow rays start: on this side even if the light is on the other, so that they meet the
    /// surface itself.
    pub(crate) fn shadow_origin(&self) -> Vec3A {
        let Self { shadow_point, error, geometric_normal, .. } = *self;
        spawn::offset_origin(shadow_point, error, geometric_normal, geometric_normal)
    }

    /// What a ray sees that ends at the closest shape and hits the mesh before it, or not.
    fn of_closer(
        scene: &'a Scene,
        ray: &Ray<Vec3A>,
        in_mesh: Option<MeshHit>,
        shape: Option<(ShapeHit, &'a Material)>,
    ) -> Option<Self> {
        if let Some(hit) = in_mesh {
            return Some(Self::of_mesh(scene, ray, &hit));
        }
        let (hit, material) = shape?;
        Some(Self::of_shape(&hit, material))
    }

    pub(crate) fn of_shape(hit: &ShapeHit, material: &'a Material) -> Self {
        let (point, error) = hit.point_and_error;
        let geometric_normal = if hit.leaving { -hit.normal } else { hit.normal };
        Self {
            point,
            error,
            normal: geometric_normal.normalize(),
            geometric_normal,
            shadow_point: point,
            leaving: hit.leaving,
            material,
        }
    }

    pub(crate) fn of_mesh(
        scene: &'a Scene,
        ray: &Ray<Vec3A>,
        &MeshHit { triangle, hit }: &MeshHit,
    ) -> Self {
        let corners = scene.mesh.triangle(triangle);
        let towards_ray = if hit.front { 1.0 } else { -1.0 };
        let geometric_normal = corners.normal() * towards_ray;
        let normals = scene.mesh.normals(triangle).map(|n| n * towards_ray);
        let (point, error) = hit.point_and_error(&corners);

        let mut normal = interpolated(&hit, normals);
        let mut shadow_point = point;
        if normal.dot(ray.direction) < 0.0 && normal.dot(geometric_normal) > 0.0 {
            // J. Hanika, "Hacking the Shadow Terminator", Ray Tracing Gems II, 2021, chapter 4: the
            // triangle's point, lifted to the planes that the vertex normals span, blended. Without
            // it, the triangle shows in the shadow's edge, as its own neighbours shade it.
            let [a, b, c] = [corners.v0, corners.v1, corners.v2];
            let lift =
                |corner: Vec3A, normal: Vec3A| normal * (corner - point).dot(normal).max(0.0);
            shadow_point +=
                hit.interpolate(lift(a, normals[0]), lift(b, normals[1]), lift(c, normals[2]));
        } else {
            // On a silhouette the interpolated normal may look away from the ray.
            normal = geometric_normal.normalize_or_zero();
        }
        Self {
            point,
            error,
            normal,
            geometric_normal,
            shadow_point,
            leaving: !hit.front,
            material: &scene.mesh_material,
        }
    }
}

/// The closest shape that a ray meets in its range, and what of the ray is before it.
fn closest_shape<'a>(
    scene: &'a Scene,
    ray: &Ray<Vec3A>,
) -> (Ray<Vec3A>, Option<(ShapeHit, &'a Material)>) {
    let mut ray = *ray;
    let mut closest = None;
    for (shape, material) in &scene.shapes {
        if let Some(hit) = shape.intersect(&ray) {
            closest = Some((hit, material));
            ray = ray.before(hit.t);
        }
    }
    (ray, closest)
}

/// The share of a light that reaches the other end of a shadow ray: none if anything opaque is hit,
/// whatever is found first.
pub(crate) fn transmittance(
    scene: &Scene,
    accelerator: &dyn Accelerator,
    shadow: &Ray<Vec3A>,
) -> f32 {
    let share = through_shapes(scene, shadow);
    if share > 0.0 && accelerator.occluded(shadow) { 0.0 } else { share }
}

/// The same for shadow rays that go together.
pub(crate) fn transmittance_of_packet(
    scene: &Scene,
    accelerator: &dyn Accelerator,
    shadows: &[Option<Ray<Vec3A>>; PACKET],
) -> [f32; PACKET] {
    let shares = shadows.map(|shadow| shadow.map_or(0.0, |shadow| through_shapes(scene, &shadow)));
    let rays = shadows.map(|shadow| shadow.unwrap_or(NO_RAY));
    let active = (0..PACKET).fold(0, |active, lane| active | u32::from(shares[lane] > 0.0) << lane);
    let occluded = accelerator.occluded_of_packet(&rays, active);
    array::from_fn(|lane| if (occluded >> lane) & 1 == 1 { 0.0 } else { shares[lane] })
}

/// The share of a light that gets through the shapes.
fn through_shapes(scene: &Scene, shadow: &Ray<Vec3A>) -> f32 {
    let mut share = 1.0;
    for (shape, material) in &scene.shapes {
        if shape.hits(shadow) {
            share *= through_material(material);
            if share == 0.0 {
                break;
            }
        }
    }
    share
}

/// The share of a light that gets through a shape of a material.
pub(crate) fn through_material(material: &Material) -> f32 {
    match (material.transparent, material.shares) {
        (None, _) => 0.0,
        (Some(_), None) => THROUGH_TRANSPARENT,
        (Some(_), Some(shares)) => shares.transmitted,
    }
}
