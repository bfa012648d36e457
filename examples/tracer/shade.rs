//! Whitted's recursion with Phong's local light.
//!
//! T. Whitted, "An Improved Illumination Model for Shaded Display", CACM 23.6, 1980:
//! `I = I_object + k_m·I_reflection + k_t·I_refraction`. B. T. Phong, "Illumination for Computer
//! Generated Pictures", CACM 18.6, 1975: `I_object = I_a·k_a + Σ f(d)·I_p·(k_d·(L·N) + k_s·(V·R)ⁿ)`.
//! A ray whose share of the pixel is too small to be seen is not followed: R. A. Hall, D. P.
//! Greenberg, "A Testbed for Realistic Image Synthesis", IEEE CG&A 3.8, 1983.

mod cones;

use std::array;
use std::ops::AddAssign;

use isect::Ray;
use isect::glam::Vec3A;

use crate::accelerator::{Accelerator, PACKET};
use crate::beams::{Beams, Found};
use crate::optics::{Refraction, mirrored_share, refract};
use crate::scene::{Color, Light, Scene};
use crate::surface::{Surface, transmittance, transmittance_of_packet};

pub(crate) use cones::Cones;

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
    fn count_onward(&mut self, is_refracted: bool) {
        *(if is_refracted { &mut self.refraction } else { &mut self.reflection }) += 1;
    }

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
    /// Where it is looked up what rays from the eye see, if not by tracing them.
    beams: Option<&'a Beams>,
}

/// A ray's place in the recursion.
#[derive(Clone, Copy)]
struct Branch<'a> {
    /// How many more times it may be reflected or refracted.
    depth: u32,
    /// Its share of the pixel.
    weight: f32,
    /// The beam that it is one of, if that is known.
    beams: Option<&'a Beams>,
}

/// A surface and how it is seen.
struct Sight<'a> {
    surface: Surface<'a>,
    /// That of the ray which found it.
    direction: Vec3A,
    /// The share of the light that comes mirrored, by Schlick's equation.
    mirrored: f32,
    /// The paint's.
    color: Color,
}

/// The light that reaches a surface from one direction, and goes on along the sight.
struct Onward {
    direction: Vec3A,
    is_refracted: bool,
    /// What of it goes on.
    share: f32,
    /// And in which colour.
    tint: Color,
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
    /// How far it is.
    distance: f32,
}

impl<'a> Tracer<'a> {
    /// Prepares to follow rays through `scene`.
    pub(crate) fn new(scene: &'a Scene, accelerator: &'a dyn Accelerator, max_depth: u32) -> Self {
        Self { scene, accelerator, max_depth, beams: None }
    }

    /// The same, but what the beams can tell is not traced.
    pub(crate) fn with_beams(self, beams: Option<&'a Beams>) -> Self {
        Self { beams, ..self }
    }

    /// What there is to see.
    pub(crate) fn scene(&self) -> &'a Scene {
        self.scene
    }

    /// The light that arrives along a ray from the eye.
    pub(crate) fn color(&self, primary: &Ray<Vec3A>, counts: &mut RayCounts) -> Color {
        counts.primary += 1;
        self.radiance(primary, self.trunk(), counts)
    }

    /// The light that arrives along rays from the eye that go together. So do their shadow rays; reflected
    /// and refracted rays go their own ways.
    pub(crate) fn colors(&self, primary: &[Ray<Vec3A>], counts: &mut RayCounts) -> [Color; PACKET] {
        if self.beams.is_some() {
            // They are looked up one by one.
            let mut rays = primary.iter();
            return array::from_fn(|_| {
                rays.next().map_or(Color::ZERO, |ray| self.color(ray, counts))
            });
        }
        counts.primary += primary.len() as u64;
        let surfaces = Surface::closest_of_packet(self.scene, self.accelerator, primary);
        let sights = array::from_fn(|lane| {
            surfaces[lane].map(|surface| Sight::new(surface, primary[lane].direction))
        });
        let local = self.local_of_packet(&sights, counts);
        let branch = self.trunk();
        let mut colors = [Color::ZERO; PACKET];
        for (lane, ray) in primary.iter().enumerate() {
            colors[lane] = match &sights[lane] {
                Some(sight) => self.completed(local[lane], sight, ray, branch, counts),
                None => self.sky(ray),
            };
        }
        colors
    }

    /// The light that arrives along any ray.
    fn radiance(&self, ray: &Ray<Vec3A>, branch: Branch<'a>, counts: &mut RayCounts) -> Color {
        let (surface, beams) = self.seen(ray, branch.beams);
        let Some(surface) = surface else {
            return self.sky(ray);
        };
        let branch = Branch { beams, ..branch };
        let sight = Sight::new(surface, ray.direction);
        let local = self.local(&sight, counts);
        self.completed(local, &sight, ray, branch, counts)
    }

    /// The start of the recursion.
    fn trunk(&self) -> Branch<'a> {
        Branch { depth: self.max_depth, weight: 1.0, beams: self.beams }
    }

    /// The surface that a ray meets first, and the beam that a mirror there makes of its own.
    fn seen(
        &self,
        ray: &Ray<Vec3A>,
        beams: Option<&'a Beams>,
    ) -> (Option<Surface<'a>>, Option<&'a Beams>) {
        match beams.and_then(|beams| beams.find(self.scene, ray)) {
            Some(Found::Sky) => return (None, None),
            Some(Found::Shape(shape, reflected)) => {
                let (shape, material) = &self.scene.shapes[shape];
                // Beside an edge, the ray may miss what the beam sees.
                if let Some(hit) = shape.intersect(ray) {
                    return (Some(Surface::of_shape(&hit, material)), reflected);
                }
            }
            None => {}
        }
        (Surface::closest(self.scene, self.accelerator, ray), None)
    }

    /// What a ray sees that hits nothing.
    fn sky(&self, ray: &Ray<Vec3A>) -> Color {
        self.scene.fog.over(self.scene.sky(ray.direction), f32::INFINITY)
    }

    /// The local light, and what is reflected and refracted, through the fog.
    fn completed(
        &self,
        local: Color,
        sight: &Sight<'_>,
        ray: &Ray<Vec3A>,
        branch: Branch<'a>,
        counts: &mut RayCounts,
    ) -> Color {
        let mut color = local;
        for Onward { direction, is_refracted, share, tint } in sight.onward() {
            if let Some(branch) = branch.next(share) {
                counts.count_onward(is_refracted);
                // A mirror's beam has its image in it.
                let beams = branch.beams.filter(|_| !is_refracted);
                let ray = sight.surface.spawn(direction);
                color += tint * (share * self.radiance(&ray, Branch { beams, ..branch }, counts));
            }
        }
        self.scene.fog.over(color, ray.origin.distance(sight.surface.point))
    }

    /// The light of the lamps and the sky that a surface itself scatters.
    fn local(&self, sight: &Sight<'_>, counts: &mut RayCounts) -> Color {
        Local::color(self.scene, sight, counts, |shadow| {
            transmittance(self.scene, self.accelerator, &shadow.ray)
        })
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
    /// Of the point itself.
    fn new(surface: Surface<'a>, direction: Vec3A) -> Self {
        Self::of_color(surface, direction, surface.material.paint.at(surface.point))
    }

    /// With a colour that the paint has.
    fn of_color(surface: Surface<'a>, direction: Vec3A, color: Color) -> Self {
        let mirror = surface.material.mirror;
        let mirrored =
            if mirror > 0.0 { mirrored_share(direction, surface.normal, mirror) } else { 0.0 };
        Self { surface, direction, mirrored, color }
    }

    /// Where the light comes from that is neither a lamp's nor scattered: `k_m` and `k_t`, or what stands in their place.
    fn onward(&self) -> impl Iterator<Item = Onward> {
        let Self { ref surface, direction, mirrored, .. } = *self;
        let material = surface.material;
        let reflected = |share, tint| Onward {
            direction: direction.reflect(surface.normal),
            is_refracted: false,
            share,
            tint,
        };
        let varnish = reflected(mirrored, material.paint.tint());
        let [mirror, passage] = if let Some(interface) = material.transparent {
            let eta = interface.eta(surface.leaving);
            let refraction = refract(direction, surface.normal, eta);
            let [reflected_share, share] = match (&refraction, material.shares) {
                (Some(refraction), None) => [refraction.reflectance, 1.0 - refraction.reflectance],
                (Some(_), Some(shares)) => [shares.reflected, shares.transmitted],
                (None, None) => [1.0, 0.0],
                (None, Some(shares)) => [shares.reflected + shares.transmitted, 0.0],
            };
            let passage = refraction.map(|Refraction { direction, .. }| Onward {
                direction,
                is_refracted: true,
                share,
                tint: Color::ONE,
            });
            [Some(reflected(reflected_share, Color::ONE)), passage]
        } else {
            [material.shares.map(|shares| reflected(shares.reflected, Color::ONE)), None]
        };
        [Some(varnish), mirror, passage].into_iter().flatten()
    }
}

impl<'a> Local<'a> {
    /// The light of the sky.
    fn new(
        scene: &Scene,
        &Sight { ref surface, direction, mirrored, color }: &'a Sight<'a>,
    ) -> Self {
        let scattered = color * (surface.material.diffuse * (1.0 - mirrored));
        Self {
            surface,
            scattered,
            mirrored: direction.reflect(surface.normal),
            shadow_origin: surface.shadow_origin(),
            color: scattered * scene.ambient(surface.normal),
        }
    }

    /// The light of the sky and of all lamps, of which the share that `lit` says arrives.
    fn color(
        scene: &Scene,
        sight: &'a Sight<'a>,
        counts: &mut RayCounts,
        lit: impl Fn(&Shadow) -> f32,
    ) -> Color {
        let mut local = Self::new(scene, sight);
        for light in &scene.lights {
            if let Some(shadow) = local.shadow(light) {
                counts.shadow += 1;
                local.add(light, &shadow, lit(&shadow));
            }
        }
        local.color
    }

    /// The way to a lamp, unless the surface is in its own shadow.
    fn shadow(&self, light: &Light) -> Option<Shadow> {
        let ray = Ray::segment(self.shadow_origin, light.position);
        let to_light = ray.direction.normalize();
        let facing = to_light.dot(self.surface.normal);
        let distance = ray.direction.length();
        (facing > 0.0).then_some(Shadow { ray, to_light, facing, distance })
    }

    /// Adds the light of a lamp, of which the share `lit` arrives.
    fn add(
        &mut self,
        light: &Light,
        &Shadow { to_light, facing, distance, .. }: &Shadow,
        lit: f32,
    ) {
        if lit > 0.0 {
            let material = self.surface.material;
            let highlight = self.mirrored.dot(to_light).max(0.0).powf(material.shininess);
            let scattered = self.scattered * facing + material.specular * highlight;
            self.color += light.color * (lit * light.falloff.at(distance)) * scattered;
        }
    }
}

impl Branch<'_> {
    /// A ray that carries `share` of this one's light, if it is to be followed.
    fn next(self, share: f32) -> Option<Self> {
        let weight = self.weight * share;
        let depth = self.depth.checked_sub(1)?;
        (weight >= INVISIBLE).then_some(Self { depth, weight, ..self })
    }
}

#[cfg(test)]
mod tests {
    use isect::Plane;

    use super::*;
    use crate::accelerator::NaiveLoop;
    use crate::fog::Fog;
    use crate::kernel::Exact;
    use crate::mesh::Obj;
    use crate::scene::{Falloff, Interface, Material, SceneName, Shape, Shares};

    /// Looks down at the plane y = 0 from (0, 1, 0), to meet it at (1, 0, 0).
    const DOWN: Ray<Vec3A> = Ray {
        origin: Vec3A::Y,
        direction: Vec3A::new(
            std::f32::consts::FRAC_1_SQRT_2,
            -std::f32::consts::FRAC_1_SQRT_2,
            0.0,
        ),
        t_min: 0.0,
        t_max: f32::INFINITY,
    };

    /// Nothing but a plane of a material, without lamps.
    fn plane(change: impl FnOnce(&mut Material)) -> Scene {
        let mut scene = SceneName::Spheres.build(Obj::icosphere(0));
        let mut material = scene.mesh_material;
        change(&mut material);
        scene.shapes = vec![(Shape::Plane(Plane { normal: Vec3A::Y, offset: 0.0 }), material)];
        scene.lights.clear();
        scene
    }

    /// What a ray sees, and what the rays of a packet do.
    fn seen(scene: &Scene, ray: Ray<Vec3A>) -> Color {
        let accelerator = NaiveLoop::<Exact>::new(&[]);
        let tracer = Tracer::new(scene, &accelerator, 4);
        let mut counts = RayCounts::default();
        let color = tracer.color(&ray, &mut counts);
        assert_eq!(tracer.colors(&[ray; 3], &mut counts)[..3], [color; 3]);
        color
    }

    /// Some dozen operations on numbers up to 1, each off by half an ulp at most.
    fn assert_close(a: Color, b: Color) {
        assert!((a - b).abs().max_element() < 16.0 * f32::EPSILON, "{a} {b}");
    }

    #[test]
    fn stated_shares_of_the_light_are_reflected_and_transmitted() {
        for (reflected, transmitted) in [(0.25, 0.0), (0.0, 0.5), (0.3, 0.6), (1.0, 1.0)] {
            let scene = plane(|material| {
                material.diffuse = 0.0;
                material.transparent = Some(Interface { inside: 1.0, outside: 1.0 });
                material.shares = Some(Shares { reflected, transmitted });
            });
            let up = Vec3A::new(DOWN.direction.x, -DOWN.direction.y, 0.0);
            let expected = reflected * scene.sky(up) + transmitted * scene.sky(DOWN.direction);
            assert_close(seen(&scene, DOWN), expected);
        }
    }

    #[test]
    fn where_nothing_passes_both_shares_are_reflected() {
        let scene = plane(|material| {
            material.diffuse = 0.0;
            // From glass into air at 45°, beyond the critical angle.
            material.transparent = Some(Interface { inside: 1.0, outside: 1.5 });
            material.shares = Some(Shares { reflected: 0.25, transmitted: 0.5 });
        });
        let up = Vec3A::new(DOWN.direction.x, -DOWN.direction.y, 0.0);
        assert_close(seen(&scene, DOWN), 0.75 * scene.sky(up));
    }

    #[test]
    fn an_opaque_surface_keeps_its_own_light_beside_the_mirrored() {
        let matt = plane(|_| ());
        let varnished =
            plane(|material| material.shares = Some(Shares { reflected: 0.5, transmitted: 0.0 }));
        let up = Vec3A::new(DOWN.direction.x, -DOWN.direction.y, 0.0);
        let expected = seen(&matt, DOWN) + 0.5 * matt.sky(up);
        assert_close(seen(&varnished, DOWN), expected);
    }

    #[test]
    fn a_mirrored_ray_passes_through_fog_too() {
        let mut scene = plane(|material| {
            material.diffuse = 0.0;
            material.shares = Some(Shares { reflected: 0.5, transmitted: 0.0 });
        });
        let color = Color::new(0.9, 0.5, 0.1);
        // The first ray is √2 long, half of the way through the fog; the mirrored one has no end.
        let end = 2.0 * std::f32::consts::SQRT_2;
        scene.fog = Fog::Linear { range: [0.0, end], color };
        assert_close(seen(&scene, DOWN), 0.5 * (0.5 * color) + 0.5 * color);
        assert_eq!(seen(&scene, Ray::new(Vec3A::Y, Vec3A::Y)), color);
    }

    #[test]
    fn lamps_weaken_as_their_falloff_says() {
        let lit_from = |height: f32, falloff| {
            let mut scene = plane(|material| material.specular = 0.0);
            let dark = seen(&scene, DOWN);
            let position = Vec3A::new(1.0, height, 0.0);
            scene.lights.push(Light { position, color: Color::ONE, falloff });
            seen(&scene, DOWN) - dark
        };
        let near = lit_from(2.0, Falloff::NONE);
        assert!(near.min_element() > 0.1);
        assert_close(lit_from(8.0, Falloff::NONE), near);
        assert_close(lit_from(2.0, Falloff::INVERSE_SQUARE), near / 4.0);
        assert_close(lit_from(8.0, Falloff::INVERSE_SQUARE), near / 64.0);
    }
}
