//! How the colour varies over a surface, or through the block that it is cut from: a function of the point.
//!
//! Marble and wood are those of K. Perlin, "An Image Synthesizer", SIGGRAPH 1985.

use std::f32::consts::TAU;
use std::sync::LazyLock;

use isect::glam::Vec3A;
use noise::{NoiseFn, Perlin};

use crate::scene::Color;

/// How the colour varies over a surface.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Paint {
    Plain(Color),
    /// Squares of edge 1 on the horizontal plane, which fade into each other with the distance from
    /// the origin, before they are smaller than pixels.
    Checkers([Color; 2]),
    /// Cubes of an edge, one with its centre at the origin; they do not fade.
    Cubes {
        colors: [Color; 2],
        edge: f32,
    },
    /// Layers across x that turbulence bends: one colour, and veins of the other in so many layers to a unit.
    Marble {
        colors: [Color; 2],
        layers: f32,
    },
    /// Rings around the axis x = z = 0, light and then darker, so many to a unit.
    Wood {
        colors: [Color; 2],
        rings: f32,
    },
}

impl Paint {
    /// The colour at a point.
    pub(crate) fn at(&self, point: Vec3A) -> Color {
        match *self {
            Self::Plain(color) => color,
            Self::Checkers([even, odd]) => {
                let is_odd = (point.x.floor() + point.z.floor()).rem_euclid(2.0) >= 1.0;
                let distance = point.x.hypot(point.z) / 14.0;
                let contrast = 0.5 / (1.0 + distance * distance);
                even.lerp(odd, if is_odd { 0.5 + contrast } else { 0.5 - contrast })
            }
            Self::Cubes { colors: [even, odd], edge } => {
                let is_odd = (point / edge).round().element_sum().rem_euclid(2.0) >= 1.0;
                if is_odd { odd } else { even }
            }
            Self::Marble { colors: [ground, vein], layers } => {
                let wave = (TAU * layers * (point.x + turbulence(point))).sin();
                ground.lerp(vein, (0.5 + 0.5 * wave).powi(4))
            }
            Self::Wood { colors: [light, dark], rings } => {
                // Trees are longer than they are wide, and so are their irregularities.
                let bent = 0.15 * noise(point * Vec3A::new(1.5, 0.3, 1.5));
                let ring = (rings * (point.x.hypot(point.z) + bent)).fract().abs();
                let grain = 0.3 * noise(point * Vec3A::new(60.0, 2.0, 60.0));
                light.lerp(dark, (ring * ring + grain).clamp(0.0, 1.0))
            }
        }
    }

    /// The mean of the colours over an ellipse around a point, given its axes.
    pub(crate) fn over(&self, center: Vec3A, [across, along]: [Vec3A; 2]) -> Color {
        const POINTS: u8 = 32;
        if let Self::Plain(color) = *self {
            return color;
        }
        // H. Vogel's spiral of 1979, which spreads points evenly over a disk.
        let turn = std::f32::consts::PI * (3.0 - 5.0_f32.sqrt());
        let points = (0..POINTS).map(|i| {
            let (sine, cosine) = (f32::from(i) * turn).sin_cos();
            let radius = ((f32::from(i) + 0.5) / f32::from(POINTS)).sqrt();
            center + (across * cosine + along * sine) * radius
        });
        points.map(|point| self.at(point)).sum::<Color>() / f32::from(POINTS)
    }

    /// The colour that it gives to mirrored light: metal tints it, a coat of varnish does not.
    pub(crate) fn tint(&self) -> Color {
        match *self {
            Self::Plain(tint) => tint,
            _ => Color::ONE,
        }
    }
}

/// Gradient noise: smooth, from −1 to 1, zero on the integer lattice.
#[expect(clippy::cast_possible_truncation, reason = "it has no more digits than its point")]
fn noise(point: Vec3A) -> f32 {
    static NOISE: LazyLock<Perlin> = LazyLock::new(|| Perlin::new(1));
    NOISE.get(point.as_dvec3().to_array()) as f32
}

/// Noise of six scales, each half as wide and half as strong as the one before, and all of it upwards.
fn turbulence(point: Vec3A) -> f32 {
    let scales = (0..6).map(|octave| f32::from(1_u8 << octave));
    scales.map(|scale| noise(point * scale).abs() / scale).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cubes_alternate_along_each_axis() {
        let paint = Paint::Cubes { colors: [Color::ZERO, Color::ONE], edge: 0.5 };
        assert_eq!(paint.at(Vec3A::splat(0.2)), Color::ZERO);
        for axis in [Vec3A::X, Vec3A::Y, Vec3A::Z] {
            assert_eq!(paint.at(0.3 * axis), Color::ONE);
            assert_eq!(paint.at(-0.3 * axis), Color::ONE);
            assert_eq!(paint.at(0.8 * axis), Color::ZERO);
        }
    }
}
