//! How a pixel gets its colour: the methods of `--antialias`, one file each.
//!
//! A method makes the colours of a tile's pixels. Each depends on the pixel's place and on nothing else, not on
//! the tile, the threads or the part of the picture that is rendered: parts fit together to the bit.

mod adaptive;
#[cfg(test)]
mod black;
mod cone;
mod none;
mod pyramid;
mod stochastic;
mod uniform;

use std::fmt;

use clap::{Args, ValueEnum};

use crate::accelerator::PACKET;
use crate::bvh2::Bvh2;
use crate::camera::Camera;
use crate::kernel::Exact;
use crate::render::Tile;
use crate::scene::Color;
use crate::shade::{RayCounts, Tracer};

/// The methods to choose from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum MethodName {
    /// One ray through the pixel's centre
    None,
    /// A regular grid of rays
    Uniform,
    /// Rays through the corners of cells, which split in four where these differ in colour
    Adaptive,
    /// A regular grid of cells with a ray at random in each
    Stochastic,
    /// Pyramids, which split in four where a primitive covers a part of them
    Pyramid,
    /// A cone, of which each thing colours the share that it covers
    Cone,
}

/// What the command line says of the method.
#[derive(Clone, Debug, Args)]
#[group(skip)]
pub(crate) struct Options {
    /// How a pixel gets its colour
    #[arg(long, value_name = "METHOD", value_enum, default_value = "uniform")]
    antialias: MethodName,
    /// Rays per pixel: 1, 4, 9, … 1024; with uniform and stochastic only [default: 4]
    #[arg(long, allow_hyphen_values = true, value_name = "N", value_parser = parse_samples)]
    samples: Option<PerEdge>,
    /// How often a pixel splits at most: 0 to 6; with adaptive and pyramid only [default: 3]
    #[arg(long, allow_hyphen_values = true, value_name = "N", value_parser = clap::value_parser!(u8).range(..=6))]
    max_level: Option<u8>,
    /// What the random numbers follow from; with stochastic only [default: 0]
    #[arg(long, allow_hyphen_values = true, value_name = "N")]
    seed: Option<u64>,
    /// The radius of all lamps, for soft shadows, in units of the scene, up to 10000; with cone only [default: 0]
    #[arg(long, allow_hyphen_values = true, value_name = "R", value_parser = parse_radius)]
    lamp_radius: Option<f32>,
}

/// The cells along one edge of a pixel: their number is the square.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct PerEdge(pub(crate) u16);

/// Reads a square number.
fn parse_samples(text: &str) -> Result<PerEdge, String> {
    let samples: u16 = text.parse().map_err(|_| "not a number from 1 to 1024")?;
    (1..=32)
        .find(|edge| edge * edge == samples)
        .map(PerEdge)
        .ok_or_else(|| "not a square number from 1 to 1024".into())
}

/// The greatest radius of a lamp: scenes are some hundreds wide.
const MAX_RADIUS: f32 = 1e4;

/// Reads a radius.
fn parse_radius(text: &str) -> Result<f32, String> {
    match text.parse() {
        Ok(radius) if (0.0..=MAX_RADIUS).contains(&radius) => Ok(radius),
        _ => Err(format!("not a number from 0 to {MAX_RADIUS}")),
    }
}

/// A method and its parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Method {
    None,
    Uniform(PerEdge),
    Adaptive { max_level: u8 },
    Stochastic(PerEdge, u64),
    Pyramid { max_level: u8 },
    Cone { lamp_radius: f32 },
}

impl Options {
    /// The method that is chosen, if the other options fit it.
    pub(crate) fn method(&self) -> Result<Method, String> {
        let &Self { antialias, samples, max_level, seed, lamp_radius } = self;
        let per_edge = samples.unwrap_or(PerEdge(2));
        let method = match antialias {
            MethodName::None => Method::None,
            MethodName::Uniform => Method::Uniform(per_edge),
            MethodName::Adaptive => Method::Adaptive { max_level: max_level.unwrap_or(3) },
            MethodName::Stochastic => Method::Stochastic(per_edge, seed.unwrap_or(0)),
            MethodName::Pyramid => Method::Pyramid { max_level: max_level.unwrap_or(3) },
            MethodName::Cone => Method::Cone { lamp_radius: lamp_radius.unwrap_or(0.0) },
        };
        let given = [
            (
                samples.is_some(),
                "samples",
                matches!(method, Method::Uniform(_) | Method::Stochastic(..)),
            ),
            (
                max_level.is_some(),
                "max-level",
                matches!(method, Method::Adaptive { .. } | Method::Pyramid { .. }),
            ),
            (seed.is_some(), "seed", matches!(method, Method::Stochastic(..))),
            (lamp_radius.is_some(), "lamp-radius", matches!(method, Method::Cone { .. })),
        ];
        match given.into_iter().find(|&(is_given, _, fits)| is_given && !fits) {
            Some((_, option, _)) => {
                Err(format!("'--{option}' has no place with '--antialias {}'", method.name()))
            }
            None => Ok(method),
        }
    }
}

impl Method {
    /// As on the command line.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Uniform(_) => "uniform",
            Self::Adaptive { .. } => "adaptive",
            Self::Stochastic(..) => "stochastic",
            Self::Pyramid { .. } => "pyramid",
            Self::Cone { .. } => "cone",
        }
    }

    /// What the others are held against: with a seed of its own, so that it shares no random number with them.
    pub(crate) const REFERENCE: Self = Self::Stochastic(PerEdge(32), u64::MAX);

    /// What tells how long they have.
    pub(crate) const BUDGET: Self = Self::Uniform(PerEdge(4));

    /// Each method with the settings to compare, from the cheapest on.
    pub(crate) fn ladders() -> Vec<Vec<Self>> {
        let per_edge = || [2, 3, 4, 6, 8].map(PerEdge).into_iter();
        vec![
            vec![Self::None],
            per_edge().map(Self::Uniform).collect(),
            (0..=5).map(|max_level| Self::Adaptive { max_level }).collect(),
            per_edge().map(|per_edge| Self::Stochastic(per_edge, 0)).collect(),
            (0..=5).map(|max_level| Self::Pyramid { max_level }).collect(),
            vec![Self::Cone { lamp_radius: 0.0 }],
        ]
    }

    /// Whether it asks for several rays at a time, for packets to be made of them.
    pub(crate) fn has_packets(self) -> bool {
        matches!(self, Self::None | Self::Uniform(_) | Self::Stochastic(..))
    }

    /// Whether it looks for all triangles that a solid touches, and needs a hierarchy for that.
    pub(crate) fn has_solids(self) -> bool {
        matches!(self, Self::Pyramid { .. } | Self::Cone { .. })
    }

    /// The colours of a tile's pixels, row by row.
    pub(crate) fn colors(self, eye: &Eye<'_>, tile: &Tile, counts: &mut RayCounts) -> Vec<Color> {
        match self {
            Self::None => none::colors(eye, tile, counts),
            Self::Uniform(per_edge) => uniform::colors(per_edge, eye, tile, counts),
            Self::Adaptive { max_level } => adaptive::colors(max_level, eye, tile, counts),
            Self::Stochastic(per_edge, seed) => {
                stochastic::colors(per_edge, seed, eye, tile, counts)
            }
            Self::Pyramid { max_level } => pyramid::colors(max_level, eye, tile, counts),
            Self::Cone { lamp_radius } => cone::colors(lamp_radius, eye, tile, counts),
        }
    }
}

/// As on the command line.
impl fmt::Display for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())?;
        match self {
            Self::None => Ok(()),
            Self::Uniform(per_edge) => write!(f, " --samples {}", per_edge.cells()),
            Self::Adaptive { max_level } | Self::Pyramid { max_level } => {
                write!(f, " --max-level {max_level}")
            }
            Self::Stochastic(per_edge, seed) => {
                write!(f, " --samples {} --seed {seed}", per_edge.cells())
            }
            Self::Cone { lamp_radius } => write!(f, " --lamp-radius {lamp_radius}"),
        }
    }
}

/// Who sees the picture, and what a method asks for colours. Points are in pixels from the picture's upper left
/// corner; a highlight brighter than white counts as white, else it would leave steps at the edges.
pub(crate) struct Eye<'a> {
    pub(crate) tracer: &'a Tracer<'a>,
    pub(crate) camera: &'a Camera,
    /// The mesh, if there is one and the method [has solids](Method::has_solids).
    pub(crate) hierarchy: Option<&'a Bvh2<Exact>>,
}

impl Eye<'_> {
    /// The colour at a point.
    fn color(&self, [x, y]: [f32; 2], counts: &mut RayCounts) -> Color {
        self.tracer.color(&self.camera.ray(x, y), counts).min(Color::ONE)
    }

    /// Of each pixel of a tile the mean of the colours at `samples` points, those that `points` has for its column
    /// and row. Points that follow each other go together.
    fn means<P: Iterator<Item = [f32; 2]>>(
        &self,
        tile: &Tile,
        samples: usize,
        points: impl Fn([u32; 2]) -> P,
        counts: &mut RayCounts,
    ) -> Vec<Color> {
        let mut means = Vec::with_capacity(tile.x.len() * tile.y.len());
        let mut colors = Vec::with_capacity(tile.x.len() * samples);
        for y in tile.y.clone() {
            let row = tile.x.clone().flat_map(|x| points([x, y]));
            let rays: Vec<_> = row.map(|[x, y]| self.camera.ray(x, y)).collect();
            colors.clear();
            for packet in rays.chunks(PACKET) {
                let packet_colors = self.tracer.colors(packet, counts);
                colors.extend(packet_colors[..packet.len()].iter().map(|c| c.min(Color::ONE)));
            }
            let pixels = colors.chunks_exact(samples);
            means.extend(pixels.map(|pixel| pixel.iter().sum::<Color>() / samples as f32));
        }
        means
    }
}

impl PerEdge {
    /// How many cells there are.
    fn cells(self) -> usize {
        usize::from(self.0 * self.0)
    }

    /// Points of a pixel, row by row: one in each cell, where `within` says, from 0 to 1 to the right and down.
    fn points(
        self,
        [x, y]: [u32; 2],
        mut within: impl FnMut() -> [f32; 2],
    ) -> impl Iterator<Item = [f32; 2]> {
        let cells = (0..self.0).flat_map(move |row| (0..self.0).map(move |column| (column, row)));
        cells.map(move |(column, row)| {
            let [right, down] = within();
            let offset = |cell: u16, within: f32| (f32::from(cell) + within) / f32::from(self.0);
            [x as f32 + offset(column, right), y as f32 + offset(row, down)]
        })
    }
}
