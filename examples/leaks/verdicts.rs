//! The verdicts on rays that start at neighbouring floats and pass beside a vertex.
//!
//! L. Kettner, K. Mehlhorn, S. Pion, S. Schirra, C. Yap, "Classroom examples of robustness problems in geometric
//! computations", Computational Geometry 40.1, 2008, made such pictures of the side of a line.

use isect::glam::Vec3A;
use isect::testkit::oracle;
use isect::testkit::shapes::vertices;
use isect::{Ray, Triangle};
use rayon::prelude::*;

use crate::kernels::KERNELS;
use crate::picture::{Color, Picture};

/// The width of a panel, in floats.
const SIZE: usize = 256;

const HIT: Color = [222, 226, 233];
const MISS: Color = [44, 52, 68];
const WRONG_HIT: Color = [255, 163, 26];
const WRONG_MISS: Color = [226, 30, 48];

/// Verdicts that are not those of exact arithmetic.
#[derive(Default)]
pub(crate) struct Wrong {
    pub(crate) hits: usize,
    pub(crate) misses: usize,
}

pub(crate) struct Verdicts {
    pub(crate) picture: Picture,
    /// By kernel.
    pub(crate) wrong: [Wrong; KERNELS.len()],
    /// How many were asked of each.
    pub(crate) rays: usize,
}

/// A triangle a few times larger than the distance from which it is seen, as in a room.
fn triangle() -> Triangle<Vec3A> {
    Triangle::new(
        Vec3A::new(-14.1, 9.2, 2.3),
        Vec3A::new(1.9, 0.3, 4.1),
        Vec3A::new(13.3, 18.7, 1.9),
    )
}

/// The ray of a pixel: parallel to the others, one pixel to the right, or up, is the next float in the origin's x, or y.
/// That of the middle is aimed at v1.
fn ray(triangle: &Triangle<Vec3A>, x: usize, y: usize) -> Ray<Vec3A> {
    let middle = Vec3A::new(0.75, 0.75, -1.0);
    // Between 0.5 and 1 floats are half an EPSILON apart.
    let steps = |pixel: usize| (pixel as f32 - 0.5 * SIZE as f32) * (0.5 * f32::EPSILON);
    let origin = middle + Vec3A::new(steps(x), -steps(y), 0.0);
    Ray::new(origin, triangle.v1 - middle)
}

/// Asks every kernel, and the oracle.
pub(crate) fn verdicts() -> Verdicts {
    let triangle = triangle();
    let exact: Vec<bool> = (0..SIZE * SIZE)
        .into_par_iter()
        .map(|pixel| {
            let ray = ray(&triangle, pixel % SIZE, pixel / SIZE);
            oracle::triangle(&(&ray).into(), vertices(&triangle)).hits()
        })
        .collect();
    let mut picture = Picture::new(SIZE);
    let mut panel = 0;
    let wrong = KERNELS.map(|kernel| {
        let hits = |x, y| (kernel.hits)(&ray(&triangle, x, y), &triangle);
        picture.draw(panel, |x, y| match (exact[y * SIZE + x], hits(x, y)) {
            (true, true) => HIT,
            (false, false) => MISS,
            (false, true) => WRONG_HIT,
            (true, false) => WRONG_MISS,
        });
        panel += 1;
        let mut wrong = Wrong::default();
        for (pixel, &exact) in exact.iter().enumerate() {
            let hits = hits(pixel % SIZE, pixel / SIZE);
            wrong.hits += usize::from(hits && !exact);
            wrong.misses += usize::from(!hits && exact);
        }
        wrong
    });
    Verdicts { picture, wrong, rays: SIZE * SIZE }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_exact_kernel_is_never_wrong() {
        for (kernel, wrong) in KERNELS.iter().zip(&verdicts().wrong) {
            let right = wrong.hits + wrong.misses == 0;
            assert_eq!(right, kernel.name == "isect exact", "{}", kernel.name);
        }
    }
}
