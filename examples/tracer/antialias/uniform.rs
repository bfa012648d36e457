//! Supersampling on a regular grid: a pixel is the mean of the colours at the centres of the equal squares that it
//! is divided into, of which a single one has the pixel's own centre.

use super::{Eye, PerEdge};
use crate::render::Tile;
use crate::scene::Color;
use crate::shade::RayCounts;

/// The colours of a tile's pixels.
pub(super) fn colors(
    per_edge: PerEdge,
    eye: &Eye<'_>,
    tile: &Tile,
    counts: &mut RayCounts,
) -> Vec<Color> {
    eye.means(tile, per_edge.cells(), |pixel| per_edge.points(pixel, || [0.5; 2]), counts)
}
