//! How the colour varies over a surface, or through the block that it is cut from: a function of the point.
//!
//! Marble and wood are those of K. Perlin, "An Image Synthesizer", SIGGRAPH 1985, with the noise of his "Improving
//! Noise", SIGGRAPH 2002.

use std::array;
use std::f32::consts::TAU;

use isect::glam::{FloatExt, Vec3A};

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

    /// The colour that it gives to mirrored light: metal tints it, a coat of varnish does not.
    pub(crate) fn tint(&self) -> Color {
        match *self {
            Self::Plain(tint) => tint,
            _ => Color::ONE,
        }
    }
}

/// Gradient noise: smooth, about −1 to 1, zero on the integer lattice.
fn noise(point: Vec3A) -> f32 {
    let cell = point.floor();
    let within = point - cell;
    let weight = within * within * within * (within * (within * 6.0 - 15.0) + 10.0);
    let corners: [f32; 8] = array::from_fn(|corner| {
        let corner =
            Vec3A::from([0, 1, 2].map(|axis| if corner >> axis & 1 == 1 { 1.0 } else { 0.0 }));
        slope(cell + corner).dot(within - corner)
    });
    let edges: [f32; 4] = array::from_fn(|i| corners[2 * i].lerp(corners[2 * i + 1], weight.x));
    let faces: [f32; 2] = array::from_fn(|i| edges[2 * i].lerp(edges[2 * i + 1], weight.y));
    faces[0].lerp(faces[1], weight.z)
}

/// The slope of the noise at a point of the lattice: towards an edge of a cube, by a hash.
fn slope(lattice: Vec3A) -> Vec3A {
    let hash = lattice.to_array().into_iter().fold(0x9e37_79b9, |hash: u32, x| {
        // A multiplication carries upwards only, and what differs in whole numbers are the upper bits.
        let mixed = (hash ^ x.to_bits().rotate_left(9)).wrapping_mul(0x85eb_ca6b);
        (mixed ^ mixed >> 13).wrapping_mul(0xc2b2_ae35)
    });
    let hash = hash ^ hash >> 16;
    let [a, b] = [1, 2].map(|bit| if hash & bit == 0 { -1.0 } else { 1.0 });
    match (hash >> 2) % 3 {
        0 => Vec3A::new(a, b, 0.0),
        1 => Vec3A::new(0.0, a, b),
        _ => Vec3A::new(b, 0.0, a),
    }
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
    fn noise_is_zero_on_the_lattice_and_continuous_across_it() {
        let mut random = fastrand::Rng::with_seed(1);
        let [mut least, mut greatest] = [0.0_f32; 2];
        for _ in 0..20_000 {
            let mut point = Vec3A::from([(); 3].map(|()| 40.0 * (random.f32() - 0.5)));
            let value = noise(point);
            [least, greatest] = [least.min(value), greatest.max(value)];
            assert_eq!(noise(point.floor()), 0.0);
            // Of two points that are 2⁻¹⁶ apart, on both sides of a face of the lattice; no slope exceeds 8.
            point.x = point.x.floor();
            let apart = Vec3A::X * 0.5_f32.powi(17);
            assert!((noise(point - apart) - noise(point + apart)).abs() < 8.0 * 0.5_f32.powi(16));
        }
        assert!(least < -0.6 && greatest > 0.6 && least > -1.1 && greatest < 1.1);
    }

    #[test]
    fn noise_has_no_favourite_sign() {
        let mut random = fastrand::Rng::with_seed(2);
        let mut point = || Vec3A::from([(); 3].map(|()| 2000.0 * (random.f32() - 0.5)));
        let mean = (0..40_000).map(|_| noise(point())).sum::<f32>() / 40_000.0;
        // The standard deviation of the noise is about 0.27, that of the mean a two-hundredth: five of them.
        assert!(mean.abs() < 5.0 * 0.27 / 200.0, "{mean}");
    }

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
