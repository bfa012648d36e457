//! Whitted's recursion with Phong's local light.
//!
//! T. Whitted, "An Improved Illumination Model for Shaded Display", CACM 23.6, 1980:
//! `I = I_object + k_m·I_reflection + k_t·I_refraction`. B. T. Phong, "Illumination for Computer
//! Generated Pictures", CACM 18.6, 1975: `I_object = I_a·k_a + Σ I_p·(k_d·(L·N) + k_s·(V·R)ⁿ)`.
//! A ray whose share of the pixel is too small to be seen is not followed: R. A. Hall, D. P.
//! Greenberg, "A Testbed for Realistic Image Synthesis", IEEE CG&A 3.8, 1983.

use std::ops::AddAssign;

use isect::Ray;
use isect::glam::Vec3A;

use crate::accelerator::Accelerator;
use crate::optics::{mirrored_share, reflect, refract};
use crate::scene::{Color, Paint, Scene};
use crate::surface::{Surface, transmittance};

/// Half of one of the 256 steps of a colour.
const INVISIBLE: f32 = 1.0 / 512.0;

/// How many rays were traced, by kind.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct RayCounts {
    pub(crate) primary: u64,
    pub(crate) shadow: u64,
    pub(crate) reflection: u64,
    pub(crate) refraction: u64,
}

impl RayCounts {
    /// All of them.
    pub(crate) fn total(&self) -> u64 {
        self.primary + self.shadow + self.reflection + self.refraction
    }
}

impl AddAssign for RayCounts {
    fn add_assign(&mut self, other: Self) {
        self.primary += other.primary;
        self.shadow += other.shadow;
        self.reflection += other.reflection;
        self.refraction += other.refraction;
    }
}

/// Follows rays through a scene.
pub(crate) struct Tracer<'a> {
    scene: &'a Scene,
    accelerator: &'a dyn Accelerator,
    /// How many times a ray may be reflected or refracted.
    max_depth: u32,
}

/// A ray's place in the recursion.
#[derive(Clone, Copy)]
struct Branch {
    /// How many more times it may be reflected or refracted.
    depth: u32,
    /// Its share of the pixel.
    weight: f32,
}

impl<'a> Tracer<'a> {
    /// Prepares to follow rays through `scene`.
    pub(crate) fn new(scene: &'a Scene, accelerator: &'a dyn Accelerator, max_depth: u32) -> Self {
        Self { scene, accelerator, max_depth }
    }

    /// The light that arrives along a ray from the eye.
    pub(crate) fn color(&self, primary: &Ray<Vec3A>, counts: &mut RayCounts) -> Color {
        counts.primary += 1;
        let branch = Branch { depth: self.max_depth, weight: 1.0 };
        self.radiance(primary, branch, counts)
    }

    /// The light that arrives along any ray.
    fn radiance(&self, ray: &Ray<Vec3A>, branch: Branch, counts: &mut RayCounts) -> Color {
        let Some(surface) = Surface::closest(self.scene, self.accelerator, ray) else {
            return self.scene.sky(ray.direction);
        };
        let material = surface.material;
        let mirrored = if material.mirror > 0.0 {
            mirrored_share(ray.direction, surface.normal, material.mirror)
        } else {
            0.0
        };
        let mut color = self.local(&surface, ray.direction, 1.0 - mirrored, counts);
        if mirrored > 0.0 {
            // Metal tints what it mirrors; a coat of varnish does not.
            let tint = match material.paint {
                Paint::Plain(tint) => tint,
                Paint::Checkers(_) => Color::ONE,
            };
            color += tint * self.reflected(&surface, ray.direction, mirrored, branch, counts);
        }
        if let Some(interface) = material.transparent {
            let eta = if surface.leaving {
                interface.inside / interface.outside
            } else {
                interface.outside / interface.inside
            };
            let refraction = refract(ray.direction, surface.normal, eta);
            let reflectance = refraction.map_or(1.0, |refraction| refraction.reflectance);
            color += self.reflected(&surface, ray.direction, reflectance, branch, counts);
            if let (Some(refraction), Some(branch)) = (refraction, branch.next(1.0 - reflectance)) {
                counts.refraction += 1;
                let ray = surface.spawn(refraction.direction);
                color += (1.0 - reflectance) * self.radiance(&ray, branch, counts);
            }
        }
        color
    }

    /// `share` of the light that comes mirrored.
    fn reflected(
        &self,
        surface: &Surface<'_>,
        direction: Vec3A,
        share: f32,
        branch: Branch,
        counts: &mut RayCounts,
    ) -> Color {
        let Some(branch) = branch.next(share) else {
            return Color::ZERO;
        };
        counts.reflection += 1;
        let ray = surface.spawn(reflect(direction, surface.normal));
        share * self.radiance(&ray, branch, counts)
    }

    /// The light of the lamps and the sky that the surface itself scatters: `I_object`. `share` is
    /// what the mirror leaves of it.
    fn local(
        &self,
        surface: &Surface<'_>,
        direction: Vec3A,
        share: f32,
        counts: &mut RayCounts,
    ) -> Color {
        let material = surface.material;
        let scattered = material.paint.at(surface.point) * (material.diffuse * share);
        let mut color = scattered * self.scene.ambient(surface.normal);
        let from = surface.shadow_origin();
        let mirrored = reflect(direction, surface.normal);
        for light in &self.scene.lights {
            let shadow = Ray::segment(from, light.position);
            let to_light = shadow.direction.normalize();
            let facing = to_light.dot(surface.normal);
            if facing <= 0.0 {
                continue; // the surface is in its own shadow
            }
            counts.shadow += 1;
            let lit = transmittance(self.scene, self.accelerator, &shadow);
            if lit > 0.0 {
                let highlight = mirrored.dot(to_light).max(0.0).powf(material.shininess);
                color += light.color * lit * (scattered * facing + material.specular * highlight);
            }
        }
        color
    }
}

impl Branch {
    /// A ray that carries `share` of this one's light, if it is to be followed.
    fn next(self, share: f32) -> Option<Self> {
        let weight = self.weight * share;
        let depth = self.depth.checked_sub(1)?;
        (weight >= INVISIBLE).then_some(Self { depth, weight })
    }
}
