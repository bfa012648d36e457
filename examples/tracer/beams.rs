//! Beam tracing: P. S. Heckbert, P. Hanrahan, "Beam Tracing Polygonal Objects", SIGGRAPH 1984.
//!
//! Before any ray is cast, the beam from the eye through the picture is divided by the polygons of the scene into parts
//! that see one polygon each, or the sky. A part that ends at a mirror goes on as a beam from the mirrored eye, with
//! that part of the mirror for its base, and is divided again: a tree of beams. What the ray through a pixel sees is
//! then looked up in the tree, and so is what it sees in a mirror. Shadows are left to rays.
//!
//! No order of the polygons is needed. The one that comes nearest divides the beam: the parts that pass it by do not see
//! it, and in the part that it stops whatever lies before it divides again.

use isect::glam::Vec3A;
use isect::overlap::beam_polygon::{clip, divide};
use isect::{Beam, Plane, Polygon, Ray};

use crate::camera::Camera;
use crate::scene::{Scene, Shape};

/// The most corners of a part. The corners of a scene's polygon and of the picture give rise to fewer, but a part that
/// many polygons have cut may have more: it is not divided any further, and rays find out what it sees.
const CORNERS: usize = 24;

type Part = Beam<Vec3A, CORNERS>;
type Face = Polygon<Vec3A, CORNERS>;

/// How far ahead the base of the picture's beam lies at least; nothing nearer is seen.
const NEAR: f32 = 1.0 / 1024.0;

/// The parts of a beam, each with what it sees.
#[derive(Debug, Default)]
pub(crate) struct Beams {
    parts: Vec<Seen>,
}

/// A part of a beam, which sees one thing.
#[derive(Debug)]
struct Seen {
    apex: Vec3A,
    /// The inward normals of its sides.
    sides: Vec<Vec3A>,
    what: Sight,
    /// What a mirror makes of it.
    reflected: Option<Beams>,
}

/// What a part of a beam sees.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Sight {
    Sky,
    /// The scene's shape at this place.
    Shape(usize),
    /// It had too many corners to tell.
    Anything,
}

/// What a ray sees, found in a beam.
pub(crate) enum Found<'a> {
    Sky,
    /// The scene's shape at this place, and the beam that its mirror sends on.
    Shape(usize, Option<&'a Beams>),
}

impl Beams {
    /// Divides the beam of a whole picture; a mirror is followed so many times. `None` for a scene that is not all of
    /// polygons.
    pub(crate) fn new(scene: &Scene, camera: &Camera, depth: u32) -> Option<Self> {
        let face = |shape: &Shape| match shape {
            Shape::Polygon(polygon) => Face::new(polygon.vertices()),
            _ => None,
        };
        let faces: Option<Vec<_>> = scene.shapes.iter().map(|(shape, _)| face(shape)).collect();
        let divider = Divider { scene, faces: faces? };
        if !scene.mesh.triangles().is_empty() {
            return None;
        }
        let beam = |ahead: f32| {
            let corners = camera.corners().map(|direction| camera.eye() + direction * ahead);
            Part::new(camera.eye(), Face::new(&corners)?)
        };
        // The farther the base, the less does the rounding of its corners count.
        let near = beam(NEAR)?;
        let lit: Option<Vec<_>> = divider.faces.iter().map(|face| clip(&near, face)).collect();
        let lit = lit?;
        let depths = lit.iter().flat_map(|lit| lit.vertices()).map(|&v| camera.depth(v));
        let nearest = depths.fold(f32::INFINITY, f32::min).min(scene.extent());
        let all: Vec<_> = (0..divider.faces.len()).collect();
        Some(divider.beams(&beam(NEAR.max(nearest / 2.0))?, &all, depth))
    }

    /// How many parts there are, all the way down.
    pub(crate) fn count(&self) -> usize {
        let reflected = self.parts.iter().filter_map(|part| part.reflected.as_ref());
        self.parts.len() + reflected.map(Self::count).sum::<usize>()
    }

    /// What a ray of the beam sees; `None` if no part can tell.
    pub(crate) fn find(&self, scene: &Scene, ray: &Ray<Vec3A>) -> Option<Found<'_>> {
        // Far beyond the base; rounding may leave it between two parts.
        let point = ray.origin + ray.direction * (4.0 * scene.extent());
        let mut nearest: Option<(f32, &Seen)> = None;
        for part in &self.parts {
            let seen = point - part.apex;
            let margin = part.sides.iter().fold(0.0_f32, |margin, side| margin.min(side.dot(seen)));
            if nearest.is_none_or(|(most, _)| margin > most) {
                nearest = Some((margin, part));
            }
            if margin >= 0.0 {
                break;
            }
        }
        let (_, part) = nearest?;
        match part.what {
            Sight::Sky => Some(Found::Sky),
            Sight::Shape(shape) => Some(Found::Shape(shape, part.reflected.as_ref())),
            Sight::Anything => None,
        }
    }
}

/// Divides beams by the polygons of a scene.
struct Divider<'a> {
    scene: &'a Scene,
    /// The scene's shapes, with room for more corners.
    faces: Vec<Face>,
}

impl Divider<'_> {
    /// Divides a beam by some of the shapes.
    fn beams(&self, beam: &Part, shapes: &[usize], depth: u32) -> Beams {
        let mut beams = Beams::default();
        self.divide(beam, shapes, None, depth, &mut beams);
        beams
    }

    /// Divides a beam that ends at a shape, or does not, by those before that.
    fn divide(
        &self,
        beam: &Part,
        shapes: &[usize],
        stopped_by: Option<usize>,
        depth: u32,
        beams: &mut Beams,
    ) {
        let what = stopped_by.map_or(Sight::Sky, Sight::Shape);
        // What the beam lights of each, as far as it lies before its end, and how far off it begins.
        let lit = shapes.iter().map(|&shape| {
            let lit = self.before(stopped_by, beam.apex, &clip(beam, &self.faces[shape])?)?;
            let distances = lit.vertices().iter().map(|v| v.distance_squared(beam.apex));
            Some((distances.fold(f32::INFINITY, f32::min), shape, lit))
        });
        let Some(mut lit) = lit.collect::<Option<Vec<_>>>() else {
            return beams.parts.push(Seen::new(beam, Sight::Anything, None));
        };
        lit.retain(|(_, _, lit)| !lit.vertices().is_empty());
        lit.sort_by(|(a, i, _), (b, k, _)| a.total_cmp(b).then(i.cmp(k)));
        let shapes: Vec<_> = lit.iter().map(|&(_, shape, _)| shape).collect();
        let Some((&(_, nearest, ref lit), others)) = lit.first().zip(shapes.get(1..)) else {
            let reflected = self.reflected(beam, stopped_by, depth);
            return beams.parts.push(Seen::new(beam, what, reflected));
        };
        let Some(division) = divide(beam, lit) else {
            return beams.parts.push(Seen::new(beam, Sight::Anything, None));
        };
        for part in division.passing() {
            self.divide(part, others, stopped_by, depth, beams);
        }
        if let Some(part) = &division.stopped {
            self.divide(part, others, Some(nearest), depth, beams);
        }
    }

    /// The part of a polygon that lies before a shape, as seen from an apex; none of it if both lie in a plane, where the
    /// first of them is seen.
    fn before(&self, shape: Option<usize>, apex: Vec3A, lit: &Face) -> Option<Face> {
        let Some(plane) = shape.and_then(|shape| self.faces[shape].plane()) else {
            return Some(*lit);
        };
        let faces_apex = plane.normal.dot(apex) > plane.offset;
        let away =
            if faces_apex { Plane { normal: -plane.normal, offset: -plane.offset } } else { plane };
        let [_, before] = lit.split(&away)?;
        Some(before)
    }

    /// What goes on from a mirror.
    fn reflected(&self, beam: &Part, shape: Option<usize>, depth: u32) -> Option<Beams> {
        let (shape, depth) = (shape?, depth.checked_sub(1)?);
        if !self.scene.shapes[shape].1.is_mirror() {
            return None;
        }
        let lit = clip(beam, &self.faces[shape])?;
        let reflected = beam.reflected(&lit)?;
        let others: Vec<_> = (0..self.faces.len()).filter(|&other| other != shape).collect();
        Some(self.beams(&reflected, &others, depth))
    }
}

impl Seen {
    fn new(beam: &Part, what: Sight, reflected: Option<Beams>) -> Self {
        let (apex, vertices) = (beam.apex, beam.base.vertices());
        let next = vertices.iter().cycle().skip(1);
        let side =
            |(&from, &to): (&Vec3A, &Vec3A)| (from - apex).cross(to - from).normalize_or_zero();
        Self { apex, sides: vertices.iter().zip(next).map(side).collect(), what, reflected }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::accelerator::NaiveLoop;
    use crate::kernel::Exact;
    use crate::mesh::Obj;
    use crate::scene::{Material, SceneName};
    use crate::shade::{RayCounts, Tracer};
    use crate::surface::Surface;

    const DEPTH: u32 = 4;

    fn room() -> Scene {
        SceneName::Polygons.build(Obj::icosphere(0))
    }

    /// What a ray sees, and then sees in each mirror: the shapes have a material each.
    fn sights(scene: &Scene, ray: Ray<Vec3A>) -> Vec<*const Material> {
        let (mut ray, mut sights) = (ray, Vec::new());
        while let Some(surface) = Surface::closest(scene, &NaiveLoop::<Exact>::new(&[]), &ray) {
            sights.push(std::ptr::from_ref(surface.material));
            if !surface.material.is_mirror() || sights.len() > DEPTH as usize {
                break;
            }
            ray = surface.spawn(ray.direction.reflect(surface.normal));
        }
        sights
    }

    /// Pixels at whose centre, and those of all their neighbours, the same polygons are seen have the same colour, to the last
    /// bit; and few others have not.
    #[test]
    fn beams_see_what_rays_see() {
        let scene = room();
        let (width, height) = (320, 180);
        let camera = Camera::new(&scene.view, width, height);
        let beams = Beams::new(&scene, &camera, DEPTH).expect("it is all of polygons");
        let none = NaiveLoop::<Exact>::new(&[]);
        let rays = Tracer::new(&scene, &none, DEPTH);
        let with_beams = Tracer::new(&scene, &none, DEPTH).with_beams(Some(&beams));
        let ray = |x: u32, y: u32| camera.ray(x as f32 + 0.5, y as f32 + 0.5);
        let all: Vec<Vec<_>> =
            (0..height).map(|y| (0..width).map(|x| sights(&scene, ray(x, y))).collect()).collect();
        let (mut counts, mut different, mut inner, mut reflected) = (RayCounts::default(), 0, 0, 0);
        for (x, y) in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))) {
            let around = |x: u32, most: u32| x.saturating_sub(1)..(x + 2).min(most);
            let is_inner = around(y, height).all(|j| {
                around(x, width).all(|i| all[j as usize][i as usize] == all[y as usize][x as usize])
            });
            let colors = [&rays, &with_beams].map(|tracer| tracer.color(&ray(x, y), &mut counts));
            assert!(!is_inner || colors[0] == colors[1], "{x} {y} {colors:?}");
            different += u32::from(colors[0] != colors[1]);
            inner += u32::from(is_inner);
            reflected += u32::from(is_inner && all[y as usize][x as usize].len() > 1);
        }
        println!(
            "{} beams; {inner} pixels away from edges, {reflected} of mirrors; {different} differ",
            beams.count()
        );
        assert!(inner > 50_000 && reflected > 5_000 && different < 10);
    }

    /// The parts of the picture's beam cover the picture, once.
    #[test]
    fn every_ray_has_its_beam() {
        let scene = room();
        let camera = Camera::new(&scene.view, 160, 90);
        let beams = Beams::new(&scene, &camera, DEPTH).expect("it is all of polygons");
        let mut random = fastrand::Rng::with_seed(1);
        let (mut shapes, mut skies) = (0, 0);
        for _ in 0..10_000 {
            let ray = camera.ray(160.0 * random.f32(), 90.0 * random.f32());
            match beams.find(&scene, &ray).expect("no part has too many corners") {
                Found::Sky => skies += 1,
                Found::Shape(..) => shapes += 1,
            }
            let point = ray.at(100.0);
            let having = beams
                .parts
                .iter()
                .filter(|part| part.sides.iter().all(|side| side.dot(point - part.apex) > 1e-3));
            assert!(having.count() <= 1);
        }
        assert!(shapes > 5_000 && skies > 500, "{shapes} {skies}");
    }

    #[test]
    fn other_scenes_have_no_beams() {
        for name in [SceneName::Showcase, SceneName::Mesh, SceneName::Spheres] {
            let scene = name.build(Obj::icosphere(0));
            let camera = Camera::new(&scene.view, 16, 9);
            assert!(Beams::new(&scene, &camera, DEPTH).is_none());
        }
    }
}
