//! No antialiasing: what the ray through a pixel's centre sees is its colour.

use super::{Eye, PerEdge, uniform};
use crate::render::Tile;
use crate::scene::Color;
use crate::shade::RayCounts;

/// The colours of a tile's pixels.
pub(super) fn colors(eye: &Eye<'_>, tile: &Tile, counts: &mut RayCounts) -> Vec<Color> {
    uniform::colors(PerEdge(1), eye, tile, counts)
}
