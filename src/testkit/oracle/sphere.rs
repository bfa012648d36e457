//! Ray against the surface of a sphere: the sign of a quadratic at both ends of a range, and of its discriminant.

use std::cmp::Ordering;

use super::integer::{Integer, Ratio, dot};
use super::{Frame, Query, Ray, decide, is_finite};

/// Whether a ray meets the surface of a sphere; a radius of zero is the point, a negative one a miss.
#[must_use]
pub fn sphere(ray: &Ray, center: [f64; 3], radius: f64) -> bool {
    Case::new(ray, center, radius).is_some_and(|case| decide(&case))
}

/// Whether the point of the line at a finite t lies inside of the sphere (less), on it, or outside (greater).
#[must_use]
pub fn sphere_side(ray: &Ray, center: [f64; 3], radius: f64, t: f64) -> Option<Ordering> {
    Case::new(&ray.with_range(t, t), center, radius).map(|case| decide(&Side(case)))
}

struct Case {
    center: [f64; 3],
    radius: f64,
    frame: Frame,
}

impl Case {
    fn new(ray: &Ray, center: [f64; 3], radius: f64) -> Option<Self> {
        let is_sphere = is_finite(&[center]) && radius.is_finite() && radius >= 0.0;
        let frame = || Frame::new(ray, [center, [radius; 3]]);
        (ray.is_valid() && is_sphere).then(|| Self { center, radius, frame: frame() })
    }
}

impl Query for Case {
    type Answer = bool;

    fn bits(&self) -> u32 {
        let (p, d) = (self.frame.points.bits, self.frame.directions.bits);
        let t = self.frame.range_bits();
        let quadratic = 2 * p.max(d) + 2 * t + 7;
        let discriminant = 2 * p + 2 * d + 8;
        quadratic.max(discriminant)
    }

    fn answer<I: Integer>(&self) -> bool {
        let quadratic = Quadratic::<I>::new(self);
        let range = self.frame.range();
        let (first, last) = (quadratic.sign_at(&range.enter), quadratic.sign_at(&range.exit));
        if first * last <= 0 {
            return true;
        }
        // Both ends inside: the surface is out of range. Both outside: the vertex must be in range and not outside.
        let Quadratic { a, b, c } = quadratic;
        first > 0
            && (b.clone() * &b - a.clone() * &c).signum() >= 0
            && range.contains(&Ratio::new(b, a))
    }
}

/// The side of the surface on which the first t of the range lies.
struct Side(Case);

impl Query for Side {
    type Answer = Ordering;

    fn bits(&self) -> u32 {
        self.0.bits()
    }

    fn answer<I: Integer>(&self) -> Ordering {
        Quadratic::<I>::new(&self.0).sign_at(&self.0.frame.range().enter).cmp(&0)
    }
}

/// `g(t) = a·t² − 2b·t + c` with `f` from the origin to the center, `a = d²`, `b = f·d`, `c = f² − r²`.
struct Quadratic<I> {
    a: I,
    b: I,
    c: I,
}

impl<I: Integer> Quadratic<I> {
    fn new(case: &Case) -> Self {
        let d = case.frame.direction::<I>();
        let [f] = case.frame.relative::<I, 1>([case.center]);
        let r = case.frame.points.integer::<I>(case.radius);
        Self { a: dot(&d, &d), b: dot(&f, &d), c: dot(&f, &f) - r.clone() * &r }
    }

    /// In the homogeneous form g is positive at infinity too.
    fn sign_at(&self, t: &Ratio<I>) -> i32 {
        let linear = self.b.clone() * &t.num * &t.den;
        let square = self.a.clone() * &t.num * &t.num + self.c.clone() * &t.den * &t.den;
        (square - &linear - &linear).signum()
    }
}

#[cfg(test)]
mod tests {
    use super::super::{
        assert_limit_holds, assert_tiers_agree, extreme_point, lattice_point, on_lattices,
    };
    use super::*;

    const INF: f64 = f64::INFINITY;

    fn ray(origin: [f64; 3], direction: [f64; 3]) -> Ray {
        Ray { origin, direction, t_min: 0.0, t_max: INF }
    }

    #[test]
    fn only_the_surface_of_a_sphere_is_hit() {
        let along = ray([-4.0, 0.0, 0.0], [2.0, 0.0, 0.0]);
        assert!(sphere(&along, [0.0; 3], 1.0));
        assert!(!sphere(&along.with_range(0.0, 1.5f64.next_down()), [0.0; 3], 1.0), "before");
        assert!(sphere(&along.with_range(0.0, 1.5), [0.0; 3], 1.0), "entry");
        assert!(
            !sphere(&along.with_range(1.5f64.next_up(), 2.5f64.next_down()), [0.0; 3], 1.0),
            "inside"
        );
        assert!(sphere(&along.with_range(2.0, INF), [0.0; 3], 1.0), "exit");
        assert!(!sphere(&along.with_range(2.5f64.next_up(), INF), [0.0; 3], 1.0), "behind");
        assert!(sphere(&along, [0.0, 1.0, 0.0], 1.0), "tangent");
        assert!(!sphere(&along, [0.0, 1.0, 0.0], 1f64.next_down()), "off");
        assert!(sphere(&along, [3.0, 0.0, 0.0], 0.0), "a point");
        assert!(!sphere(&along, [3.0, 5e-324, 0.0], 0.0), "beside a point");
        assert!(!sphere(&along, [-6.0, 0.0, 0.0], 1.0), "behind");
    }

    #[test]
    fn bad_input_misses_a_sphere() {
        let good = ray([0.0; 3], [0.0, 0.0, 1.0]);
        for radius in [-1.0, f64::NAN, INF] {
            assert!(!sphere(&good, [0.0; 3], radius));
        }
        assert!(sphere(&good, [0.0; 3], -0.0));
        assert!(!sphere(&good, [0.0, f64::NAN, 0.0], 1.0));
        assert!(!sphere(&good.with_range(2.0, 0.0), [0.0; 3], 1.0));
        assert!(!sphere(&ray([0.0; 3], [0.0; 3]), [0.0; 3], 0.0));
    }

    #[test]
    fn a_root_lies_between_two_sides() {
        let along = ray([-4.0, 0.0, 0.0], [1.0, 0.0, 0.0]);
        let side = |t| sphere_side(&along, [0.0, 0.5, 0.0], 1.0, t);
        let t = 4.0 - 0.75f64.sqrt();
        assert_eq!(side(t.next_down()), Some(Ordering::Greater));
        assert_eq!(side(t.next_up()), Some(Ordering::Less));
        assert_eq!(sphere_side(&along, [0.0; 3], 1.0, 3.0), Some(Ordering::Equal));
        assert_eq!(sphere_side(&along, [0.0; 3], -1.0, 3.0), None);
    }

    #[test]
    fn tiers_agree_and_powers_of_two_change_nothing() {
        on_lattices(2, 30_000, [3, 1 << 22], |rng, radius, ray| {
            let center = lattice_point(rng, radius);
            let r = f64::from(rng.i32(-1..=radius));
            let hits = sphere(&ray, center, r);
            if let Some(case) = Case::new(&ray, center, r) {
                assert_tiers_agree(&case);
                assert_tiers_agree(&Side(case));
            }
            let scale = |p: [f64; 3]| p.map(|x| x * 2f64.powi(-200));
            let scaled = Ray { origin: scale(ray.origin), direction: scale(ray.direction), ..ray };
            assert_eq!(sphere(&scaled, scale(center), r * 2f64.powi(-200)), hits);
            assert_eq!(sphere(&ray.reversed(), center, r), hits);
        });
    }

    #[test]
    fn the_fast_tier_holds_the_largest_numbers_it_admits() {
        for (points, directions, t) in [(58, 1, 2), (30, 29, 30)] {
            assert_limit_holds(15, 3_000, |rng| {
                let (origin, center) = (extreme_point(rng, points), extreme_point(rng, points));
                let t = 2f64.powi(t) - 1.0;
                let ray = ray(origin, extreme_point(rng, directions)).with_range(-t, t);
                Case::new(&ray, center, 2f64.powi(points).next_down().floor()).expect("valid")
            });
        }
    }
}
