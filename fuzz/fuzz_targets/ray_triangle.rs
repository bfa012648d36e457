//! Ray against triangle.
#![no_main]

use isect::glam::{DVec3, Vec3, Vec3A};
use isect::ray::triangle::exact::{self, Verdict};
use isect::ray::triangle::watertight::ShearedRay;
use isect::ray::triangle::{TriangleHit, badouel, moller_trumbore, segura, watertight};
use isect::testkit::oracle::{self, TriangleVerdict};
use isect::testkit::{shapes, verdict};
use isect::{Ray, Scalar, Triangle, Vector};
use isect_fuzz::{FACTORS, Query, assert_in_range, can_hit, is_finite, scaled_ray};
use libfuzzer_sys::fuzz_target;

type Shapes<V> = (Ray<V>, Triangle<V>);

fuzz_target!(|query: Query<Shapes<Vec3>, Shapes<DVec3>>| match query {
    Query::Single { shapes: (ray, triangle), is_integral } => {
        let answers = check(&ray, &triangle, is_integral);
        let answers_a = check::<Vec3A>(&ray.into(), &triangle.into(), is_integral);
        assert_eq!(answers, answers_a, "Vec3 and Vec3A differ");
    }
    Query::Double { shapes: (ray, triangle), is_integral } => {
        check(&ray, &triangle, is_integral);
    }
});

/// The kernels, in the order of their answers.
const KERNELS: [&str; 4] = ["badouel", "moller_trumbore", "segura", "watertight"];

/// What the kernels find, and what `segura::detects` says.
type Answers<T> = ([Option<TriangleHit<T>>; 4], bool);

fn all<V: Vector>(ray: &Ray<V>, triangle: &Triangle<V>) -> Answers<V::Scalar> {
    let hits = [
        badouel::intersect(ray, triangle),
        moller_trumbore::intersect(ray, triangle),
        segura::intersect(ray, triangle),
        watertight::intersect(&ShearedRay::new(ray), triangle),
    ];
    (hits, segura::detects(ray, triangle))
}

fn check<V: Vector>(ray: &Ray<V>, triangle: &Triangle<V>, is_integral: bool) -> Answers<V::Scalar> {
    check_exact(ray, triangle);
    let (hits, detected) = all(ray, triangle);
    assert_eq!(ray.hits(triangle), ray.intersect(triangle).is_some());
    let Triangle { v0, v1, v2 } = *triangle;
    let can_hit = can_hit(ray) && is_finite(triangle) && v0 != v1 && v1 != v2 && v2 != v0;
    assert!(!detected || can_hit, "detects: bad input was hit");
    for (kernel, hit) in KERNELS.iter().zip(&hits) {
        if let Some(hit) = hit {
            assert!(can_hit, "{kernel}: bad input was hit");
            assert_in_range(kernel, hit.t, ray);
            check_weights(kernel, hit);
        }
    }
    if is_integral {
        check_integral(ray, triangle, &(hits, detected));
    }
    (hits, detected)
}

/// The exact verdict is that of big integers, a refined hit is within an ulp, and a crossing is one of a triangle that is
/// touched, in the right direction.
fn check_exact<V: Vector>(ray: &Ray<V>, triangle: &Triangle<V>) {
    let expected = verdict::ray_triangle(ray, triangle);
    let (exact_ray, vertices) = (oracle::Ray::from(ray), shapes::vertices(triangle));
    let front = oracle::triangle_front(&exact_ray, vertices);
    assert_eq!(exact::hits(ray, triangle), expected.hits(), "exact");
    let hit = exact::intersect(ray, triangle);
    assert_eq!(hit.is_some(), expected.hits());
    if let Some(hit) = hit {
        assert_in_range("exact", hit.t, ray);
    }
    let is_agreed = match exact::classify(ray, triangle) {
        Verdict::Miss => expected == TriangleVerdict::Miss,
        Verdict::Interior => expected == TriangleVerdict::Interior,
        Verdict::Edge(i) => {
            [TriangleVerdict::Edge(i), TriangleVerdict::Degenerate].contains(&expected)
        }
        Verdict::Vertex(i) => {
            [TriangleVerdict::Vertex(i), TriangleVerdict::Degenerate].contains(&expected)
        }
        Verdict::Coplanar => {
            [TriangleVerdict::Coplanar, TriangleVerdict::Degenerate].contains(&expected)
        }
    };
    assert!(is_agreed, "exact: not {expected:?}");
    if expected.hits() {
        let hit = exact::refine(ray, triangle);
        assert_in_range("refine", hit.t, ray);
        let questions = [oracle::triangle_t_in, oracle::triangle_u_in, oracle::triangle_v_in];
        for (x, is_in) in [hit.t, hit.u, hit.v].into_iter().zip(questions) {
            let within = is_in(&exact_ray, vertices, x.next_down().into(), x.next_up().into());
            assert!(within != Some(false), "refine: {hit:?}");
        }
        assert_eq!(hit.front, front == Some(true), "refine: {hit:?}");
    }
    check_crossing(ray, triangle, expected, front);
}

/// What is touched inside, and not at an end of the range, is crossed; what is not touched, or only along it, is not.
fn check_crossing<V: Vector>(
    ray: &Ray<V>,
    triangle: &Triangle<V>,
    expected: TriangleVerdict,
    front: Option<bool>,
) {
    let crossing = exact::crosses(ray, triangle);
    if crossing.is_some() {
        assert!(expected.hits(), "crosses: {expected:?}");
        assert_eq!(crossing, front, "crosses");
    }
    let at_end = |t: V::Scalar| {
        let end = ray.with_range(t, t);
        t.is_finite() && verdict::ray_triangle(&end, triangle).hits()
    };
    if expected == TriangleVerdict::Interior && !at_end(ray.t_min) && !at_end(ray.t_max) {
        assert_eq!(crossing, front, "crosses");
    }
    // Backward the line is crossed the other way; two ranges that meet at a t share no crossing and lose none.
    let infinity = V::Scalar::INFINITY;
    let crossing_in = |t_min, t_max| exact::crosses(&ray.with_range(t_min, t_max), triangle);
    let whole = crossing_in(-infinity, infinity);
    let back = Ray { direction: -ray.direction, ..ray.with_range(-infinity, infinity) };
    assert_eq!(exact::crosses(&back, triangle), whole.map(|front| !front), "crosses");
    if ray.t_min.is_finite() {
        let (before, after) = (crossing_in(-infinity, ray.t_min), crossing_in(ray.t_min, infinity));
        assert_eq!(before.xor(after), whole, "crosses: {before:?} {after:?}");
    }
}

/// No weight is negative, and their sum is 1.
///
/// Where a kernel divides three numbers of one sign by their sum, the sum has 2 roundings, the
/// reciprocal and each product 1: the weights add up to 1 within 4u, u = EPSILON/2. `barycentric`
/// replaces the first one by 1 − u − v, with 2 roundings, or zero; adding up here has 2 more.
fn check_weights<T: Scalar>(kernel: &str, hit: &TriangleHit<T>) {
    let [w, u, v] = hit.barycentric();
    let zero = T::ZERO;
    assert!(zero <= hit.u && zero <= hit.v, "{kernel}: {hit:?}");
    assert!(zero <= w && zero <= u && zero <= v, "{kernel}: {hit:?}");
    let off = (w + u + v - T::ONE).abs();
    assert!(off <= T::EPSILON.lit(4.0) * T::EPSILON, "{kernel}: {hit:?}");
}

/// Small integers: the determinants are exact, and so are their signs.
fn check_integral<V: Vector>(ray: &Ray<V>, triangle: &Triangle<V>, answers: &Answers<V::Scalar>) {
    for factor in FACTORS.map(V::Scalar::from) {
        let vertices = <[V; 3]>::from(*triangle).map(|v| v * factor);
        let scaled = all(&scaled_ray(ray, factor), &vertices.into());
        assert_eq!(*answers, scaled, "scaled by {factor:?}");
    }
    let backward = Ray { direction: -ray.direction, t_min: -ray.t_max, t_max: -ray.t_min, ..*ray };
    let reversed = all(&backward, triangle).0;
    for (i, kernel) in KERNELS.iter().enumerate() {
        let (t, t_reversed) = (answers.0[i].map(|hit| -hit.t), reversed[i].map(|hit| hit.t));
        // The line is the same, and every rounding on the way has just the other sign.
        assert_eq!(t, t_reversed, "{kernel}");
    }

    let normal = triangle.normal();
    let slope = normal.dot(ray.direction);
    if slope == V::Scalar::ZERO {
        // Seen edge on, it has no side; and a computed shear may tilt it.
        return;
    }
    let front = slope < V::Scalar::ZERO;
    let turned = Triangle::new(triangle.v0, triangle.v2, triangle.v1);
    let back = all(ray, &turned).0;
    for (i, kernel) in KERNELS.iter().enumerate() {
        if let Some(hit) = answers.0[i] {
            assert_eq!(hit.front, front, "{kernel}");
        }
        for other in [back[i], reversed[i]].into_iter().flatten() {
            assert_eq!(other.front, !front, "{kernel}");
        }
    }
    // These decide on which side of each edge the line passes with exact signs. An end of the range
    // is another matter.
    let line = ray.with_range(-V::Scalar::INFINITY, V::Scalar::INFINITY);
    let (one_way, other_way) = (all(&line, triangle).0, all(&line, &turned).0);
    for i in [2, 3] {
        assert!(
            one_way[i].is_some() == other_way[i].is_some(),
            "{}: turning the triangle changes the verdict",
            KERNELS[i]
        );
    }
}
