//! Claim: t, u and v are within the error bounds that the documentation states, and so is each verdict.
//!
//! A hit must be one of the exact geometry moved by the bounds; a miss must be one of it as well.

use isect::ray::aabb::{BoxRay, exact, slab};
use isect::ray::plane::{self, PlaneHit};
use isect::{Plane, Scalar, Vector};

use crate::support::bounds::{Bound, unit_roundoff};
use crate::support::kernels::{SphereKernel, TriangleKernel, sphere_kernels, triangle_kernels};
use crate::support::{
    aabb, for_every_vector, generators, name, oracle, ray, scalar, sphere, triangle, vector,
};

const SEED: u64 = 4;
const INFINITY: f64 = f64::INFINITY;

type Vertices = [[f64; 3]; 3];

/// Whether the exact t and weights lie in the given intervals.
fn exactly_in(
    ray: &oracle::Ray,
    [v0, v1, v2]: Vertices,
    t: [f64; 2],
    weights: [[f64; 2]; 3],
) -> bool {
    let [w, u, v] = weights;
    let holds = |answer: Option<bool>| answer == Some(true);
    holds(oracle::triangle_t_in(ray, [v0, v1, v2], t[0], t[1]))
        && holds(oracle::triangle_u_in(ray, [v0, v1, v2], u[0], u[1]))
        && holds(oracle::triangle_v_in(ray, [v0, v1, v2], v[0], v[1]))
        // With the vertices cycled, v0 is weighted by v.
        && holds(oracle::triangle_v_in(ray, [v1, v2, v0], w[0], w[1]))
}

/// Holds a kernel's answer against the oracle, within a bound; returns whether it is a hit.
pub(crate) fn check_triangle<V: Vector>(
    kernel: &TriangleKernel<V>,
    ray_: &oracle::Ray,
    vertices: Vertices,
    bound: Bound,
) -> bool {
    let Bound { t: t_error, weights } = bound;
    let hit = (kernel.intersect)(&ray(ray_), &triangle(&vertices));
    let case =
        || format!("{} {}: {ray_:?} {vertices:?} {hit:?} {bound:?}", kernel.name, name::<V>());
    if let Some(hit) = &hit {
        let around = |x: f64, error: f64| [x - error, x + error];
        let (t, u, v) = (hit.t.into(), hit.u.into(), hit.v.into());
        assert!(ray_.t_min <= t && t <= ray_.t_max, "{}", case());
        assert!(u >= 0.0 && v >= 0.0, "{}", case());
        if t.abs() == V::Scalar::MAX.into() {
            return true; // as it reports what is beyond
        }
        let intervals =
            [around(1.0 - u - v, weights[0]), around(u, weights[1]), around(v, weights[2])];
        assert!(exactly_in(ray_, vertices, around(t, t_error), intervals), "{}", case());
        true
    } else {
        // Not if it is clearly inside, at a t that is a float.
        let limit: f64 = V::Scalar::MAX.into();
        let inside = weights.map(|error| [error, INFINITY]);
        let range = [ray_.t_min.max(-limit) + t_error, ray_.t_max.min(limit) - t_error];
        assert!(!exactly_in(ray_, vertices, range, inside), "{}", case());
        false
    }
}

#[test]
fn triangles() {
    fn check<V: Vector>() {
        let unit = unit_roundoff::<V::Scalar>();
        for kernel in triangle_kernels::<V>() {
            let mut rng = fastrand::Rng::with_seed(SEED);
            let (mut hits, mut misses, mut unbounded) = (0, 0, 0);
            for _ in 0..60_000 {
                let (ray_, vertices) = generators::ray_triangle(&mut rng);
                match (kernel.bound)(unit, &ray_, &vertices)
                    .filter(|b| in_exponent_range::<V>(&ray_, &vertices, b))
                {
                    Some(bound) if check_triangle(&kernel, &ray_, vertices, bound) => hits += 1,
                    Some(_) => misses += 1,
                    None => unbounded += 1,
                }
            }
            println!(
                "{:<6} {:<16} {hits} hits and {misses} misses within bounds, {unbounded} have none",
                name::<V>(),
                kernel.name
            );
            assert!(hits > 8_000 && misses > 8_000);
        }
    }
    for_every_vector!(check);
}

/// The bounds are about rounding, not about underflow: where t, a weight, or a length that matters, is subnormal they do not
/// count.
pub(crate) fn in_exponent_range<V: Vector>(
    ray: &oracle::Ray,
    vertices: &Vertices,
    bound: &Bound,
) -> bool {
    let tiny: f64 = <V::Scalar as Scalar>::MIN_POSITIVE.into();
    let lengths = vertices.as_flattened().iter().chain(&ray.origin).chain(&ray.direction);
    let errors = bound.weights.iter().chain([&bound.t]);
    bound.t.is_finite() && lengths.chain(errors).all(|&x| x == 0.0 || x.abs() > tiny)
}

/// A sphere's radius as far off as a kernel's documentation allows, either way.
struct Shell {
    center: [f64; 3],
    /// Zero or less where the sphere may be lost entirely.
    inner: f64,
    outer: f64,
}

impl Shell {
    fn new<V: Vector>(
        kernel: &SphereKernel<V>,
        ray: &oracle::Ray,
        center: [f64; 3],
        radius: f64,
    ) -> Self {
        let f = (0..3).map(|i| (center[i] - ray.origin[i]).powi(2)).sum::<f64>().sqrt();
        let (square, linear) = (kernel.error)(unit_roundoff::<V::Scalar>(), f, radius);
        let (inner, outer) = (radius * radius - square, radius * radius + square);
        // The bound itself is rounded: f² and its root, r², the sum and its root, the last sum.
        let rounding = 4.0 * f64::EPSILON * radius;
        Self {
            center,
            inner: inner.max(0.0).sqrt() - linear - rounding,
            outer: outer.sqrt() + linear + rounding,
        }
    }

    /// Whether a root of the line's is in a range, for the smallest radius: then two are for each.
    fn inner_root(&self, line: &oracle::Ray, t_min: f64, t_max: f64) -> bool {
        self.inner > 0.0
            && oracle::sphere(&oracle::Ray { t_min, t_max, ..*line }, self.center, self.inner)
    }

    fn outer_root(&self, line: &oracle::Ray, t_min: f64, t_max: f64) -> bool {
        oracle::sphere(&oracle::Ray { t_min, t_max, ..*line }, self.center, self.outer)
    }

    /// Whether the near root is in the ray's range for every radius: the later it is the smaller the radius.
    fn near_root_is_in_range(&self, ray: &oracle::Ray) -> bool {
        self.inner_root(ray, -INFINITY, ray.t_max) && !self.outer_root(ray, -INFINITY, ray.t_min)
    }

    /// Whether the far root is: the sooner it is the smaller the radius.
    fn far_root_is_in_range(&self, ray: &oracle::Ray) -> bool {
        self.inner_root(ray, ray.t_min, INFINITY) && !self.outer_root(ray, ray.t_max, INFINITY)
    }

    /// Whether t is the near root, or the far one, for some radius.
    fn has_root(&self, line: &oracle::Ray, t: f64, far: bool) -> bool {
        let side = |radius| oracle::sphere_side(line, self.center, radius, t).expect("valid");
        if self.inner <= 0.0 {
            return side(self.outer).is_le();
        }
        // A line that meets the smallest sphere has its near roots before it, and its far ones behind.
        let (before, behind) = if far { (-INFINITY, t) } else { (t, INFINITY) };
        side(self.outer).is_le()
            && side(self.inner).is_ge()
            && (!self.inner_root(line, -INFINITY, INFINITY)
                || self.inner_root(line, before, behind))
    }
}

/// Each root is the exact one for a radius that is wrong by the stated error: so is the hit, which is the nearest root in
/// range; and a miss has none there for some radius.
#[test]
fn spheres() {
    fn check<V: Vector>() {
        let largest: f64 = V::Scalar::MAX.into();
        for kernel in sphere_kernels::<V>() {
            let mut rng = fastrand::Rng::with_seed(SEED + 1);
            let (mut near, mut far, mut misses, mut clear_misses) = (0, 0, 0, 0);
            for _ in 0..60_000 {
                let (ray_, center, radius) = generators::ray_sphere(&mut rng);
                let shell = Shell::new(&kernel, &ray_, center, radius);
                let hit = (kernel.intersect)(&ray::<V>(&ray_), &sphere(&center, radius));
                let case = || {
                    format!(
                        "{} {}: {ray_:?} {center:?} {radius}: {hit:?}",
                        kernel.name,
                        name::<V>()
                    )
                };
                // A t beyond the largest float is none.
                let finite = oracle::Ray {
                    t_min: ray_.t_min.max(-largest),
                    t_max: ray_.t_max.min(largest),
                    ..ray_
                };
                if let Some(hit) = hit {
                    let t = hit.t.into();
                    assert!(ray_.t_min <= t && t <= ray_.t_max, "{}", case());
                    // The largest float stands for what is beyond.
                    let is_beyond = t.abs() == largest;
                    assert!(is_beyond || shell.has_root(&ray_, t, hit.leaving), "{}", case());
                    if hit.leaving {
                        far += 1;
                        assert!(!shell.near_root_is_in_range(&finite), "{}", case());
                    } else {
                        near += 1;
                    }
                } else {
                    misses += 1;
                    assert!(!shell.near_root_is_in_range(&finite), "{}", case());
                    assert!(!shell.far_root_is_in_range(&finite), "{}", case());
                    clear_misses +=
                        u32::from(!shell.outer_root(&finite, finite.t_min, finite.t_max));
                }
            }
            println!(
                "{:<6} {:<10} {near} near and {far} far roots, {misses} misses within bounds, {clear_misses} of them clear",
                name::<V>(),
                kernel.name
            );
            assert!(near > 20_000 && far > 5_000 && misses > 10_000 && clear_misses > 5_000);
        }
    }
    for_every_vector!(check);
}

/// The plane's t satisfies n·(o + t·d) = offset with the stated errors of numerator, denominator and quotient; and a miss
/// has no t in range with some of them.
#[test]
fn planes() {
    fn check<V: Vector>() {
        let unit = unit_roundoff::<V::Scalar>();
        let mut rng = fastrand::Rng::with_seed(SEED + 2);
        let (mut at, mut contained, mut missed, mut left_out) = (0, 0, 0, 0);
        for _ in 0..300_000 {
            let (ray_, normal, offset) = generators::ray_plane(&mut rng);
            // The bounds are about rounding: where a product, or the quotient before its powers of two are taken out, over- or
            // underflows they do not count.
            let moderate = |x: f64| x == 0.0 || (1e-30..1e30).contains(&x.abs());
            let products =
                (0..3).flat_map(|i| [ray_.origin[i], ray_.direction[i]].map(|x| x * normal[i]));
            if !products.chain([offset]).all(moderate) {
                left_out += 1;
                continue;
            }
            let plane = Plane { normal: vector::<V>(normal), offset: scalar(offset) };
            let found = plane::intersect(&ray(&ray_), &plane);
            let case = || format!("{} {ray_:?} {normal:?} {offset}: {found:?}", name::<V>());

            if normal == [0.0; 3] || ray_.direction == [0.0; 3] {
                assert_eq!(found, None, "{}", case());
                continue;
            }
            let terms = |a: &[f64; 3]| (0..3).map(|i| (a[i] * normal[i]).abs()).sum::<f64>();
            // A thousandth for what is of second order.
            let first_order = 1.001 * unit;
            let numerator_error = first_order * 4.0 * (offset.abs() + terms(&ray_.origin));
            let denominator_error = first_order * 3.0 * terms(&ray_.direction);
            let denominator = (0..3).map(|i| normal[i] * ray_.direction[i]).sum::<f64>().abs();
            // How far n·(o + t·d) may be from the offset.
            let slack = |t: f64| {
                numerator_error
                    + t.abs() * denominator_error
                    + first_order * t.abs() * (denominator + denominator_error)
            };
            // Whether it is clearly less, or clearly greater; with the bounds rounded outward.
            let below = |t: f64| {
                let moved = (offset - slack(t)).next_down();
                oracle::plane_side(&ray_, normal, moved, t).expect("valid").is_lt()
            };
            let above = |t: f64| {
                let moved = (offset + slack(t)).next_up();
                oracle::plane_side(&ray_, normal, moved, t).expect("valid").is_gt()
            };
            match found {
                Some(PlaneHit::At(t)) => {
                    at += 1;
                    let t: f64 = t.into();
                    assert!(ray_.t_min <= t && t <= ray_.t_max, "{}", case());
                    assert!(!below(t) && !above(t) || !moderate(t), "{}", case());
                }
                Some(PlaneHit::Contained) => {
                    contained += 1;
                    assert!(!below(0.0) && !above(0.0), "{}", case());
                    let slope = oracle::Ray { origin: [0.0; 3], ..ray_ };
                    let side =
                        |error: f64| oracle::plane_side(&slope, normal, error, 1.0).expect("valid");
                    assert!(side(denominator_error).is_le(), "{}", case());
                    assert!(side(-denominator_error).is_ge(), "{}", case());
                }
                None => {
                    missed += 1;
                    // Not if the ends of the range, as far as that is moderate, are clearly on different sides.
                    let far = 1e30 / ray_.direction.iter().fold(1.0, |m, x| x.abs().max(m));
                    let (start, end) = (ray_.t_min.max(-far), ray_.t_max.min(far));
                    let crosses = below(start) && above(end) || above(start) && below(end);
                    assert!(start > end || !crosses, "{}", case());
                    // Nor if the numerator is zero without error, and so is t.
                    let through_origin = numerator_error == 0.0;
                    assert!(!(through_origin && start <= 0.0 && 0.0 <= end), "{}", case());
                }
            }
        }
        println!(
            "{:<6} planes: {at} at, {contained} contained, {missed} missed, {left_out} left out",
            name::<V>()
        );
        assert!(at > 50_000 && contained > 5_000 && missed > 50_000);
    }
    for_every_vector!(check);
}

/// Entry and exit are within 3.1u; and so is each verdict one of a box whose planes are met at a t that is.
#[test]
fn slabs() {
    fn check<V: Vector>() {
        let relative = 3.1 * unit_roundoff::<V::Scalar>();
        // A t that underflows is off by at most half of the least float.
        let least: f64 = (<V::Scalar as Scalar>::MIN_POSITIVE * V::Scalar::EPSILON).into();
        let largest: f64 = V::Scalar::MAX.into();
        let mut rng = fastrand::Rng::with_seed(SEED + 3);
        let (mut hits, mut misses, mut false_hits, mut false_misses) = (0, 0, 0, 0);
        for _ in 0..300_000 {
            let (ray_, min, max) = generators::ray_aabb(&mut rng);
            let hit = slab::intersect(&BoxRay::new(&ray(&ray_)), &aabb::<V>(&min, &max));
            let case = || format!("{} {ray_:?} {min:?} {max:?} {hit:?}", name::<V>());
            // A t beyond the largest float is none.
            let finite = oracle::Ray {
                t_min: ray_.t_min.max(-largest),
                t_max: ray_.t_max.min(largest),
                ..ray_
            };
            match (hit, oracle::aabb(&ray_, min, max)) {
                (Some(hit), true) => {
                    hits += 1;
                    let around = |t: f64| {
                        if t.is_infinite() {
                            // Beyond the largest float, or unbounded.
                            return if t < 0.0 { (t, -largest) } else { (largest, t) };
                        }
                        let error = relative * t.abs() + least;
                        (t - error, t + error)
                    };
                    let (enter, exit): (f64, f64) = (hit.t_enter.into(), hit.t_exit.into());
                    assert!(ray_.t_min <= enter && enter <= exit && exit <= ray_.t_max);
                    let (low, high) = around(enter);
                    assert!(oracle::aabb_enter_in(&ray_, min, max, low, high), "{}", case());
                    let (low, high) = around(exit);
                    assert!(oracle::aabb_exit_in(&ray_, min, max, low, high), "{}", case());
                }
                (None, false) => misses += 1,
                (Some(_), false) => {
                    false_hits += 1;
                    let touches = oracle::aabb_if_moved(&ray_, min, max, relative, least);
                    assert!(touches, "{}", case());
                }
                (None, true) => {
                    false_misses += 1;
                    let touches = oracle::aabb_if_moved(&finite, min, max, -relative, -least);
                    assert!(!touches, "{}", case());
                }
            }
        }
        println!(
            "{:<6} slab: {hits} hits and {misses} misses right; {false_hits} and {false_misses} wrong within bounds",
            name::<V>()
        );
        assert!(hits > 50_000 && misses > 50_000 && false_hits > 500 && false_misses > 500);
    }
    for_every_vector!(check);
}

/// The exact kernel's entry and exit are within 3.1u, or twice that where they are reported as equal, and on their faces.
#[test]
fn exact_boxes() {
    fn check<V: Vector>() {
        let relative = 3.1 * unit_roundoff::<V::Scalar>();
        let least: f64 = (<V::Scalar as Scalar>::MIN_POSITIVE * V::Scalar::EPSILON).into();
        let largest: f64 = V::Scalar::MAX.into();
        let mut rng = fastrand::Rng::with_seed(SEED + 3);
        let (mut hits, mut faces, mut beyond) = (0, 0, 0);
        for _ in 0..300_000 {
            let (ray_, min, max) = generators::ray_aabb(&mut rng);
            let hit = exact::intersect(&BoxRay::new(&ray(&ray_)), &aabb::<V>(&min, &max));
            let case = || format!("{} {ray_:?} {min:?} {max:?} {hit:?}", name::<V>());
            assert_eq!(hit.is_some(), oracle::aabb(&ray_, min, max), "{}", case());
            let Some(hit) = hit else { continue };
            hits += 1;
            let (enter, exit): (f64, f64) = (hit.t_enter.into(), hit.t_exit.into());
            assert!(ray_.t_min <= enter && enter <= exit && exit <= ray_.t_max, "{}", case());
            let relative = if enter == exit { 2.0 * relative } else { relative };
            let around = |t: f64| {
                if t.abs() >= largest {
                    // Beyond the largest float, or as close to it; or unbounded.
                    let least = largest * (1.0 - relative);
                    return if t < 0.0 { (f64::NEG_INFINITY, -least) } else { (least, INFINITY) };
                }
                let error = relative * t.abs() + least;
                (t - error, t + error)
            };
            let (low, high) = around(enter);
            assert!(oracle::aabb_enter_in(&ray_, min, max, low, high), "{}", case());
            let (low, high) = around(exit);
            assert!(oracle::aabb_exit_in(&ray_, min, max, low, high), "{}", case());
            for (t, face, clip) in
                [(enter, hit.enter_face, ray_.t_min), (exit, hit.exit_face, ray_.t_max)]
            {
                beyond += u32::from(t.abs() == largest);
                let Some(face) = face else {
                    // Clipped; or unbounded.
                    assert!(t == clip || t.is_infinite() || enter == exit, "{}", case());
                    continue;
                };
                faces += 1;
                let axis = face.axis();
                let plane = if face.sign() < 0 { min[axis] } else { max[axis] };
                let expected = (plane - ray_.origin[axis]) / ray_.direction[axis];
                // As much again for what is computed here, in f64.
                let error = 4.0 * (relative * t.abs() + least);
                let is_there = (expected - t).abs() <= error || t.abs() == largest;
                assert!(is_there, "{} {face:?} {expected}", case());
            }
        }
        println!(
            "{:<6} {hits} hits, {faces} faces, {beyond} ends beyond the largest float",
            name::<V>()
        );
        assert!(hits > 50_000 && faces > 50_000);
    }
    for_every_vector!(check);
}
