//! Cone against sphere.
//!
//! J. Amanatides, "Ray Tracing with Cones", SIGGRAPH 1984, takes the sphere's outline for a circle. Seen
//! from the apex of a wide cone it is an ellipse, or a part of a parabola or hyperbola if the sphere reaches
//! beside the apex; the area that it has in common with the cone's section has a closed form all the same.

use glam::{DVec2, Vec3Swizzles};

use super::cone::{ConeHit, Section};
use crate::shape::{Cone, Sphere};
use crate::vector::{Number, Vector, acos, asinh};

/// Where the cone touches the sphere, and what share of its section the sphere covers.
///
/// The sphere is the surface, as to a ray: a line of sight that starts inside of it meets it where it leaves.
/// Projected from the cone's apex into the section, the unit disk, its outline is a conic, symmetric to
/// the line from the axis through the centre; so is what a section cuts out of it, a circle. Between their
/// intersections the area has a closed form. t is the least one at which the disk around `ray.at(t)` touches the sphere.
///
/// **Grade: conservative** for hit or miss: no sphere that the cone touches is missed; let u be 2⁻⁵³ and s the distance
/// from the cone's origin to the farthest point of the sphere: it may be found by a cone that is wider by
/// 128u·((1 + spread/|d|)·s + radius). t is that of such a cone. The coverage is within 10⁻¹³, and the rounding to the
/// scalar, of that of a sphere moved by at most 64u·s.
///
/// A radius of zero is a point, which covers nothing. Bad input, which is a cone that touches nothing or a
/// sphere that is never hit: `None`.
///
/// ```
/// use isect::{Cone, Ray, Sphere, glam::DVec3, overlap::cone_sphere};
///
/// // A sphere of half the cone's width.
/// let cone = Cone::new(Ray::new(DVec3::ZERO, DVec3::Z), 1.0, 0.0);
/// let hit = cone_sphere::intersect(&cone, &Sphere::new(DVec3::Z * 3.0, 0.5)).expect("the axis hits it");
/// assert!((hit.t - 2.5).abs() < 1e-14 && (hit.coverage - 0.25).abs() < 1e-14);
/// ```
#[must_use]
pub fn intersect<V: Vector>(cone: &Cone<V>, sphere: &Sphere<V>) -> Option<ConeHit<V::Scalar>> {
    let (section, ball) = Ball::new(cone, sphere)?;
    let z = ball.nearest(&section)?;
    Some(section.hit(cone, z, ball.covered_area(&section)))
}

/// Whether the cone touches the sphere: the verdict of [`intersect`].
///
/// **Grade: conservative**, as [`intersect`].
///
/// ```
/// use isect::{Cone, Ray, Sphere, glam::Vec3, overlap::cone_sphere};
///
/// let sphere = Sphere::new(Vec3::ZERO, 2.0);
/// // It begins and ends inside.
/// let cone = |t_max| Cone::new(Ray::new(Vec3::ZERO, Vec3::Z).with_range(0.0, t_max), 1.0, 0.0);
/// assert!(cone_sphere::touches(&cone(3.0), &sphere) && !cone_sphere::touches(&cone(1.7), &sphere));
/// ```
#[must_use]
pub fn touches<V: Vector>(cone: &Cone<V>, sphere: &Sphere<V>) -> bool {
    Ball::new(cone, sphere).is_some_and(|(section, ball)| ball.nearest(&section).is_some())
}

/// A ball in the cone's frame.
struct Ball {
    /// The centre's distance from the axis.
    q: f64,
    /// And its place along it.
    z: f64,
    radius: f64,
}

impl Ball {
    fn new<V: Vector>(cone: &Cone<V>, sphere: &Sphere<V>) -> Option<(Section, Self)> {
        if !sphere.is_valid() {
            return None;
        }
        let (section, [center]) = Section::new(cone, [sphere.center], sphere.radius)?;
        let radius = sphere.radius.into() * section.scale;
        Some((section, Self { q: center.xy().length(), z: center.z, radius }))
    }

    /// The least z at which the section meets the sphere.
    ///
    /// In the plane of axis and centre the cone is a trapezoid. It touches the sphere unless its point nearest to the
    /// centre is out of it, or its farthest corner in it.
    fn nearest(&self, section: &Section) -> Option<f64> {
        let Self { q, z, radius } = *self;
        let Section { slope, near, far, margin, .. } = *section;
        let (outer, inner) = (radius + margin, radius - margin);
        let distance = |x: f64, at: f64| DVec2::new(x - q, at - z).length();
        let nearest_of_section = |at: f64| distance(q.min(section.radius_at(at)), at);
        let farthest_of_section = |at: f64| distance(-section.radius_at(at), at);

        // The point of the slanted side nearest to the centre, or the centre.
        let foot = ((z + slope * (q - section.radius)) / (1.0 + slope * slope)).clamp(near, far);
        let inside = near <= z && z <= far && q <= section.radius_at(z);
        let nearest = if inside { 0.0 } else { distance(section.radius_at(foot), foot) };
        let nearest = nearest.min(nearest_of_section(near)).min(nearest_of_section(far));
        let farthest = farthest_of_section(near).max(farthest_of_section(far));
        if outer < nearest || farthest < inner {
            return None;
        }

        let begins_within = nearest_of_section(near) <= outer;
        if begins_within && farthest_of_section(near) >= inner {
            return Some(near);
        }
        let pole = z - radius;
        if !begins_within && near <= pole && q <= section.radius_at(pole) {
            return Some(pole);
        }
        // Where the side of the cone, x = r(z), enters the ball, or leaves it at the other side, which is
        // farther from the centre.
        let height = if begins_within { -q } else { q };
        let square = 1.0 + slope * slope;
        let foot = (z + slope * (height - section.radius)) / square;
        let away = height - section.radius_at(z);
        let chord = Number::sqrt((radius * radius * square - away * away).max(0.0)) / square;
        let root = if begins_within { foot + chord } else { foot - chord };
        Some(root.clamp(near, far))
    }

    /// The area of the disk that the sphere covers.
    ///
    /// A section's circle touches the outline at an X, or at none. Of the outline the range leaves what lies
    /// between those of its ends; beyond them the ends' circles bound what is seen. What lies in both of
    /// these circles begins and ends within the ball, and never meets the sphere.
    fn covered_area(&self, section: &Section) -> f64 {
        let Section { near, far, .. } = *section;
        let [nearest, farthest] = [self.z - self.radius, self.z + self.radius];
        if self.radius <= 0.0 || farthest <= near || far <= nearest {
            return 0.0;
        }
        let (first, last) = (self.circle(section, near), self.circle(section, far));
        let outline = self.outline(section);
        let (mut from, mut to) = (-1.0, 1.0);
        // A circle that is all of the outline touches it everywhere: there both ends are NaN and stay as they are.
        if nearest < near {
            to = to.min(self.contact(section, near)).max(-1.0);
        }
        if far < farthest {
            from = from.max(self.contact(section, far)).min(to);
        }
        if outline.is_none() {
            // The apex is in the ball, and sees what it sees from where the range begins.
            (from, to) = (-1.0, -1.0);
        }
        let parts = [(last, -1.0, from), (outline, from, to), (first, to, 1.0)];
        let area: f64 = parts
            .into_iter()
            .filter_map(|(conic, from, to)| Some(common_area(&[Conic::DISK, conic?], from, to)))
            .sum();
        let within = first
            .zip(last)
            .map_or(0.0, |(first, last)| common_area(&[Conic::DISK, first, last], -1.0, 1.0));
        area - within
    }

    /// What the section at z cuts out of the ball, in the disk.
    fn circle(&self, section: &Section, z: f64) -> Option<Conic> {
        let Self { q, radius, .. } = *self;
        let height = z - self.z;
        let square = (radius - height) * (radius + height);
        if square <= 0.0 {
            return None;
        }
        let (cut, w) = (Number::sqrt(square), section.radius_at(z));
        if w <= 0.0 {
            // At the apex, which is in the ball or is not.
            return (q <= cut).then_some(Conic { start: -2.0, h: 2.0, g: 1.0, rim: -2.0 });
        }
        let rim = ((q - cut) * (q + cut) + w * w) / (2.0 * q * w);
        Some(Conic { start: (q - cut) / w, h: cut / w, g: 1.0, rim })
    }

    /// The outline as the apex sees it; `None` if that is in the ball.
    ///
    /// A line of sight (X·w, Y·w) at z touches the ball where G·X² − 2qw·X + (q² − ρ²) + S·Y² = 0, with
    /// w = r(z) at the centre, S = w² + slope²·(q² − ρ²), G = w² − slope²·ρ². S is slope² times the square of a
    /// tangent's length, and G is positive where all of the ball is in front of the apex.
    fn outline(&self, section: &Section) -> Option<Conic> {
        let Self { q, radius, z } = *self;
        let (w, square) = (section.radius_at(z), section.slope * section.slope);
        let power = (q - radius) * (q + radius);
        let s = w * w + square * power;
        if s <= 0.0 {
            return None;
        }
        let g = (w - section.slope * radius) * (w + section.slope * radius);
        let root = Number::sqrt(s);
        // Each of the quotients by the form that does not cancel.
        let start =
            if w > 0.0 { power / (q * w + radius * root) } else { (q * w - radius * root) / g };
        let m = Number::sqrt(s * (1.0 + square));
        let rim = if w > 0.0 {
            (power * (1.0 + square) + w * w) / (q * (m + w))
        } else {
            (m - w) / (q * square)
        };
        Some(Conic { start, h: radius / root, g: g / s, rim })
    }

    /// The X at which the section's circle at z touches the outline.
    fn contact(&self, section: &Section, z: f64) -> f64 {
        let Self { q, radius, .. } = *self;
        let w = section.radius_at(self.z);
        let x = w * (self.z - z) / section.slope + (q - radius) * (q + radius);
        x / (q * section.radius_at(z))
    }
}

/// The points of the disk with Y² ≤ 2h·ξ − g·ξ², ξ = X − start ≥ 0: an ellipse, parabola or branch of a hyperbola,
/// symmetric to the X axis.
#[derive(Clone, Copy)]
struct Conic {
    start: f64,
    h: f64,
    g: f64,
    /// The X at which it meets the rim of the disk, if that is between −1 and 1.
    rim: f64,
}

impl Conic {
    const DISK: Self = Self { start: -1.0, h: 1.0, g: 1.0, rim: -1.0 };

    /// Y² at X, negative where there is none.
    fn square_at(&self, x: f64) -> f64 {
        let xi = x - self.start;
        if xi < 0.0 { -1.0 } else { xi * (2.0 * self.h - self.g * xi) }
    }

    /// The X at which it ends.
    fn end(&self) -> f64 {
        if self.g > 0.0 { self.start + 2.0 * self.h / self.g } else { f64::INFINITY }
    }

    /// The X at which two circles meet.
    fn crossing(&self, other: &Self) -> f64 {
        let power = |c: &Self| c.start * (c.start + 2.0 * c.h);
        let center = |c: &Self| c.start + c.h;
        (power(self) - power(other)) / (2.0 * (center(self) - center(other)))
    }

    /// The area up to X, which is not beyond the end: 2·√h·ξ^(3/2)·F(g·ξ/h).
    fn area_to(&self, x: f64) -> f64 {
        let xi = (x - self.start).max(0.0);
        let eta = (self.g * xi / self.h).min(2.0);
        2.0 * xi * Number::sqrt(self.h * xi) * Self::shape(eta)
    }

    /// F(η), the integral of √(2s − η·s²) over s from 0 to 1.
    fn shape(eta: f64) -> f64 {
        if eta.abs() < 0.5 {
            // √2·Σ C(½, k)·(−η/2)^k/(k + 3/2): each term is less than a quarter of the last.
            let (mut term, mut sum) = (core::f64::consts::SQRT_2, 0.0);
            for k in 0..26 {
                let k = f64::from(k);
                sum += term / (k + 1.5);
                term *= (0.5 - k) / (k + 1.0) * (-0.5 * eta);
            }
            return sum;
        }
        let size = eta.abs();
        let sine = Number::sqrt(size * (2.0 - eta));
        let twice = if eta > 0.0 {
            acos(1.0 - eta) - sine * (1.0 - eta)
        } else {
            sine * (1.0 - eta) - asinh(sine)
        };
        twice / (2.0 * size * Number::sqrt(size))
    }
}

/// The area between two X that conics have in common, one of them the disk and the others circles if there are two.
fn common_area<const N: usize>(conics: &[Conic; N], from: f64, to: f64) -> f64 {
    // Between these places the same one is the narrowest.
    let mut places = [to; 12];
    let mut count = 0;
    let mut add = |x: f64| {
        if from < x && x < to {
            places[count] = x;
            count += 1;
        }
    };
    for conic in conics {
        add(conic.start);
        add(conic.end());
        add(conic.rim);
    }
    if let [_, first, last] = conics[..] {
        add(first.crossing(&last));
    }
    let places = &mut places[..=count];
    places.sort_unstable_by(f64::total_cmp);
    let (mut area, mut last) = (0.0, from);
    for &place in &*places {
        let middle = 0.5 * (last + place);
        let narrowest =
            conics.iter().min_by(|a, b| f64::total_cmp(&a.square_at(middle), &b.square_at(middle)));
        if let Some(conic) = narrowest
            && conic.square_at(middle) > 0.0
        {
            area += conic.area_to(place) - conic.area_to(last);
        }
        last = place;
    }
    area
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The areas in closed form are those that summing up strips gives.
    #[test]
    fn areas_are_those_of_strips() {
        let circle = |x: f64, r: f64| {
            let rim = (x * x + 1.0 - r * r) / (2.0 * x);
            Conic { start: x - r, h: r, g: 1.0, rim }
        };
        // Where 2h·ξ − g·ξ² = 1 − X².
        let open = |start: f64, h: f64, g: f64| {
            let (a, b, c) =
                (1.0 - g, 2.0 * h + 2.0 * g * start, -2.0 * h * start - g * start * start - 1.0);
            let rim = (-b + (b * b - 4.0 * a * c).sqrt()) / (2.0 * a);
            Conic { start, h, g, rim }
        };
        let mut cases = vec![
            vec![circle(0.5, 0.75), circle(0.25, 0.75)],
            vec![circle(0.1, 0.9), circle(0.6, 1.2)],
            vec![circle(0.3, 0.9), circle(0.9, 0.4)],
        ];
        for g in [-4.0, -1.0, -0.25, 0.0, 0.25] {
            cases.extend([-0.5, 0.25].map(|start| vec![open(start, 0.4, g)]));
        }
        for conics in cases {
            let area = match conics[..] {
                [one] => common_area(&[Conic::DISK, one], -1.0, 1.0),
                [first, last] => common_area(&[Conic::DISK, first, last], -1.0, 1.0),
                _ => unreachable!("one or two"),
            };
            let strips = 100_000;
            let width = 2.0 / f64::from(strips);
            let strip = |i: i32| {
                let x = (f64::from(i) + 0.5) * width - 1.0;
                let squares = conics.iter().chain(&[Conic::DISK]).map(|c| c.square_at(x));
                2.0 * width * squares.fold(1.0, f64::min).max(0.0).sqrt()
            };
            let sum: f64 = (0..strips).map(strip).sum();
            // At an upright end the error of the midpoint rule is of the order of width^(3/2).
            assert!((area - sum).abs() < width.powf(1.5) * 4.0, "{area} {sum} {:?}", conics.len());
        }
    }
}
