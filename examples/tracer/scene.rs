//! What there is to see: shapes, materials, lights, a sky; and the scenes of `--scene`.

use clap::ValueEnum;
use isect::glam::{Vec3, Vec3A};
use isect::ray::plane::PlaneHit;
use isect::{Aabb, Plane, Ray, Sphere};

use crate::camera::View;
use crate::mesh::{Mesh, Obj};

/// Linear red, green and blue.
pub(crate) type Color = Vec3;

/// A shape other than the mesh.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Shape {
    Sphere(Sphere<Vec3A>),
    Box(Aabb<Vec3A>),
    Plane(Plane<Vec3A>),
}

/// Where a ray meets a [`Shape`].
#[derive(Clone, Copy, Debug)]
pub(crate) struct ShapeHit {
    /// The ray's parameter.
    pub(crate) t: f32,
    /// The point, and by how much it may be off.
    pub(crate) point_and_error: (Vec3A, Vec3A),
    /// The outward normal, of any length.
    pub(crate) normal: Vec3A,
    /// Whether the ray comes from inside.
    pub(crate) leaving: bool,
}

impl Shape {
    /// The closest hit in the ray's range, with isect's recommended kernels.
    pub(crate) fn intersect(&self, ray: &Ray<Vec3A>) -> Option<ShapeHit> {
        match self {
            Self::Sphere(sphere) => {
                let hit = ray.intersect(sphere)?;
                let point_and_error = hit.point_and_error(ray, sphere);
                Some(ShapeHit {
                    t: hit.t,
                    point_and_error,
                    normal: sphere.normal_at(point_and_error.0),
                    leaving: hit.leaving,
                })
            }
            Self::Box(aabb) => {
                let hit = ray.intersect(aabb)?;
                let (t, face) = hit.surface()?;
                Some(ShapeHit {
                    t,
                    point_and_error: hit.point_and_error(ray, aabb)?,
                    normal: face.normal(),
                    leaving: hit.enter_face.is_none(),
                })
            }
            Self::Plane(plane) => {
                let hit = ray.intersect(plane)?;
                // Seen edge-on there is nothing to see.
                let PlaneHit::At(t) = hit else { return None };
                Some(ShapeHit {
                    t,
                    point_and_error: hit.point_and_error(ray, plane)?,
                    normal: plane.normal,
                    leaving: plane.normal.dot(ray.direction) > 0.0,
                })
            }
        }
    }

    /// Whether there is a hit in the ray's range.
    pub(crate) fn hits(&self, ray: &Ray<Vec3A>) -> bool {
        match self {
            Self::Sphere(sphere) => ray.hits(sphere),
            Self::Box(aabb) => ray.intersect(aabb).is_some_and(|hit| hit.surface().is_some()),
            Self::Plane(plane) => matches!(ray.intersect(plane), Some(PlaneHit::At(_))),
        }
    }

    /// The greatest coordinate of a shape that has bounds, else 0.
    fn extent(&self) -> f32 {
        let bounds = match self {
            Self::Sphere(sphere) => sphere.aabb(),
            Self::Box(aabb) => *aabb,
            Self::Plane(_) => return 0.0,
        };
        extent(&bounds)
    }
}

/// The greatest coordinate of a box, 0 for an empty one.
fn extent(aabb: &Aabb<Vec3A>) -> f32 {
    if aabb.is_empty() {
        return 0.0;
    }
    aabb.min.abs().max(aabb.max.abs()).max_element()
}

/// How the colour varies over a surface.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Paint {
    Plain(Color),
    /// Squares of edge 1 on the horizontal plane, which fade into each other with the distance from
    /// the origin, before they are smaller than pixels.
    Checkers([Color; 2]),
}

impl Paint {
    /// The colour at a point.
    pub(crate) fn at(&self, point: Vec3A) -> Color {
        match *self {
            Self::Plain(color) => color,
            Self::Checkers([even, odd]) => {
                let is_odd = (point.x.floor() + point.z.floor()).rem_euclid(2.0) >= 1.0;
                let distance = point.x.hypot(point.z) / 14.0;
                let contrast = 0.5 / (1.0 + distance * distance);
                even.lerp(odd, if is_odd { 0.5 + contrast } else { 0.5 - contrast })
            }
        }
    }
}

/// The refractive indices on both sides of a surface.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Interface {
    pub(crate) inside: f32,
    pub(crate) outside: f32,
}

/// What a surface does with light: the constants of Phong (1975) and Whitted (1980).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Material {
    pub(crate) paint: Paint,
    /// `k_a` and `k_d`, the share of the ambient and of the direct light that is scattered.
    pub(crate) diffuse: f32,
    /// `k_s`, the strength of the highlights.
    pub(crate) specular: f32,
    /// n, their sharpness.
    pub(crate) shininess: f32,
    /// `k_m`, the share of the mirrored light for a surface seen from straight above.
    pub(crate) mirror: f32,
    /// What a transparent surface lies between; Fresnel's equations share out the light.
    pub(crate) transparent: Option<Interface>,
}

impl Material {
    /// Paint with a soft sheen.
    const fn painted(paint: Paint) -> Self {
        Self { paint, diffuse: 1.0, specular: 0.2, shininess: 30.0, mirror: 0.0, transparent: None }
    }

    /// Polished metal.
    const fn mirror(tint: Color) -> Self {
        Self {
            paint: Paint::Plain(tint),
            diffuse: 0.06,
            specular: 0.9,
            shininess: 300.0,
            mirror: 0.9,
            transparent: None,
        }
    }

    /// A clear medium.
    const fn transparent(inside: f32, outside: f32) -> Self {
        Self {
            paint: Paint::Plain(Color::ONE),
            diffuse: 0.0,
            specular: 0.9,
            shininess: 300.0,
            mirror: 0.0,
            transparent: Some(Interface { inside, outside }),
        }
    }

    const GLASS: Self = Self::transparent(1.5, 1.0);
}

/// A point light, `I_p`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Light {
    pub(crate) position: Vec3A,
    pub(crate) color: Color,
}

/// Everything that is rendered.
#[derive(Debug)]
pub(crate) struct Scene {
    pub(crate) view: View,
    pub(crate) mesh: Mesh,
    pub(crate) mesh_material: Material,
    pub(crate) shapes: Vec<(Shape, Material)>,
    pub(crate) lights: Vec<Light>,
}

/// The scenes to choose from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum SceneName {
    /// A mesh among a glass sphere, a mirror and a box
    Showcase,
    /// The mesh alone
    Mesh,
    /// After Whitted's picture: a hollow glass sphere before a mirror
    Spheres,
}

impl SceneName {
    /// Whether there is a place for a mesh in it.
    pub(crate) fn has_mesh(self) -> bool {
        self != Self::Spheres
    }

    /// The scene, around `obj` where it has a mesh.
    pub(crate) fn build(self, obj: Obj) -> Scene {
        match self {
            Self::Showcase => showcase(obj),
            Self::Mesh => mesh(obj),
            Self::Spheres => spheres(),
        }
    }
}

impl Scene {
    /// The greatest coordinate of the eye and of all that has bounds.
    pub(crate) fn extent(&self) -> f32 {
        let shapes = self.shapes.iter().map(|(shape, _)| shape.extent());
        shapes
            .chain([extent(&self.mesh.bounds()), self.view.from.abs().max_element()])
            .fold(0.0, f32::max)
    }

    /// What a ray sees that hits nothing.
    #[expect(clippy::unused_self, reason = "a sky belongs to its scene")]
    pub(crate) fn sky(&self, direction: Vec3A) -> Color {
        let height = direction.y.max(0.0).sqrt();
        Color::new(0.72, 0.80, 0.88).lerp(Color::new(0.05, 0.16, 0.46), height)
    }

    /// `I_a`: the light from all around at a surface that faces along `normal`, from the sky or back
    /// from the floor.
    pub(crate) fn ambient(&self, normal: Vec3A) -> Color {
        let below = Color::new(0.11, 0.10, 0.09);
        let above = Color::new(0.17, 0.21, 0.27);
        below.lerp(above, 0.5 + 0.5 * normal.y)
    }
}

/// The floor y = 0.
fn floor() -> (Shape, Material) {
    let plane = Plane { normal: Vec3A::Y, offset: 0.0 };
    let paint = Paint::Checkers([Color::new(0.74, 0.70, 0.64), Color::new(0.16, 0.17, 0.21)]);
    let material = Material { mirror: 0.04, ..Material::painted(paint) };
    (Shape::Plane(plane), material)
}

/// A sphere that touches the floor.
fn ball(x: f32, z: f32, radius: f32) -> Shape {
    Shape::Sphere(Sphere::new(Vec3A::new(x, radius, z), radius))
}

/// A warm light from the left and a weak cool one from the right, so far off that the floor is lit up
/// to the horizon.
fn lights() -> Vec<Light> {
    vec![
        Light { position: Vec3A::new(-84.0, 120.0, 60.0), color: Color::new(0.86, 0.80, 0.69) },
        Light { position: Vec3A::new(90.0, 70.0, 50.0), color: Color::new(0.10, 0.12, 0.16) },
    ]
}

/// The matt material of a mesh.
fn clay() -> Material {
    Material::painted(Paint::Plain(Color::new(0.78, 0.40, 0.20)))
}

fn showcase(obj: Obj) -> Scene {
    let block = Aabb::new(Vec3A::new(-3.1, 0.0, -1.6), Vec3A::new(-1.8, 1.3, -0.3));
    let teal = Paint::Plain(Color::new(0.04, 0.30, 0.34));
    Scene {
        view: View {
            from: Vec3A::new(0.4, 2.3, 7.8),
            at: Vec3A::new(0.1, 0.98, 0.0),
            field_of_view: 27.0,
        },
        mesh: obj.standing(2.3, Vec3A::new(-0.35, 0.0, 0.2)),
        mesh_material: clay(),
        shapes: vec![
            floor(),
            (Shape::Box(block), Material::painted(teal)),
            (ball(1.95, -1.2, 1.15), Material::mirror(Color::new(0.95, 0.96, 1.0))),
            (ball(1.15, 1.75, 0.58), Material::GLASS),
        ],
        lights: lights(),
    }
}

fn mesh(obj: Obj) -> Scene {
    let mesh = obj.standing(2.5, Vec3A::ZERO);
    let bounds = mesh.bounds();
    let field_of_view = 30.0_f32;
    // The ball around the mesh fills the picture's height.
    let radius = bounds.size().length() / 2.0;
    let distance = radius / (field_of_view / 2.0).to_radians().sin();
    let at = bounds.center();
    Scene {
        view: View {
            from: at + Vec3A::new(0.35, 0.35, 1.0).normalize() * distance,
            at,
            field_of_view,
        },
        mesh,
        mesh_material: clay(),
        shapes: vec![floor()],
        lights: lights(),
    }
}

fn spheres() -> Scene {
    let bubble = Sphere::new(Vec3A::new(-0.55, 1.25, 1.6), 0.85);
    let hollow = Sphere { radius: 0.68, ..bubble };
    let red = Paint::Plain(Color::new(0.62, 0.08, 0.06));
    Scene {
        view: View {
            from: Vec3A::new(0.0, 1.9, 8.0),
            at: Vec3A::new(0.1, 1.05, 0.0),
            field_of_view: 28.0,
        },
        mesh: Mesh::default(),
        mesh_material: clay(),
        shapes: vec![
            floor(),
            (Shape::Sphere(bubble), Material::GLASS),
            (Shape::Sphere(hollow), Material::transparent(1.0, 1.5)),
            (ball(0.95, -0.4, 1.05), Material::mirror(Color::new(0.95, 0.96, 1.0))),
            (ball(-2.2, -0.9, 0.7), Material::painted(red)),
        ],
        lights: lights(),
    }
}
