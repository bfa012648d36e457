//! A cone for each pixel: J. Amanatides, "Ray Tracing with Cones", SIGGRAPH 1984.
//!
//! It is as wide as the pixel, and round: the area of its section is the pixel's. However small a thing in it is, it has its share, and no
//! random number makes noise.

use super::Eye;
use crate::render::Tile;
use crate::scene::Color;
use crate::shade::{Cones, RayCounts};

/// The colours of a tile's pixels.
pub(super) fn colors(
    lamp_radius: f32,
    eye: &Eye<'_>,
    tile: &Tile,
    counts: &mut RayCounts,
) -> Vec<Color> {
    let cones = Cones::new(eye.tracer, eye.hierarchy, lamp_radius);
    tile.pixels().map(|pixel| cones.color(&eye.camera.cone(pixel), counts)).collect()
}

#[cfg(test)]
mod tests {
    use isect::glam::Vec3A;
    use isect::{Aabb, Plane, Polygon, Sphere};

    use super::*;
    use crate::antialias::Method;
    use crate::antialias::black::{SIZE, ahead, black, camera, pixel, scene, triangle};
    use crate::mesh::Obj;
    use crate::scene::Shape;

    const CONE: Method = Method::Cone { lamp_radius: 0.0 };

    /// Of colours and coverages in `f32`, sums and products of some dozens: what rounding may leave.
    const ROUNDING: f32 = 64.0 * f32::EPSILON;

    /// How black a pixel is.
    fn share(scene: &crate::scene::Scene, x: u32, y: u32) -> f32 {
        black(scene, CONE, pixel(x, y)).0[0]
    }

    #[test]
    fn it_is_as_wide_as_the_pixel() {
        let camera = camera();
        let sum: f32 = (0..SIZE)
            .flat_map(|x| (0..SIZE).map(move |y| [x, y]))
            .map(|at| std::f32::consts::PI * camera.cone(at).spread.powi(2))
            .sum();
        // The picture's solid angle, that of a square pyramid: 4·asin(sin²(a/2)), of which the pixels' tangents instead of angles
        // are off by less than their square.
        let half = (camera.corners()[0] - camera.corners()[1]).length() / 2.0;
        let angle = 4.0 * (half * half / (1.0 + half * half)).asin();
        assert!((sum / angle - 1.0).abs() < (2.0 * half / SIZE as f32).powi(2), "{sum} {angle}");
    }

    #[test]
    fn each_thing_colours_what_it_covers() {
        // The edge runs through the middle of the pixels of a column; the pixels beside it are in or out.
        let half = triangle([[5.5, -20.0], [-30.0, 8.0], [5.5, 40.0]], 3.0);
        let scene = scene(&[half], &[]);
        assert!((share(&scene, 5, 8) - 0.5).abs() < 1e-5);
        assert_eq!(share(&scene, 7, 8), 0.0);
        assert!((share(&scene, 3, 8) - 1.0).abs() < ROUNDING);
    }

    #[test]
    fn what_shares_an_edge_leaves_no_gap_and_what_is_hidden_does_not_count() {
        let quarters = |depth| {
            let middle = [5.4, 5.3];
            let corners = [[0.0, 0.0], [12.0, 1.0], [11.0, 12.0], [1.0, 11.0]];
            [0, 1, 2, 3].map(|i| triangle([middle, corners[i], corners[(i + 1) % 4]], depth))
        };
        let tiles = scene(&quarters(3.0), &[]);
        assert!((share(&tiles, 5, 5) - 1.0).abs() < ROUNDING, "{}", share(&tiles, 5, 5));
        let shapes = quarters(3.0).map(|triangle| {
            let corners = <[Vec3A; 3]>::from(triangle);
            Shape::Polygon(Polygon::new(&corners).expect("three of four"))
        });
        assert!((share(&scene(&[], &shapes), 5, 5) - 1.0).abs() < ROUNDING);
        // A half behind the same half, of one surface, in any order.
        let half = |depth| triangle([[5.5, -20.0], [-30.0, 8.0], [5.5, 40.0]], depth);
        let backs = |depth| triangle([[5.5, 40.0], [-30.0, 8.0], [5.5, -20.0]], depth);
        for triangles in [[half(3.0), backs(3.5)], [backs(3.5), half(3.0)]] {
            assert!((share(&scene(&triangles, &[]), 5, 8) - 0.5).abs() < 1e-5);
        }
    }

    #[test]
    fn a_closed_mesh_covers_as_much_as_the_sphere_around_it() {
        let obj = Obj::icosphere(4);
        let mesh = obj.standing(2.0 * 0.4, ahead([8.0, 8.0], 3.0) - 0.4 * Vec3A::Y);
        let mut round = scene(&[], &[]);
        let bounds = mesh.bounds();
        let sphere = Sphere::new(bounds.center(), bounds.size().max_element() / 2.0);
        round.shapes = vec![(Shape::Sphere(sphere), round.mesh_material)];
        let mut flat = scene(&[], &[]);
        flat.mesh = mesh;
        let all = || Tile { x: 0..SIZE, y: 0..SIZE };
        let [of_mesh, of_sphere] = [&flat, &round].map(|scene| black(scene, CONE, all()).0);
        let mut at_the_edge = 0;
        // Of a pixel's width, at three times the sphere's distance: its edges of 1/17 lie 1/8·(1/17)² inside of it.
        let pixel = 2.0 * 0.176 * 3.0 / SIZE as f32;
        let sag = 0.4 * (1.0 / 17.0_f32).powi(2) / 8.0 / pixel;
        for (a, b) in of_mesh.into_iter().zip(of_sphere) {
            at_the_edge += u32::from(0.05 < b && b < 0.95);
            // Across the widest part of the disk the edge is 2/√π of a pixel long.
            assert!((a - b).abs() < 4.0 * sag, "{a} {b} {sag}");
        }
        assert!(at_the_edge > 16, "{at_the_edge}");
    }

    #[test]
    fn what_centre_rays_miss_is_found() {
        let splinter = triangle([[5.6, 2.0], [5.85, 2.0], [5.7, 14.0]], 3.0);
        let speck = Shape::Sphere(Sphere::new(ahead([9.7, 3.3], 3.0), 0.01));
        let post = Aabb::from_points([[12.6, 8.6], [12.8, 8.8]].map(|at| ahead(at, 3.0)));
        let scene = scene(&[splinter], &[speck, Shape::Box(post)]);
        let all = || Tile { x: 0..SIZE, y: 0..SIZE };
        assert_eq!(black(&scene, Method::None, all()).0, [0.0; (SIZE * SIZE) as usize]);
        // A strip of 0.25 to 0 pixels, across a disk of 2/√π.
        for y in 2..9 {
            let wide = 0.25 * (14.0 - (y as f32 + 0.5)) / 12.0;
            let share = share(&scene, 5, y);
            assert!(share > 0.8 * wide && share < 1.2 * wide, "{y} {share} {wide}");
        }
        assert!(share(&scene, 9, 3) > 0.01 && share(&scene, 12, 8) > 0.01);
        assert_eq!(share(&scene, 7, 7), 0.0);
    }

    #[test]
    fn a_mirror_shows_as_much_of_a_thing_as_there_is() {
        // A mirror at right angles to the view of a pixel between eye and triangle, which now lies behind the eye.
        let seen = triangle([[5.3, -20.0], [-30.0, 8.0], [5.3, 40.0]], 3.0);
        let ray = camera().ray(5.5, 8.5);
        let offset = ray.direction.dot(ray.at(2.0));
        let mirrored = |p: Vec3A| p - ray.direction * (2.0 * (ray.direction.dot(p) - offset));
        let corners = <[Vec3A; 3]>::from(seen).map(mirrored);
        let direct = share(&scene(&[seen], &[]), 5, 8);
        let plane = Plane { normal: -ray.direction, offset: -offset };
        let mut scene = scene(&[corners.into()], &[Shape::Plane(plane)]);
        let mirror = &mut scene.shapes[0].1;
        mirror.shares = Some(crate::scene::Shares { reflected: 1.0, transmitted: 0.0 });
        // Upwards the sky has another colour, all of which the triangle hides or leaves.
        let tile = || black(&scene, CONE, pixel(5, 8)).0[0];
        let with = tile();
        let mut without = scene;
        without.mesh = Obj::icosphere(0).standing(0.01, Vec3A::splat(100.0));
        let empty = black(&without, CONE, pixel(5, 8)).0[0];
        let in_mirror = 1.0 - (1.0 - with) / (1.0 - empty);
        assert!(direct > 0.2 && (in_mirror - direct).abs() < 1e-3, "{in_mirror} {direct}");
    }
}
