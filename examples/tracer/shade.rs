//! Whitted's recursion with Phong's local light.
//!
//! T. Whitted, "An Improved Illumination Model for Shaded Display", CACM 23.6, 1980:
//! `I = I_object + k_m·I_reflection + k_t·I_refraction`. B. T. Phong, "Illumination for Computer
//! Generated Pictures", CACM 18.6, 1975: `I_object = I_a·k_a + Σ I_p·(k_d·(L·N) + k_s·(V·R)ⁿ)`.
//! A ray whose share of the pixel is too small to be seen is not followed: R. A. Hall, D. P.
//! Greenberg, "A Testbed for Realistic Image Synthesis", IEEE CG&A 3.8, 1983.

use std::array;
use std::ops::AddAssign;

use isect::Ray;
use isect::glam::Vec3A;

use crate::accelerator::{Accelerator, PACKET};
use crate::optics::{mirrored_share, reflect, refract};
use crate::scene::{Color, Light, Paint, Scene};
use crate::surface::{Surface, transmittance, transmittance_of_packet};

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

/// A surface and how it is seen.
struct Sight<'a> {
    surface: Surface<'a>,
    /// That of the ray which found it.
    direction: Vec3A,
    /// The share of the light that comes mirrored.
    mirrored: f32,
}

/// The light of the lamps and the sky that a surface itself scatters, `I_object`, lamp by lamp.
struct Local<'a> {
    surface: &'a Surface<'a>,
    /// The share that is scattered: what the mirror leaves.
    scattered: Color,
    /// Where the light would come from in a mirror.
    mirrored: Vec3A,
    shadow_origin: Vec3A,
    /// The sum so far.
    color: Color,
}

/// The way from a surface to a lamp that it faces.
struct Shadow {
    ray: Ray<Vec3A>,
    to_light: Vec3A,
    /// The cosine of the angle between it and the normal.
    facing: f32,
}

impl<'a> Tracer<'a> {
    /// Prepares to follow rays through `scene`.
    pub(crate) fn new(scene: &'a Scene, accelerator: &'a dyn Accelerator, max_depth: u32) -> Self {
        Self { scene, accelerator, max_depth }
    }

    /// The light that arrives along rays from the eye that go together. So do their shadow rays; reflected
    /// and refracted rays go their own ways.
    pub(crate) fn colors(&self, primary: &[Ray<Vec3A>], counts: &mut RayCounts) -> [Color; PACKET] {
        counts.primary += primary.len() as u64;
        let surfaces = Surface::closest_of_packet(self.scene, self.accelerator, primary);
        let sights = array::from_fn(|lane| {
            surfaces[lane].map(|surface| Sight::new(surface, primary[lane].direction))
        });
        let local = self.local_of_packet(&sights, counts);
        let branch = Branch { depth: self.max_depth, weight: 1.0 };
        let mut colors = [Color::ZERO; PACKET];
        for (lane, ray) in primary.iter().enumerate() {
            colors[lane] = match &sights[lane] {
                Some(sight) => self.completed(local[lane], sight, branch, counts),
                None => self.scene.sky(ray.direction),
            };
        }
        colors
    }

    /// The light that arrives along any ray.
    fn radiance(&self, ray: &Ray<Vec3A>, branch: Branch, counts: &mut RayCounts) -> Color {
        let Some(surface) = Surface::closest(self.scene, self.accelerator, ray) else {
            return self.scene.sky(ray.direction);
        };
        let sight = Sight::new(surface, ray.direction);
        let local = self.local(&sight, counts);
        self.completed(local, &sight, branch, counts)
    }

    /// The local light, and what is reflected and refracted.
    fn completed(
        &self,
        local: Color,
        &Sight { ref surface, direction, mirrored }: &Sight<'_>,
        branch: Branch,
        counts: &mut RayCounts,
    ) -> Color {
        let material = surface.material;
        let mut color = local;
        if mirrored > 0.0 {
            // Metal tints what it mirrors; a coat of varnish does not.
            let tint = match material.paint {
                Paint::Plain(tint) => tint,
                Paint::Checkers(_) => Color::ONE,
            };
            color += tint * self.reflected(surface, direction, mirrored, branch, counts);
        }
        if let Some(interface) = material.transparent {
            let eta = if surface.leaving {
                interface.inside / interface.outside
            } else {
                interface.outside / interface.inside
            };
            let refraction = refract(direction, surface.normal, eta);
            let reflectance = refraction.map_or(1.0, |refraction| refraction.reflectance);
            color += self.reflected(surface, direction, reflectance, branch, counts);
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

    /// The light of the lamps and the sky that a surface itself scatters.
    fn local(&self, sight: &Sight<'_>, counts: &mut RayCounts) -> Color {
        let mut local = Local::new(self.scene, sight);
        for light in &self.scene.lights {
            if let Some(shadow) = local.shadow(light) {
                counts.shadow += 1;
                let lit = transmittance(self.scene, self.accelerator, &shadow.ray);
                local.add(light, &shadow, lit);
            }
        }
        local.color
    }

    /// The same for surfaces whose shadow rays go together; of no meaning where there is none.
    fn local_of_packet(
        &self,
        sights: &[Option<Sight<'_>>; PACKET],
        counts: &mut RayCounts,
    ) -> [Color; PACKET] {
        let mut locals = sights
            .each_ref()
            .map(|sight| sight.as_ref().map(|sight| Local::new(self.scene, sight)));
        for light in &self.scene.lights {
            let shadows = locals.each_ref().map(|local| local.as_ref()?.shadow(light));
            let rays = shadows.each_ref().map(|shadow| shadow.as_ref().map(|shadow| shadow.ray));
            let lit = transmittance_of_packet(self.scene, self.accelerator, &rays);
            for (lane, local) in locals.iter_mut().enumerate() {
                if let (Some(local), Some(shadow)) = (local, &shadows[lane]) {
                    counts.shadow += 1;
                    local.add(light, shadow, lit[lane]);
                }
            }
        }
        locals.map(|local| local.map_or(Color::ZERO, |local| local.color))
    }
}

impl<'a> Sight<'a> {
    fn new(surface: Surface<'a>, direction: Vec3A) -> Self {
        let mirror = surface.material.mirror;
        let mirrored =
            if mirror > 0.0 { mirrored_share(direction, surface.normal, mirror) } else { 0.0 };
        Self { surface, direction, mirrored }
    }
}

impl<'a> Local<'a> {
    /// The light of the sky.
    fn new(scene: &Scene, &Sight { ref surface, direction, mirrored }: &'a Sight<'a>) -> Self {
        let material = surface.material;
        let scattered = material.paint.at(surface.point) * (material.diffuse * (1.0 - mirrored));
        Self {
            surface,
            scattered,
            mirrored: reflect(direction, surface.normal),
            shadow_origin: surface.shadow_origin(),
            color: scattered * scene.ambient(surface.normal),
        }
    }

    /// The way to a lamp, unless the surface is in its own shadow.
    fn shadow(&self, light: &Light) -> Option<Shadow> {
        let ray = Ray::segment(self.shadow_origin, light.position);
        let to_light = ray.direction.normalize();
        let facing = to_light.dot(self.surface.normal);
        (facing > 0.0).then_some(Shadow { ray, to_light, facing })
    }

    /// Adds the light of a lamp, of which the share `lit` arrives.
    fn add(&mut self, light: &Light, &Shadow { to_light, facing, .. }: &Shadow, lit: f32) {
        if lit > 0.0 {
            let material = self.surface.material;
            let highlight = self.mirrored.dot(to_light).max(0.0).powf(material.shininess);
            let scattered = self.scattered * facing + material.specular * highlight;
            self.color += light.color * lit * scattered;
        }
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
