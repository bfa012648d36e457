//! Collections of shapes in packs, for a caller without a hierarchy: each call dispatches once, and holds the ray
//! against all of them.

mod aabbs;
mod spheres;
mod triangles;

use alloc::vec::Vec;
use core::iter;

use fearless_simd::Level;

pub use aabbs::Aabbs;
pub use spheres::Spheres;
pub use triangles::Triangles;

/// Packs of which all but the last one are full.
#[derive(Clone, Debug)]
struct Packs<P> {
    packs: Vec<P>,
    /// How many shapes they hold.
    len: usize,
    level: Level,
}

impl<P> Default for Packs<P> {
    fn default() -> Self {
        let level = Level::try_detect().unwrap_or(Level::baseline());
        Self { packs: Vec::new(), len: 0, level }
    }
}

impl<P> Packs<P> {
    /// Adds shapes, of which `lanes` make a pack; `unpack` gives back the one of a lane.
    fn extend<S>(
        &mut self,
        shapes: impl IntoIterator<Item = S>,
        lanes: usize,
        pack: impl Fn(&[S]) -> P,
        unpack: impl Fn(&P, usize) -> S,
    ) {
        let mut next = Vec::with_capacity(lanes);
        let open = self.len % lanes;
        if open > 0 {
            next.extend(
                self.packs.last().into_iter().flat_map(|last| (0..open).map(|i| unpack(last, i))),
            );
            self.packs.pop();
        }
        for shape in shapes {
            next.push(shape);
            self.len += 1;
            if next.len() == lanes {
                self.packs.push(pack(&next));
                next.clear();
            }
        }
        if !next.is_empty() {
            self.packs.push(pack(&next));
        }
    }

    /// The shape at an index.
    fn get<S>(&self, index: usize, lanes: usize, unpack: impl Fn(&P, usize) -> S) -> Option<S> {
        (index < self.len).then(|| unpack(&self.packs[index / lanes], index % lanes))
    }

    /// The indices of the lanes that are set in the masks of the packs. `masks` gets up to 64 lanes of them at once,
    /// so that it may dispatch, and writes the masks side by side.
    fn indices(&self, lanes: usize, masks: impl Fn(&[P]) -> u64) -> impl Iterator<Item = usize> {
        self.packs.chunks(64 / lanes).zip((0..).step_by(64)).flat_map(move |(packs, start)| {
            let mut mask = masks(packs);
            iter::from_fn(move || {
                let lane = mask.trailing_zeros() as usize;
                mask &= mask.wrapping_sub(1);
                (lane < 64).then_some(start + lane)
            })
        })
    }
}

/// Whether a pack has what is looked for. (The iterator's own `any` may stay outside of the caller, and so of its level.)
#[inline(always)]
fn any<P>(packs: &[P], has: impl Fn(&P) -> bool) -> bool {
    for pack in packs {
        if has(pack) {
            return true;
        }
    }
    false
}

/// The masks of some packs, side by side, of so many lanes each.
#[inline(always)]
fn side_by_side<P>(packs: &[P], lanes: usize, mask: impl Fn(&P) -> u32) -> u64 {
    let mut masks = 0;
    for (number, pack) in packs.iter().enumerate() {
        masks |= u64::from(mask(pack)) << (number * lanes);
    }
    masks
}

/// The hit at the lesser t; the first of two at the same.
#[inline(always)]
fn closer<H>(
    best: Option<(usize, H)>,
    next: Option<(usize, H)>,
    is_closer: impl Fn(&H, &H) -> bool,
) -> Option<(usize, H)> {
    match (best, next) {
        (Some(best), Some(next)) => Some(if is_closer(&next.1, &best.1) { next } else { best }),
        (best, next) => best.or(next),
    }
}
