//! Ray against closed box: six half-spaces clip the range.

use num_bigint::BigInt;

use super::integer::{Integer, Interval, Ratio};
use super::{Frame, Query, Ray, decide, is_box};

/// Whether a ray touches a closed box; infinite bounds leave it open on that side, an empty box is a miss.
#[must_use]
pub fn aabb(ray: &Ray, min: [f64; 3], max: [f64; 3]) -> bool {
    query(ray, min, max, Question::Touches)
}

/// Whether the ray touches the box and the first t in the box and in the ray's range lies in the closed range from `lo` to `hi`.
#[must_use]
pub fn aabb_enter_in(ray: &Ray, min: [f64; 3], max: [f64; 3], lo: f64, hi: f64) -> bool {
    query(ray, min, max, Question::EnterIn(lo, hi))
}

/// Whether the ray touches the box and the last t in the box and in the ray's range lies in the closed range from `lo` to `hi`.
#[must_use]
pub fn aabb_exit_in(ray: &Ray, min: [f64; 3], max: [f64; 3], lo: f64, hi: f64) -> bool {
    query(ray, min, max, Question::ExitIn(lo, hi))
}

/// Whether a ray touches a closed box if each t at which it crosses a plane of the box is moved: entries down and exits up, by
/// `relative` of the t's magnitude and by `absolute`; negative numbers move them the other way. The range stays.
#[must_use]
pub fn aabb_if_moved(
    ray: &Ray,
    min: [f64; 3],
    max: [f64; 3],
    relative: f64,
    absolute: f64,
) -> bool {
    Case::new(ray, min, max, Question::Touches)
        .is_some_and(|case| case.touches_if_moved(relative, absolute))
}

#[derive(Clone, Copy)]
enum Question {
    Touches,
    EnterIn(f64, f64),
    ExitIn(f64, f64),
}

impl Question {
    /// The range asked about, if any.
    fn range(self) -> Option<(f64, f64)> {
        match self {
            Self::Touches => None,
            Self::EnterIn(lo, hi) | Self::ExitIn(lo, hi) => Some((lo, hi)),
        }
    }
}

fn query(ray: &Ray, min: [f64; 3], max: [f64; 3], question: Question) -> bool {
    Case::new(ray, min, max, question).is_some_and(|case| decide(&case))
}

struct Case {
    min: [f64; 3],
    max: [f64; 3],
    question: Question,
    frame: Frame,
}

impl Case {
    fn new(ray: &Ray, min: [f64; 3], max: [f64; 3], question: Question) -> Option<Self> {
        let comparable = question.range().is_none_or(|(lo, hi)| lo <= hi);
        let frame = || Frame::new(ray, [min, max]);
        (ray.is_valid() && is_box(min, max) && comparable).then(|| Self {
            min,
            max,
            question,
            frame: frame(),
        })
    }

    /// The part of a range that lies in the box.
    fn inside<I: Integer>(&self, mut range: Interval<I>) -> Interval<I> {
        let direction = self.frame.direction::<I>();
        // An infinite bound has no half-space; the origin stands in for it.
        let bound = |b: [f64; 3]| {
            std::array::from_fn(|k| if b[k].is_finite() { b[k] } else { self.frame.ray.origin[k] })
        };
        let [min, max] = self.frame.relative::<I, 2>([bound(self.min), bound(self.max)]);
        for k in 0..3 {
            if self.min[k].is_finite() {
                range.clip(-min[k].clone(), direction[k].clone());
            }
            if self.max[k].is_finite() {
                range.clip(max[k].clone(), -direction[k].clone());
            }
        }
        range
    }

    fn touches_if_moved(&self, relative: f64, absolute: f64) -> bool {
        let relative = Ratio::<BigInt>::from_float(relative, 0);
        let absolute = Ratio::from_float(absolute, self.frame.t_shift());
        let crossings = self.inside(self.frame.interval(f64::NEG_INFINITY, f64::INFINITY));
        // Moving keeps the order: the last entry stays the last, the first exit the first.
        let by = |t: &Ratio<_>| t.abs().times(&relative).plus(&absolute);
        let enter = crossings.enter.plus(&by(&crossings.enter).negated());
        let exit = crossings.exit.plus(&by(&crossings.exit));
        let range = self.frame.range();
        enter.max(range.enter) <= exit.min(range.exit)
    }
}

impl Query for Case {
    type Answer = bool;

    fn bits(&self) -> u32 {
        let asked = self.question.range().map_or(0, |(lo, hi)| self.frame.interval_bits(lo, hi));
        let t = self.frame.range_bits().max(asked);
        (self.frame.points.bits + 1).max(t) + self.frame.directions.bits.max(t)
    }

    fn answer<I: Integer>(&self) -> bool {
        let inside = self.inside::<I>(self.frame.range());
        let lies_in = |t: &Ratio<I>, lo, hi| self.frame.interval(lo, hi).contains(t);
        !inside.is_empty()
            && match self.question {
                Question::Touches => true,
                Question::EnterIn(lo, hi) => lies_in(&inside.enter, lo, hi),
                Question::ExitIn(lo, hi) => lies_in(&inside.exit, lo, hi),
            }
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
    fn a_closed_box_is_hit_up_to_its_corners() {
        let (min, max) = ([0.0; 3], [1.0, 2.0, 3.0]);
        assert!(aabb(&ray([-1.0, 1.0, 1.0], [1.0, 0.0, -0.0]), min, max), "a face");
        assert!(aabb(&ray([-1.0, 2.0, 1.0], [1.0, -0.0, 0.0]), min, max), "in a face");
        assert!(aabb(&ray([-1.0, 2.0, 3.0], [1.0, 0.0, 0.0]), min, max), "along an edge");
        assert!(
            !aabb(&ray([-1.0, 2f64.next_up(), 3.0], [1.0, 0.0, 0.0]), min, max),
            "beside an edge"
        );
        assert!(aabb(&ray([2.0, 1.0, 3.0], [-1.0, 1.0, 0.0]), min, max), "across an edge");
        assert!(aabb(&ray([2.0, 3.0, 4.0], [-1.0, -1.0, -1.0]), min, max), "a corner");
        let graze = ray([2.0, 3.0, 2.0], [-1.0, -1.0, 1.0]);
        assert!(aabb(&graze, min, max), "only a corner");
        assert!(!aabb(&graze, min, [1.0, 2.0, 3f64.next_down()]), "past a corner");
        assert!(!aabb(&ray([2.0, 1.0, 1.0], [1.0, 0.0, 0.0]), min, max), "behind");
        assert!(aabb(&ray([1.0, 1.0, 1.0], [5e-324, 0.0, 0.0]), min, max), "from a face");
        assert!(
            aabb(&ray([1.0, 0.0, 0.0], [1.0, 1.0, 1.0]), [1.0, 0.0, 0.0], [1.0, 0.0, 0.0]),
            "a point"
        );
        assert!(
            aabb(&ray([0.5, 1.0, 1.0], [1.0, 0.0, 0.0]).with_range(0.1, 0.2), min, max),
            "within"
        );
    }

    #[test]
    fn empty_boxes_are_missed_and_infinite_bounds_are_open() {
        let along = ray([-1.0, 0.0, 0.0], [1.0, 0.0, 0.0]);
        assert!(!aabb(&along, [0.0; 3], [1.0, -1.0, 1.0]));
        assert!(!aabb(&along, [INF; 3], [-INF; 3]));
        assert!(!aabb(&along, [0.0, f64::NAN, 0.0], [1.0; 3]));
        assert!(!aabb(&along, [INF, -1.0, -1.0], [INF, 1.0, 1.0]), "at infinity");
        assert!(aabb(&along, [-INF; 3], [INF; 3]));
        assert!(aabb(&along, [7.0, -INF, 0.0], [INF, INF, 0.0]));
        assert!(!aabb(&along, [-INF; 3], [-2.0, INF, INF]));
        assert!(!aabb(&along.with_range(1.0, 0.5), [-INF; 3], [INF; 3]));
        assert!(!aabb(&Ray { direction: [0.0; 3], ..along }, [-INF; 3], [INF; 3]));
    }

    #[test]
    fn entry_and_exit_are_bracketed() {
        let along = ray([-1.0, 0.0, 0.0], [3.0, 0.0, 0.0]);
        let (min, max) = ([0.0, -1.0, -1.0], [1.0; 3]);
        // Rounded down.
        let third: f64 = 1.0 / 3.0;
        assert!(aabb_enter_in(&along, min, max, third, third.next_up()));
        assert!(
            !aabb_enter_in(&along, min, max, third, third)
                && !aabb_enter_in(&along, min, max, 0.5, 0.6)
        );
        assert!(aabb_exit_in(&along, min, max, 2.0 * third, 2.0 * third.next_up()));
        assert!(
            aabb_enter_in(&along.with_range(0.5, 0.6), min, max, 0.5, 0.5),
            "clipped by the range"
        );
        assert!(aabb_exit_in(&along.with_range(0.5, 0.6), min, max, 0.6, 0.6));
        assert!(
            aabb_exit_in(&along, [-INF; 3], [INF; 3], 9.0, INF)
                && !aabb_exit_in(&along, [-INF; 3], [INF; 3], 0.0, 9.0)
        );
        assert!(!aabb_enter_in(&along, max, min, -INF, INF), "a miss enters nowhere");
        assert!(!aabb_enter_in(&along, min, max, f64::NAN, INF));
    }

    #[test]
    fn crossings_are_moved_and_the_range_is_not() {
        // From 2 to 4 on one axis, from 4.5 to 6 on another.
        let (min, max) = ([2.0, 4.5, 0.0], [4.0, 6.0, 0.0]);
        let gap = ray([0.0; 3], [1.0, 1.0, 0.0]);
        let moved =
            |ray: &Ray, relative, absolute| aabb_if_moved(ray, min, max, relative, absolute);
        assert!(moved(&gap, 0.0, 0.25) && !moved(&gap, 0.0, 0.25f64.next_down()));
        assert!(moved(&gap, 0.0625, 0.0) && !moved(&gap, 0.058, 0.0), "0.5 of 8.5");
        assert!(moved(&gap.reversed(), 0.0625, 0.0), "at negative t as well");
        let early = gap.with_range(0.0, 4.25);
        assert!(moved(&early, 0.0, 0.25) && !moved(&early.with_range(0.0, 4.0), 0.0, 0.25));
        let inner = ray([0.0, 5.0, 0.0], [1.0, 0.0, 0.0]);
        assert!(moved(&inner, -0.25, 0.0) && moved(&inner, 0.0, -1.0), "2.5 and 3; 3 and 3");
        assert!(!moved(&inner, -0.375, 0.0) && !moved(&inner, 0.0, -1.125));
        let beside = ray([0.0, 5.0, 1.0], [1.0, 0.0, 0.0]);
        assert!(!moved(&beside, 9.0, 9.0), "a parallel ray enters nowhere");
    }

    #[test]
    fn tiers_agree_and_symmetries_change_nothing() {
        on_lattices(3, 30_000, [3, 1 << 23], |rng, radius, ray| {
            let (a, b) = (lattice_point(rng, radius), lattice_point(rng, radius));
            let min = std::array::from_fn(|k| a[k].min(b[k]));
            let max = std::array::from_fn(|k| a[k].max(b[k]));
            for question in
                [Question::Touches, Question::EnterIn(0.25, 0.75), Question::ExitIn(0.25, 0.75)]
            {
                if let Some(case) = Case::new(&ray, min, max, question) {
                    assert_tiers_agree(&case);
                }
            }
            let hits = aabb(&ray, min, max);
            let turn = |[x, y, z]: [f64; 3]| [y, z, x].map(|x| x * 2f64.powi(300));
            let turned = Ray { origin: turn(ray.origin), direction: turn(ray.direction), ..ray };
            assert_eq!(aabb(&turned, turn(min), turn(max)), hits);
            let back = ray.reversed();
            assert_eq!(aabb(&back, min, max), hits);
            assert_eq!(
                aabb_exit_in(&back, min, max, -0.75, -0.25),
                aabb_enter_in(&ray, min, max, 0.25, 0.75)
            );
            assert_eq!(aabb_if_moved(&ray, min, max, 0.0, 0.0), hits);
        });
    }

    #[test]
    fn the_fast_tier_holds_the_largest_numbers_it_admits() {
        assert_limit_holds(13, 6_000, |rng| {
            let mut extreme = || extreme_point(rng, 63);
            let ray = ray(extreme(), extreme()).with_range(-INF, INF);
            let (a, b) = (extreme(), extreme());
            let min = std::array::from_fn(|k| a[k].min(b[k]));
            let max = std::array::from_fn(|k| a[k].max(b[k]));
            Case::new(&ray, min, max, Question::Touches).expect("valid")
        });
    }
}
