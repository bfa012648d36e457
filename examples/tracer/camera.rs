//! The pinhole camera: a ray from the eye through each pixel's centre.

use isect::glam::Vec3A;
use isect::{Cone, Pyramid, Ray};

/// Where to look from, at what, and how wide.
#[derive(Clone, Copy, Debug)]
pub(crate) struct View {
    /// The eye.
    pub(crate) from: Vec3A,
    /// The point in the middle of the picture.
    pub(crate) at: Vec3A,
    /// The angle from the lower to the upper edge of a 16:9 picture, in degrees. Narrower pictures
    /// see more above and below instead of less at the sides.
    pub(crate) field_of_view: f32,
}

/// A view onto a grid of pixels.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Camera {
    eye: Vec3A,
    /// From the eye to the middle of the picture, of length 1.
    forward: Vec3A,
    /// From the middle of the picture to its right edge.
    right: Vec3A,
    /// From the middle of the picture to its upper edge.
    up: Vec3A,
    width: f32,
    height: f32,
}

impl Camera {
    /// The camera of a picture with this many pixels.
    pub(crate) fn new(view: &View, width: u32, height: u32) -> Self {
        let [width, height] = [width as f32, height as f32];
        let aspect = width / height;
        let forward = (view.at - view.from).normalize();
        let right = forward.cross(Vec3A::Y).normalize();
        let half_height =
            (view.field_of_view.to_radians() / 2.0).tan() * (16.0 / 9.0 / aspect).max(1.0);
        Self {
            eye: view.from,
            forward,
            right: right * (half_height * aspect),
            up: right.cross(forward) * half_height,
            width,
            height,
        }
    }

    /// The ray through a point of the picture, in pixels from its upper left corner: the centre of
    /// the first pixel is (0.5, 0.5).
    ///
    /// d = forward + (2x/width − 1)·right + (1 − 2y/height)·up, normalised.
    pub(crate) fn ray(&self, x: f32, y: f32) -> Ray<Vec3A> {
        Ray::new(self.eye, self.direction(x, y).normalize())
    }

    /// The pyramid of the rays through a rectangle of the picture, with the corners in the order upper left, upper
    /// right, lower right, lower left. `None` if it is too narrow for floats.
    pub(crate) fn pyramid(&self, [x0, y0]: [f32; 2], [x1, y1]: [f32; 2]) -> Option<Pyramid<Vec3A>> {
        let corners = [(x0, y0), (x1, y0), (x1, y1), (x0, y1)];
        Pyramid::new(self.eye, corners.map(|(x, y)| self.direction(x, y)))
    }

    /// The cone around the ray through a pixel's centre that is as wide as the pixel, by its area.
    pub(crate) fn cone(&self, pixel: [u32; 2]) -> Cone<Vec3A> {
        let [x, y] = pixel.map(|x| x as f32 + 0.5);
        let ray = self.ray(x, y);
        // The pixel lies ahead by 1, and is seen under an angle.
        let area = 4.0 * self.right.length() * self.up.length() / (self.width * self.height);
        let cosine = self.forward.dot(ray.direction);
        Cone::new(ray, 0.0, (area * cosine.powi(3) / std::f32::consts::PI).sqrt())
    }

    /// Where all rays start.
    pub(crate) fn eye(&self) -> Vec3A {
        self.eye
    }

    /// The directions to the corners of the picture, in the same order.
    pub(crate) fn corners(&self) -> [Vec3A; 4] {
        let (right, bottom) = (self.width, self.height);
        [(0.0, 0.0), (right, 0.0), (right, bottom), (0.0, bottom)]
            .map(|(x, y)| self.direction(x, y))
    }

    /// How far a point lies ahead.
    pub(crate) fn depth(&self, point: Vec3A) -> f32 {
        self.forward.dot(point - self.eye)
    }

    /// The direction to a point of the picture, which lies ahead by 1.
    fn direction(&self, x: f32, y: f32) -> Vec3A {
        let along = 2.0 * x / self.width - 1.0;
        let above = 1.0 - 2.0 * y / self.height;
        self.forward + self.right * along + self.up * above
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const VIEW: View = View {
        from: Vec3A::new(1.0, 2.0, 5.0),
        at: Vec3A::new(1.0, 2.0, 0.0),
        field_of_view: 90.0,
    };

    #[test]
    fn the_ray_through_the_middle_looks_straight_ahead() {
        // The middle of an odd picture is the centre of its middle pixel.
        let camera = Camera::new(&VIEW, 33, 17);
        let ray = camera.ray(16.5, 8.5);
        assert_eq!(ray.origin, VIEW.from);
        assert!((ray.direction - Vec3A::NEG_Z).length() < 1e-6);
    }

    #[test]
    fn the_edges_are_half_the_field_of_view_away() {
        let camera = Camera::new(&VIEW, 1600, 900);
        let up = camera.ray(800.0, 0.0).direction;
        assert!((up.y - 0.5_f32.sqrt()).abs() < 1e-6 && up.x.abs() < 1e-6);
        let right = camera.ray(1600.0, 450.0).direction;
        assert!((right.x / -right.z - 16.0 / 9.0).abs() < 1e-5);
    }

    #[test]
    fn a_pixel_is_a_pyramid_around_its_ray() {
        let camera = Camera::new(&VIEW, 1600, 900);
        let pyramid = camera.pyramid([100.0, 200.0], [101.0, 201.0]).expect("it is wide enough");
        let corners = [(100.0, 200.0), (101.0, 200.0), (101.0, 201.0), (100.0, 201.0)];
        for (corner, (x, y)) in pyramid.corners.into_iter().zip(corners) {
            assert!((corner.normalize() - camera.ray(x, y).direction).length() < 1e-6);
        }
        for (x, y, inside) in [(100.5, 200.5, true), (99.9, 200.5, false), (100.5, 201.1, false)] {
            assert_eq!(pyramid.contains(camera.ray(x, y).at(3.0)), inside);
        }
        let too_narrow = camera.pyramid([100.0, 200.0], [100.0, 201.0]);
        assert!(too_narrow.is_none());
    }

    #[test]
    fn a_tall_picture_keeps_the_width() {
        let camera = Camera::new(&VIEW, 90, 160);
        let right = camera.ray(90.0, 80.0).direction;
        assert!((right.x / -right.z - 16.0 / 9.0).abs() < 1e-5);
    }
}
