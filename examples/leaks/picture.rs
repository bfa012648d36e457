//! A picture of panels, and its file.

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::Path;

use png::{BitDepth, ColorType, Compression, Encoder, Filter};

pub(crate) type Color = [u8; 3];

/// Two rows of three square panels.
pub(crate) struct Picture {
    /// The width of a panel.
    size: usize,
    pixels: Vec<Color>,
}

impl Picture {
    const COLUMNS: usize = 3;
    const ROWS: usize = 2;
    /// Between the panels.
    const GAP: usize = 8;
    const GROUND: Color = [255; 3];

    /// Panels of `size` times `size` pixels, without anything.
    pub(crate) fn new(size: usize) -> Self {
        let [width, height] = Self::extent(size);
        Self { size, pixels: vec![Self::GROUND; width * height] }
    }

    fn extent(size: usize) -> [usize; 2] {
        [Self::COLUMNS, Self::ROWS].map(|panels| panels * (size + Self::GAP) - Self::GAP)
    }

    /// Fills a panel with what `color` says of its pixels, (0, 0) at the upper left.
    pub(crate) fn draw(&mut self, panel: usize, color: impl Fn(usize, usize) -> Color) {
        let [width, _] = Self::extent(self.size);
        let [left, top] = [panel % Self::COLUMNS, panel / Self::COLUMNS]
            .map(|place| place * (self.size + Self::GAP));
        for y in 0..self.size {
            for x in 0..self.size {
                self.pixels[(top + y) * width + left + x] = color(x, y);
            }
        }
    }

    /// Writes it as PNG.
    pub(crate) fn write(&self, file: &Path) -> io::Result<()> {
        let [width, height] = Self::extent(self.size)
            .map(|pixels| u32::try_from(pixels).expect("a picture is small"));
        let mut file = BufWriter::new(File::create(file)?);
        let mut encoder = Encoder::new(&mut file, width, height);
        encoder.set_color(ColorType::Rgb);
        encoder.set_depth(BitDepth::Eight);
        encoder.set_compression(Compression::High);
        // In flat colours a filter only hides what repeats.
        encoder.set_filter(Filter::NoFilter);
        let mut writer = encoder.write_header()?;
        writer.write_image_data(self.pixels.as_flattened())?;
        writer.finish()?;
        file.flush()
    }
}
