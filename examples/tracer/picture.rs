//! A picture, or a rectangular part of one, as PNG.

use std::io::{self, Write};

use png::{BitDepth, ColorType, Compression, Encoder, Filter};

use crate::part::Place;
use crate::render::Tile;
use crate::scene::Color;

/// A picture, in sRGB if nothing else is said, row by row from the top.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Picture<P = [u8; 3]> {
    pub(crate) width: u32,
    pub(crate) height: u32,
    pub(crate) pixels: Vec<P>,
}

impl<P: Copy + Default> Picture<P> {
    /// Without any light.
    pub(crate) fn new([width, height]: [u32; 2]) -> Self {
        Self { width, height, pixels: vec![P::default(); width as usize * height as usize] }
    }

    /// Replaces a part of it.
    pub(crate) fn put(&mut self, place: &Tile, pixels: &[P]) {
        for (y, row) in place.y.clone().zip(pixels.chunks_exact(place.x.len())) {
            let first = y as usize * self.width as usize + place.x.start as usize;
            self.pixels[first..first + row.len()].copy_from_slice(row);
        }
    }
}

impl Picture {
    /// Writes it; if it is a part, with its place.
    pub(crate) fn encode(&self, file: impl Write, place: Option<&Place>) -> io::Result<()> {
        let mut encoder = Encoder::new(file, self.width, self.height);
        encoder.set_color(ColorType::Rgb);
        encoder.set_depth(BitDepth::Eight);
        encoder.set_compression(Compression::Fast);
        encoder.set_filter(Filter::Adaptive);
        for (keyword, text) in place.into_iter().flat_map(Place::texts) {
            encoder.add_text_chunk(keyword.into(), text)?;
        }
        let mut writer = encoder.write_header()?;
        writer.write_image_data(self.pixels.as_flattened())?;
        Ok(writer.finish()?)
    }
}

/// The colour in sRGB (IEC 61966-2-1).
pub(crate) fn srgb(linear: Color) -> [u8; 3] {
    let encode = |x: f32| {
        if x <= 0.003_130_8 { 12.92 * x } else { 1.055 * x.powf(1.0 / 2.4) - 0.055 }
    };
    let encoded: Color = linear.clamp(Color::ZERO, Color::ONE).map(encode);
    encoded.to_array().map(|x| {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 255")]
        let byte = (x * 255.0).round() as u8;
        byte
    })
}
