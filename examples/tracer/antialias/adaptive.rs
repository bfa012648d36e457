//! Adaptive supersampling: T. Whitted, "An Improved Illumination Model for Shaded Display", CACM 23.6, 1980.
//!
//! Rays pass through the corners of a pixel. A cell whose corners differ in colour splits in four; another has the
//! mean of its corners. Neighbours share corners, so that a pixel in which nothing happens costs one ray. What is
//! so small that it lies between all corners is missed.

use std::collections::HashMap;

use super::Eye;
use crate::render::Tile;
use crate::scene::Color;
use crate::shade::RayCounts;

/// Colours differ if the contrast of one channel is greater than this: D. P. Mitchell, "Generating Antialiased
/// Images at Low Sampling Densities", SIGGRAPH 1987, measures (max − min) / (max + min).
const CONTRAST: f32 = 0.1;

/// Half of one of the 256 steps of a colour: what differs by less is not seen, however dark it is.
const INVISIBLE: f32 = 1.0 / 512.0;

/// The colours of a tile's pixels.
pub(super) fn colors(
    max_level: u8,
    eye: &Eye<'_>,
    tile: &Tile,
    counts: &mut RayCounts,
) -> Vec<Color> {
    let mut corners = Corners { eye, counts, per_pixel: 1 << max_level, colors: HashMap::new() };
    tile.pixels().map(|pixel| corners.cell(pixel.map(|x| x << max_level), 1 << max_level)).collect()
}

/// The corners of the finest cells, each asked for once.
struct Corners<'a> {
    eye: &'a Eye<'a>,
    counts: &'a mut RayCounts,
    /// How many of the finest cells lie along one edge of a pixel.
    per_pixel: u32,
    colors: HashMap<[u32; 2], Color>,
}

impl Corners<'_> {
    /// The colour of a cell; in units of the finest ones, its upper left corner and its edge.
    fn cell(&mut self, [x, y]: [u32; 2], edge: u32) -> Color {
        let corners =
            [[x, y], [x + edge, y], [x, y + edge], [x + edge, y + edge]].map(|at| self.at(at));
        if edge == 1 || !differ(&corners) {
            return corners.iter().sum::<Color>() / 4.0;
        }
        let half = edge / 2;
        let quarters = [[x, y], [x + half, y], [x, y + half], [x + half, y + half]];
        quarters.map(|at| self.cell(at, half)).iter().sum::<Color>() / 4.0
    }

    /// The colour at a corner.
    fn at(&mut self, corner: [u32; 2]) -> Color {
        let Self { eye, counts, per_pixel, colors } = self;
        *colors
            .entry(corner)
            .or_insert_with(|| eye.color(corner.map(|x| x as f32 / *per_pixel as f32), counts))
    }
}

/// Whether the colours of some corners differ.
fn differ(corners: &[Color; 4]) -> bool {
    let [least, greatest] = [Color::min, Color::max]
        .map(|extreme| corners.iter().copied().reduce(extreme).expect("there are four"));
    let difference = greatest - least;
    (difference.cmpgt(CONTRAST * (greatest + least)) & difference.cmpgt(Color::splat(INVISIBLE)))
        .any()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn contrast_is_relative_and_seen() {
        let corners = |color| [Color::splat(0.5), color, Color::splat(0.5), Color::splat(0.5)];
        assert!(!differ(&corners(Color::splat(0.5))));
        assert!(differ(&corners(Color::new(0.5, 0.62, 0.5))));
        assert!(!differ(&corners(Color::new(0.5, 0.58, 0.5))));
        let dark = |x: f32| [Color::splat(x), Color::ZERO, Color::ZERO, Color::ZERO];
        assert!(differ(&dark(0.01)) && !differ(&dark(0.001)));
    }
}
