//! From a scene to a picture: tiles on all cores, samples per pixel, statistics.

use std::ops::Range;

use isect::glam::Vec3;
use rayon::iter::{IntoParallelRefIterator, ParallelIterator};

use crate::accelerator::PACKET;
use crate::camera::Camera;
use crate::scene::Color;
use crate::shade::{RayCounts, Tracer};

/// The edge of a tile in pixels.
const TILE: u32 = 32;

/// A picture in sRGB, row by row from the top.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct Picture {
    pub(crate) width: u32,
    pub(crate) height: u32,
    pub(crate) pixels: Vec<[u8; 3]>,
}

/// How a picture is made.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Settings {
    /// In pixels.
    pub(crate) width: u32,
    /// In pixels.
    pub(crate) height: u32,
    /// The samples along one edge of a pixel: their number is the square.
    pub(crate) samples_per_edge: u16,
}

impl Settings {
    /// The number of tiles.
    pub(crate) fn tiles(&self) -> u64 {
        u64::from(self.width.div_ceil(TILE)) * u64::from(self.height.div_ceil(TILE))
    }
}

/// A rectangle of pixels.
struct Tile {
    x: Range<u32>,
    y: Range<u32>,
}

/// Renders on rayon's threads; `progress` is called after each tile.
///
/// A pixel depends on nothing but its place, and the counts are integers: the same settings give
/// the same picture and the same counts, in whatever order the tiles are done.
pub(crate) fn render(
    tracer: &Tracer<'_>,
    camera: &Camera,
    settings: &Settings,
    progress: impl Fn() + Sync,
) -> (Picture, RayCounts) {
    let Settings { width, height, .. } = *settings;
    let tiles: Vec<Tile> = starts(height)
        .flat_map(|y| {
            starts(width)
                .map(move |x| Tile { x: x..(x + TILE).min(width), y: y..(y + TILE).min(height) })
        })
        .collect();
    let done: Vec<(Vec<[u8; 3]>, RayCounts)> = tiles
        .par_iter()
        .map(|tile| {
            let mut counts = RayCounts::default();
            let mut pixels = Vec::with_capacity(tile.x.len() * tile.y.len());
            for y in tile.y.clone() {
                let colors = row(tracer, camera, settings, tile.x.clone(), y, &mut counts);
                pixels.extend(colors.into_iter().map(srgb));
            }
            progress();
            (pixels, counts)
        })
        .collect();

    let mut pixels = vec![[0; 3]; width as usize * height as usize];
    let mut total = RayCounts::default();
    for (tile, (done, counts)) in tiles.iter().zip(done) {
        total += counts;
        for (y, row) in tile.y.clone().zip(done.chunks_exact(tile.x.len())) {
            let first = y as usize * width as usize + tile.x.start as usize;
            pixels[first..first + row.len()].copy_from_slice(row);
        }
    }
    let picture = Picture { width, height, pixels };
    (picture, total)
}

/// Where the tiles along an edge of the picture start.
fn starts(length: u32) -> impl Iterator<Item = u32> {
    (0..length).step_by(TILE as usize)
}

/// Some pixels of a row, each the mean of its samples: the centres of the squares into which a regular grid
/// divides it, of which a single one is the pixel's own centre. Samples that follow each other go together.
fn row(
    tracer: &Tracer<'_>,
    camera: &Camera,
    settings: &Settings,
    pixels: Range<u32>,
    y: u32,
    counts: &mut RayCounts,
) -> Vec<Color> {
    let per_edge = settings.samples_per_edge;
    let offset = |sample: u16| (f32::from(sample) + 0.5) / f32::from(per_edge);
    let grid = || (0..per_edge).flat_map(|row| (0..per_edge).map(move |column| (column, row)));
    let rays: Vec<_> = pixels
        .flat_map(|x| grid().map(move |sample| (x, sample)))
        .map(|(x, (column, row))| camera.ray(x as f32 + offset(column), y as f32 + offset(row)))
        .collect();
    let mut samples = Vec::with_capacity(rays.len());
    for packet in rays.chunks(PACKET) {
        samples.extend_from_slice(&tracer.colors(packet, counts)[..packet.len()]);
    }
    let per_pixel = usize::from(per_edge * per_edge);
    samples
        .chunks_exact(per_pixel)
        // A highlight brighter than white would leave steps at the edges.
        .map(|samples| samples.iter().map(|color| color.min(Color::ONE)).sum::<Color>())
        .map(|sum| sum / per_pixel as f32)
        .collect()
}

/// The colour in sRGB (IEC 61966-2-1).
fn srgb(linear: Color) -> [u8; 3] {
    let encode = |x: f32| {
        if x <= 0.003_130_8 { 12.92 * x } else { 1.055 * x.powf(1.0 / 2.4) - 0.055 }
    };
    let encoded: Vec3 = linear.clamp(Vec3::ZERO, Vec3::ONE).map(encode);
    encoded.to_array().map(|x| {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 255")]
        let byte = (x * 255.0).round() as u8;
        byte
    })
}
