//! A bar for each contender, as long as its ratio to the reference, question by question.

use std::error::Error;

use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use crate::report::ratio;
use crate::timing::{Outcome, Question};

const WIDTH: i32 = 900;
const MARGIN: i32 = 16;
const TITLE: i32 = 34;
const ROW: i32 = 20;

/// Where the bars begin, and how long one of the reference's is.
const BARS: i32 = 420;
const UNIT: i32 = 200;

/// M. Okabe, K. Ito, "Color Universal Design", 2008: blue for isect, orange for the peers, grey for the reference.
const ISECT: RGBColor = RGBColor(0, 114, 178);
const PEER: RGBColor = RGBColor(230, 159, 0);
const REFERENCE: RGBColor = RGBColor(120, 120, 120);

/// The bars of a question.
pub struct Group {
    title: String,
    /// Name, colour and ratio.
    bars: Vec<(&'static str, RGBColor, f64)>,
}

impl Group {
    pub fn new(question: &Question, outcomes: &[Outcome]) -> Self {
        let bars = question.contenders.iter().zip(outcomes).map(|(contender, outcome)| {
            let color = match contender.name {
                _ if contender.is_reference => REFERENCE,
                name if name.starts_with("isect") => ISECT,
                _ => PEER,
            };
            (contender.name, color, ratio(outcome))
        });
        Self { title: question.title.clone(), bars: bars.collect() }
    }
}

/// The chart, as SVG. A bar that is too long is cut off, and its number says how long it is.
pub fn draw(groups: &[Group]) -> Result<String, Box<dyn Error>> {
    let rows: i32 = groups.iter().map(|group| group.bars.len() as i32 * ROW + TITLE).sum();
    let size = (WIDTH as u32, (rows + 2 * MARGIN) as u32);
    let mut svg = String::new();
    {
        let area = SVGBackend::with_string(&mut svg, size).into_drawing_area();
        area.fill(&WHITE)?;
        let font = ("sans-serif", 13).into_font();
        let middle = |h| TextStyle::from(font.clone()).pos(Pos::new(h, VPos::Center));
        let mut top = MARGIN;
        for Group { title, bars } in groups {
            let heading = TextStyle::from(("sans-serif", 15).into_font().style(FontStyle::Bold));
            area.draw(&Text::new(title.as_str(), (MARGIN, top + 8), heading))?;
            top += TITLE;
            for &(name, color, ratio) in bars {
                let center = top + ROW / 2;
                let end = BARS + (ratio * f64::from(UNIT)) as i32;
                let cut = end.min(WIDTH - MARGIN - 44);
                let name = name.replace('`', "");
                area.draw(&Text::new(name, (BARS - 8, center), middle(HPos::Right)))?;
                let bar = [(BARS, top + 3), (cut, top + ROW - 3)];
                area.draw(&Rectangle::new(bar, color.filled()))?;
                let number = format!("{ratio:.2}{}", if end > cut { " →" } else { "" });
                area.draw(&Text::new(number, (cut + 5, center), middle(HPos::Left)))?;
                top += ROW;
            }
        }
        area.present()?;
    }
    Ok(svg)
}
