//! How close each method of antialiasing comes to the right picture, and how long it takes.

use std::error::Error;
use std::fmt::Write as _;
use std::ops::Range;
use std::time::Instant;

use plotters::coord::combinators::IntoLogRange;
use plotters::prelude::*;
use plotters::style::Color as _;

use crate::antialias::{Eye, Method};
use crate::picture::Picture;
use crate::render::{Tile, render};
use crate::scene::Color;

/// How often everyone takes a turn; the fastest counts.
const ROUNDS: usize = 3;

/// The plot's width and height.
const PLOT: (u32, u32) = (800, 520);

/// M. Okabe, K. Ito, "Color Universal Design", 2008: colours that differ for all kinds of colour vision.
const PALETTE: [RGBColor; 7] = [
    RGBColor(0, 0, 0),
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(230, 159, 0),
    RGBColor(86, 180, 233),
];

/// A method at one of its settings.
#[derive(Clone, Copy, Debug)]
struct Measured {
    method: Method,
    /// Of all kinds.
    rays: u64,
    seconds: f64,
    /// The root of the mean square error of the colours' channels, which are linear, from 0 to 1.
    rmse: f64,
}

/// What was measured: of each method its settings, from the cheapest on.
#[derive(Debug)]
pub(crate) struct Comparison {
    series: Vec<Vec<Measured>>,
}

impl Comparison {
    /// How many tiles of a picture are rendered for it.
    pub(crate) fn tiles(picture: &Tile) -> usize {
        let settings: usize = Method::ladders().iter().map(Vec::len).sum();
        picture.tiles().len() * (1 + ROUNDS * settings)
    }

    /// Renders a picture by all methods, who take turns, and by stochastic sampling with 1,024 rays to a pixel, which
    /// is taken to be right. `progress` is called after each tile.
    pub(crate) fn new(eye: &Eye<'_>, picture: &Tile, progress: impl Fn() + Sync) -> Self {
        let turn = |method| render(eye, method, picture, |color| color, &progress);
        let (reference, _) = turn(Method::REFERENCE);
        let of_method = |method| Measured { method, rays: 0, seconds: f64::INFINITY, rmse: 0.0 };
        let of_ladder = |ladder: Vec<_>| ladder.into_iter().map(of_method).collect::<Vec<_>>();
        let mut series: Vec<_> = Method::ladders().into_iter().map(of_ladder).collect();
        for _ in 0..ROUNDS {
            for measured in series.iter_mut().flatten() {
                let start = Instant::now();
                let (picture, counts) = turn(measured.method);
                measured.seconds = measured.seconds.min(start.elapsed().as_secs_f64());
                measured.rays = counts.total();
                measured.rmse = Errors::new(&picture, &reference).rmse();
            }
        }
        Self { series }
    }

    /// All of it, and of each method the setting that takes about as long as a regular grid of 16 rays.
    pub(crate) fn table(&self) -> String {
        let mut table = String::new();
        let mut line = |text: String| writeln!(table, "{text}").expect("a string takes any text");
        let row = |of: &Measured| {
            let Measured { method, rays, seconds, rmse } = of;
            let name = method.to_string();
            format!("{name:<36}{:>10.2}{seconds:>10.3}{rmse:>10.5}", *rays as f64 / 1e6)
        };
        line(format!("{:<36}{:>10}{:>10}{:>10}", "--antialias", "Mrays", "s", "RMSE"));
        self.series.iter().flatten().for_each(|measured| line(row(measured)));
        let budget = self.series.iter().flatten().find(|of| of.method == Method::BUDGET);
        let budget = budget.expect("it is one of the settings").seconds;
        line(format!("\nin about {budget:.3} s"));
        for series in &self.series {
            let distance = |of: &&Measured| (of.seconds / budget).ln().abs();
            let closest = series.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)));
            closest.into_iter().for_each(|measured| line(row(measured)));
        }
        table
    }

    /// A plot of the error by time, as SVG.
    pub(crate) fn plot(&self) -> Result<String, Box<dyn Error>> {
        let all = || self.series.iter().flatten();
        let [seconds, errors] = [range(all().map(|of| of.seconds)), range(all().map(|of| of.rmse))];
        let mut svg = String::new();
        {
            let area = SVGBackend::with_string(&mut svg, PLOT).into_drawing_area();
            area.fill(&WHITE)?;
            let mut chart = ChartBuilder::on(&area)
                .margin(16)
                .caption("Error against 1,024 samples to a pixel, by time", ("sans-serif", 18))
                .x_label_area_size(44)
                .y_label_area_size(64)
                .build_cartesian_2d(seconds.log_scale(), errors.log_scale())?;
            chart
                .configure_mesh()
                .light_line_style(TRANSPARENT)
                .bold_line_style(BLACK.mix(0.12))
                .x_desc("seconds")
                .y_desc("RMSE")
                .draw()?;
            for (series, color) in self.series.iter().zip(PALETTE.into_iter().cycle()) {
                let points = || series.iter().map(|of| (of.seconds, of.rmse));
                let name = series.first().map_or("", |of| of.method.name());
                chart
                    .draw_series(LineSeries::new(points(), color.stroke_width(2)))?
                    .label(name)
                    .legend(move |(x, y)| {
                        PathElement::new([(x, y), (x + 18, y)], color.stroke_width(2))
                    });
                chart.draw_series(points().map(|point| Circle::new(point, 4, color.filled())))?;
            }
            chart
                .configure_series_labels()
                .position(SeriesLabelPosition::LowerLeft)
                .background_style(WHITE)
                .border_style(BLACK.mix(0.3))
                .draw()?;
            area.present()?;
        }
        Ok(svg)
    }
}

/// From the least to the greatest of some positive numbers, with room on both sides.
fn range(numbers: impl Iterator<Item = f64>) -> Range<f64> {
    let (least, greatest) =
        numbers.fold((f64::INFINITY, 0.0_f64), |(a, b), x| (a.min(x), b.max(x)));
    least / 1.3..greatest * 1.3
}

/// The square errors of a picture, pixel by pixel, each the mean of its channels'.
struct Errors(Vec<f64>);

impl Errors {
    fn new(picture: &Picture<Color>, reference: &Picture<Color>) -> Self {
        let pixels = picture.pixels.iter().zip(&reference.pixels);
        Self(pixels.map(|(&a, &b)| f64::from((a - b).length_squared()) / 3.0).collect())
    }

    fn mean(&self) -> f64 {
        self.0.iter().sum::<f64>() / self.0.len() as f64
    }

    fn rmse(&self) -> f64 {
        self.mean().sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::antialias::PerEdge;
    use crate::bvh8::Bvh8;
    use crate::camera::Camera;
    use crate::mesh::Obj;
    use crate::scene::SceneName;
    use crate::shade::Tracer;

    impl Errors {
        /// The variance of the logarithm of the root mean square, as the errors' own spread has it:
        /// σ² / (pixels · mean²), and half the logarithm.
        fn log_variance(&self) -> f64 {
            let (mean, pixels) = (self.mean(), self.0.len() as f64);
            let variance = self.0.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / pixels;
            variance / (pixels * mean * mean) / 4.0
        }
    }

    #[test]
    fn errors_fall_as_they_should() {
        let scene = SceneName::Edges.build(Obj::icosphere(2));
        let accelerator = Bvh8::new(&scene.mesh.triangles());
        let tracer = Tracer::new(&scene, &accelerator, 1);
        let camera = Camera::new(&scene.view, 32, 18);
        let eye = Eye { tracer: &tracer, camera: &camera, hierarchy: None };
        let picture = Tile { x: 0..32, y: 0..18 };
        let turn = |method| render(&eye, method, &picture, |color| color, || ());
        let (reference, _) = turn(Method::REFERENCE);

        // Each quadrupling splits every cell in four. The variance of a cell's sample is at least the mean of that of
        // its quarters', so the variance of the mean falls to a quarter or less, whatever is sampled: its root by a
        // slope of −1/2 or less over the logarithm of n. At edges, which only √n of n cells have, it is −3/4.
        let mut errors = Vec::new();
        for per_edge in [1, 2, 4, 8] {
            errors.push(Errors::new(&turn(Method::Stochastic(PerEdge(per_edge), 1)).0, &reference));
        }
        let x = [0.0, 1.0, 2.0, 3.0].map(|quadruplings| quadruplings * 4.0_f64.ln());
        let mean = x.iter().sum::<f64>() / 4.0;
        let square = x.iter().map(|x| (x - mean).powi(2)).sum::<f64>();
        let weight = x.map(|x| (x - mean) / square);
        let slope: f64 = weight.iter().zip(&errors).map(|(w, e)| w * e.rmse().ln()).sum();
        let sigma = weight.iter().zip(&errors).map(|(w, e)| w * w * e.log_variance()).sum::<f64>();
        let sigma = sigma.sqrt();
        // The reference is one of 1,024 samples, whose variance is a sixteenth of that of 64 at most; the line that
        // it lifts by half of that at its end turns by less than weight[3] / 32.
        let tolerance = 3.0 * sigma + weight[3] / 32.0;
        println!("slope {slope:.3}, σ {sigma:.3}");
        assert!(sigma < 0.04);
        assert!(slope < -0.5 + tolerance, "{slope} {tolerance}");
        // What is random in the whole pixel has −1/2; cells have more.
        assert!(slope < -0.5 - tolerance, "{slope} {tolerance}");
    }
}
