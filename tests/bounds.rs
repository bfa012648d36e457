//! Claim: t, u and v are within the error bounds that the documentation states, and so is each verdict.
//!
//! A hit must be one of the exact geometry moved by the bounds; a miss must be one of it as well.

use isect::ray::aabb::{BoxRay, slab};
use isect::ray::plane::{self, PlaneHit};
use isect::{Plane, Scalar, Vector};

use crate::support::bounds::{Bound, unit_roundoff};
use crate::support::kernels::{TriangleKernel, sphere_kernels, triangle_kernels};
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
            for _ in 0..150_000 {
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
            assert!(hits > 20_000 && misses > 20_000);
        }
    }
    for_every_vector!(check);
}

/// The bounds are about rounding, not about underflow: where t, or a length that matters, is subnormal they do not count.
fn in_exponent_range<V: Vector>(ray: &oracle::Ray, vertices: &Vertices, bound: &Bound) -> bool {
    let tiny: f64 = <V::Scalar as Scalar>::MIN_POSITIVE.into();
    let all = vertices.as_flattened().iter().chain(&ray.origin).chain(&ray.direction);
    let smallest = all.filter(|x| **x != 0.0).fold(INFINITY, |m, x| m.min(x.abs()));
    bound.t.is_finite() && smallest > tiny
}

/// The hit point lies on a sphere of which the radius is wrong by the stated error; a missed line does not cross one.
#[test]
fn spheres() {
    fn check<V: Vector>() {
        let unit = unit_roundoff::<V::Scalar>();
        for kernel in sphere_kernels::<V>() {
            let mut rng = fastrand::Rng::with_seed(SEED + 1);
            let (mut hits, mut misses) = (0, 0);
            for _ in 0..150_000 {
                let (ray_, center, radius) = generators::ray_sphere(&mut rng);
                let f: f64 =
                    (0..3).map(|i| (center[i] - ray_.origin[i]).powi(2)).sum::<f64>().sqrt();
                let (square, linear) = (kernel.error)(unit, f, radius);
                let inner = (radius * radius - square).max(0.0).sqrt() - linear;
                let outer = (radius * radius + square).sqrt() + linear;
                let hit = (kernel.intersect)(&ray::<V>(&ray_), &sphere(&center, radius));
                let case = || {
                    format!(
                        "{} {}: {ray_:?} {center:?} {radius}: {hit:?}",
                        kernel.name,
                        name::<V>()
                    )
                };
                if let Some(hit) = hit {
                    hits += 1;
                    let t = hit.t.into();
                    assert!(ray_.t_min <= t && t <= ray_.t_max, "{}", case());
                    let side =
                        |radius| oracle::sphere_side(&ray_, center, radius, t).expect("valid");
                    assert!(side(outer).is_le(), "{}", case());
                    assert!(inner <= 0.0 || side(inner).is_ge(), "{}", case());
                } else {
                    misses += 1;
                    // A line that passes well inside of the sphere cannot be missed.
                    // (If its roots are floats, even with an error that is large against a tiny direction.)
                    let limit = f64::from(f32::MAX) / 1024.0;
                    let line = oracle::Ray { t_min: -limit, t_max: limit, ..ray_ };
                    let whole = isect::Ray {
                        t_min: scalar(-INFINITY),
                        t_max: scalar(INFINITY),
                        ..ray::<V>(&ray_)
                    };
                    let found = (kernel.intersect)(&whole, &sphere(&center, radius)).is_some();
                    assert!(
                        found || inner <= 0.0 || !oracle::sphere(&line, center, inner),
                        "{}",
                        case()
                    );
                }
            }
            println!(
                "{:<6} {:<10} {hits} hits and {misses} misses within bounds",
                name::<V>(),
                kernel.name
            );
            assert!(hits > 20_000 && misses > 10_000);
        }
    }
    for_every_vector!(check);
}

/// The plane's t satisfies n·(o + t·d) = offset with the stated errors of numerator and denominator.
#[test]
fn planes() {
    fn check<V: Vector>() {
        let unit = unit_roundoff::<V::Scalar>();
        let mut rng = fastrand::Rng::with_seed(SEED + 2);
        let mut outcomes = [0; 3];
        for _ in 0..300_000 {
            let (ray_, normal, offset) = generators::ray_plane(&mut rng);
            let plane = Plane { normal: vector::<V>(normal), offset: scalar(offset) };
            let found = plane::intersect(&ray(&ray_), &plane);
            // The bounds are about rounding: where a product underflows they do not count.
            let products =
                (0..3).flat_map(|i| [ray_.origin[i], ray_.direction[i]].map(|x| x * normal[i]));
            if products.chain([offset]).any(|x| x != 0.0 && !(1e-30..1e30).contains(&x.abs())) {
                continue;
            }
            let terms = |a: &[f64; 3]| (0..3).map(|i| (a[i] * normal[i]).abs()).sum::<f64>();
            let numerator_error = 4.0 * unit * (offset.abs() + terms(&ray_.origin));
            let denominator_error = 3.0 * unit * terms(&ray_.direction);
            let case = || format!("{} {ray_:?} {normal:?} {offset}: {found:?}", name::<V>());
            match found {
                Some(PlaneHit::At(t)) => {
                    outcomes[0] += 1;
                    let t: f64 = t.into();
                    if t != 0.0 && t.abs() < 1e-30 {
                        continue; // nor where t itself may
                    }
                    assert!(ray_.t_min <= t && t <= ray_.t_max, "{}", case());
                    // n·o + t·n·d, moved by the errors, straddles the offset: as exact planes.
                    let line = oracle::Ray { t_min: -INFINITY, t_max: t, ..ray_ };
                    let slack = 1.01
                        * (numerator_error
                            + t.abs() * denominator_error
                            + 2.0 * unit * t.abs() * terms(&ray_.direction));
                    let up_to = |by: f64| {
                        oracle::plane(&line, normal, offset + by) != oracle::PlaneVerdict::Miss
                    };
                    assert!(
                        up_to(slack) != up_to(-slack)
                            || slack < f64::from(f32::MIN_POSITIVE)
                            || !slack.is_finite(),
                        "{}",
                        case()
                    );
                }
                Some(PlaneHit::Contained) => {
                    outcomes[1] += 1;
                    let den: f64 = (0..3).map(|i| normal[i] * ray_.direction[i]).sum();
                    let num: f64 = offset - (0..3).map(|i| normal[i] * ray_.origin[i]).sum::<f64>();
                    assert!(
                        den.abs() <= 1.01 * denominator_error
                            && num.abs() <= 1.01 * numerator_error,
                        "{}",
                        case()
                    );
                }
                None => outcomes[2] += 1,
            }
        }
        println!("{:<6} planes: {outcomes:?} at, contained, missed", name::<V>());
        assert!(outcomes.iter().all(|&n| n > 5_000), "{outcomes:?}");
    }
    for_every_vector!(check);
}

/// Entry and exit within three roundings; a wrong verdict flips when every t may move by that.
#[test]
fn slabs() {
    fn check<V: Vector>() {
        let unit = unit_roundoff::<V::Scalar>();
        let tiny: f64 = <V::Scalar as Scalar>::MIN_POSITIVE.into();
        let mut rng = fastrand::Rng::with_seed(SEED + 3);
        let (mut right, mut wrong) = (0, 0);
        for _ in 0..300_000 {
            let (ray_, min, max) = generators::ray_aabb(&mut rng);
            let hit = slab::intersect(&BoxRay::new(&ray(&ray_)), &aabb::<V>(&min, &max));
            if hit.is_some() != oracle::aabb(&ray_, min, max) {
                wrong += 1;
                continue;
            }
            right += 1;
            let Some(hit) = hit else { continue };
            let around = |t: f64| {
                if t.is_infinite() {
                    // Beyond the largest float, or unbounded.
                    let largest: f64 = <V::Scalar as Scalar>::MAX.into();
                    return if t < 0.0 { (t, -largest) } else { (largest, t) };
                }
                let error = 3.1 * unit * t.abs() + tiny;
                (t - error, t + error)
            };
            let (enter, exit): (f64, f64) = (hit.t_enter.into(), hit.t_exit.into());
            assert!(ray_.t_min <= enter && enter <= exit && exit <= ray_.t_max);
            let (low, high) = around(enter);
            assert!(
                oracle::aabb_enter_in(&ray_, min, max, low, high),
                "{ray_:?} {min:?} {max:?} {hit:?}"
            );
            let (low, high) = around(exit);
            assert!(
                oracle::aabb_exit_in(&ray_, min, max, low, high),
                "{ray_:?} {min:?} {max:?} {hit:?}"
            );
        }
        println!(
            "{:<6} slab: {right} verdicts right, {wrong} wrong of adversarial cases",
            name::<V>()
        );
    }
    for_every_vector!(check);
}
