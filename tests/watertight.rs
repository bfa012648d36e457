//! Claim: no ray slips through a closed mesh between triangles, if the kernel is the watertight or the exact one.
//!
//! Rays start inside of a mesh and are aimed at points of its edges and at its vertices, where a kernel that lets two
//! neighbours disagree loses them. The loss of the fast kernels is measured and printed
//! (`cargo test --test suite watertight -- --nocapture`).

use isect::glam::{DVec3, Vec3, Vec3A};
use isect::{Ray, Vector};

use crate::support::generators::single;
use crate::support::kernels::{TriangleKernel, triangle_kernels};
use crate::support::meshes::{Mesh, Surface, icosphere, lattice_cube, parse_obj};
use crate::support::{array, for_every_vector, name, oracle, vector};

const SEED: u64 = 1;
/// Per mesh, aim and vector type: 2,000,000 rays for each type.
const RAYS: u32 = 250_000;

/// A closed mesh, and points inside.
struct Target<V: Vector> {
    name: &'static str,
    surface: Surface<V>,
    inside: Vec<V>,
}

impl<V: Vector> Target<V> {
    fn new(name: &'static str, mesh: &Mesh, inside: &[[f64; 3]]) -> Self {
        assert!(mesh.is_closed(), "{name}");
        let inside = inside.iter().map(|&p| vector(p)).collect();
        Self { name, surface: Surface::new(mesh), inside }
    }

    /// A ray from inside towards the middle part of an edge, or towards a vertex, and a vertex close by.
    fn aimed(&self, rng: &mut fastrand::Rng, at_vertex: bool) -> (Ray<V>, usize) {
        let origin = self.inside[rng.usize(..self.inside.len())];
        let (close, target) = if at_vertex {
            self.surface.vertex(rng)
        } else {
            let ([close, _], target) = self.surface.edge_point(rng);
            (close, target)
        };
        (Ray::new(origin, target - origin), close)
    }

    /// Whether any triangle is hit.
    fn stops(&self, kernel: &TriangleKernel<V>, ray: &Ray<V>, close: usize) -> bool {
        self.surface.stops(&[close], |triangle| (kernel.intersect)(ray, triangle).is_some())
    }
}

/// Points inside of a closed mesh: a random ray from them crosses it an odd number of times, exactly.
fn points_inside(mesh: &Mesh, count: usize) -> Vec<[f64; 3]> {
    let mut rng = fastrand::Rng::with_seed(SEED);
    let bound = |f: fn(f64, f64) -> f64, axis: usize| {
        mesh.vertices.iter().map(|v| v[axis]).reduce(f).expect("a mesh has vertices")
    };
    let mut points = Vec::new();
    while points.len() < count {
        let mut random = |scale: fn(f64, f64, f64) -> f64| {
            std::array::from_fn(|axis| {
                let (low, high) = (bound(f64::min, axis), bound(f64::max, axis));
                single(scale(low, high, rng.f64()))
            })
        };
        let origin: [f64; 3] = random(|low, high, x| low + (high - low) * x);
        let direction = random(|_, _, x| x - 0.5);
        let ray = oracle::Ray { origin, direction, t_min: 0.0, t_max: f64::INFINITY };
        let verdicts: Vec<_> = mesh.triangles().map(|t| oracle::triangle(&ray, t)).collect();
        let clean = |v: &oracle::TriangleVerdict| {
            matches!(v, oracle::TriangleVerdict::Miss | oracle::TriangleVerdict::Interior)
        };
        let crossings = verdicts.iter().filter(|v| v.hits()).count();
        if verdicts.iter().all(clean) && crossings % 2 == 1 {
            points.push(origin);
        }
    }
    points
}

fn meshes() -> Vec<(&'static str, Mesh, Vec<[f64; 3]>)> {
    let bunny = parse_obj(include_str!("../examples/tracer/bunny.obj"));
    let lattice: Vec<[f64; 3]> = (1..8)
        .flat_map(|x| (1..8).flat_map(move |y| (1..8).map(move |z| [x, y, z].map(f64::from))))
        .collect();
    let mut rng = fastrand::Rng::with_seed(SEED);
    let ball: Vec<[f64; 3]> = (0..64).map(|_| [(); 3].map(|()| single(rng.f64() - 0.5))).collect();
    let inside = points_inside(&bunny, 64);
    vec![
        ("icosphere", icosphere(4), ball),
        ("bunny", bunny, inside),
        ("cube", lattice_cube(8), lattice.clone()),
        // Away from the origin, where coordinates have few bits left for the shape.
        (
            "far cube",
            lattice_cube(8).moved([1e6; 3]),
            lattice.iter().map(|p| p.map(|x| x + 1e6)).collect(),
        ),
    ]
}

fn check<V: Vector>(meshes: &[(&'static str, Mesh, Vec<[f64; 3]>)]) {
    for (mesh_name, mesh, inside) in meshes {
        let target = Target::<V>::new(mesh_name, mesh, inside);
        for kernel in triangle_kernels::<V>() {
            let [at_edges, at_vertices] = [false, true].map(|at_vertex| {
                let mut rng = fastrand::Rng::with_seed(SEED);
                let mut lost = 0;
                for _ in 0..RAYS {
                    let (ray, close) = target.aimed(&mut rng, at_vertex);
                    if !target.stops(&kernel, &ray, close) {
                        lost += 1;
                        assert!(
                            !["watertight", "exact"].contains(&kernel.name),
                            "{}: lost {:?} -> {:?}",
                            target.name,
                            array(ray.origin),
                            array(ray.direction)
                        );
                    }
                }
                100.0 * f64::from(lost) / f64::from(RAYS)
            });
            println!(
                "{:<6} {:<10} {:<16} lost {at_edges:7.3} % at edges, {at_vertices:7.3} % at vertices, of {RAYS} each",
                name::<V>(),
                target.name,
                kernel.name,
            );
        }
    }
}

#[test]
fn no_ray_leaves_a_closed_mesh() {
    let meshes = meshes();
    for_every_vector!(check, &meshes);
}

/// The zero above would not be worth much if a kernel that may lose rays did not lose any.
#[test]
fn the_aim_is_good_enough_to_see_leaks() {
    fn losses<V: Vector>() -> usize {
        let target = Target::<V>::new(
            "icosphere",
            &icosphere(4),
            &[[0.1, 0.2, 0.3], [-0.3, 0.1, 0.2]].map(|p: [f64; 3]| p.map(single)),
        );
        let [kernel, ..] = triangle_kernels::<V>();
        let mut rng = fastrand::Rng::with_seed(SEED);
        (0..20_000)
            .filter(|_| {
                let (ray, close) = target.aimed(&mut rng, false);
                !target.stops(&kernel, &ray, close)
            })
            .count()
    }
    assert!(losses::<Vec3>() > 100 && losses::<Vec3A>() > 100 && losses::<DVec3>() > 100);
}
