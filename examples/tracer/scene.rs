//! What there is to see: shapes, materials, lights, a sky; and the scenes of `--scene`.

use clap::ValueEnum;
use isect::glam::{Vec3, Vec3A};
use isect::ray::plane::PlaneHit;
use isect::{Aabb, Plane, Polygon, Ray, Sphere};

use crate::camera::View;
use crate::fog::Fog;
use crate::mesh::{Mesh, Obj};
use crate::paint::Paint;

/// Linear red, green and blue.
pub(crate) type Color = Vec3;

/// A shape other than the mesh.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Shape {
    Sphere(Sphere<Vec3A>),
    Box(Aabb<Vec3A>),
    Plane(Plane<Vec3A>),
    Polygon(Polygon<Vec3A, 4>),
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
            Self::Polygon(polygon) => {
                let hit = ray.intersect(polygon)?;
                Some(ShapeHit {
                    t: hit.t,
                    point_and_error: hit.point_and_error(polygon),
                    normal: polygon.normal(),
                    leaving: !hit.front,
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
            Self::Polygon(polygon) => ray.hits(polygon),
        }
    }

    /// The greatest coordinate of a shape that has bounds, else 0.
    fn extent(&self) -> f32 {
        let bounds = match self {
            Self::Sphere(sphere) => sphere.aabb(),
            Self::Box(aabb) => *aabb,
            Self::Plane(_) => return 0.0,
            Self::Polygon(polygon) => polygon.aabb(),
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

/// The refractive indices on both sides of a surface.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Interface {
    pub(crate) inside: f32,
    pub(crate) outside: f32,
}

impl Interface {
    /// η, the index on a ray's side over that on the other.
    pub(crate) fn eta(&self, leaving: bool) -> f32 {
        if leaving { self.inside / self.outside } else { self.outside / self.inside }
    }
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
    /// The share of the mirrored light for a surface seen from straight above; Schlick's equation has the rest.
    pub(crate) mirror: f32,
    /// What a transparent surface lies between; Fresnel's equations share out the light.
    pub(crate) transparent: Option<Interface>,
    /// Whitted's constants in the place of both equations.
    pub(crate) shares: Option<Shares>,
}

/// What a surface does with light whatever its angle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Shares {
    /// `k_m`, of the mirrored light.
    pub(crate) reflected: f32,
    /// `k_t`, of the refracted light, for a transparent surface.
    pub(crate) transmitted: f32,
}

impl Material {
    /// Paint with a soft sheen.
    const fn painted(paint: Paint) -> Self {
        Self {
            paint,
            diffuse: 1.0,
            specular: 0.2,
            shininess: 30.0,
            mirror: 0.0,
            transparent: None,
            shares: None,
        }
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
            shares: None,
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
            shares: None,
        }
    }

    const GLASS: Self = Self::transparent(1.5, 1.0);

    /// Whether it mirrors light.
    pub(crate) fn is_mirror(&self) -> bool {
        self.mirror > 0.0 || self.shares.is_some_and(|shares| shares.reflected > 0.0)
    }
}

/// A point light, `I_p`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Light {
    pub(crate) position: Vec3A,
    pub(crate) color: Color,
    pub(crate) falloff: Falloff,
}

/// How a light weakens with the distance, f(d) = 1 / (c₀ + c₁·d + c₂·d²).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Falloff([f32; 3]);

impl Falloff {
    /// Not at all, as if it were very far away.
    pub(crate) const NONE: Self = Self([1.0, 0.0, 0.0]);
    /// f(d) = 1 / d², as of a small lamp.
    pub(crate) const INVERSE_SQUARE: Self = Self([0.0, 0.0, 1.0]);

    /// f(d); d > 0.
    pub(crate) fn at(&self, distance: f32) -> f32 {
        let [constant, linear, quadratic] = self.0;
        1.0 / (constant + distance * (linear + distance * quadratic))
    }
}

/// The light from all around.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sky {
    /// What a ray sees of it, from the horizon up.
    seen: [Color; 2],
    /// What comes from it to a surface that looks down at the lit floor, and to one that looks up.
    shed: [Color; 2],
}

impl Sky {
    const DAY: Self = Self {
        seen: [Color::new(0.72, 0.80, 0.88), Color::new(0.05, 0.16, 0.46)],
        shed: [Color::new(0.11, 0.10, 0.09), Color::new(0.17, 0.21, 0.27)],
    };
    const NIGHT: Self = Self {
        seen: [Color::new(0.012, 0.014, 0.024), Color::new(0.002, 0.003, 0.008)],
        shed: [Color::new(0.008, 0.008, 0.008), Color::new(0.014, 0.016, 0.024)],
    };
}

/// Everything that is rendered.
#[derive(Debug)]
pub(crate) struct Scene {
    pub(crate) view: View,
    pub(crate) mesh: Mesh,
    pub(crate) mesh_material: Material,
    pub(crate) shapes: Vec<(Shape, Material)>,
    pub(crate) lights: Vec<Light>,
    pub(crate) sky: Sky,
    pub(crate) fog: Fog,
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
    /// Spheres that mirror and let through constant shares of the light
    Shares,
    /// Marble, wood and a block of cubes
    Textures,
    /// Lamps in the night whose light weakens with the distance
    Lamps,
    /// What is hard to sample: a floor of small squares, thin posts, the mesh and a mirror
    Edges,
    /// A room of polygons with mirrors, also for beams
    Polygons,
}

impl SceneName {
    /// Whether there is a place for a mesh in it.
    pub(crate) fn has_mesh(self) -> bool {
        matches!(self, Self::Showcase | Self::Mesh | Self::Edges)
    }

    /// The scene, around `obj` where it has a mesh.
    pub(crate) fn build(self, obj: Obj) -> Scene {
        match self {
            Self::Showcase => showcase(obj),
            Self::Mesh => mesh(obj),
            Self::Spheres => spheres(),
            Self::Shares => shares(),
            Self::Textures => textures(),
            Self::Lamps => lamps(),
            Self::Edges => edges(obj),
            Self::Polygons => polygons(),
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
    pub(crate) fn sky(&self, direction: Vec3A) -> Color {
        let [horizon, zenith] = self.sky.seen;
        horizon.lerp(zenith, direction.y.max(0.0).sqrt())
    }

    /// The colour of the sky where it meets the floor.
    pub(crate) fn horizon(&self) -> Color {
        self.sky.seen[0]
    }

    /// `I_a`: the light from all around at a surface that faces along `normal`, from the sky or back
    /// from the floor.
    pub(crate) fn ambient(&self, normal: Vec3A) -> Color {
        let [below, above] = self.sky.shed;
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
        Light {
            position: Vec3A::new(-84.0, 120.0, 60.0),
            color: Color::new(0.86, 0.80, 0.69),
            falloff: Falloff::NONE,
        },
        Light {
            position: Vec3A::new(90.0, 70.0, 50.0),
            color: Color::new(0.10, 0.12, 0.16),
            falloff: Falloff::NONE,
        },
    ]
}

/// The matt material of a mesh.
fn clay() -> Material {
    Material::painted(Paint::Plain(Color::new(0.78, 0.40, 0.20)))
}

/// Nothing, in clear daylight.
fn by_day() -> Scene {
    Scene {
        view: View { from: Vec3A::Z, at: Vec3A::ZERO, field_of_view: 30.0 },
        mesh: Mesh::default(),
        mesh_material: clay(),
        shapes: Vec::new(),
        lights: lights(),
        sky: Sky::DAY,
        fog: Fog::None,
    }
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
        shapes: vec![
            floor(),
            (Shape::Box(block), Material::painted(teal)),
            (ball(1.95, -1.2, 1.15), Material::mirror(Color::new(0.95, 0.96, 1.0))),
            (ball(1.15, 1.75, 0.58), Material::GLASS),
        ],
        ..by_day()
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
        shapes: vec![floor()],
        ..by_day()
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
        shapes: vec![
            floor(),
            (Shape::Sphere(bubble), Material::GLASS),
            (Shape::Sphere(hollow), Material::transparent(1.0, 1.5)),
            (ball(0.95, -0.4, 1.05), Material::mirror(Color::new(0.95, 0.96, 1.0))),
            (ball(-2.2, -0.9, 0.7), Material::painted(red)),
        ],
        ..by_day()
    }
}

fn shares() -> Scene {
    let painted = Material::painted(Paint::Plain(Color::new(0.62, 0.08, 0.06)));
    let mirror = |reflected| Material {
        shares: Some(Shares { reflected, transmitted: 0.0 }),
        diffuse: 1.0 - reflected,
        ..painted
    };
    let glass = |reflected, transmitted| Material {
        shares: Some(Shares { reflected, transmitted }),
        ..Material::GLASS
    };
    let materials =
        [mirror(0.0), mirror(0.3), mirror(0.8), glass(0.0, 0.4), glass(0.1, 0.9), Material::GLASS];
    let balls = [-2.5_f32, -1.5, -0.5, 0.5, 1.5, 2.5].map(|x| ball(x, -0.1 * x * x, 0.46));
    let mut shapes = vec![floor()];
    shapes.extend(balls.into_iter().zip(materials));
    Scene {
        view: View {
            from: Vec3A::new(0.0, 1.5, 8.0),
            at: Vec3A::new(0.0, 0.45, 0.0),
            field_of_view: 23.0,
        },
        shapes,
        ..by_day()
    }
}

fn textures() -> Scene {
    let marble = Paint::Marble {
        colors: [Color::new(0.80, 0.78, 0.74), Color::new(0.10, 0.13, 0.16)],
        layers: 0.9,
    };
    let wood = Paint::Wood {
        colors: [Color::new(0.56, 0.33, 0.14), Color::new(0.27, 0.12, 0.04)],
        rings: 5.0,
    };
    let cubes = Paint::Cubes {
        colors: [Color::new(0.72, 0.12, 0.08), Color::new(0.80, 0.76, 0.66)],
        edge: 0.3,
    };
    let block = Aabb::new(Vec3A::new(-0.75, 0.0, -1.3), Vec3A::new(0.75, 1.9, 0.3));
    let varnished = |paint| Material { mirror: 0.04, ..Material::painted(paint) };
    Scene {
        view: View {
            from: Vec3A::new(1.1, 2.6, 8.0),
            at: Vec3A::new(0.0, 0.85, 0.0),
            field_of_view: 26.0,
        },
        shapes: vec![
            floor(),
            (ball(-1.9, 0.2, 1.0), varnished(marble)),
            (Shape::Box(block), varnished(wood)),
            (ball(1.8, 0.3, 0.9), Material::painted(cubes)),
        ],
        ..by_day()
    }
}

fn lamps() -> Scene {
    let white = Material::painted(Paint::Plain(Color::splat(0.75)));
    let plane = Plane { normal: Vec3A::Y, offset: 0.0 };
    let post = Aabb::new(Vec3A::new(-0.25, 0.0, -0.25), Vec3A::new(0.25, 1.6, 0.25));
    let lamp =
        |x, height, z, color, falloff| Light { position: Vec3A::new(x, height, z), color, falloff };
    Scene {
        view: View {
            from: Vec3A::new(0.0, 4.2, 9.0),
            at: Vec3A::new(0.0, 0.5, 0.0),
            field_of_view: 30.0,
        },
        shapes: vec![
            (Shape::Plane(plane), white),
            (Shape::Box(post), white),
            (ball(-2.6, -0.6, 0.6), white),
            (ball(2.6, -0.6, 0.6), white),
        ],
        lights: vec![
            lamp(-1.5, 1.2, 0.6, Color::new(1.3, 0.55, 0.18), Falloff::INVERSE_SQUARE),
            lamp(1.5, 1.2, 0.6, Color::new(0.25, 0.6, 1.3), Falloff::INVERSE_SQUARE),
            lamp(0.0, 2.4, -3.0, Color::new(0.5, 0.9, 0.4), Falloff([1.0, 0.7, 0.0])),
        ],
        sky: Sky::NIGHT,
        ..by_day()
    }
}

fn edges(obj: Obj) -> Scene {
    let ink = [Color::splat(0.85), Color::splat(0.04)];
    let plane = Plane { normal: Vec3A::Y, offset: 0.0 };
    let floor = Material::painted(Paint::Cubes { colors: ink, edge: 0.4 });
    let post = Material::painted(Paint::Plain(Color::splat(0.03)));
    let mut shapes = vec![
        (Shape::Plane(plane), floor),
        (ball(1.6, -0.6, 0.9), Material::mirror(Color::new(0.95, 0.96, 1.0))),
    ];
    // In a picture of 180 rows they are a quarter of a pixel to a whole one wide.
    shapes.extend((0..12_u8).map(|index| {
        let index = f32::from(index);
        let foot = Vec3A::new(-2.9 + 0.4 * index, 0.0, -2.6);
        let half = 0.003 + 0.001 * index;
        let top = Vec3A::new(0.0, 2.7, 0.0);
        let aabb =
            Aabb::new(foot - Vec3A::new(half, 0.0, half), foot + top + Vec3A::new(half, 0.0, half));
        (Shape::Box(aabb), post)
    }));
    Scene {
        view: View {
            from: Vec3A::new(0.1, 1.5, 7.0),
            at: Vec3A::new(0.0, 1.05, 0.0),
            field_of_view: 28.0,
        },
        mesh: obj.standing(1.9, Vec3A::new(-0.9, 0.0, 0.2)),
        shapes,
        ..by_day()
    }
}

/// A polygon of three or four corners.
fn face(corners: &[[f32; 3]]) -> Shape {
    let corners: Vec<_> = corners.iter().copied().map(Vec3A::from_array).collect();
    Shape::Polygon(Polygon::new(&corners).expect("it has four corners at most"))
}

/// The walls and the top of a block that stands on the floor, turned by an angle.
fn block([x, z]: [f32; 2], half: f32, height: f32, angle: f32) -> [Shape; 5] {
    let corner = |quarter: u8| {
        let (sin, cos) = (angle + f32::from(quarter) * std::f32::consts::FRAC_PI_2).sin_cos();
        [x + half * cos, z + half * sin]
    };
    let at = |quarter: u8, y: f32| {
        let [x, z] = corner(quarter % 4);
        [x, y, z]
    };
    let wall = |quarter: u8| {
        let next = quarter + 1;
        face(&[at(quarter, 0.0), at(quarter, height), at(next, height), at(next, 0.0)])
    };
    [wall(0), wall(1), wall(2), wall(3), face(&[3, 2, 1, 0].map(|quarter| at(quarter, height)))]
}

/// A pyramid on four corners of a floor at a height.
fn spire([x, z]: [f32; 2], half: f32, [foot, top]: [f32; 2]) -> [Shape; 4] {
    let corners = [[-half, -half], [half, -half], [half, half], [-half, half]];
    let corners = corners.map(|[dx, dz]| [x + dx, foot, z + dz]);
    [0, 1, 2, 3].map(|i: usize| face(&[corners[i], [x, top, z], corners[(i + 1) % 4]]))
}

fn polygons() -> Scene {
    let plain = |r, g, b| Material::painted(Paint::Plain(Color::new(r, g, b)));
    let checkers = Paint::Checkers([Color::new(0.74, 0.70, 0.64), Color::new(0.16, 0.17, 0.21)]);
    let mirror = Material::mirror(Color::new(0.93, 0.95, 1.0));
    // The room is open towards the eye and above: the sky is seen in the mirrors, too.
    let mut shapes = vec![
        (
            face(&[[-4.0, 0.0, -3.0], [-4.0, 0.0, 5.0], [4.0, 0.0, 5.0], [4.0, 0.0, -3.0]]),
            Material::painted(checkers),
        ),
        (
            face(&[[-4.0, 0.0, -3.0], [4.0, 0.0, -3.0], [4.0, 3.2, -3.0], [-4.0, 3.2, -3.0]]),
            plain(0.66, 0.62, 0.54),
        ),
        (
            face(&[[-4.0, 0.0, 5.0], [-4.0, 0.0, -3.0], [-4.0, 3.2, -3.0], [-4.0, 3.2, 5.0]]),
            plain(0.44, 0.16, 0.12),
        ),
        // One mirror hangs on the back wall, one leans in the room, and they see each other.
        (face(&[[-1.6, 0.5, -2.9], [2.2, 0.5, -2.9], [2.2, 2.7, -2.9], [-1.6, 2.7, -2.9]]), mirror),
        (face(&[[3.4, 0.0, 0.4], [2.6, 0.0, -2.2], [3.0, 2.4, -2.4], [3.8, 2.4, 0.2]]), mirror),
    ];
    shapes
        .extend(block([-1.5, -0.2], 0.75, 1.1, 0.35).map(|shape| (shape, plain(0.10, 0.36, 0.40))));
    shapes.extend(block([0.7, 0.6], 0.6, 0.5, 1.0).map(|shape| (shape, plain(0.72, 0.44, 0.16))));
    shapes.extend(spire([0.7, 0.6], 0.3, [0.5, 1.3]).map(|shape| (shape, plain(0.62, 0.60, 0.20))));
    Scene {
        view: View {
            from: Vec3A::new(-0.6, 2.1, 7.4),
            at: Vec3A::new(0.1, 1.1, 0.0),
            field_of_view: 32.0,
        },
        shapes,
        ..by_day()
    }
}
