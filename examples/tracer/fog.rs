//! Fog, or depth cueing: the farther away, the more of its colour is in what is seen.
//!
//! I = `I_in`·(1 − f) + `I_fog`·f along every ray, also a mirrored or refracted one, of length d. The sky is infinitely
//! far away, where f = 1: it has the colour of the fog, and so has the horizon.

use clap::{Args, ValueEnum};

use crate::scene::Color;

/// The fogs to choose from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum FogName {
    /// Clear air
    None,
    /// f = (d − DMIN) / (DMAX − DMIN), from 0 to 1
    Linear,
    /// f = 1 − e^(−d·D)
    Exponential,
}

/// What the command line says of the fog.
#[derive(Clone, Debug, Args)]
#[group(skip)]
pub(crate) struct Options {
    /// What is between the eye and what it sees
    #[arg(long, value_enum, default_value = "none")]
    fog: FogName,
    /// Where linear fog begins, and where nothing else is left [default: 4,24]
    #[arg(long, allow_hyphen_values = true, value_name = "DMIN,DMAX", value_parser = parse_range)]
    fog_range: Option<[f32; 2]>,
    /// How dense exponential fog is [default: 0.08]
    #[arg(long, allow_hyphen_values = true, value_name = "D", value_parser = parse_density)]
    fog_density: Option<f32>,
    /// Its colour, linear, 0 to 1 [default: that of the sky at the horizon]
    #[arg(long, allow_hyphen_values = true, value_name = "R,G,B", value_parser = parse_color)]
    fog_color: Option<Color>,
}

/// Reads as many numbers as there are commas and one more.
fn numbers<const N: usize>(text: &str) -> Option<[f32; N]> {
    let numbers: Option<Vec<f32>> = text.split(',').map(|number| number.parse().ok()).collect();
    numbers?.try_into().ok().filter(|numbers: &[f32; N]| numbers.iter().all(|x| x.is_finite()))
}

/// Reads `4,24`.
fn parse_range(text: &str) -> Result<[f32; 2], String> {
    match numbers(text) {
        Some([min, max]) if 0.0 <= min && min < max => Ok([min, max]),
        Some(_) => Err("not 0 ≤ DMIN < DMAX".into()),
        None => Err("not of the form 4,24".into()),
    }
}

/// Reads a number that is greater than 0.
fn parse_density(text: &str) -> Result<f32, String> {
    match numbers(text) {
        Some([density]) if density > 0.0 => Ok(density),
        _ => Err("not a number greater than 0".into()),
    }
}

/// Reads `0.7,0.8,0.9`.
fn parse_color(text: &str) -> Result<Color, String> {
    match numbers(text) {
        Some(color) if color.iter().all(|channel| (0.0..=1.0).contains(channel)) => {
            Ok(color.into())
        }
        _ => Err("not three numbers from 0 to 1".into()),
    }
}

impl Options {
    /// The fog that is chosen, if the other options fit it, over a horizon of this colour.
    pub(crate) fn fog(&self, horizon: Color) -> Result<Fog, String> {
        let &Self { fog, fog_range, fog_density, fog_color } = self;
        let given = [
            ("fog-range", fog_range.is_some() && fog != FogName::Linear),
            ("fog-density", fog_density.is_some() && fog != FogName::Exponential),
            ("fog-color", fog_color.is_some() && fog == FogName::None),
        ];
        if let Some((option, _)) = given.into_iter().find(|&(_, is_misplaced)| is_misplaced) {
            let name = fog.to_possible_value().expect("none is left out");
            return Err(format!("'--{option}' has no place with '--fog {}'", name.get_name()));
        }
        let color = fog_color.unwrap_or(horizon);
        Ok(match fog {
            FogName::None => Fog::None,
            FogName::Linear => Fog::Linear { range: fog_range.unwrap_or([4.0, 24.0]), color },
            FogName::Exponential => {
                Fog::Exponential { density: fog_density.unwrap_or(0.08), color }
            }
        })
    }
}

/// What is between the eye and what it sees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Fog {
    None,
    Linear {
        /// 0 ≤ `D_min` < `D_max`.
        range: [f32; 2],
        color: Color,
    },
    Exponential {
        /// D > 0.
        density: f32,
        color: Color,
    },
}

impl Fog {
    /// What a surface of some colour looks like through so much of it.
    pub(crate) fn over(&self, seen: Color, distance: f32) -> Color {
        let (share, color) = match *self {
            Self::None => return seen,
            Self::Linear { range: [min, max], color } => {
                (((distance - min) / (max - min)).clamp(0.0, 1.0), color)
            }
            Self::Exponential { density, color } => (-(-distance * density).exp_m1(), color),
        };
        seen * (1.0 - share) + color * share
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SEEN: Color = Color::new(0.0, 0.5, 1.0);
    const WHITE: Color = Color::ONE;

    #[test]
    fn linear_fog_grows_from_its_beginning_to_its_end() {
        let fog = Fog::Linear { range: [2.0, 4.0], color: WHITE };
        for (distance, share) in
            [(0.0, 0.0), (2.0, 0.0), (2.5, 0.25), (3.0, 0.5), (4.0, 1.0), (f32::INFINITY, 1.0)]
        {
            assert_eq!(fog.over(SEEN, distance), SEEN * (1.0 - share) + WHITE * share);
        }
    }

    #[test]
    fn exponential_fog_lets_through_what_two_layers_of_half_the_depth_do() {
        let fog = Fog::Exponential { density: 0.3, color: WHITE };
        assert_eq!(fog.over(SEEN, 0.0), SEEN);
        assert_eq!(fog.over(SEEN, f32::INFINITY), WHITE);
        for distance in [0.01_f32, 1.0, 2.0, 7.0] {
            let whole = fog.over(SEEN, distance);
            // e^(−2x) = e^(−x)·e^(−x): each side has some four roundings of numbers up to 1.
            let halves = fog.over(fog.over(SEEN, distance / 2.0), distance / 2.0);
            assert!((whole - halves).abs().max_element() < 8.0 * f32::EPSILON, "{distance}");
            let through = (whole.z - whole.x) / (SEEN.z - SEEN.x);
            assert!((through - (-0.3 * distance).exp()).abs() < 8.0 * f32::EPSILON, "{distance}");
        }
    }

    #[test]
    fn clear_air_changes_nothing() {
        assert_eq!(Fog::None.over(SEEN * 3.0, f32::INFINITY), SEEN * 3.0);
    }

    #[test]
    fn bad_numbers_are_refused() {
        for text in ["3,3", "4,3", "-1,3", "1", "1,2,3", "0,inf", "nan,3", ""] {
            assert!(parse_range(text).is_err(), "{text}");
        }
        for text in ["0", "-1", "inf", "nan", "1,2", "x"] {
            assert!(parse_density(text).is_err(), "{text}");
        }
        for text in ["1,1", "1,1,1.1", "-0.1,0,0", "nan,0,0", "white"] {
            assert!(parse_color(text).is_err(), "{text}");
        }
        assert_eq!(parse_range("0,1.5"), Ok([0.0, 1.5]));
        assert_eq!(parse_color("0,0.5,1"), Ok(SEEN));
    }
}
