//! From a scene to a picture: tiles on all cores, samples per pixel, statistics.

use std::ops::Range;

use rayon::iter::{IntoParallelRefIterator, ParallelIterator};

use crate::antialias::{Eye, Method};
use crate::picture::Picture;
use crate::scene::Color;
use crate::shade::RayCounts;

/// The edge of a tile in pixels.
const TILE: u32 = 32;

/// A rectangle of pixels.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Tile {
    pub(crate) x: Range<u32>,
    pub(crate) y: Range<u32>,
}

impl Tile {
    /// Its pixels, row by row.
    pub(crate) fn pixels(&self) -> impl Iterator<Item = [u32; 2]> {
        self.y.clone().flat_map(|y| self.x.clone().map(move |x| [x, y]))
    }

    /// Its width and height.
    pub(crate) fn size(&self) -> [u32; 2] {
        [self.x.end - self.x.start, self.y.end - self.y.start]
    }

    /// The tiles that it is rendered in, row by row.
    pub(crate) fn tiles(&self) -> Vec<Self> {
        fn ranges(edge: &Range<u32>) -> impl Iterator<Item = Range<u32>> {
            edge.clone().step_by(TILE as usize).map(|start| start..(start + TILE).min(edge.end))
        }
        let columns = || ranges(&self.x);
        ranges(&self.y).flat_map(|y| columns().map(move |x| Self { x, y: y.clone() })).collect()
    }
}

/// Renders a part of a picture on rayon's threads, tile by tile. `finish` makes pixels out of colours, `progress` is
/// called after each tile.
///
/// A pixel depends on nothing but its place, and the counts are integers: the same method gives the same picture and
/// the same counts, in whatever order the tiles are done.
pub(crate) fn render<P: Copy + Default + Send>(
    eye: &Eye<'_>,
    method: Method,
    part: &Tile,
    finish: impl Fn(Color) -> P + Sync,
    progress: impl Fn() + Sync,
) -> (Picture<P>, RayCounts) {
    let tiles = part.tiles();
    let done: Vec<(Vec<P>, RayCounts)> = tiles
        .par_iter()
        .map(|tile| {
            let mut counts = RayCounts::default();
            let colors = method.colors(eye, tile, &mut counts);
            progress();
            (colors.into_iter().map(&finish).collect(), counts)
        })
        .collect();

    let mut picture = Picture::new(part.size());
    let mut total = RayCounts::default();
    for (Tile { x, y }, (pixels, counts)) in tiles.into_iter().zip(done) {
        let [x, y] = [(x, part.x.start), (y, part.y.start)]
            .map(|(of_tile, start)| of_tile.start - start..of_tile.end - start);
        picture.put(&Tile { x, y }, &pixels);
        total += counts;
    }
    (picture, total)
}
