//! Pyramidal ray tracing: J. Genetti, D. Gordon, G. Williams, "Adaptive Supersampling in Object Space Using Pyramidal
//! Rays", Computer Graphics Forum 17.1, 1998.
//!
//! A pixel is a pyramid with its apex in the eye. One that a primitive covers in part splits in four, down to a depth; the
//! others, and those of the last level, have the colour that the ray through their centre sees, and weigh as much as they
//! are wide. So the rays go where edges are, however small what they bound. Edges that something nearer hides do not
//! count; those of shadows and of textures are not looked for.

use isect::glam::Vec3A;
use isect::overlap::{Containment, pyramid_aabb, pyramid_sphere, pyramid_triangle};
use isect::{Aabb, Pyramid, Ray};

use super::Eye;
use crate::render::Tile;
use crate::scene::{Color, Shape};
use crate::shade::RayCounts;

/// The colours of a tile's pixels.
pub(super) fn colors(
    max_level: u8,
    eye: &Eye<'_>,
    tile: &Tile,
    counts: &mut RayCounts,
) -> Vec<Color> {
    let mut caster = Caster { eye, counts };
    tile.pixels().map(|pixel| caster.pixel(max_level, pixel.map(|x| x as f32))).collect()
}

/// What a pyramid may meet.
#[derive(Clone, Copy, Debug)]
enum Primitive {
    /// One of the mesh.
    Triangle(u32),
    /// One of the scene's.
    Shape(usize),
}

/// How much of a pyramid a primitive covers.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Cover {
    None,
    /// From this depth on, or farther.
    Part(f32),
    /// All of it, with no point that is farther.
    Whole(f32),
}

struct Caster<'a> {
    eye: &'a Eye<'a>,
    counts: &'a mut RayCounts,
}

impl Caster<'_> {
    /// The colour of a pixel, given its upper left corner.
    fn pixel(&mut self, max_level: u8, corner: [f32; 2]) -> Color {
        let opposite = corner.map(|x| x + 1.0);
        let Some(pyramid) = self.eye.camera.pyramid(corner, opposite) else {
            // So narrow that floats do not tell its sides apart.
            return self.leaf(corner, 1.0);
        };
        let mut met: Vec<_> =
            (0..self.eye.tracer.scene().shapes.len()).map(Primitive::Shape).collect();
        if let Some(hierarchy) = self.eye.hierarchy {
            hierarchy.visit(
                |aabb| pyramid_aabb::classify(&pyramid, aabb) != Containment::Outside,
                |triangle| met.push(Primitive::Triangle(triangle)),
            );
        }
        self.cell(max_level, &pyramid, corner, 1.0, &met)
    }

    /// The colour of a pyramid, given its upper left corner and its edge, and what it may meet.
    fn cell(
        &mut self,
        levels: u8,
        pyramid: &Pyramid<Vec3A>,
        [x, y]: [f32; 2],
        edge: f32,
        may_meet: &[Primitive],
    ) -> Color {
        if levels == 0 {
            return self.leaf([x, y], edge);
        }
        let covers = may_meet.iter().map(|&primitive| (primitive, self.cover(pyramid, primitive)));
        let met: Vec<_> = covers.filter(|&(_, cover)| cover != Cover::None).collect();
        let hidden_from = met.iter().fold(f32::INFINITY, |nearest, &(_, cover)| match cover {
            Cover::Whole(depth) => nearest.min(depth),
            _ => nearest,
        });
        let shows_edge =
            |&(_, cover): &(_, Cover)| matches!(cover, Cover::Part(depth) if depth <= hidden_from);
        if !met.iter().any(shows_edge) {
            return self.leaf([x, y], edge);
        }
        let met: Vec<_> = met.into_iter().map(|(primitive, _)| primitive).collect();
        let half = edge / 2.0;
        let corners = [[x, y], [x + half, y], [x + half, y + half], [x, y + half]];
        let quarters = pyramid.split().into_iter().zip(corners);
        let sum: Color = quarters
            .map(|(quarter, corner)| self.cell(levels - 1, &quarter, corner, half, &met))
            .sum();
        sum / 4.0
    }

    /// What the ray through the centre sees.
    fn leaf(&mut self, corner: [f32; 2], edge: f32) -> Color {
        self.eye.color(corner.map(|x| x + edge / 2.0), self.counts)
    }

    fn cover(&self, pyramid: &Pyramid<Vec3A>, primitive: Primitive) -> Cover {
        let (scene, camera) = (self.eye.tracer.scene(), self.eye.camera);
        let nearest = |points: &[Vec3A]| {
            points.iter().fold(f32::INFINITY, |nearest, &p| nearest.min(camera.depth(p)))
        };
        let farthest = |points: &[Vec3A]| {
            points.iter().fold(f32::NEG_INFINITY, |farthest, &p| farthest.max(camera.depth(p)))
        };
        // A convex shape covers the whole if the pyramid's edges meet it.
        let rays = pyramid.corners.map(|direction| Ray::new(pyramid.apex, direction));
        let meet = |hits: &dyn Fn(&Ray<Vec3A>) -> bool| rays.iter().all(hits);
        match primitive {
            Primitive::Triangle(index) => {
                let triangle = scene.mesh.triangle(index);
                match pyramid_triangle::classify(pyramid, &triangle) {
                    Containment::Outside => Cover::None,
                    _ if meet(&|ray| ray.hits(&triangle)) => {
                        Cover::Whole(farthest(&<[Vec3A; 3]>::from(triangle)))
                    }
                    _ => Cover::Part(nearest(&<[Vec3A; 3]>::from(triangle))),
                }
            }
            Primitive::Shape(index) => match &scene.shapes[index].0 {
                shape @ Shape::Sphere(sphere) => {
                    let depth = camera.depth(sphere.center);
                    match pyramid_sphere::classify(pyramid, sphere) {
                        Containment::Outside => Cover::None,
                        _ if meet(&|ray| shape.hits(ray)) => Cover::Whole(depth + sphere.radius),
                        _ => Cover::Part(depth - sphere.radius),
                    }
                }
                shape @ Shape::Box(aabb) => match pyramid_aabb::classify(pyramid, aabb) {
                    Containment::Outside => Cover::None,
                    _ if meet(&|ray| shape.hits(ray)) => {
                        Cover::Whole(farthest(&Aabb::corners(aabb)))
                    }
                    _ => Cover::Part(nearest(&Aabb::corners(aabb))),
                },
                shape @ Shape::Polygon(polygon) => {
                    let is_outside = polygon.triangles().all(|triangle| {
                        pyramid_triangle::classify(pyramid, &triangle) == Containment::Outside
                    });
                    match is_outside {
                        true => Cover::None,
                        _ if meet(&|ray| shape.hits(ray)) => {
                            Cover::Whole(farthest(polygon.vertices()))
                        }
                        _ => Cover::Part(nearest(polygon.vertices())),
                    }
                }
                shape @ Shape::Plane(_) => {
                    let depths = rays.each_ref().map(|ray| {
                        let hit = shape.intersect(ray)?;
                        Some(camera.depth(hit.point_and_error.0))
                    });
                    let met = || depths.iter().flatten();
                    match met().count() {
                        0 => Cover::None,
                        4 => Cover::Whole(met().fold(0.0, |farthest, &x| x.max(farthest))),
                        // To the horizon from the corner that is nearest.
                        _ => Cover::Part(met().fold(f32::INFINITY, |nearest, &x| x.min(nearest))),
                    }
                }
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use isect::{Aabb, Sphere};

    use super::*;
    use crate::antialias::Method;
    use crate::antialias::black::{SIZE, ahead, black, pixel, scene, triangle};

    const THREE_LEVELS: Method = Method::Pyramid { max_level: 3 };

    #[test]
    fn a_triangle_is_seven_sixty_fourths_of_a_pixel() {
        // In eighths of a pixel it covers the centres of four squares, of two and of one.
        let corners = [[0.2, 0.2], [4.2, 0.2], [0.2, 3.1]].map(|p| p.map(|x| 5.0 + x / 8.0));
        let scene = scene(&[triangle(corners, 3.0)], &[]);
        assert_eq!(black(&scene, Method::None, pixel(5, 5)).0, [0.0]);
        let (shares, rays) = black(&scene, THREE_LEVELS, pixel(5, 5));
        // Of sums and quarters of one colour the rounding of a few floats is all that may be off.
        assert!((shares[0] - 7.0 / 64.0).abs() < 1e-6, "{shares:?}");
        // Two of the four quarters have an edge in them, and of their quarters four at the most, and one.
        assert!(rays < 32, "{rays}");
        let shares = [0, 1, 2]
            .map(|max_level| black(&scene, Method::Pyramid { max_level }, pixel(5, 5)).0[0]);
        // The centres of the quarters and of the sixteenths: (2, 2) lies beyond; (1, 1) and (3, 1) do not.
        assert_eq!(shares[..2], [0.0; 2]);
        assert!((shares[2] - 2.0 / 16.0).abs() < 1e-6, "{shares:?}");
        for (x, y) in [(4, 5), (6, 5), (5, 4), (5, 6)] {
            assert_eq!(black(&scene, THREE_LEVELS, pixel(x, y)), (vec![0.0], 1));
        }
    }

    #[test]
    fn what_centre_rays_miss_is_found() {
        let all = || Tile { x: 0..SIZE, y: 0..SIZE };
        // A splinter between the centres of two columns, two eighths of a pixel wide or less.
        let splinter = triangle([[5.6, 2.0], [5.85, 2.0], [5.7, 14.0]], 3.0);
        let speck = Shape::Sphere(Sphere::new(ahead([9.8, 3.2], 3.0), 0.01));
        let post = Aabb::from_points([[12.1, 8.1], [12.3, 8.3]].map(|at| ahead(at, 3.0)));
        let scene = scene(&[splinter], &[speck, Shape::Box(post)]);
        assert_eq!(black(&scene, Method::None, all()).0, [0.0; (SIZE * SIZE) as usize]);
        let (shares, rays) = black(&scene, THREE_LEVELS, all());
        let share = |x: usize, y: usize| shares[y * SIZE as usize + x];
        for y in 2..10 {
            assert!(share(5, y) > 0.04 && share(5, y) < 0.3, "{y} {}", share(5, y));
        }
        assert!(share(9, 3) > 0.0 && share(12, 8) > 0.0, "{} {}", share(9, 3), share(12, 8));
        assert_eq!(share(7, 7), 0.0);
        // A ray for each pixel in which there is nothing.
        assert!(rays < u64::from(SIZE * SIZE) + 20 * 64, "{rays}");
    }

    #[test]
    fn edges_that_are_hidden_cost_no_rays() {
        let corners = [[5.2, 5.2], [5.9, 5.3], [5.3, 5.9]];
        let cover = [[0.0, 0.0], [16.0, 0.0], [0.0, 16.0]];
        let [small, before, behind] = [(corners, 3.0), (cover, 2.0), (cover, 4.0)]
            .map(|(corners, depth)| triangle(corners, depth));
        for (triangles, is_one) in
            [(vec![small, before], true), (vec![small, behind], false), (vec![before], true)]
        {
            let (shares, rays) = black(&scene(&triangles, &[]), THREE_LEVELS, pixel(5, 5));
            assert_eq!((rays == 1, shares[0]), (is_one, 1.0), "{rays}");
        }
    }
}
