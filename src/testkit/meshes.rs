//! Triangle meshes for watertightness tests: closed, but for one with a square for its rim.

use std::collections::{BTreeSet, HashMap, HashSet};

use super::shapes::{scalar, vector};
use crate::{Triangle, Vector};

/// Indexed triangles, counter-clockwise as seen from outside; every coordinate is a single-precision value.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// The positions.
    pub vertices: Vec<[f64; 3]>,
    /// Three indices into `vertices` each.
    pub faces: Vec<[u32; 3]>,
}

impl Mesh {
    /// The corners of every face.
    pub fn triangles(&self) -> impl Iterator<Item = [[f64; 3]; 3]> {
        self.faces.iter().map(|face| face.map(|k| self.vertices[k as usize]))
    }

    /// Every undirected edge once, as the smaller and the larger index, in order.
    #[must_use]
    pub fn edges(&self) -> Vec<[u32; 2]> {
        let ordered = self.directed_edges().map(|[a, b]| [a.min(b), a.max(b)]);
        ordered.collect::<BTreeSet<_>>().into_iter().collect()
    }

    /// Whether the mesh bounds a volume consistently: each directed edge occurs once, and so does its reverse.
    #[must_use]
    pub fn is_closed(&self) -> bool {
        let edges: HashSet<_> = self.directed_edges().collect();
        !edges.is_empty()
            && edges.len() == 3 * self.faces.len()
            && edges.iter().all(|&[a, b]| a != b && edges.contains(&[b, a]))
    }

    /// The same faces elsewhere, the vertices rounded to single precision there.
    #[must_use]
    pub fn moved(&self, by: [f64; 3]) -> Self {
        let vertices = self.vertices.iter().map(|v| std::array::from_fn(|k| single(v[k] + by[k])));
        Self { vertices: vertices.collect(), faces: self.faces.clone() }
    }

    fn directed_edges(&self) -> impl Iterator<Item = [u32; 2]> {
        self.faces.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]])
    }

    /// The index of the next vertex to be added.
    fn next_index(&self) -> u32 {
        u32::try_from(self.vertices.len()).expect("fewer than 2^32 vertices")
    }
}

/// A mesh as triangles of a vector type, which knows the triangles around each vertex: those that a ray at a vertex or an
/// edge is likely to hit are tried first.
///
/// ```
/// use isect::glam::Vec3;
/// use isect::ray::triangle::watertight::{self, ShearedRay};
/// use isect::testkit::meshes::{Surface, icosphere};
/// use isect::{Ray, testkit::Rng};
///
/// let surface = Surface::<Vec3>::new(&icosphere(2));
/// let mut rng = Rng::with_seed(1);
/// for _ in 0..1000 {
///     let ([a, b], target) = surface.edge_point(&mut rng);
///     let ray = ShearedRay::new(&Ray::new(Vec3::new(0.1, 0.2, 0.3), target - Vec3::new(0.1, 0.2, 0.3)));
///     assert!(surface.stops(&[a, b], |triangle| watertight::intersect(&ray, triangle).is_some()));
/// }
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Surface<V: Vector> {
    /// In the order of the mesh's faces.
    pub triangles: Vec<Triangle<V>>,
    /// The positions.
    pub vertices: Vec<V>,
    /// Every edge once, by the indices of its vertices.
    pub edges: Vec<[usize; 2]>,
    /// By vertex, the indices of the triangles around it.
    pub around: Vec<Vec<usize>>,
}

impl<V: Vector> Surface<V> {
    /// The surface of a mesh, its coordinates rounded to the vector type.
    #[must_use]
    pub fn new(mesh: &Mesh) -> Self {
        let mut around = vec![Vec::new(); mesh.vertices.len()];
        for (index, face) in mesh.faces.iter().enumerate() {
            for &vertex in face {
                around[vertex as usize].push(index);
            }
        }
        Self {
            triangles: mesh.triangles().map(|t| t.map(vector).into()).collect(),
            vertices: mesh.vertices.iter().map(|&p| vector(p)).collect(),
            edges: mesh.edges().into_iter().map(|edge| edge.map(|v| v as usize)).collect(),
            around,
        }
    }

    /// Whether any triangle is hit. Those around some vertices are tried first.
    pub fn stops(&self, near: &[usize], mut is_hit: impl FnMut(&Triangle<V>) -> bool) -> bool {
        near.iter().flat_map(|&v| &self.around[v]).any(|&k| is_hit(&self.triangles[k]))
            || self.triangles.iter().any(is_hit)
    }

    /// A random vertex.
    pub fn vertex(&self, rng: &mut fastrand::Rng) -> (usize, V) {
        let vertex = rng.usize(..self.vertices.len());
        (vertex, self.vertices[vertex])
    }

    /// The ends of a random edge, and one of 63 points that part it equally, rounded.
    pub fn edge_point(&self, rng: &mut fastrand::Rng) -> ([usize; 2], V) {
        let edge = self.edges[rng.usize(..self.edges.len())];
        let [a, b] = edge.map(|v| self.vertices[v]);
        let weight = scalar(f64::from(rng.u32(1..64)) / 64.0);
        (edge, a + (b - a) * weight)
    }
}

/// A unit sphere about the origin: an icosahedron of which each face is split in four so many times.
#[must_use]
pub fn icosphere(subdivisions: u32) -> Mesh {
    let golden = f64::midpoint(1.0, 5f64.sqrt());
    // The vertices are the corners of three golden rectangles.
    let mut vertices = Vec::new();
    for axis in 0..3 {
        for (short, long) in [(-1.0, golden), (1.0, golden), (-1.0, -golden), (1.0, -golden)] {
            let mut vertex = [0.0; 3];
            vertex[axis] = short;
            vertex[(axis + 1) % 3] = long;
            vertices.push(on_unit_sphere(vertex));
        }
    }
    let mut mesh = Mesh { vertices, faces: ICOSAHEDRON.to_vec() };
    for _ in 0..subdivisions {
        mesh = subdivided(mesh);
    }
    mesh
}

/// The faces over the golden rectangles of [`icosphere`].
#[rustfmt::skip]
const ICOSAHEDRON: [[u32; 3]; 20] = [
    [0, 5, 1], [0, 1, 7], [0, 11, 5], [0, 7, 10],
    [0, 10, 11], [1, 5, 9], [1, 8, 7], [1, 9, 8],
    [2, 3, 4], [2, 6, 3], [2, 4, 11], [2, 10, 6],
    [2, 11, 10], [3, 9, 4], [3, 6, 8], [3, 8, 9],
    [4, 9, 5], [4, 5, 11], [6, 7, 8], [6, 10, 7],
];

/// Each face split in four at the middles of its edges.
fn subdivided(mesh: Mesh) -> Mesh {
    let mut fine =
        Mesh { vertices: mesh.vertices, faces: Vec::with_capacity(4 * mesh.faces.len()) };
    let mut middles = HashMap::new();
    for [a, b, c] in mesh.faces {
        let [ab, bc, ca] = [(a, b), (b, c), (c, a)].map(|(p, q)| {
            *middles.entry((p.min(q), p.max(q))).or_insert_with(|| {
                let (from, to) = (fine.vertices[p as usize], fine.vertices[q as usize]);
                let index = fine.next_index();
                fine.vertices.push(on_unit_sphere([0, 1, 2].map(|k| from[k] + to[k])));
                index
            })
        });
        fine.faces.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
    }
    fine
}

/// The point in the same direction at distance 1, rounded to single precision.
fn on_unit_sphere(p: [f64; 3]) -> [f64; 3] {
    let length = p.iter().map(|x| x * x).sum::<f64>().sqrt();
    p.map(|x| single(x / length))
}

#[expect(clippy::cast_possible_truncation, reason = "rounding is the purpose")]
fn single(x: f64) -> f64 {
    f64::from(x as f32)
}

/// The surface of the cube from 0 to `n` along each axis, `n × n` squares of two triangles a side; vertices are integers.
#[must_use]
pub fn lattice_cube(n: u32) -> Mesh {
    let mut mesh = Mesh::default();
    let mut indices = HashMap::new();
    let mut index = |mesh: &mut Mesh, p: [u32; 3]| {
        *indices.entry(p).or_insert_with(|| {
            let index = mesh.next_index();
            mesh.vertices.push(p.map(f64::from));
            index
        })
    };
    for axis in 0..3 {
        for (height, outward) in [(0, false), (n, true)] {
            for (x, y) in (0..n).flat_map(|x| (0..n).map(move |y| (x, y))) {
                let mut corner = |dx: u32, dy: u32| {
                    let mut p = [height; 3];
                    p[(axis + 1) % 3] = x + dx;
                    p[(axis + 2) % 3] = y + dy;
                    index(&mut mesh, p)
                };
                let [a, b, c, d] = [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)];
                let faces = if outward { [[a, b, c], [a, c, d]] } else { [[a, c, b], [a, d, c]] };
                mesh.faces.extend(faces);
            }
        }
    }
    mesh
}

/// A sphere about the origin, cut by meridians into `segments` and by parallels into `rings`; the vertices of the n-th
/// parallel, of which the poles are the first and the last, are `radius(n)` away from the centre. In order: the north pole
/// on +z, the parallels eastward from +x, the south pole.
#[must_use]
pub fn uv_sphere(rings: u32, segments: u32, mut radius: impl FnMut(u32) -> f64) -> Mesh {
    let mut mesh = Mesh::default();
    for ring in 0..=rings {
        let polar = std::f64::consts::PI * f64::from(ring) / f64::from(rings);
        let is_pole = ring == 0 || ring == rings;
        for segment in 0..if is_pole { 1 } else { segments } {
            let azimuth = std::f64::consts::TAU * f64::from(segment) / f64::from(segments);
            // (At the south pole the computed sine is not zero.)
            let across = if is_pole { 0.0 } else { polar.sin() };
            let unit = [across * azimuth.cos(), across * azimuth.sin(), polar.cos()];
            let radius = radius(ring);
            mesh.vertices.push(unit.map(|x| single(radius * x)));
        }
    }
    let south = mesh.next_index() - 1;
    let vertex = |ring: u32, segment: u32| 1 + (ring - 1) * segments + segment % segments;
    for segment in 0..segments {
        let (west, east) = (segment, segment + 1);
        mesh.faces.push([0, vertex(1, west), vertex(1, east)]);
        for (upper, lower) in (1..rings - 1).map(|ring| (ring, ring + 1)) {
            let corners = [(upper, west), (lower, west), (lower, east), (upper, east)];
            let [a, b, c, d] = corners.map(|(ring, segment)| vertex(ring, segment));
            mesh.faces.extend([[a, b, c], [a, c, d]]);
        }
        mesh.faces.push([south, vertex(rings - 1, east), vertex(rings - 1, west)]);
    }
    mesh
}

/// A landscape over the unit square: its rim lies at z = −1, and one random triangle after the other is split in three at
/// a random point of random height in [−0.99, −0.01], until there are `count`, an even number. Seen from above, rounding
/// may fold it; still any way down through the square crosses it.
#[must_use]
pub fn landscape(rng: &mut fastrand::Rng, count: usize) -> Mesh {
    let corners = [[0.0, 0.0, -1.0], [1.0, 0.0, -1.0], [1.0, 1.0, -1.0], [0.0, 1.0, -1.0]];
    let mut mesh = Mesh { vertices: corners.to_vec(), faces: vec![[0, 1, 3], [2, 3, 1]] };
    while mesh.faces.len() < count {
        let face = rng.usize(..mesh.faces.len());
        let [a, b, c] = mesh.faces[face];
        let [p, q, r] = [a, b, c].map(|k| mesh.vertices[k as usize]);
        let [along, across, depth] = [(); 3].map(|()| 0.01 + 0.98 * rng.f64());
        let weights = [(1.0 - along) * (1.0 - across), along * (1.0 - across), across];
        let [x, y] = [0, 1].map(|k| weights[0] * p[k] + weights[1] * q[k] + weights[2] * r[k]);
        let top = mesh.next_index();
        mesh.vertices.push([x, y, -depth].map(single));
        mesh.faces[face] = [a, b, top];
        mesh.faces.extend([[b, c, top], [c, a, top]]);
    }
    mesh
}

/// The `v` and `f` lines of a Wavefront OBJ text; faces are triangles, coordinates are rounded to single precision.
///
/// # Panics
///
/// On a line that cannot be read, a face that is not a triangle, or an index out of range.
#[must_use]
pub fn parse_obj(text: &str) -> Mesh {
    let mut mesh = Mesh::default();
    for line in text.lines() {
        let mut words = line.split_whitespace();
        match words.next() {
            Some("v") => mesh.vertices.push(three(words.take(3).map(|word| {
                single(word.parse().unwrap_or_else(|_| panic!("not a coordinate: {line}")))
            }))),
            Some("f") => mesh.faces.push(three(words.map(|word| {
                // Position, texture and normal are separated by slashes and count from 1.
                let position = word.split('/').next().unwrap_or_default();
                let index: u32 =
                    position.parse().unwrap_or_else(|_| panic!("not an index: {line}"));
                index.checked_sub(1).unwrap_or_else(|| panic!("index 0: {line}"))
            }))),
            _ => {}
        }
    }
    let count = mesh.next_index();
    assert!(mesh.faces.as_flattened().iter().all(|&k| k < count), "index out of range");
    mesh
}

/// Exactly three items.
fn three<T>(items: impl Iterator<Item = T>) -> [T; 3] {
    let items: Vec<T> = items.collect();
    let count = items.len();
    items.try_into().unwrap_or_else(|_| panic!("three items expected, {count} found"))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Six times the enclosed volume, positive when faces look outward.
    fn volume(mesh: &Mesh) -> f64 {
        let determinant = |[a, b, c]: [[f64; 3]; 3]| {
            a[0] * (b[1] * c[2] - b[2] * c[1])
                + a[1] * (b[2] * c[0] - b[0] * c[2])
                + a[2] * (b[0] * c[1] - b[1] * c[0])
        };
        mesh.triangles().map(determinant).sum()
    }

    fn assert_is_solid(mesh: &Mesh) {
        assert!(mesh.is_closed());
        assert_eq!(mesh.vertices.len() + mesh.faces.len(), mesh.edges().len() + 2, "Euler");
        assert!(mesh.vertices.as_flattened().iter().all(|&x| single(x) == x));
    }

    #[test]
    fn an_icosphere_is_closed_and_looks_outward() {
        for subdivisions in 0..5 {
            let mesh = icosphere(subdivisions);
            assert_eq!(mesh.faces.len(), 20 * 4usize.pow(subdivisions));
            assert_is_solid(&mesh);
            for triangle in mesh.triangles() {
                assert!(
                    volume(&Mesh { vertices: triangle.to_vec(), faces: vec![[0, 1, 2]] }) > 0.0
                );
            }
        }
        let sphere = 8.0 * std::f64::consts::PI;
        assert!((0.99 * sphere..sphere).contains(&volume(&icosphere(4))));
    }

    #[test]
    fn a_lattice_cube_is_closed_and_looks_outward() {
        for n in 1..5 {
            let mesh = lattice_cube(n);
            assert_eq!(mesh.faces.len(), 12 * n as usize * n as usize);
            assert_is_solid(&mesh);
            assert_eq!(volume(&mesh), 6.0 * f64::from(n).powi(3));
        }
    }

    #[test]
    fn a_uv_sphere_is_closed_and_looks_outward() {
        for (rings, segments) in [(2, 3), (3, 4), (15, 15), (40, 80)] {
            let mesh = uv_sphere(rings, segments, |_| 2.0);
            assert_eq!(mesh.faces.len(), 2 * segments as usize * (rings as usize - 1));
            assert_is_solid(&mesh);
            for triangle in mesh.triangles() {
                assert!(
                    volume(&Mesh { vertices: triangle.to_vec(), faces: vec![[0, 1, 2]] }) > 0.0
                );
            }
        }
        let sphere = 64.0 * std::f64::consts::PI;
        assert!((0.99 * sphere..sphere).contains(&volume(&uv_sphere(40, 80, |_| 2.0))));
    }

    /// With a floor it is closed.
    #[test]
    fn a_landscape_rises_from_a_square() {
        for count in [2, 4, 16, 1024] {
            let mut mesh = landscape(&mut fastrand::Rng::with_seed(1), count);
            assert_eq!((mesh.faces.len(), mesh.vertices.len()), (count, count / 2 + 3));
            assert!(mesh.vertices[4..].iter().all(|v| (-0.99..=-0.01).contains(&v[2])));
            // Of the other diagonal.
            mesh.faces.extend([[0, 2, 1], [0, 3, 2]]);
            assert_is_solid(&mesh);
            assert!(volume(&mesh) > 0.0 || count == 2);
        }
    }

    #[test]
    fn faces_around_vertices_are_tried_first() {
        let mesh = lattice_cube(1);
        let Surface { around, triangles, .. } = &Surface::<glam::DVec3>::new(&mesh);
        assert_eq!((triangles.len(), around.iter().map(Vec::len).sum::<usize>()), (12, 36));
        for (vertex, faces) in around.iter().enumerate() {
            assert!(faces.iter().all(|&k| mesh.faces[k].iter().any(|&v| v as usize == vertex)));
        }
        let surface = Surface::<glam::DVec3>::new(&mesh);
        let first = triangles[around[7][0]];
        assert!(surface.stops(&[7], |triangle| {
            assert_eq!(*triangle, first);
            true
        }));
        let mut asked = 0;
        let blind = surface.stops(&[7], |_| {
            asked += 1;
            false
        });
        assert_eq!((blind, asked), (false, around[7].len() + 12));
    }

    #[test]
    fn obj_texts_are_read() {
        let text = "# a tetrahedron\nv 0 0 0\nv 1 0 0 1.0\nv 0 1 0\nv 0 0 .1e1\nvn 0 0 1\n\
                    f 1 3 2\nf 1/1/1 2//1 4\nf 2 3 4\nf 1 4 3\n";
        let mesh = parse_obj(text);
        assert_eq!(mesh.vertices[3], [0.0, 0.0, 1.0]);
        assert_eq!(mesh.faces[1], [0, 1, 3]);
        assert_is_solid(&mesh);
        assert_eq!(volume(&mesh), 1.0);
        let open = Mesh { faces: mesh.faces[1..].to_vec(), ..mesh };
        assert!(!open.is_closed() && !Mesh::default().is_closed());
    }

    #[test]
    #[should_panic(expected = "three items expected, 4 found")]
    fn a_quadrilateral_is_refused() {
        let _ = parse_obj("v 0 0 0\nf 1 1 1 1");
    }
}
