//! The error bounds that the kernels' documentation states, evaluated for one case.
//!
//! Everything is computed in f64. Where the kernel under test works in f64 itself the bound is only as exact as
//! that, so each gets a tenth on top, and a case is left out where the determinant is not known to a sixteenth.

use isect::Scalar;

type Vec3 = [f64; 3];

/// How far a kernel's t, u, v, and the weight of v0, may be from the exact ones.
#[derive(Clone, Copy, Debug)]
pub struct Bound {
    pub t: f64,
    /// By vertex.
    pub weights: [f64; 3],
}

/// What a kernel promises about a case; `None` where the determinant's own error is not small against it.
pub type BoundOf = fn(unit: f64, ray: &super::oracle::Ray, triangle: &[Vec3; 3]) -> Option<Bound>;

/// Half of EPSILON.
pub fn unit_roundoff<T: Scalar>() -> f64 {
    T::EPSILON.into() / 2.0
}

fn sub(a: &Vec3, b: &Vec3) -> Vec3 {
    std::array::from_fn(|i| a[i] - b[i])
}

fn dot(a: &Vec3, b: &Vec3) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: &Vec3, b: &Vec3) -> Vec3 {
    std::array::from_fn(|i| a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3])
}

fn abs(a: &Vec3) -> Vec3 {
    a.map(f64::abs)
}

/// The first axis on which the magnitude is largest.
fn dominant(a: &Vec3) -> usize {
    (0..3).rev().max_by(|&i, &j| a[i].abs().total_cmp(&a[j].abs())).expect("three axes")
}

fn largest(a: &Vec3) -> f64 {
    a.iter().fold(0.0, |m, x| x.abs().max(m))
}

/// The magnitudes of the six terms of a·(b × c).
fn permanent(a: &Vec3, b: &Vec3, c: &Vec3) -> f64 {
    dot(&abs(a), &permanents(b, c))
}

/// The magnitudes of the two terms of each component of b × c.
fn permanents(b: &Vec3, c: &Vec3) -> Vec3 {
    std::array::from_fn(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        (b[j] * c[k]).abs() + (b[k] * c[j]).abs()
    })
}

/// A tenth for what is of second order, and for the rounding of the bound itself.
fn with_margin(t: f64, weights: [f64; 3]) -> Bound {
    Bound { t: t * 1.1, weights: weights.map(|w| w * 1.1) }
}

/// 10u·(P(num) + |value|·P(det)) / |det| for each of t, u and v; the weight of v0 is 1 − u − v.
pub fn moller_trumbore(unit: f64, ray: &super::oracle::Ray, triangle: &[Vec3; 3]) -> Option<Bound> {
    determinants(unit, [10.0, 10.0], ray, triangle)
}

/// 8u for u and v, 9u for t, of the same.
pub fn exact(unit: f64, ray: &super::oracle::Ray, triangle: &[Vec3; 3]) -> Option<Bound> {
    determinants(unit, [8.0, 9.0], ray, triangle)
}

/// 9u for u and v, 10u for t: one rounding more, of the reciprocal.
pub fn packed_exact(unit: f64, ray: &super::oracle::Ray, triangle: &[Vec3; 3]) -> Option<Bound> {
    determinants(unit, [9.0, 10.0], ray, triangle)
}

/// The roundings of a weight and of t, times u·(P(num) + |value|·P(det)) / |det|.
fn determinants(
    unit: f64,
    [of_weight, of_t]: [f64; 2],
    ray: &super::oracle::Ray,
    triangle: &[Vec3; 3],
) -> Option<Bound> {
    let [v0, v1, v2] = triangle;
    let (e1, e2, s, d) = (sub(v1, v0), sub(v2, v0), sub(&ray.origin, v0), ray.direction);
    let det = dot(&e1, &cross(&d, &e2)).abs();
    let p_det = permanent(&e1, &d, &e2);
    if det == 0.0 || 10.0 * unit * p_det > det / 16.0 {
        return None;
    }
    let bound = |roundings: f64, p_numerator: f64, value: f64| {
        roundings * unit * (p_numerator + value.abs() * p_det) / det
    };
    let t = dot(&e2, &cross(&s, &e1)) / det;
    let u = bound(of_weight, permanent(&s, &d, &e2), dot(&e2, &cross(&s, &d)) / det);
    let v = bound(of_weight, permanent(&s, &d, &e1), dot(&e1, &cross(&s, &d)) / det);
    Some(with_margin(bound(of_t, permanent(&e2, &s, &e1), t), [u + v + 4.0 * unit, u, v]))
}

/// The plane's t, then the errors of p − v0 and of the two projections.
pub fn badouel(unit: f64, ray: &super::oracle::Ray, triangle: &[Vec3; 3]) -> Option<Bound> {
    let [v0, v1, v2] = triangle;
    let (e1, e2, s, d) = (sub(v1, v0), sub(v2, v0), sub(&ray.origin, v0), ray.direction);
    // Products of edge components below 2⁻⁵⁰ of the longest underflow.
    let longest = largest(&e1).max(largest(&e2));
    if e1.iter().chain(&e2).any(|x| *x != 0.0 && x.abs() < 2_f64.powi(-50) * longest) {
        return None;
    }
    let n = cross(&e1, &e2);
    let p_n = permanents(&e1, &e2);
    let det = dot(&d, &n).abs();
    let p_det = permanent(&d, &e1, &e2);
    let axis = dominant(&n);
    let condition = p_n[axis] / n[axis].abs();
    if 10.0 * unit * p_det > det / 16.0 || condition * 10.0 * unit > 1.0 / 16.0 {
        return None;
    }
    let t = -dot(&s, &n) / dot(&d, &n);
    let t_error = 9.0 * unit * (permanent(&s, &e1, &e2) + t.abs() * p_det) / det;
    let mut k = [0.0; 3];
    k[axis] = 1.0 / n[axis];
    let weight = |row: Vec3| -> f64 {
        (0..3)
            .map(|i| {
                let p = s[i] + t * d[i];
                let p_error =
                    unit * (2.0 * s[i].abs() + 3.0 * (t * d[i]).abs()) + d[i].abs() * t_error;
                row[i].abs() * (p_error + 10.0 * unit * condition * p.abs())
            })
            .sum()
    };
    let (u, v) = (weight(cross(&e2, &k)), weight(cross(&k, &e1)));
    Some(with_margin(t_error, [u + v + 4.0 * unit, u, v]))
}

/// 12u·(P_i + Σ P_j) / |Σ s| for each weight, and what it adds to t.
pub fn segura(unit: f64, ray: &super::oracle::Ray, triangle: &[Vec3; 3]) -> Option<Bound> {
    let a: [Vec3; 3] = std::array::from_fn(|i| sub(&triangle[i], &ray.origin));
    let d = ray.direction;
    let pair = |i: usize| (&a[(i + 1) % 3], &a[(i + 2) % 3]);
    let s: [f64; 3] = std::array::from_fn(|i| dot(&cross(pair(i).0, pair(i).1), &d));
    let p: [f64; 3] = std::array::from_fn(|i| permanent(&d, pair(i).0, pair(i).1));
    let (sum, p_sum) = (s.iter().sum::<f64>().abs(), p.iter().sum::<f64>());
    if 12.0 * unit * p_sum > sum / 16.0 {
        return None;
    }
    let weights: [f64; 3] = std::array::from_fn(|i| 12.0 * unit * (p[i] + p_sum) / sum);
    let along: [f64; 3] = std::array::from_fn(|i| dot(&abs(&a[i]), &abs(&d)) / dot(&d, &d));
    let t = (0..3).map(|i| (weights[i] + 12.0 * unit) * along[i]).sum();
    Some(with_margin(t, weights))
}

/// The exact weights for vertices moved across the ray by 6u·|a_i|, with the roundings of the last steps.
pub fn watertight(unit: f64, ray: &super::oracle::Ray, triangle: &[Vec3; 3]) -> Option<Bound> {
    let d = ray.direction;
    let axis = dominant(&d);
    let [kx, ky] = [(axis + 1) % 3, (axis + 2) % 3];
    let a: [Vec3; 3] = std::array::from_fn(|i| sub(&triangle[i], &ray.origin));
    let moved = a.map(|a| 6.0 * unit * largest(&a));
    let flat = a.map(|a| [a[kx] - a[axis] * d[kx] / d[axis], a[ky] - a[axis] * d[ky] / d[axis]]);
    let area = |i: usize| {
        let ([px, py], [qx, qy]) = (flat[(i + 1) % 3], flat[(i + 2) % 3]);
        let (dp, dq) = (moved[(i + 1) % 3], moved[(i + 2) % 3]);
        let products = (px * qy).abs() + (py * qx).abs();
        let error = dp * (qx.abs() + qy.abs() + dq) + dq * (px.abs() + py.abs() + dp);
        (qx * py - qy * px, error + 2.0 * unit * products)
    };
    let areas: [(f64, f64); 3] = std::array::from_fn(area);
    let sum = areas.iter().map(|a| a.0).sum::<f64>().abs();
    let error = areas.iter().map(|a| a.1 + 2.0 * unit * a.0.abs()).sum::<f64>();
    if error > sum / 16.0 {
        return None;
    }
    let weights = areas.map(|(area, own)| (own + error * area.abs() / sum) / sum + 3.0 * unit);
    let t = (0..3).map(|i| (weights[i] + 9.0 * unit) * (a[i][axis] / d[axis]).abs()).sum();
    Some(with_margin(t, weights))
}
