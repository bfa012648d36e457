//! Parts of a picture, rendered by `--crop` wherever there is a processor, and put together by `--merge`.
//!
//! A part is a PNG file with three texts: `Crop`, its place in the whole; `Size`, that of the whole; `Rendering`, what
//! else its pixels follow from. The first two are written as on the command line.

use std::error::Error;
use std::fmt::{self, Debug, Write as _};
use std::fs::File;
use std::io::BufReader;
use std::path::{Path, PathBuf};

use png::{BitDepth, ColorType, Decoder, Reader};

use crate::failure::Failure;
use crate::parse_size;
use crate::picture::Picture;
use crate::render::Tile;

/// Where a part belongs.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Place {
    /// Its pixels.
    pub(crate) crop: Tile,
    /// The width and the height of the whole.
    pub(crate) size: [u32; 2],
    /// Of which rendering it is, in ASCII on one line.
    pub(crate) rendering: String,
}

const CROP: &str = "Crop";
const SIZE: &str = "Size";
const RENDERING: &str = "Rendering";

impl Place {
    /// The texts of the file.
    pub(crate) fn texts(&self) -> [(&'static str, String); 3] {
        let [width, height] = self.size;
        [
            (CROP, self.crop.to_string()),
            (SIZE, format!("{width}x{height}")),
            (RENDERING, self.rendering.clone()),
        ]
    }

    /// Reads the texts; the reason if it is no part.
    fn read(reader: &Reader<BufReader<File>>) -> Result<Self, String> {
        let info = reader.info();
        let text = |keyword| {
            let mut texts = info.uncompressed_latin1_text.iter();
            let found = texts.find(|text| text.keyword == keyword).map(|text| text.text.as_str());
            found.ok_or_else(|| format!("not a part of a picture: no text '{keyword}' in it"))
        };
        let (crop, size) = (text(CROP)?, text(SIZE)?);
        let blame = |reason| format!("not a part of a picture: {crop} of {size}: {reason}");
        let place = Self {
            size: parse_size(size).map_err(blame)?,
            crop: parse_crop(crop).map_err(blame)?,
            rendering: text(RENDERING)?.into(),
        };
        place.crop.check(place.size).map_err(blame)?;
        let size = [place.crop.x.len(), place.crop.y.len()];
        if size != [info.width as usize, info.height as usize] {
            return Err(blame(format!("but it has {}x{} pixels", info.width, info.height)));
        }
        if reader.output_color_type() != (ColorType::Rgb, BitDepth::Eight) {
            return Err(blame("but its colours are not three bytes".into()));
        }
        Ok(place)
    }

    /// Whether it is of the same rendering as `first`, which is `like` that.
    fn check_like(&self, like: &Self, first: &Path) -> Result<(), String> {
        if self.size == like.size && self.rendering == like.rendering {
            return Ok(());
        }
        let [mine, others] =
            [self, like].map(|Self { size: [width, height], rendering, .. }| {
                format!("{width}x{height}, {rendering}")
            });
        Err(format!("of another picture than {}: {mine}; not {others}", first.display()))
    }
}

/// Reads `0,0,480,270`.
pub(crate) fn parse_crop(text: &str) -> Result<Tile, String> {
    let numbers: Option<Vec<u32>> = text.split(',').map(|number| number.parse().ok()).collect();
    let Some(&[x0, y0, x1, y1]) = numbers.as_deref() else {
        return Err("not of the form 0,0,480,270".into());
    };
    if x0 >= x1 || y0 >= y1 {
        return Err("no pixels in it".into());
    }
    Ok(Tile { x: x0..x1, y: y0..y1 })
}

impl Tile {
    /// Whether it lies in a picture of this size.
    pub(crate) fn check(&self, [width, height]: [u32; 2]) -> Result<(), String> {
        if self.x.end <= width && self.y.end <= height {
            return Ok(());
        }
        Err(format!("there are no pixels beyond {width}x{height}"))
    }

    /// What it has in common with another.
    fn common(&self, other: &Self) -> Option<Self> {
        let [x, y] = [(&self.x, &other.x), (&self.y, &other.y)]
            .map(|(a, b)| a.start.max(b.start)..a.end.min(b.end));
        (!x.is_empty() && !y.is_empty()).then_some(Self { x, y })
    }
}

impl fmt::Display for Tile {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{},{},{},{}", self.x.start, self.y.start, self.x.end, self.y.end)
    }
}

/// Puts parts together, whatever their order: each pixel of the picture has to be in one of them.
pub(crate) fn merge(files: &[PathBuf]) -> Result<Picture, Box<dyn Error>> {
    let mut whole = Picture::default();
    let mut done = Vec::<(&Path, Place)>::with_capacity(files.len());
    for file in files {
        let blame = |reason: String| Failure::new(file, reason);
        let opened = File::open(file).map_err(|error| Failure::new(file, error))?;
        let mut reader = Decoder::new(BufReader::new(opened))
            .read_info()
            .map_err(|error| Failure::new(file, error))?;
        let place = Place::read(&reader).map_err(blame)?;
        match done.first() {
            None => whole = Picture::new(place.size),
            Some((first, like)) => place.check_like(like, first).map_err(blame)?,
        }
        for (other, taken) in &done {
            if let Some(common) = place.crop.common(&taken.crop) {
                let other = other.display();
                return Err(blame(format!("the pixels {common} are in {other} too")).into());
            }
        }
        let mut pixels = vec![[0; 3]; place.crop.x.len() * place.crop.y.len()];
        reader.next_frame(pixels.as_flattened_mut()).map_err(|error| Failure::new(file, error))?;
        whole.put(&place.crop, &pixels);
        done.push((file, place));
    }
    match missing(done.iter().map(|(_, place)| &place.crop), [whole.width, whole.height]) {
        Some(missing) => Err(format!("the pixels {missing} are in none of the parts").into()),
        None => Ok(whole),
    }
}

/// Pixels of the whole that are in none of its parts: from the first one as many as there are to the right, and of
/// these rows as many as there are below.
fn missing<'a>(parts: impl Iterator<Item = &'a Tile>, size: [u32; 2]) -> Option<Tile> {
    let [width, height] = size.map(|edge| edge as usize);
    let mut is_there = vec![false; width * height];
    for part in parts {
        for y in part.y.clone() {
            let row = y as usize * width;
            is_there[row + part.x.start as usize..row + part.x.end as usize].fill(true);
        }
    }
    let first = is_there.iter().position(|there| !there)?;
    let (x, y) = (first % width, first / width);
    let columns = is_there[first..(y + 1) * width].iter().take_while(|there| !**there).count();
    let is_missing = |y: &usize| !is_there[y * width + x..][..columns].contains(&true);
    let rows = (y..height).take_while(is_missing).count();
    let [x, y] = [(x, columns), (y, rows)].map(|(start, count)| {
        let edge = |at| u32::try_from(at).expect("it is in the picture");
        edge(start)..edge(start + count)
    });
    Some(Tile { x, y })
}

/// A digest of what a value's `Debug` says, all of it for the types of this program: FNV-1a, by G. Fowler, L. C. Noll
/// and K.-P. Vo.
pub(crate) fn digest(value: &impl Debug) -> u64 {
    struct Fnv(u64);
    impl fmt::Write for Fnv {
        fn write_str(&mut self, text: &str) -> fmt::Result {
            for byte in text.bytes() {
                self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3);
            }
            Ok(())
        }
    }
    let mut digest = Fnv(0xcbf2_9ce4_8422_2325);
    write!(digest, "{value:?}").expect("a digest takes any text");
    digest.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_digest_is_that_of_its_authors() {
        // `Debug` of a name writes it as it is.
        struct Text(&'static str);
        impl Debug for Text {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str(self.0)
            }
        }
        assert_eq!(digest(&Text("")), 0xcbf2_9ce4_8422_2325);
        assert_eq!(digest(&Text("a")), 0xaf63_dc4c_8601_ec8c);
        assert_eq!(digest(&Text("foobar")), 0x8594_4171_f739_67e8);
    }

    #[test]
    fn missing_pixels_are_a_rectangle() {
        let missing = |parts: &[&str]| {
            let parts: Vec<_> = parts.iter().map(|part| parse_crop(part).unwrap()).collect();
            missing(parts.iter(), [5, 4]).map(|tile| tile.to_string())
        };
        assert_eq!(missing(&[]).unwrap(), "0,0,5,4");
        assert_eq!(missing(&["0,0,5,1", "0,3,5,4"]).unwrap(), "0,1,5,3");
        assert_eq!(missing(&["0,0,2,4", "3,0,5,4"]).unwrap(), "2,0,3,4");
        assert_eq!(missing(&["0,0,5,2", "0,2,1,3"]).unwrap(), "1,2,5,4");
        assert_eq!(missing(&["0,0,5,2", "0,2,1,4", "1,3,5,4"]).unwrap(), "1,2,5,3");
        assert_eq!(missing(&["0,0,5,3", "0,3,5,4"]), None);
    }
}
