//! Triangle meshes out of Wavefront OBJ files: read, checked, and put on the floor of a scene.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use isect::glam::{DVec3, Vec3A};
use isect::ray::triangle::TriangleHit;
use isect::testkit::meshes;
use isect::{Aabb, Triangle};

use crate::failure::Failure;

/// The Stanford bunny, decimated, in the public domain.
const BUNNY: &str = include_str!("bunny.obj");

/// Files longer than this are refused rather than read until the memory is full.
const MAX_BYTES: u64 = 1 << 30;

/// What an OBJ file says: finite positions, not all the same, and triangles of them.
#[derive(Debug)]
pub(crate) struct Obj {
    positions: Vec<Vec3A>,
    indices: Vec<[u32; 3]>,
}

impl Obj {
    /// The bunny.
    pub(crate) fn bunny() -> Self {
        Self::parse(BUNNY).expect("the bunny is a sound mesh")
    }

    /// A sphere of 20·4^level triangles, in single precision as it is.
    pub(crate) fn icosphere(level: u32) -> Self {
        let meshes::Mesh { vertices, faces } = meshes::icosphere(level);
        let position = |vertex| DVec3::from_array(vertex).as_vec3a();
        Self { positions: vertices.into_iter().map(position).collect(), indices: faces }
    }

    /// Reads a file.
    pub(crate) fn read(file: &Path) -> Result<Self, Failure> {
        let mut bytes = Vec::new();
        File::open(file)
            .and_then(|opened| opened.take(MAX_BYTES + 1).read_to_end(&mut bytes))
            .map_err(|error| Failure::new(file, error))?;
        if bytes.len() as u64 > MAX_BYTES {
            return Err(Failure::new(file, "longer than 1 GiB"));
        }
        let text = String::from_utf8(bytes).map_err(|error| {
            let at = error.utf8_error().valid_up_to();
            Failure::new(file, format!("not a text file: byte {at} is not UTF-8"))
        })?;
        Self::parse(&text).map_err(|reason| Failure::new(file, reason))
    }

    /// Reads the positions and the faces of a text, and no more of it.
    fn parse(text: &str) -> Result<Self, String> {
        // The parser sees no normals and texture coordinates, whose indices it does not check well,
        // and no objects and groups, at which it would part the vertices. Empty lines in their
        // place keep the count.
        let lines = text.lines().map(|line| {
            let mut words = line.split_whitespace();
            let kept = matches!(words.next(), Some("v" | "f"));
            if kept { line } else { "" }
        });
        let mut kept = String::with_capacity(text.len());
        for (number, line) in lines.enumerate() {
            let infinite = |word: &str| word.parse::<f32>().is_ok_and(|x| !x.is_finite());
            if line.split_whitespace().any(infinite) {
                let number = number + 1;
                return Err(format!("line {number}: not finite: {}", line.trim()));
            }
            kept.push_str(line);
            kept.push('\n');
        }
        let options = tobj::LoadOptions {
            triangulate: true,
            ignore_points: true,
            ignore_lines: true,
            ..Default::default()
        };
        let no_materials = |_: &Path| Err(tobj::LoadError::MaterialParseError);
        let mut rest = kept.as_bytes();
        let (models, _) =
            tobj::load_obj_buf(&mut rest, &options, no_materials).map_err(|error| {
                use tobj::LoadError::{FaceVertexOutOfBounds, InvalidPolygon};
                if matches!(error, FaceVertexOutOfBounds | InvalidPolygon) {
                    return error.to_string(); // found when all lines are read
                }
                let read = &kept.as_bytes()[..kept.len() - rest.len()];
                let number = read.iter().filter(|&&byte| byte == b'\n').count();
                format!("line {number}: {error}")
            })?;

        let mut obj = Self { positions: Vec::new(), indices: Vec::new() };
        for tobj::Model { mesh, .. } in models {
            let first = u32::try_from(obj.positions.len()).map_err(|_| "too many vertices")?;
            let (positions, _) = mesh.positions.as_chunks();
            let (indices, _) = mesh.indices.as_chunks();
            obj.positions.extend(positions.iter().copied().map(Vec3A::from_array));
            obj.indices.extend(indices.iter().map(|corners| corners.map(|i| first + i)));
        }
        if obj.indices.is_empty() {
            return Err("no triangles in it".into());
        }
        let size = obj.bounds().size();
        if !size.is_finite() {
            return Err("too large: its extent is not a float".into());
        }
        if !size.max_element().is_normal() {
            return Err("all its vertices are in one place".into());
        }
        Ok(obj)
    }

    /// The box around the vertices.
    fn bounds(&self) -> Aabb<Vec3A> {
        Aabb::from_points(self.positions.iter().copied())
    }

    /// The mesh scaled to `size` along its longest axis, standing on `foot`.
    pub(crate) fn standing(self, size: f32, foot: Vec3A) -> Mesh {
        let bounds = self.bounds();
        let scale = size / bounds.size().max_element();
        let mut base = bounds.center();
        base.y = bounds.min.y;
        let place = |position: Vec3A| (position - base) * scale + foot;
        Mesh::new(self.positions.into_iter().map(place).collect(), self.indices)
    }
}

/// Triangles with a normal at each vertex; there may be none.
#[derive(Debug, Default)]
pub(crate) struct Mesh {
    positions: Vec<Vec3A>,
    /// The mean of the normals around each vertex, weighted by area, of length 1; zero where they
    /// cancel.
    normals: Vec<Vec3A>,
    indices: Vec<[u32; 3]>,
}

impl Mesh {
    fn new(positions: Vec<Vec3A>, indices: Vec<[u32; 3]>) -> Self {
        let mut mesh = Self { normals: vec![Vec3A::ZERO; positions.len()], positions, indices };
        for corners in &mesh.indices {
            let normal = mesh.triangle_of(corners).normal();
            for &corner in corners {
                mesh.normals[corner as usize] += normal;
            }
        }
        for normal in &mut mesh.normals {
            *normal = normal.normalize_or_zero();
        }
        mesh
    }

    /// One of these triangles, which share no vertex.
    #[cfg(test)]
    pub(crate) fn of(triangles: &[Triangle<Vec3A>]) -> Self {
        let positions = triangles.iter().flat_map(|&triangle| <[Vec3A; 3]>::from(triangle));
        let indices = (0..).step_by(3).map(|i| [i, i + 1, i + 2]).take(triangles.len());
        Self::new(positions.collect(), indices.collect())
    }

    /// The triangles, in order.
    pub(crate) fn triangles(&self) -> Vec<Triangle<Vec3A>> {
        let triangle = |corners| self.triangle_of(corners);
        self.indices.iter().map(triangle).collect()
    }

    /// The box around the vertices.
    pub(crate) fn bounds(&self) -> Aabb<Vec3A> {
        Aabb::from_points(self.positions.iter().copied())
    }

    /// One triangle.
    pub(crate) fn triangle(&self, index: u32) -> Triangle<Vec3A> {
        self.triangle_of(&self.indices[index as usize])
    }

    /// The normals at the corners of a triangle.
    pub(crate) fn normals(&self, index: u32) -> [Vec3A; 3] {
        self.indices[index as usize].map(|corner| self.normals[corner as usize])
    }

    fn triangle_of(&self, corners: &[u32; 3]) -> Triangle<Vec3A> {
        corners.map(|corner| self.positions[corner as usize]).into()
    }
}

/// The vertex normals, interpolated: what makes flat triangles look round.
pub(crate) fn interpolated(hit: &TriangleHit<f32>, [a, b, c]: [Vec3A; 3]) -> Vec3A {
    hit.interpolate(a, b, c).normalize_or_zero()
}

#[cfg(test)]
mod tests {
    use super::*;

    const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 2 0\nv 0 2 0\n";

    fn reason(faces: &str) -> String {
        Obj::parse(&format!("{SQUARE}{faces}")).expect_err("it is not sound")
    }

    #[test]
    fn polygons_become_triangles_whatever_stands_around_them() {
        let text = "mtllib none.mtl\no thing\nvt 0 0\nvn 0 0 1\nusemtl\ng a\n";
        let faces = "s off\nf 1/1/1 2/1/1 3/1/1 4/1/1\ng b\nf -4//9223372036854775807 -2 -1\n";
        let obj = Obj::parse(&format!("{text}{SQUARE}{faces}")).expect("a sound mesh");
        assert_eq!((obj.positions.len(), obj.indices.len()), (4, 3));
    }

    #[test]
    fn unsound_meshes_are_refused() {
        let cases = [
            ("", "no triangles"),
            ("f 1 2\nl 1 2\n", "no triangles"),
            ("f 1 2 5\n", "out of bounds"),
            ("f 1 2 0\n", "out of bounds"),
            ("f 1 2 -9\n", "out of bounds"),
            ("f 1 2 -9223372036854775808\n", "out of bounds"),
            ("f 1 2 99999999999999999999\n", "line 5: face parse error"),
            ("f 1 2 three\n", "line 5: face parse error"),
            ("f\n", "invalid polygon"),
            ("v 1 2\nf 1 2 3\n", "line 5: position parse error"),
            ("v 1 2 3 0\nf 1 2 3\n", "line 5: scaling (w) by zero"),
            ("v 1 nan 3\nf 1 2 5\n", "line 5: not finite: v 1 nan 3"),
            ("v 1 -inf 3\nf 1 2 5\n", "line 5: not finite"),
            ("v 1e99 0 3\nf 1 2 5\n", "line 5: not finite"),
            ("v 1e30 0 0 1e-20\nf 1 2 5\n", "too large"),
            ("v 3e38 0 0\nv -3e38 0 0\nf 1 5 6\n", "too large"),
            ("f 1 1 1\n", "in one place"),
        ];
        for (faces, expected) in cases {
            let reason = reason(faces);
            assert!(reason.contains(expected), "{faces:?}: {reason}");
            assert!(!reason.contains('\n'));
        }
    }

    #[test]
    fn a_mesh_stands_where_it_is_put() {
        let obj = Obj::parse(&format!("{SQUARE}f 1 2 3 4\n")).expect("a sound mesh");
        let mesh = obj.standing(4.0, Vec3A::new(10.0, 1.0, 5.0));
        let bounds = mesh.bounds();
        assert_eq!(bounds.min, Vec3A::new(9.0, 1.0, 5.0));
        assert_eq!(bounds.max, Vec3A::new(11.0, 5.0, 5.0));
        assert_eq!(mesh.normals(0), [Vec3A::Z; 3]);
    }
}
