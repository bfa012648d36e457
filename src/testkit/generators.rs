//! Hard cases, by seed: rays aimed exactly at vertices, edges and faces, coordinates of all magnitudes, flat boxes,
//! degenerate triangles, ranges that end at the hit.
//!
//! Every number is a finite `f32`, so that all vector types take the same case.

use fastrand::Rng;

use super::oracle::Ray;

type Point = [f64; 3];

/// The nearest finite single-precision number.
#[expect(clippy::cast_possible_truncation, reason = "rounding is the purpose")]
#[must_use]
pub fn single(x: f64) -> f64 {
    f64::from((x as f32).clamp(f32::MIN, f32::MAX))
}

fn pick<T: Copy>(rng: &mut Rng, choices: &[T]) -> T {
    choices[rng.usize(..choices.len())]
}

fn power(rng: &mut Rng, exponents: std::ops::RangeInclusive<i32>) -> f64 {
    2f64.powi(rng.i32(exponents))
}

/// A coordinate, in the style of a case.
#[derive(Clone, Copy)]
enum Style {
    /// Small integers: exact coincidences.
    Lattice,
    /// Integers below 2^22.
    Grid,
    /// Full mantissas around 1.
    Uniform,
    /// Magnitudes from 2^−60 to 2^60 in one case, zeros of both signs.
    Mixed,
    /// Full mantissas at a distance of about a million.
    Far,
}

impl Style {
    fn random(rng: &mut Rng) -> Self {
        pick(
            rng,
            &[
                Self::Lattice,
                Self::Lattice,
                Self::Grid,
                Self::Uniform,
                Self::Uniform,
                Self::Mixed,
                Self::Far,
            ],
        )
    }

    fn coordinate(self, rng: &mut Rng) -> f64 {
        match self {
            Self::Lattice => {
                let x = rng.u32(0..=4).into();
                signed(rng, x)
            }
            Self::Grid => f64::from(rng.i32(-(1 << 22)..=1 << 22)),
            Self::Uniform => single(2.0 * rng.f64() - 1.0),
            Self::Mixed if rng.u8(..8) == 0 => signed(rng, 0.0),
            Self::Mixed => single((rng.f64() - 0.5) * power(rng, -60..=60)),
            Self::Far => single(1e6 + rng.f64()),
        }
    }

    fn point(self, rng: &mut Rng) -> Point {
        [(); 3].map(|()| self.coordinate(rng))
    }
}

/// ±x, also for zero.
fn signed(rng: &mut Rng, x: f64) -> f64 {
    if rng.bool() { x } else { -x }
}

fn sum(a: Point, b: Point, weight: f64) -> Point {
    std::array::from_fn(|i| single(a[i] + (b[i] - a[i]) * weight))
}

/// A weight that lands on the ends, on a dyadic point, or anywhere.
fn weight(rng: &mut Rng) -> f64 {
    match rng.u8(..4) {
        0 => 0.0,
        1 => 0.5,
        2 => f64::from(rng.u32(0..=64)) / 64.0,
        _ => rng.f64(),
    }
}

/// A ray of which the line comes near `target`: exactly through it where the difference is representable.
fn aimed(rng: &mut Rng, style: Style, target: Point) -> Ray {
    let mut origin = style.point(rng);
    if rng.u8(..8) == 0 {
        // From far away.
        origin = origin.map(|x| single(x * 1e6));
    }
    let mut direction: Point = std::array::from_fn(|i| single(target[i] - origin[i]));
    let mut t_target = 1.0;
    match rng.u8(..12) {
        // Along an axis or in a plane of axes, from a point that shares coordinates with the target.
        0..=2 => {
            for i in 0..3 {
                if rng.bool() {
                    origin[i] = target[i];
                    direction[i] = single(pick(rng, &[0.0, -0.0, 0.0, 1e-45, -1e-42]));
                }
            }
        }
        // On the target.
        3 => {
            origin = target;
            direction = style.point(rng);
            t_target = 0.0;
        }
        // Of another length, which may be tiny or huge.
        4 => {
            let scale = power(rng, -30..=30);
            direction = direction.map(|x| single(x * scale));
            t_target /= scale;
        }
        5 => {
            let scale = power(rng, -140..=-100);
            direction = direction.map(|x| single(x * scale));
            t_target /= scale;
        }
        // Anywhere.
        6 => direction = style.point(rng),
        _ => {}
    }
    let infinity = f64::INFINITY;
    let t = single(t_target);
    let (t_min, t_max) = match rng.u8(..10) {
        0 => (-infinity, infinity),
        1 => (-infinity, t),
        2 => (t, infinity),
        3 => (0.0, t),
        4 => (t, t),
        5 => (single(-2.0 * rng.f64() * t.max(1.0)), single(2.0 * rng.f64() * t.max(1.0))),
        _ => (0.0, infinity),
    };
    Ray { origin, direction, t_min, t_max }
}

/// Vertices of a triangle: any, or a needle, or degenerate.
fn vertices(rng: &mut Rng, style: Style) -> [Point; 3] {
    let [a, b, mut c] = [(); 3].map(|()| style.point(rng));
    match rng.u8(..16) {
        // Collinear, exactly or as well as rounding allows.
        0 => c = sum(a, b, weight(rng)),
        1 => c = pick(rng, &[a, b]),
        // A needle.
        2 => c = std::array::from_fn(|i| single(b[i] + (c[i] - b[i]) * 1e-6)),
        // In a plane across an axis.
        3 => {
            let axis = rng.usize(..3);
            let mut points = [a, b, c];
            for p in &mut points {
                p[axis] = a[axis];
            }
            return points;
        }
        _ => {}
    }
    [a, b, c]
}

/// A point of a triangle: a vertex, on an edge, or inside.
fn point_of(rng: &mut Rng, &[a, b, c]: &[Point; 3]) -> Point {
    let on_edge = sum(a, b, weight(rng));
    if rng.bool() { on_edge } else { sum(on_edge, c, weight(rng)) }
}

/// A ray and a triangle at which it is aimed.
pub fn ray_triangle(rng: &mut Rng) -> (Ray, [Point; 3]) {
    let style = Style::random(rng);
    let mut triangle = vertices(rng, style);
    triangle.rotate_left(rng.usize(..3));
    let mut target = point_of(rng, &triangle);
    if rng.u8(..8) == 0 {
        target = style.point(rng);
    }
    let mut ray = aimed(rng, style, target);
    if rng.u8(..12) == 0 {
        // In the triangle's plane.
        ray.origin = sum(point_of(rng, &triangle), triangle[0], -1.0);
        ray.direction = std::array::from_fn(|i| single(target[i] - ray.origin[i]));
    }
    (ray, triangle)
}

fn bounds(rng: &mut Rng, style: Style) -> [Point; 2] {
    let (mut a, b) = (style.point(rng), style.point(rng));
    // Flat on some axes, or a point.
    for i in 0..3 {
        if rng.u8(..8) == 0 {
            a[i] = b[i];
        }
    }
    [std::array::from_fn(|i| a[i].min(b[i])), std::array::from_fn(|i| a[i].max(b[i]))]
}

/// A point on the surface of a box: mostly of its edges and corners.
fn surface_point(rng: &mut Rng, [min, max]: &[Point; 2]) -> Point {
    let free = rng.usize(..6);
    std::array::from_fn(|i| {
        if i == free {
            single(min[i] + (max[i] - min[i]) * weight(rng)).clamp(min[i], max[i])
        } else {
            pick(rng, &[min[i], max[i]])
        }
    })
}

/// A ray and a box at whose edges and corners it is aimed: they differ by what rounding the direction does.
pub fn ray_aabb(rng: &mut Rng) -> (Ray, Point, Point) {
    let style = Style::random(rng);
    let mut bounds = bounds(rng, style);
    let target = surface_point(rng, &bounds);
    let ray = aimed(rng, style, target);
    if rng.u8(..16) == 0 {
        bounds[0][rng.usize(..3)] = f64::NEG_INFINITY;
    }
    if rng.u8(..16) == 0 {
        bounds[1][rng.usize(..3)] = f64::INFINITY;
    }
    (ray, bounds[0], bounds[1])
}

/// A ray and a sphere at whose centre, inside or silhouette it is aimed.
pub fn ray_sphere(rng: &mut Rng) -> (Ray, Point, f64) {
    let style = Style::random(rng);
    let center = style.point(rng);
    let radii = [0.0, 1.0, style.coordinate(rng).abs(), single(rng.f64())];
    let radius = pick(rng, &radii);
    let offset = pick(rng, &[0.0, 0.5, 1.0, 1.0, 1.0 + 1e-6]) * radius;
    let mut target = center;
    let axis = rng.usize(..3);
    target[axis] = single(target[axis] + offset);
    (aimed(rng, style, target), center, radius)
}

/// A ray and a plane n·p = offset at a point of which it is aimed, or in which it lies.
pub fn ray_plane(rng: &mut Rng) -> (Ray, Point, f64) {
    let style = Style::random(rng);
    let (normal, point) = (style.point(rng), style.point(rng));
    let offset = single((0..3).map(|i| normal[i] * point[i]).sum());
    let mut ray = aimed(rng, style, point);
    if rng.u8(..4) == 0 {
        let [x, y, _] = normal;
        ray.direction = [-y, x, 0.0];
    }
    (ray, normal, offset)
}

/// A triangle and a box that it touches or nearly touches.
pub fn triangle_aabb(rng: &mut Rng) -> ([Point; 3], Point, Point) {
    let style = Style::random(rng);
    let bounds = bounds(rng, style);
    let mut triangle = vertices(rng, style);
    let target = surface_point(rng, &bounds);
    match rng.u8(..4) {
        // A vertex on the box.
        0 => triangle[rng.usize(..3)] = target,
        // An edge through a point of it.
        1 => triangle[1] = sum(triangle[0], target, 2.0),
        // A point inside of the triangle on it.
        2 => triangle[2] = sum(sum(triangle[0], triangle[1], 0.5), target, 3.0),
        _ => {}
    }
    (triangle, bounds[0], bounds[1])
}

/// Any number at all: NaN, infinities, zeros, subnormals, the largest, random bits.
pub fn hostile(rng: &mut Rng) -> f64 {
    let special = [
        f32::NAN,
        f32::INFINITY,
        f32::NEG_INFINITY,
        0.0,
        -0.0,
        1e-45,
        1e-40,
        f32::MAX,
        f32::MIN,
        1.0,
        -2.0,
    ];
    match rng.u8(..3) {
        0 => f64::from(pick(rng, &special)),
        1 => f64::from(f32::from_bits(rng.u32(..))),
        _ => Style::Lattice.coordinate(rng),
    }
}
