//! Cones in the place of rays: J. Amanatides, "Ray Tracing with Cones", SIGGRAPH 1984.
//!
//! What a cone sees is the sum of what covers its section, each thing by the share that is left of it by what is nearer, and
//! what is not covered travels on to the sky. Triangles that make up one surface share out what they cover between them,
//! others hide each other as if they did not know of each other. A cone goes on from a mirror or through glass as wide as what
//! it sees of it, and to a lamp, of which the share that is not covered shines.

use std::array;
use std::f64::consts::PI;

use isect::glam::{DVec3, Vec3A};
use isect::overlap::{beam_polygon, cone_aabb, cone_plane, cone_sphere, cone_triangle};
use isect::{Aabb, Beam, Cone, Polygon, Ray, Triangle};

use super::{Branch, Local, Onward, RayCounts, Shadow, Sight, Tracer};
use crate::accelerator::MeshHit;
use crate::bvh2::Bvh2;
use crate::kernel::Exact;
use crate::scene::{Color, Scene, Shape};
use crate::surface::{Surface, through_material, transmittance};

/// The number of primitives beyond which a cone does not look at each of them.
const MANY: usize = 16;

/// Of more than [`MANY`] one stands for as many parts of a surface as make up this share.
const SMALL: f32 = 1.0 / 32.0;

/// How much longer than wide what a cone sees of a surface may be: beyond that it is cut off.
const LONGEST: f32 = 64.0;

/// Follows cones through a scene.
pub(crate) struct Cones<'a> {
    tracer: &'a Tracer<'a>,
    /// The mesh, if there is one.
    hierarchy: Option<&'a Bvh2<Exact>>,
    /// That of all lamps.
    lamp_radius: f32,
}

/// What a cone may touch.
#[derive(Clone, Copy, Debug)]
enum Primitive {
    /// A triangle of the mesh.
    Mesh(u32, Triangle<Vec3A>),
    /// A triangle of a box or polygon of the scene's.
    Face(usize, Triangle<Vec3A>),
    /// A sphere or plane of the scene's.
    Shape(usize),
}

/// A primitive that covers a share of a cone's section.
#[derive(Clone, Copy, Debug)]
struct Touch {
    primitive: Primitive,
    /// Where it begins to, for the axis.
    t: f32,
    coverage: f32,
    /// The surface that it is a part of.
    layer: usize,
    /// Where a triangle ends that is seen from behind: of a closed surface a front hides it, whichever begins first.
    back: Option<f32>,
    /// The ray to the middle of it, if that was looked for.
    middle: Option<Ray<Vec3A>>,
}

/// What of a cone's section the primitives of a surface have covered so far.
#[derive(Clone, Copy, Debug, Default)]
struct Layer {
    covered: f32,
    /// The fronts, hidden or not.
    fronts: f32,
    /// What of the backs they have hidden.
    hidden: f32,
    /// A part that waits for another to stand for it.
    waiting: Option<Part>,
    /// The last one that did.
    last: Option<usize>,
}

/// What a cone sees of a primitive.
#[derive(Clone, Copy, Debug)]
struct Part {
    touch: Touch,
    /// Of the section, without what is hidden, with what it stands for.
    share: f32,
}

/// A point of a surface and what is around it.
struct Spot<'a> {
    surface: Surface<'a>,
    /// The shape that need not be asked again.
    shape: Option<usize>,
    /// That of the ray to it.
    direction: Vec3A,
    /// The radius of what the cone sees of it, across the axis.
    radius: f32,
    /// By how much it grows with the distance.
    spread: f32,
    /// By how much the normal turns along the surface.
    curvature: f32,
}

impl<'a> Cones<'a> {
    pub(crate) fn new(
        tracer: &'a Tracer<'a>,
        hierarchy: Option<&'a Bvh2<Exact>>,
        lamp_radius: f32,
    ) -> Self {
        Self { tracer, hierarchy, lamp_radius }
    }

    /// The light that arrives through a cone from the eye.
    pub(crate) fn color(&self, cone: &Cone<Vec3A>, counts: &mut RayCounts) -> Color {
        counts.primary += 1;
        self.radiance(cone, None, self.tracer.trunk(), counts)
    }

    /// The light that arrives through any cone, which comes from one of the scene's shapes or does not.
    fn radiance(
        &self,
        cone: &Cone<Vec3A>,
        from: Option<usize>,
        branch: Branch<'a>,
        counts: &mut RayCounts,
    ) -> Color {
        // The shapes, all polygons, and the mesh.
        let layers = self.scene().shapes.len() + 2;
        let lines = Lines::new(cone);
        let touches = self.in_order(&lines, self.touches(cone, &lines, from));
        let parts = parts(touches, layers);
        let (mut color, mut found) = (Color::ZERO, 0.0);
        for part in &parts {
            if let Some(spot) = self.spot(cone, &lines, &part.touch) {
                let branch = Branch { weight: branch.weight * part.share, ..branch };
                let seen = self.seen(cone.ray.origin, spot, branch, counts);
                // As of a ray: brighter than white is white, or edges would have steps.
                color += part.share * seen.min(Color::ONE);
                found += part.share;
            }
        }
        if found <= 0.0 {
            return self.tracer.sky(&cone.ray);
        }
        // What no ray found looks like the rest.
        let covered = parts.iter().map(|part| part.share).sum::<f32>().min(1.0);
        color * (covered / found) + self.tracer.sky(&cone.ray) * (1.0 - covered)
    }

    fn scene(&self) -> &'a Scene {
        self.tracer.scene
    }

    /// All that a cone touches, but for the shape that it comes from.
    fn touches(&self, cone: &Cone<Vec3A>, lines: &Lines, from: Option<usize>) -> Vec<Touch> {
        let mut touches = Vec::new();
        let Scene { shapes, mesh, .. } = self.scene();
        for (layer, (shape, _)) in shapes.iter().enumerate() {
            if Some(layer) == from {
                continue;
            }
            let hit = match shape {
                Shape::Sphere(sphere) => cone_sphere::intersect(cone, sphere),
                Shape::Plane(plane) => cone_plane::intersect(cone, plane),
                Shape::Box(aabb) => {
                    for (triangle, normal) in faces(aabb) {
                        let face = Primitive::Face(layer, triangle);
                        touches.extend(lines.touch(cone, face, &triangle, normal, layer));
                    }
                    None
                }
                Shape::Polygon(polygon) => {
                    // All polygons are one surface: they share their edges.
                    for triangle in polygon.triangles() {
                        let (face, normal) = (Primitive::Face(layer, triangle), triangle.normal());
                        touches.extend(lines.touch(cone, face, &triangle, normal, shapes.len()));
                    }
                    None
                }
            };
            touches.extend(hit.map(|hit| Touch {
                primitive: Primitive::Shape(layer),
                t: hit.t,
                coverage: hit.coverage,
                layer,
                back: None,
                middle: None,
            }));
        }
        if let Some(hierarchy) = self.hierarchy {
            let layer = shapes.len() + 1;
            hierarchy.visit(
                |aabb| cone_aabb::touches(cone, aabb),
                |index| {
                    let triangle = mesh.triangle(index);
                    let (primitive, normal) = (Primitive::Mesh(index, triangle), triangle.normal());
                    touches.extend(lines.touch(cone, primitive, &triangle, normal, layer));
                },
            );
        }
        touches
    }

    /// What covers a cone, from near to far.
    ///
    /// Where something begins says little if it is long, as a floor under what stands on it. So of two things the smaller one's
    /// middle decides, if they are not too many to ask.
    fn in_order(&self, lines: &Lines, mut touches: Vec<Touch>) -> Vec<Touch> {
        touches.retain(|touch| touch.coverage > 0.0);
        touches.sort_by(|a, b| a.back.unwrap_or(a.t).total_cmp(&b.back.unwrap_or(b.t)));
        if touches.len() > MANY {
            return touches;
        }
        for touch in &mut touches {
            touch.middle = self.middle(lines, &touch.primitive, touch.t);
        }
        let is_before = |a: &Touch, b: &Touch| {
            let smaller = if a.coverage < b.coverage { a } else { b };
            smaller
                .middle
                .is_some_and(|ray| self.depth(&ray, &a.primitive) < self.depth(&ray, &b.primitive))
        };
        for end in 1..touches.len() {
            let mut place = end;
            while place > 0 && is_before(&touches[place], &touches[place - 1]) {
                touches.swap(place, place - 1);
                place -= 1;
            }
        }
        touches
    }

    /// Where a ray meets a primitive, a triangle as far as its plane goes; infinity if it does not.
    fn depth(&self, ray: &Ray<Vec3A>, primitive: &Primitive) -> f32 {
        match primitive {
            Primitive::Mesh(_, triangle) | Primitive::Face(_, triangle) => {
                let normal = triangle.normal();
                let t = normal.dot(triangle.v0 - ray.origin) / normal.dot(ray.direction);
                if t >= 0.0 { t } else { f32::INFINITY }
            }
            Primitive::Shape(index) => {
                let hit = self.scene().shapes[*index].0.intersect(ray);
                hit.map_or(f32::INFINITY, |hit| hit.t)
            }
        }
    }

    /// The ray to the middle of a primitive that begins at t.
    fn middle(&self, lines: &Lines, primitive: &Primitive, t: f32) -> Option<Ray<Vec3A>> {
        match primitive {
            Primitive::Mesh(_, triangle) | Primitive::Face(_, triangle) => {
                lines.to_triangle(triangle, t)
            }
            Primitive::Shape(index) => lines.ray(match &self.scene().shapes[*index].0 {
                Shape::Sphere(sphere) => lines.to_sphere(sphere.center, sphere.radius),
                Shape::Plane(plane) => {
                    let height = plane.normal.as_dvec3().dot(lines.apex) - f64::from(plane.offset);
                    lines.to_plane(if height < 0.0 { plane.normal } else { -plane.normal })
                }
                Shape::Box(_) | Shape::Polygon(_) => return None,
            }),
        }
    }

    /// What is in the middle of what a cone touches, if a ray finds it: of a thin thing it may not.
    fn spot(&self, cone: &Cone<Vec3A>, lines: &Lines, touch: &Touch) -> Option<Spot<'a>> {
        let scene = self.scene();
        let ray = touch.middle.or_else(|| self.middle(lines, &touch.primitive, touch.t))?;
        let (surface, shape) = match touch.primitive {
            Primitive::Mesh(index, triangle) => {
                let hit = MeshHit { triangle: index, hit: ray.intersect(&triangle)? };
                (Surface::of_mesh(scene, &ray, &hit), None)
            }
            Primitive::Face(index, _) | Primitive::Shape(index) => {
                let (shape, material) = &scene.shapes[index];
                (Surface::of_shape(&shape.intersect(&ray)?, material), Some(index))
            }
        };
        let curvature = match shape.map(|index| &scene.shapes[index].0) {
            Some(Shape::Sphere(sphere)) => sphere.radius.recip(),
            _ => 0.0,
        };
        // Shapes are convex: what leaves one on the outside does not come back.
        let shape = shape.filter(|_| !surface.leaving);
        // A narrower cone has room in the lines of sight that meet the part.
        let width = touch.coverage;
        let radius = cone.radius_at(t_at(cone, surface.point)) * width;
        Some(Spot {
            surface,
            shape,
            direction: ray.direction,
            radius,
            spread: cone.spread / cone.ray.direction.length() * width,
            curvature,
        })
    }

    /// The light that comes from a spot.
    fn seen(
        &self,
        from: Vec3A,
        spot: Spot<'a>,
        branch: Branch<'a>,
        counts: &mut RayCounts,
    ) -> Color {
        let around = spot.around();
        let Spot { surface, shape, direction, radius, spread, curvature } = spot;
        let color = surface.material.paint.over(surface.point, around);
        let sight = Sight::of_color(surface, direction, color);
        let mut color = Local::color(self.scene(), &sight, counts, |shadow| {
            self.lit(&sight.surface, shape, shadow, radius)
        });
        for Onward { direction, is_refracted, share, tint } in sight.onward() {
            let Some(branch) = branch.next(share) else { continue };
            counts.count_onward(is_refracted);
            let Sight { surface, direction: before, .. } = &sight;
            let normal = surface.normal;
            // V − 2N(N·V) and ηV + (η cosθi − cosθr)N, where both V and N change along the surface: N as it bends, and from
            // inside the other way.
            let bend = if surface.leaving { -curvature * radius } else { curvature * radius };
            let (grown, turned) = match surface.material.transparent {
                Some(interface) if is_refracted => {
                    let eta = interface.eta(surface.leaving);
                    (eta * spread, normal.dot(direction) - eta * normal.dot(*before))
                }
                _ => (spread, 2.0),
            };
            // A cone cannot become narrower. Behind their focus lines part as they met before it; there is none in a lens.
            let spread = match grown + turned * bend {
                narrower if narrower < grown && is_refracted && !surface.leaving => grown,
                other => other.abs().max(grown),
            };
            let mut ray = surface.spawn(direction);
            let from = shape.filter(|_| !is_refracted);
            if from.is_none() {
                let cosine = surface.geometric_normal.normalize().dot(direction);
                let sag = radius * radius * curvature;
                ray.t_min = clearance(radius, cosine) + sag / cosine.abs().max(1.0 / LONGEST);
            }
            let onward = Cone::new(ray, radius, spread);
            color += tint * (share * self.radiance(&onward, from, branch, counts));
        }
        self.scene().fog.over(color, from.distance(sight.surface.point))
    }

    /// The share of a lamp that a spot sees, on the average: of the lines between the two that nothing covers.
    fn lit(
        &self,
        surface: &Surface<'_>,
        shape: Option<usize>,
        shadow: &Shadow,
        radius: f32,
    ) -> f32 {
        let cosine = surface.geometric_normal.normalize().dot(shadow.to_light);
        let clear = if shape.is_some() { 0.0 } else { clearance(radius, cosine) / shadow.distance };
        if clear >= 1.0 {
            // The lamp is as near as the spot is wide.
            return transmittance(self.scene(), self.tracer.accelerator, &shadow.ray);
        }
        let Ray { origin, direction, .. } = shadow.ray;
        let cone = if radius < self.lamp_radius {
            let ray = shadow.ray.with_range(clear, 1.0);
            Cone::new(ray, radius, self.lamp_radius - radius)
        } else {
            let ray = Ray::new(origin + direction, -direction).with_range(0.0, 1.0 - clear);
            // The two as wide make a cylinder.
            Cone::new(ray, self.lamp_radius, radius - self.lamp_radius)
        };
        self.through(&cone, shape)
    }

    /// The share of a shadow cone that gets through, whatever it comes from.
    fn through(&self, cone: &Cone<Vec3A>, from: Option<usize>) -> f32 {
        let Scene { shapes, mesh, .. } = self.scene();
        let lines = Lines::new(cone);
        let mut share = 1.0;
        // Of the fronts and of the backs: a closed surface has as many of both.
        let [mut in_polygons, mut in_mesh] = [[0.0_f32; 2]; 2];
        let add = |sums: &mut [f32; 2], triangle: &Triangle<Vec3A>, opacity: f32| {
            if let Some(hit) = cone_triangle::intersect(cone, triangle) {
                let is_back = lines.see_back(triangle.v0, triangle.normal());
                sums[usize::from(is_back)] += hit.coverage * opacity;
            }
        };
        for (index, (shape, material)) in shapes.iter().enumerate() {
            if Some(index) == from {
                continue;
            }
            let opacity = 1.0 - through_material(material);
            let hit = match shape {
                Shape::Sphere(sphere) => cone_sphere::intersect(cone, sphere),
                Shape::Plane(plane) => cone_plane::intersect(cone, plane),
                Shape::Box(aabb) => cone_aabb::intersect(cone, aabb),
                Shape::Polygon(polygon) => {
                    polygon.triangles().for_each(|t| add(&mut in_polygons, &t, opacity));
                    None
                }
            };
            if let Some(hit) = hit {
                share *= 1.0 - hit.coverage * opacity;
            }
        }
        if let Some(hierarchy) = self.hierarchy {
            hierarchy.visit(
                |aabb| cone_aabb::touches(cone, aabb),
                |index| add(&mut in_mesh, &mesh.triangle(index), 1.0),
            );
        }
        for [fronts, backs] in [in_polygons, in_mesh] {
            share *= 1.0 - fronts.max(backs).min(1.0);
        }
        share
    }
}

impl Spot<'_> {
    /// The axes of the ellipse that the cone cuts out of the plane that touches the surface.
    fn around(&self) -> [Vec3A; 2] {
        let normal = self.surface.geometric_normal.normalize();
        let cosine = normal.dot(self.direction).min(-1.0 / LONGEST);
        let (across, along) = self.direction.normalize().any_orthonormal_pair();
        [across, along].map(|v| (v - self.direction * (v.dot(normal) / cosine)) * self.radius)
    }
}

/// The t of the section in which a point lies.
fn t_at(cone: &Cone<Vec3A>, point: Vec3A) -> f32 {
    let Ray { origin, direction, .. } = cone.ray;
    (point - origin).dot(direction) / direction.length_squared()
}

/// How far a disk has to go until it is clear of the plane that its centre comes from.
fn clearance(radius: f32, cosine: f32) -> f32 {
    let cosine = cosine.abs().clamp(1.0 / LONGEST, 1.0);
    radius * (1.0 - cosine * cosine).sqrt() / cosine
}

/// The triangles of a box, two to a face, with the outward normals.
fn faces(aabb: &Aabb<Vec3A>) -> impl Iterator<Item = (Triangle<Vec3A>, Vec3A)> {
    const AXES: [Vec3A; 3] = [Vec3A::X, Vec3A::Y, Vec3A::Z];
    let (min, size) = (aabb.min, aabb.max - aabb.min);
    [0, 1, 2].into_iter().flat_map(move |axis| {
        let [normal, right, up] = [0, 1, 2].map(|i| AXES[(axis + i) % 3]);
        [(min, -normal), (min + normal * size, normal)].into_iter().flat_map(move |(a, normal)| {
            let [b, c, d] = [right, right + up, up].map(|offset| a + offset * size);
            [(Triangle::new(a, b, c), normal), (Triangle::new(a, c, d), normal)]
        })
    })
}

/// The lines of sight through a cone.
struct Lines {
    /// Where they meet, or would.
    apex: DVec3,
    /// The middle one, of length 1.
    axis: DVec3,
    /// By how much they part with the distance.
    spread: f64,
    /// From the apex to the origin of the cone, and to where it begins.
    origin: f64,
    start: f64,
    /// Of the cone's direction.
    length: f64,
}

impl Lines {
    fn new(cone: &Cone<Vec3A>) -> Self {
        let direction = cone.ray.direction.as_dvec3();
        let length = direction.length();
        let (axis, spread) = (direction / length, f64::from(cone.spread) / length);
        let origin = f64::from(cone.radius) / spread;
        let apex = cone.ray.origin.as_dvec3() - axis * origin;
        let start = origin + f64::from(cone.ray.t_min.max(0.0)) * length;
        Self { apex, axis, spread, origin, start, length }
    }

    /// What a cone touches of a triangle with this normal.
    fn touch(
        &self,
        cone: &Cone<Vec3A>,
        primitive: Primitive,
        triangle: &Triangle<Vec3A>,
        normal: Vec3A,
        layer: usize,
    ) -> Option<Touch> {
        let hit = cone_triangle::intersect(cone, triangle)?;
        let back = self.see_back(triangle.v0, normal).then(|| {
            let corners = <[Vec3A; 3]>::from(*triangle).map(|v| t_at(cone, v));
            let farthest = corners.into_iter().fold(hit.t, f32::max);
            self.farthest(triangle.v0, normal).map_or(farthest, |t| farthest.min(t).max(hit.t))
        });
        let (t, coverage) = (hit.t, hit.coverage);
        Some(Touch { primitive, t, coverage, layer, back, middle: None })
    }

    /// Whether they come to a point from behind.
    fn see_back(&self, point: Vec3A, normal: Vec3A) -> bool {
        let line = if self.spread > 0.0 { point.as_dvec3() - self.apex } else { self.axis };
        line.dot(normal.as_dvec3()) > 0.0
    }

    /// The greatest t at which they meet the plane through a point that faces away from them, if all do.
    #[expect(clippy::cast_possible_truncation, reason = "as a cone's t is rounded")]
    fn farthest(&self, point: Vec3A, normal: Vec3A) -> Option<f32> {
        let normal = normal.as_dvec3();
        let height = normal.dot(point.as_dvec3() - self.apex);
        let across = self.spread * normal.reject_from(self.axis).length();
        let least = normal.dot(self.axis) - across;
        (least > 0.0).then(|| ((height / least - self.origin) / self.length) as f32)
    }

    /// The ray along one of them, of length 1 to t.
    fn ray(&self, direction: DVec3) -> Option<Ray<Vec3A>> {
        let along = direction.dot(self.axis);
        let origin = self.apex + direction * (self.start / along);
        (along > 0.0).then(|| Ray::new(origin.as_vec3a(), direction.normalize().as_vec3a()))
    }

    /// The ray to the middle of what is seen of a triangle, which begins at t.
    fn to_triangle(&self, triangle: &Triangle<Vec3A>, t: f32) -> Option<Ray<Vec3A>> {
        // Eight sides around the cone, from somewhere before the triangle on.
        let base = 0.5 * (self.start + self.origin + f64::from(t) * self.length);
        let radius = self.spread * base / (PI / 8.0).cos();
        let (right, up) = self.axis.any_orthonormal_pair();
        let corners: [DVec3; 8] = array::from_fn(|i| {
            let (sine, cosine) = (i as f64 * (PI / 4.0)).sin_cos();
            self.apex + self.axis * base + (right * cosine + up * sine) * radius
        });
        let beam = Beam::new(self.apex, Polygon::<_, 8>::new(&corners)?)?;
        let corners = <[Vec3A; 3]>::from(*triangle).map(|v| v.as_dvec3());
        let seen = beam_polygon::clip(&beam, &Polygon::<_, 12>::new(&corners)?)?;
        let sum: DVec3 = seen.vertices().iter().map(|v| v - self.apex).sum();
        self.ray(sum / seen.vertices().len() as f64)
    }

    /// The middle one of those that a sphere may meet, in the plane of its centre.
    fn to_sphere(&self, center: Vec3A, radius: f32) -> DVec3 {
        let to_center = center.as_dvec3() - self.apex;
        let (distance, radius) = (to_center.length(), f64::from(radius));
        if distance <= radius {
            return self.axis;
        }
        let aside = to_center.reject_from(self.axis);
        let (angle, half) =
            (aside.length().atan2(to_center.dot(self.axis)), (radius / distance).asin());
        let end = self.spread.atan();
        let middle = 0.5 * ((angle - half).max(-end) + (angle + half).min(end));
        self.axis * middle.cos() + aside.normalize_or_zero() * middle.sin()
    }

    /// The middle one of those that go down, or the axis if all do.
    fn to_plane(&self, down: Vec3A) -> DVec3 {
        let down = down.as_dvec3().normalize();
        let aside = down.reject_from(self.axis);
        // Across the axis, in units of the radius.
        let from = -down.dot(self.axis) / (self.spread * aside.length());
        let middle = if from > -1.0 { 0.5 * (1.0 + from) } else { 0.0 };
        self.axis + aside.normalize_or_zero() * (self.spread * middle)
    }
}

/// Shares out a cone's section among what covers it, from near to far.
fn parts(touches: Vec<Touch>, layers: usize) -> Vec<Part> {
    let least = if touches.len() > MANY { SMALL } else { 0.0 };
    let mut layers = vec![Layer::default(); layers];
    let mut parts = Vec::new();
    for touch in touches {
        let coverage = touch.coverage;
        let others = layers.iter().enumerate().filter(|&(layer, _)| layer != touch.layer);
        let not_hidden: f32 = others.map(|(_, layer)| 1.0 - layer.covered).product();
        let layer = &mut layers[touch.layer];
        let hidden =
            if touch.back.is_some() { coverage.min(layer.fronts - layer.hidden) } else { 0.0 };
        if touch.back.is_none() {
            layer.fronts += coverage;
        }
        layer.hidden += hidden;
        let covered = (coverage - hidden).min(1.0 - layer.covered);
        layer.covered += covered;
        let share = covered * not_hidden + layer.waiting.map_or(0.0, |part| part.share);
        let part = Part { touch, share };
        layer.waiting = Some(part).filter(|part| part.share > 0.0);
        if layer.waiting.is_some() && share > least {
            layer.waiting = None;
            layer.last = Some(parts.len());
            parts.push(part);
        }
    }
    for Layer { waiting, last, .. } in layers {
        match (waiting, last) {
            (Some(waiting), Some(last)) => parts[last].share += waiting.share,
            (Some(waiting), None) => parts.push(waiting),
            (None, _) => {}
        }
    }
    parts
}

#[cfg(test)]
mod tests {
    use isect::{Aabb, Sphere};

    use super::*;
    use crate::accelerator::NaiveLoop;
    use crate::bvh2::Bvh2;
    use crate::mesh::{Mesh, Obj};
    use crate::scene::{Falloff, Light, SceneName};

    const LAMP: Light =
        Light { position: Vec3A::new(0.5, 8.0, 0.3), color: Color::ONE, falloff: Falloff::NONE };

    const LAMP_RADIUS: f32 = 1.5;

    /// Nothing but a lamp and what is in its way.
    fn scene(shapes: &[Shape], triangles: &[Triangle<Vec3A>]) -> Scene {
        let mut scene = SceneName::Spheres.build(Obj::icosphere(0));
        let material = scene.mesh_material;
        scene.shapes = shapes.iter().map(|&shape| (shape, material)).collect();
        scene.mesh = Mesh::of(triangles);
        scene.lights = vec![LAMP];
        scene
    }

    /// The share of the lamp's disk that a point of the floor sees, by a cone.
    fn lit(scene: &Scene, point: Vec3A, radius: f32) -> f32 {
        let triangles = scene.mesh.triangles();
        let hierarchy = Bvh2::<Exact>::new(&triangles, 16.0);
        let tracer = Tracer::new(scene, &hierarchy, 0);
        let cones = Cones::new(&tracer, Some(&hierarchy), LAMP_RADIUS);
        let surface = Surface {
            point,
            error: Vec3A::ZERO,
            normal: Vec3A::Y,
            geometric_normal: Vec3A::Y,
            shadow_point: point,
            leaving: false,
            material: &scene.mesh_material,
        };
        let ray = Ray::segment(point, LAMP.position);
        let to_light = ray.direction.normalize();
        let distance = ray.direction.length();
        let shadow = Shadow { ray, to_light, facing: to_light.y, distance };
        cones.lit(&surface, None, &shadow, radius)
    }

    /// The edge of the cells that the lamp's disk is divided in, of its radius.
    const CELL: f32 = 1.0 / 64.0;

    /// The same by a ray to each cell of the disk.
    fn sampled(scene: &Scene, point: Vec3A) -> f32 {
        let triangles = scene.mesh.triangles();
        let accelerator = NaiveLoop::<Exact>::new(&triangles);
        let axis = (LAMP.position - point).normalize();
        let (right, up) = axis.any_orthonormal_pair();
        let (mut seen, mut all) = (0.0, 0.0);
        for i in -64..64_i8 {
            for j in -64..64_i8 {
                let [x, y] = [i, j].map(|k| (f32::from(k) + 0.5) * CELL);
                if x * x + y * y <= 1.0 {
                    let at = LAMP.position + (right * x + up * y) * LAMP_RADIUS;
                    all += 1.0;
                    seen += transmittance(scene, &accelerator, &Ray::segment(point, at));
                }
            }
        }
        seen / all
    }

    #[test]
    fn soft_shadows_are_those_of_many_rays_to_the_lamp() {
        let block = Aabb::new(Vec3A::new(-1.0, 1.0, -1.0), Vec3A::new(0.3, 2.0, 0.5));
        let ball = Sphere::new(Vec3A::new(0.4, 2.0, 0.1), 0.8);
        let mesh = Obj::icosphere(3).standing(1.6, Vec3A::new(0.4, 1.2, 0.1)).triangles();
        let scenes = [
            scene(&[Shape::Sphere(ball)], &[]),
            scene(&[Shape::Box(block)], &[]),
            scene(&[], &mesh),
        ];
        let mut penumbra = 0;
        for scene in &scenes {
            for i in 0..40_u8 {
                let point = Vec3A::new(-3.0 + 0.15 * f32::from(i), 0.0, -0.2);
                let (lit, sampled) = (lit(scene, point, 0.0), sampled(scene, point));
                penumbra += u32::from(0.02 < sampled && sampled < 0.98);
                // A convex shape's outline crosses 8/CELL + 4 cells at most, and the disk's as many: they are off by half of
                // their cells, one way or the other, by chance; six deviations of the sum, of the disk's π/CELL² cells.
                let crossed = 2.0 * (8.0 / CELL + 4.0);
                let error = 3.0 * crossed.sqrt() * CELL * CELL / std::f32::consts::PI;
                assert!((lit - sampled).abs() < error, "{i}: {lit} {sampled} {error}");
            }
        }
        assert!(penumbra > 20, "{penumbra}");
    }

    #[test]
    fn a_spot_with_a_width_sees_the_mean() {
        let wall = Aabb::new(Vec3A::new(0.0, 0.5, -9.0), Vec3A::new(9.0, 0.6, 9.0));
        let scene = scene(&[Shape::Box(wall)], &[]);
        // The lamp is wider than the spot, or not; the shadow's edge goes through the middle of both.
        for radius in [0.1, LAMP_RADIUS, 2.0] {
            let ends = [-40.0, 40.0].map(|x| lit(&scene, Vec3A::new(x, 0.0, 0.3), radius));
            assert_eq!(ends, [1.0, 1.0], "{radius}");
            let shares = [-8.0_f32, -2.0, 0.0, 2.0, 8.0]
                .map(|x| lit(&scene, Vec3A::new(0.5 + 0.125 * x, 0.0, 0.3), radius));
            assert!(shares.is_sorted_by(|a, b| a >= b), "{radius}: {shares:?}");
        }
    }

    #[test]
    fn a_floor_does_not_hide_what_stands_on_it() {
        let block = Aabb::new(Vec3A::new(-1.0, 0.0, -1.0), Vec3A::new(1.0, 1.0, 0.0));
        let floor = isect::Plane { normal: Vec3A::Y, offset: 0.0 };
        let scene = scene(&[Shape::Plane(floor), Shape::Box(block)], &[]);
        let accelerator = NaiveLoop::<Exact>::new(&[]);
        let tracer = Tracer::new(&scene, &accelerator, 0);
        let cones = Cones::new(&tracer, None, 0.0);
        // At the foot of the block: the floor begins nearer and is all over the section, the block covers its upper half.
        let eye = Vec3A::new(0.1, 1.0, 5.0);
        let cone = Cone::new(Ray::new(eye, (Vec3A::X * 0.1 - eye).normalize()), 0.0, 0.02);
        let lines = Lines::new(&cone);
        let touches = cones.in_order(&lines, cones.touches(&cone, &lines, None));
        assert!(touches.iter().any(|touch| touch.layer == 0 && touch.coverage > 0.99));
        let parts = parts(touches, 4);
        let share = |is_floor: bool| -> f32 {
            let of = |part: &&Part| matches!(part.touch.primitive, Primitive::Shape(0)) == is_floor;
            parts.iter().filter(of).map(|part| part.share).sum()
        };
        assert!((share(true) - 0.5).abs() < 0.02 && (share(false) - 0.5).abs() < 0.02, "{parts:?}");
    }

    #[test]
    fn parts_add_up_to_what_is_covered() {
        let touch = |layer: usize, t: f32, coverage: f32, back: Option<f32>| Touch {
            primitive: Primitive::Shape(layer),
            t,
            coverage,
            layer,
            back,
            middle: None,
        };
        let shares = |touches: &[Touch]| -> Vec<f32> {
            let mut touches = touches.to_vec();
            touches.sort_by(|a, b| a.back.unwrap_or(a.t).total_cmp(&b.back.unwrap_or(b.t)));
            parts(touches, 3).into_iter().map(|part| part.share).collect()
        };
        // Two surfaces that do not know of each other; then one, whose parts do; then its back.
        assert_eq!(shares(&[touch(0, 1.0, 0.5, None), touch(1, 2.0, 0.5, None)]), [0.5, 0.25]);
        assert_eq!(shares(&[touch(0, 1.0, 0.5, None), touch(0, 2.0, 0.75, None)]), [0.5, 0.5]);
        assert_eq!(shares(&[touch(0, 1.5, 0.5, None), touch(0, 1.0, 0.5, Some(2.0))]), [0.5]);
        assert_eq!(
            shares(&[touch(0, 1.0, 0.25, None), touch(0, 1.0, 0.75, Some(2.0))]),
            [0.25, 0.5]
        );
        // Of many small ones some stand for all.
        let many: Vec<_> =
            (0..256_u16).map(|i| touch(2, f32::from(i), 1.0 / 256.0, None)).collect();
        let shares = shares(&many);
        assert!(shares.len() <= 32 && shares.iter().sum::<f32>() == 1.0, "{shares:?}");
    }
}
