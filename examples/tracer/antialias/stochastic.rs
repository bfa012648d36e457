//! Stochastic sampling by jitter: R. L. Cook, "Stochastic Sampling in Computer Graphics", ACM TOG 5.1, 1986.
//!
//! A pixel is divided into equal squares with a point at random in each; what a regular grid turns into false
//! patterns becomes noise. The mean is right on average, and for four times as many points its variance is at
//! most a quarter, as for points at random in the whole pixel; at edges it falls to an eighth.

use fastrand::Rng;

use super::{Eye, PerEdge};
use crate::render::Tile;
use crate::scene::Color;
use crate::shade::RayCounts;

/// The colours of a tile's pixels.
pub(super) fn colors(
    per_edge: PerEdge,
    seed: u64,
    eye: &Eye<'_>,
    tile: &Tile,
    counts: &mut RayCounts,
) -> Vec<Color> {
    let points = |pixel| {
        let mut random = random(seed, pixel);
        per_edge.points(pixel, move || [random.f32(), random.f32()])
    };
    eye.means(tile, per_edge.cells(), points, counts)
}

/// The pixel's own random numbers.
fn random(seed: u64, [x, y]: [u32; 2]) -> Rng {
    // A number of the first generator seeds the second: seeds that follow each other should not show.
    Rng::with_seed(Rng::with_seed(seed ^ (u64::from(y) << 32 | u64::from(x))).u64(..))
}
