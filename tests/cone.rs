//! Claim: what a cone touches is found, where, and how much of its section it covers.

use std::f64::consts::PI;

use fastrand::Rng;
use isect::glam::{DVec3, Vec3, Vec3A};
use isect::overlap::{ConeHit, cone_aabb, cone_plane, cone_sphere, cone_triangle};
use isect::{Aabb, Cone, Intersect, Plane, Ray, Scalar, Sphere, Triangle, Vector};

use crate::support::bounds::unit_roundoff;
use crate::support::{array, for_every_vector, generators, name, scalar, vector};

const SEED: u64 = 11;

/// A shape that a cone may touch.
trait Touch<V: Vector>: Copy + std::fmt::Debug {
    /// The same in `f64`, for a ray to hit.
    type Wide: Intersect<DVec3> + Copy;

    fn wide(self) -> Self::Wide;
    fn met_by(&self, cone: &Cone<V>) -> Option<ConeHit<V::Scalar>>;
    fn touches(&self, cone: &Cone<V>) -> bool;
    /// A random one near the origin.
    fn random(rng: &mut Rng) -> Self;
    /// The distance from `at` of the part of the shape in the plane through `at` across `axis`; infinite if there is none.
    fn distance_across(wide: &Self::Wide, at: DVec3, axis: DVec3) -> f64;
}

fn wide<V: Vector>(v: V) -> DVec3 {
    array(v).into()
}

fn point<V: Vector>(rng: &mut Rng, radius: f64) -> V {
    vector([(); 3].map(|()| radius * (2.0 * rng.f64() - 1.0)))
}

impl<V: Vector> Touch<V> for Triangle<V> {
    type Wide = Triangle<DVec3>;

    fn wide(self) -> Triangle<DVec3> {
        <[V; 3]>::from(self).map(wide).into()
    }
    fn met_by(&self, cone: &Cone<V>) -> Option<ConeHit<V::Scalar>> {
        cone_triangle::intersect(cone, self)
    }
    fn touches(&self, cone: &Cone<V>) -> bool {
        cone_triangle::touches(cone, self)
    }
    fn random(rng: &mut Rng) -> Self {
        [(); 3].map(|()| point(rng, 1.5)).into()
    }
    fn distance_across(triangle: &Triangle<DVec3>, at: DVec3, axis: DVec3) -> f64 {
        let corners: [DVec3; 3] = (*triangle).into();
        distance_of_edges(&[[0, 1], [1, 2], [2, 0]], &corners, at, axis, false)
    }
}

impl<V: Vector> Touch<V> for Aabb<V> {
    type Wide = Aabb<DVec3>;

    fn wide(self) -> Aabb<DVec3> {
        Aabb::new(wide(self.min), wide(self.max))
    }
    fn met_by(&self, cone: &Cone<V>) -> Option<ConeHit<V::Scalar>> {
        cone_aabb::intersect(cone, self)
    }
    fn touches(&self, cone: &Cone<V>) -> bool {
        cone_aabb::touches(cone, self)
    }
    fn random(rng: &mut Rng) -> Self {
        Self::from_points([point(rng, 1.0), point(rng, 1.0)])
    }
    fn distance_across(aabb: &Aabb<DVec3>, at: DVec3, axis: DVec3) -> f64 {
        let edges: Vec<_> = (0..8)
            .flat_map(|i| [1, 2, 4].map(|bit| [i, i | bit]))
            .filter(|[a, b]| a != b)
            .collect();
        let inside = aabb.inflated(1e-12).contains(at);
        distance_of_edges(&edges, &aabb.corners(), at, axis, inside)
    }
}

/// The distance of the convex polygon in which a plane cuts a convex shape with these edges.
fn distance_of_edges(
    edges: &[[usize; 2]],
    corners: &[DVec3],
    at: DVec3,
    axis: DVec3,
    inside: bool,
) -> f64 {
    let height = |p: DVec3| (p - at).dot(axis);
    // What rounding does to t counts as much here.
    let slack = 1e-12;
    let cuts: Vec<DVec3> = edges
        .iter()
        .flat_map(|&[i, j]| {
            let (p, q) = (corners[i], corners[j]);
            let (a, b) = (height(p), height(q));
            let crossing = (a * b < 0.0).then(|| p + (q - p) * (a / (a - b)));
            let ends = [(p, a), (q, b)].map(|(end, h)| (h.abs() <= slack).then_some(end));
            [crossing, ends[0], ends[1]]
        })
        .flatten()
        .collect();
    let distances = cuts.iter().flat_map(|&p| {
        cuts.iter().map(move |&q| {
            let step = q - p;
            let s = ((at - p).dot(step) / step.length_squared().max(1e-300)).clamp(0.0, 1.0);
            (p + step * s - at).length()
        })
    });
    if inside { 0.0 } else { distances.fold(f64::INFINITY, f64::min) }
}

impl<V: Vector> Touch<V> for Sphere<V> {
    type Wide = Sphere<DVec3>;

    fn wide(self) -> Sphere<DVec3> {
        Sphere::new(wide(self.center), self.radius.into())
    }
    fn met_by(&self, cone: &Cone<V>) -> Option<ConeHit<V::Scalar>> {
        cone_sphere::intersect(cone, self)
    }
    fn touches(&self, cone: &Cone<V>) -> bool {
        cone_sphere::touches(cone, self)
    }
    fn random(rng: &mut Rng) -> Self {
        Self::new(point(rng, 1.0), scalar(1.5 * rng.f64()))
    }
    fn distance_across(sphere: &Sphere<DVec3>, at: DVec3, axis: DVec3) -> f64 {
        let offset = sphere.center - at;
        let height = offset.dot(axis);
        let square = sphere.radius.powi(2) - height * height;
        // Near a pole the circle's radius is uncertain by the root of the slack.
        if square < -1e-11 {
            return f64::INFINITY;
        }
        let radius = square.max(0.0).sqrt();
        let q = (offset - axis * height).length();
        let slack = if square < 1e-6 { 1e-5 } else { 0.0 };
        (q - radius).abs() - slack
    }
}

impl<V: Vector> Touch<V> for Plane<V> {
    type Wide = Plane<DVec3>;

    fn wide(self) -> Plane<DVec3> {
        Plane { normal: wide(self.normal), offset: self.offset.into() }
    }
    fn met_by(&self, cone: &Cone<V>) -> Option<ConeHit<V::Scalar>> {
        cone_plane::intersect(cone, self)
    }
    fn touches(&self, cone: &Cone<V>) -> bool {
        cone_plane::touches(cone, self)
    }
    fn random(rng: &mut Rng) -> Self {
        Self { normal: point(rng, 1.0), offset: scalar(2.0 * rng.f64() - 1.0) }
    }
    fn distance_across(plane: &Plane<DVec3>, at: DVec3, axis: DVec3) -> f64 {
        let across = plane.normal - axis * plane.normal.dot(axis);
        (plane.normal.dot(at) - plane.offset).abs() / across.length()
    }
}

/// A cone near the origin: from an apex, from a disk, or a cylinder; narrow or wide; from t_min on, and some end.
fn random_cone<V: Vector>(rng: &mut Rng) -> Cone<V> {
    let size = 2f64.powi(rng.i32(-6..=1));
    let (mut radius, mut spread) = (size * rng.f64(), size * rng.f64());
    match rng.u8(..4) {
        0 => radius = 0.0,
        1 => spread = 0.0,
        _ => {}
    }
    let (origin, target): (V, V) = (point(rng, 2.0), point(rng, 1.0));
    let mut ray = Ray::new(origin, target - origin);
    if rng.bool() {
        ray.t_min = scalar(rng.f64());
    }
    if rng.u8(..3) == 0 {
        ray.t_max = scalar(ray.t_min.into() + rng.f64());
    }
    Cone::new(ray, scalar(radius), scalar(spread))
}

fn wide_cone<V: Vector>(cone: &Cone<V>) -> Cone<DVec3> {
    let Ray { origin, direction, t_min, t_max } = cone.ray;
    let ray = Ray::new(wide(origin), wide(direction)).with_range(t_min.into(), t_max.into());
    Cone::new(ray, cone.radius.into(), cone.spread.into())
}

/// The lines of sight of a cone: (X, Y) is in the unit disk, and t is that of the cone.
fn line_of_sight(cone: &Cone<DVec3>, [x, y]: [f64; 2]) -> Ray<DVec3> {
    let (first, second) = cone.ray.direction.normalize().any_orthonormal_pair();
    let across = first * x + second * y;
    Ray {
        origin: cone.ray.origin + across * cone.radius,
        direction: cone.ray.direction + across * cone.spread,
        ..cone.ray
    }
}

/// Of the grid's cells as many lie between the axis and the rim, with one line of sight in each.
const CELLS: i32 = 100;

/// Their edge.
const CELL: f64 = 1.0 / CELLS as f64;

/// What a convex shape covers of the disk is bounded by a convex curve, which goes to and fro along x and y once,
/// by 2 at most: it crosses 8/CELL + 4 cells at most. What begins and ends within a sphere has such a bound as well. Each of those cells
/// has a sample that is in or out: Hoeffding's inequality gives a deviation of more than 6 half roots of their number
/// a probability of 2·e^(−18).
fn sampling_error() -> f64 {
    3.0 * (2.0 * (8.0 / CELL + 4.0)).sqrt() * CELL * CELL / PI
}

/// The share of lines of sight that hit.
fn sampled<S: Intersect<DVec3>>(rng: &mut Rng, cone: &Cone<DVec3>, shape: &S) -> f64 {
    let mut hits = 0;
    for i in -CELLS..CELLS {
        for j in -CELLS..CELLS {
            let [x, y] = [i, j].map(|k| (f64::from(k) + rng.f64()) * CELL);
            if x * x + y * y <= 1.0 && line_of_sight(cone, [x, y]).hits(shape) {
                hits += 1;
            }
        }
    }
    f64::from(hits) * CELL * CELL / PI
}

#[test]
fn coverage_is_that_of_dense_samples() {
    fn check<V: Vector, S: Touch<V>>(seed: u64) {
        let mut rng = Rng::with_seed(seed);
        let (mut partial, mut whole) = (0, 0);
        for _ in 0..120 {
            let (cone, shape) = (random_cone::<V>(&mut rng), S::random(&mut rng));
            let coverage = shape.met_by(&cone).map_or(0.0, |hit| hit.coverage.into());
            let expected = sampled(&mut rng, &wide_cone(&cone), &shape.wide());
            assert!(
                (coverage - expected).abs() <= sampling_error(),
                "{coverage} {expected} {cone:?} {shape:?}"
            );
            partial += u32::from(0.01 < coverage && coverage < 0.99);
            whole += u32::from(coverage > 0.99);
        }
        assert!(partial > 20 && whole > 0, "{partial} {whole} {}", std::any::type_name::<S>());
    }
    fn check_all<V: Vector>() {
        check::<V, Triangle<V>>(SEED);
        check::<V, Aabb<V>>(SEED + 1);
        check::<V, Sphere<V>>(SEED + 2);
        check::<V, Plane<V>>(SEED + 3);
    }
    for_every_vector!(check_all);
}

/// The disk at t touches the shape, and none of some lines of sight meets it before.
#[test]
fn t_is_where_the_section_first_touches() {
    fn check<V: Vector, S: Touch<V>>(seed: u64) {
        let mut rng = Rng::with_seed(seed);
        let mut touched = 0;
        for _ in 0..4_000 {
            let (narrow, shape) = (random_cone::<V>(&mut rng), S::random(&mut rng));
            let (cone, wide) = (wide_cone(&narrow), shape.wide());
            let hit = shape.met_by(&narrow);
            assert_eq!(shape.touches(&narrow), hit.is_some(), "{narrow:?} {shape:?}");
            let first = (0..40)
                .filter_map(|_| {
                    let angle = 2.0 * PI * rng.f64();
                    let radius = if rng.bool() { 1.0 } else { rng.f64().sqrt() };
                    let ray = line_of_sight(&cone, [radius * angle.cos(), radius * angle.sin()]);
                    // Slightly longer than it is at most, to be bisected.
                    ray.hits(&wide).then(|| first_t(&ray, &wide))
                })
                .fold(f64::INFINITY, f64::min);
            let Some(hit) = hit else {
                assert_eq!(first, f64::INFINITY, "missed: {narrow:?} {shape:?}");
                continue;
            };
            touched += 1;
            let (t, length) = (hit.t.into(), cone.ray.direction.length());
            // t is rounded once to the scalar; all else is in f64, with coordinates up to 4 and few operations.
            let rounding = unit_roundoff::<V::Scalar>() * t;
            assert!(cone.ray.t_min <= t && t <= cone.ray.t_max);
            assert!(t <= first + rounding + 1e-12, "{t} {first} {narrow:?} {shape:?}");
            // In f64 only t is exact enough to ask about the section there.
            if V::Scalar::EPSILON.into() < 1e-10 {
                let axis = cone.ray.direction / length;
                let distance = S::distance_across(&wide, cone.ray.at(t), axis);
                let radius = cone.radius_at(t);
                assert!(distance <= radius + 1e-10, "{distance} {radius} {narrow:?} {shape:?}");
            }
        }
        assert!((400..3_900).contains(&touched), "{touched} {}", std::any::type_name::<S>());
    }
    fn check_all<V: Vector>() {
        check::<V, Triangle<V>>(SEED + 4);
        check::<V, Aabb<V>>(SEED + 5);
        check::<V, Sphere<V>>(SEED + 6);
        check::<V, Plane<V>>(SEED + 7);
    }
    for_every_vector!(check_all);
}

/// Where a ray that hits does so first: the least end of the range with a hit.
fn first_t<S: Intersect<DVec3>>(ray: &Ray<DVec3>, shape: &S) -> f64 {
    let (mut miss, mut hit) = (ray.t_min, ray.t_max.min(1e3));
    if ray.with_range(miss, miss).hits(shape) {
        return miss;
    }
    if !ray.with_range(miss, hit).hits(shape) {
        return f64::INFINITY; // beyond all that counts
    }
    for _ in 0..60 {
        let middle = 0.5 * (miss + hit);
        if ray.with_range(ray.t_min, middle).hits(shape) {
            hit = middle;
        } else {
            miss = middle;
        }
    }
    hit
}

/// What is said of coverages holds to 1e-5, and for doubles to 1e-13.
#[track_caller]
fn assert_near<T: Scalar>(coverage: T, expected: f64) {
    let tolerance = if T::EPSILON.into() < 1e-10 { 1e-13 } else { 1e-6 };
    let coverage: f64 = coverage.into();
    assert!((coverage - expected).abs() <= tolerance, "{coverage} instead of {expected}");
}

/// The share of the unit disk on the far side of a line.
fn beyond(h: f64) -> f64 {
    (h.acos() - h * (1.0 - h * h).sqrt()) / PI
}

/// The area that circles of these radii have in common, their centres d apart.
fn lens(r: f64, s: f64, d: f64) -> f64 {
    let x = (d * d + r * r - s * s) / (2.0 * d);
    r * r * beyond(x / r) * PI + s * s * beyond((d - x) / s) * PI
}

#[test]
fn closed_forms() {
    fn check<V: Vector>() {
        let v = |x: f64, y: f64, z: f64| vector::<V>([x, y, z]);
        let n = |x: f64| scalar::<V::Scalar>(x);
        // From an apex, from a disk, a cylinder; each of radius 1 at z = 2.
        for (radius, spread) in [(0.0, 0.5), (0.5, 0.25), (1.0, 0.0)] {
            let ray = Ray::new(v(0.0, 0.0, 0.0), v(0.0, 0.0, 1.0));
            let cone = Cone::new(ray, n(radius), n(spread));
            let covered = |corners: [V; 3]| {
                cone_triangle::intersect(&cone, &corners.into()).map_or(n(0.0), |hit| hit.coverage)
            };
            // The half plane beyond a line, by a triangle that is large enough, to either side.
            for h in [-1.25, -1.0, -0.5, 0.0, 0.25, 0.75, 1.0, 1.5] {
                let far = [v(h, -99.0, 2.0), v(h, 99.0, 2.0), v(99.0, 0.0, 2.0)];
                assert_near(
                    covered(far),
                    if h.abs() < 1.0 { beyond(h) } else { 0.5 - h.signum() * 0.5 },
                );
                let plane = Plane { normal: v(1.0, 0.0, 0.0), offset: n(h) };
                let cylinder = Cone::new(ray, n(1.0), n(0.0));
                assert_eq!(cone_plane::touches(&cylinder, &plane), h.abs() <= 1.0);
                // In front of a wall that leans over, at 45 degrees: seen from the apex it has its horizon at
                // x = z, and it is met at z = 2 where x = h.
                let leaning = Plane { normal: v(1.0, 0.0, -1.0), offset: n(h - 2.0) };
                let ends = Ray { t_min: n(2.0), ..ray };
                let hit = cone_plane::intersect(&Cone { ray: ends, ..cone }, &leaning);
                // At the far end the section is infinite, and the line at 1/spread.
                let share = |h: f64| if h.abs() < 1.0 { beyond(h) } else { 0.5 - h.signum() * 0.5 };
                assert_near(hit.map_or(n(0.0), |hit| hit.coverage), (share(h) - share(9.0)).abs());
            }
            // A square in the disk, of area 2 in π, and one around it.
            let square = |s: f64| [v(-s, -s, 2.0), v(s, -s, 2.0), v(s, s, 2.0), v(-s, s, 2.0)];
            for (s, share) in
                [(0.5_f64.sqrt(), 2.0 / PI), (1.0, 1.0), (0.25, 0.25 / PI), (50.0, 1.0)]
            {
                let [a, b, c, d] = square(s);
                let halves = [covered([a, b, c]), covered([c, a, d])];
                for half in halves {
                    assert_near(half, share / 2.0);
                }
            }
            // The inside of an equilateral triangle's inscribed circle, and its circumscribed one.
            let equilateral = |r: f64| {
                [0.0, 1.0, 2.0]
                    .map(|k| 2.0 * PI * k / 3.0)
                    .map(|a| v(r * a.cos(), r * a.sin(), 2.0))
            };
            assert_near(covered(equilateral(2.0)), 1.0);
            assert_near(covered(equilateral(1.0)), 0.75 * 3.0_f64.sqrt() / PI);

            let sphere = |q: f64, z: f64, r: f64| {
                let sphere = Sphere::new(v(q, 0.0, z), n(r));
                cone_sphere::intersect(&cone, &sphere).map_or(n(0.0), |hit| hit.coverage)
            };
            let apex = if spread > 0.0 { -radius / spread } else { f64::NEG_INFINITY };
            // On the axis: the outline is a circle. Let β be the angle between the axis and a tangent from the apex.
            for r in [0.125, 0.5, 0.75] {
                let distance = 2.0 - apex;
                let tangent = r / (distance * distance - r * r).sqrt();
                let share = if spread > 0.0 { tangent / spread } else { r };
                assert_near(sphere(0.0, 2.0, r), share.min(1.0).powi(2));
            }
            // Beside the axis of a cylinder: two circles.
            if spread == 0.0 {
                for (q, r) in [(0.5, 0.75), (1.0, 0.5), (1.5, 1.0), (3.0, 2.5), (2.0, 1.0)] {
                    let expected = if q < r + 1.0 { lens(1.0, r, q) / PI } else { 0.0 };
                    assert_near(sphere(q, 4.0, r), expected);
                }
            }
            // From inside a sphere it is all around; through its surface only what begins there sees it.
            assert_near(sphere(0.5, 0.0, 3.0), 1.0);
            let aabb = |min: V, max: V| {
                let aabb = Aabb::new(min, max);
                cone_aabb::intersect(&cone, &aabb).map_or(n(0.0), |hit| hit.coverage)
            };
            assert_near(aabb(v(-3.0, -3.0, -3.0), v(3.0, 3.0, 3.0)), 1.0);
            // Its front is seen, and the side that is turned to the axis, up to the edge at the back.
            let back = 0.25 / (radius + 3.0 * spread);
            assert_near(aabb(v(0.25, -9.0, 2.0), v(9.0, 9.0, 3.0)), beyond(back));
            // Flat, and edge-on.
            assert_near(aabb(v(0.25, -9.0, 2.0), v(9.0, 9.0, 2.0)), beyond(0.25));
            assert_near(aabb(v(0.0, -9.0, 1.0), v(0.0, 9.0, 2.0)), 0.0);
        }
        // Wide cones on spheres that reach behind the apex, their centres beside it, at a distance of 2. In units of the
        // tangent of the half-angle, and with the length l of the tangents to the sphere, the outline is the branch of
        // (2X)² = l²·(1 + X² + Y²) with X > 0, a²X² − Y² = 1 with a² = 4/l² − 1.
        let ray = Ray::new(v(0.0, 0.0, 0.0), v(0.0, 0.0, 1.0));
        for (l, spread) in [(1.0_f64, 1.0_f64), (0.25, 1.0), (1.25, 1.0), (0.5, 4.0)] {
            let a = (4.0 / (l * l) - 1.0).sqrt();
            let sphere = Sphere::new(v(2.0, 0.0, 0.0), n((4.0 - l * l).sqrt()));
            let cone = Cone::new(ray, n(0.0), n(spread));
            let hit = cone_sphere::intersect(&cone, &sphere).expect("it is wide enough");
            // ∫ √(a²x² − 1) dx, and it meets the rim where (a² + 1)·X² = 1 + spread².
            let hyperbola = |x: f64| {
                let root = (a * a * x * x - 1.0).max(0.0).sqrt();
                x * root / 2.0 - (a * x + root).ln() / (2.0 * a)
            };
            let square = spread * spread;
            let rim = ((1.0 + square) / (a * a + 1.0)).sqrt();
            let branch = 2.0 * (hyperbola(rim) - hyperbola(1.0 / a));
            let share = branch / (square * PI) + beyond(rim / spread);
            // The radius, up to 2, is rounded, by which l² changes by 8u at most, and no area by a greater share.
            let error = (hit.coverage.into() - share).abs();
            let bound = 8.0 * unit_roundoff::<V::Scalar>() / (l * l) + unit_roundoff::<V::Scalar>();
            assert!(error <= bound + 1e-13, "{error} {l}");
        }
    }
    for_every_vector!(check);
}

/// The coverages of triangles that are side by side and cover the disk add up to 1.
#[test]
fn a_partition_sums_to_one() {
    fn check<V: Vector>() {
        let mut rng = Rng::with_seed(SEED + 8);
        for case in 0..300 {
            let origin: V = point(&mut rng, 1.0);
            let direction = point::<DVec3>(&mut rng, 1.0).normalize() * (1.0 + rng.f64());
            let direction: V = vector(direction.to_array());
            let narrow = 2f64.powi(rng.i32(-14..=-1));
            let spread = narrow * wide(direction).length();
            let (radius, spread) =
                [(0.0, spread), (narrow, 0.0), (narrow, spread * rng.f64())][case % 3];
            let ray = Ray::new(origin, direction);
            let cone = Cone::new(ray, scalar(radius), scalar(spread));
            // A grid on a leaning plane, far larger than the disk there, with its inner vertices moved.
            let axis = wide(direction);
            let (first, second) = axis.normalize().any_orthonormal_pair();
            let tilt = [(); 2].map(|()| rng.f64() - 0.5);
            let center = wide(origin) + axis * (1.0 + rng.f64());
            let size = 8.0 * (radius + 2.0 * spread) * (1.0 + 2.0 * rng.f64());
            let n = 2 + case % 9;
            // Moved by at most a fifth of a cell, no triangle turns over; neighbours share their rounded vertices.
            let vertices: Vec<V> = (0..=n)
                .flat_map(|i| (0..=n).map(move |j| [i, j]))
                .map(|cell| {
                    let [x, y] = cell.map(|k| {
                        let inner = 0 < k && k < n;
                        let moved = if inner { 0.4 * (rng.f64() - 0.5) } else { 0.0 };
                        size * (2.0 * (k as f64 + moved) / n as f64 - 1.0)
                    });
                    let offset = first * x + second * y;
                    let p = center + offset + axis.normalize() * (tilt[0] * x + tilt[1] * y);
                    vector(p.to_array())
                })
                .collect();
            let at = |i: usize, j: usize| vertices[i * (n + 1) + j];
            let mut sum = 0.0;
            for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
                for corners in [
                    [at(i, j), at(i + 1, j), at(i, j + 1)],
                    [at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)],
                ] {
                    let hit = cone_triangle::intersect(&cone, &corners.into());
                    sum += hit.map_or(0.0, |hit| hit.coverage.into());
                }
            }
            // Each share is rounded relative to itself, and off by 40u of f64.
            let evaluation = (2 * n * n) as f64 * 40.0 * unit_roundoff::<f64>();
            let bound = unit_roundoff::<V::Scalar>() + evaluation;
            assert!((sum - 1.0).abs() <= bound, "{} {}: {case} {n}", sum - 1.0, name::<V>());
        }
    }
    for_every_vector!(check);
}

#[test]
fn scaling_by_powers_of_two_changes_nothing() {
    fn check<V: Vector, S: Touch<V>>(scaled: fn(&S, V::Scalar) -> S) {
        let mut rng = Rng::with_seed(SEED + 9);
        for _ in 0..2_000 {
            let (cone, shape) = (random_cone::<V>(&mut rng), S::random(&mut rng));
            let exponents = [rng.i32(-40..=40), rng.i32(-40..=40)];
            let [length, step] = exponents.map(|k| scalar::<V::Scalar>(2f64.powi(k)));
            let Ray { origin, direction, t_min, t_max } = cone.ray;
            let ray = Ray::new(origin * length, direction * step)
                .with_range(t_min * length / step, t_max * length / step);
            let larger = Cone::new(ray, cone.radius * length, cone.spread * step);
            let expected = shape.met_by(&cone);
            let expected = expected.map(|hit| ConeHit { t: hit.t * length / step, ..hit });
            assert_eq!(scaled(&shape, length).met_by(&larger), expected, "{cone:?} {shape:?}");
        }
    }
    fn check_all<V: Vector>() {
        check::<V, Triangle<V>>(|triangle, by| <[V; 3]>::from(*triangle).map(|p| p * by).into());
        check::<V, Aabb<V>>(|aabb, by| Aabb::new(aabb.min * by, aabb.max * by));
        check::<V, Sphere<V>>(|sphere, by| Sphere::new(sphere.center * by, sphere.radius * by));
        check::<V, Plane<V>>(|plane, by| Plane { offset: plane.offset * by, ..*plane });
    }
    for_every_vector!(check_all);
}

#[test]
fn bad_input_is_not_touched() {
    fn check<V: Vector>() {
        let mut rng = Rng::with_seed(SEED + 10);
        let mut touched = 0;
        for case in 0..200_000 {
            let mut number = || generators::hostile(&mut rng);
            let mut any_point = || [number(), number(), number()];
            let [o, d, a, b, c] = [(); 5].map(|()| any_point());
            let [r, radius, spread, t_min, t_max] = [(); 5].map(|()| number());
            let (t_min, t_max) = if case % 2 == 0 { (0.0, f64::INFINITY) } else { (t_min, t_max) };
            let finite = |numbers: &[f64]| numbers.iter().all(|x| x.is_finite());
            let good = finite(&o)
                && finite(&d)
                && d != [0.0; 3]
                && t_min <= t_max
                && t_max >= 0.0
                && t_min < f64::INFINITY
                && radius >= 0.0
                && spread >= 0.0
                && radius + spread > 0.0
                && finite(&[radius, spread]);
            let ray = Ray::new(vector::<V>(o), vector(d)).with_range(scalar(t_min), scalar(t_max));
            let cone = Cone::new(ray, scalar(radius), scalar(spread));
            let mut ask = |hit: Option<ConeHit<V::Scalar>>, touches: bool, shape: &[f64]| {
                assert_eq!(hit.is_some(), touches, "{cone:?} {shape:?}");
                let Some(hit) = hit else { return };
                touched += 1;
                assert!(good && finite(shape), "{cone:?} {shape:?}");
                let (t, coverage) = (hit.t.into(), hit.coverage.into());
                assert!((0.0..=1.0).contains(&coverage), "{cone:?} {shape:?} {hit:?}");
                assert!(t.is_finite() && t_min <= t && t <= t_max, "{cone:?} {shape:?} {hit:?}");
            };
            let triangle = Triangle::from([a, b, c].map(vector::<V>));
            let corners = [a, b, c].concat();
            ask(triangle.met_by(&cone), triangle.touches(&cone), &corners);
            let aabb = Aabb::new(vector::<V>(a), vector(b));
            ask(aabb.met_by(&cone), aabb.touches(&cone), &corners[..6]);
            let sphere = Sphere::new(vector::<V>(a), scalar(r));
            ask(sphere.met_by(&cone), sphere.touches(&cone), &[a[0], a[1], a[2], r.sqrt()]);
            let plane = Plane { normal: vector::<V>(a), offset: scalar(r) };
            ask(plane.met_by(&cone), plane.touches(&cone), &[a[0], a[1], a[2], r]);
        }
        assert!(touched > 1_000, "{touched}");
    }
    for_every_vector!(check);
}

/// Degenerate shapes are the points that they are.
#[test]
fn shapes_without_area() {
    let cone = Cone::new(Ray::new(Vec3A::ZERO, Vec3A::Z), 1.0, 0.0);
    let hit = |t| Some(ConeHit { t, coverage: 0.0 });
    let v = Vec3A::new;
    let triangle = |a, b, c| cone_triangle::intersect(&cone, &Triangle::new(a, b, c));
    // Points, segments through the cone, edge-on triangles.
    assert_eq!(triangle(v(0.5, 0.5, 2.0), v(0.5, 0.5, 2.0), v(0.5, 0.5, 2.0)), hit(2.0));
    assert_eq!(triangle(v(0.9, 0.9, 2.0), v(0.9, 0.9, 2.0), v(0.9, 0.9, 2.0)), None);
    assert_eq!(triangle(v(-9.0, 0.0, 2.0), v(9.0, 0.0, 2.0), v(9.0, 0.0, 2.0)), hit(2.0));
    assert_eq!(triangle(v(-1.0, 0.0, 3.0), v(1.0, 0.0, 3.0), v(0.0, 0.0, 4.0)), hit(3.0));
    assert_eq!(cone_sphere::intersect(&cone, &Sphere::new(v(1.0, 0.0, 2.0), 0.0)), hit(2.0));
    assert_eq!(cone_sphere::intersect(&cone, &Sphere::new(v(1.1, 0.0, 2.0), 0.0)), None);
    let point = Aabb::new(v(0.0, 1.0, 5.0), v(0.0, 1.0, 5.0));
    assert_eq!(cone_aabb::intersect(&cone, &point), hit(5.0));
    // A triangle with a vertex at the apex, and one around it.
    let apex = Cone::new(Ray::new(Vec3::ZERO, Vec3::Z), 0.0, 1.0);
    let at_apex = Triangle::new(Vec3::ZERO, Vec3::new(0.1, 0.0, 1.0), Vec3::new(0.0, 0.1, 1.0));
    assert_eq!(cone_triangle::intersect(&apex, &at_apex), Some(ConeHit { t: 0.0, coverage: 0.0 }));
    assert!(cone_triangle::touches(
        &apex,
        &[Vec3::X, Vec3::NEG_X, Vec3::Y].map(|p| p - Vec3::Y * 0.1).into()
    ));
}

type Lattice = [i64; 3];

/// Three integer vectors at right angles, of the same integer length.
const FRAMES: [([Lattice; 3], i64); 4] = [
    ([[1, 0, 0], [0, 1, 0], [0, 0, 1]], 1),
    ([[1, 2, 2], [2, 1, -2], [2, -2, 1]], 3),
    ([[0, 3, 4], [0, 4, -3], [5, 0, 0]], 5),
    ([[2, 3, 6], [3, -6, 2], [6, 2, -3]], 7),
];

fn sum(a: Lattice, b: Lattice, times: i64) -> Lattice {
    [0, 1, 2].map(|i| a[i] + times * b[i])
}

fn dot(a: Lattice, b: Lattice) -> i64 {
    (0..3).map(|i| a[i] * b[i]).sum()
}

/// A cone that a point is on the side of, exactly, and all that lies beyond the tangent plane there.
struct Tangent {
    origin: Lattice,
    direction: Lattice,
    length: i64,
    radius: i64,
    spread: i64,
    /// The t at which the point is.
    t: i64,
    point: Lattice,
    /// The normal of the tangent plane, away from the cone.
    normal: Lattice,
}

impl Tangent {
    /// With coordinates up to 2^bits, of a spread that makes the normal's length an integer, or of any.
    ///
    /// The frame is d, e, … of length L. At o + t·d + n·e the distance from the axis is n·L, and the cone is as wide
    /// with the radius n·L − t·spread. Its side there has the normal L·e − spread·d.
    fn random(rng: &mut Rng, bits: u32, is_integer: bool) -> Self {
        let (mut frame, length) = FRAMES[rng.usize(..FRAMES.len())];
        rng.shuffle(&mut frame);
        let mut signs = || frame[0].map(|_| if rng.bool() { 1 } else { -1 });
        let signs = signs();
        let [direction, side, _] = frame.map(|v| [0, 1, 2].map(|i| signs[i] * v[i]));
        let largest = 1_i64 << (bits - 5);
        let spread = if is_integer {
            // L² + spread² is a square.
            let spreads = match length {
                1 => [0, 0],
                3 => [0, 4],
                5 => [0, 12],
                _ => [0, 24],
            };
            spreads[rng.usize(..2)]
        } else {
            rng.i64(0..=12)
        };
        let n = rng.i64(1..=largest);
        let most = if spread == 0 { largest } else { largest.min(n * length / spread) };
        let t = if rng.u8(..8) == 0 { 0 } else { rng.i64(0..=most) };
        let origin = [(); 3].map(|()| rng.i64(-largest..=largest));
        let radius = n * length - t * spread;
        Self {
            origin,
            direction,
            length,
            radius,
            spread,
            t,
            point: sum(sum(origin, direction, t), side, n),
            normal: sum(side.map(|x| x * length), direction, -spread),
        }
    }

    /// The vector, or its opposite, that points away from the cone.
    fn outward(&self, v: Lattice) -> Lattice {
        if dot(v, self.normal) < 0 { v.map(|x| -x) } else { v }
    }

    /// A vector along the tangent plane.
    fn along(&self, rng: &mut Rng) -> Lattice {
        let (n, r) = (self.normal, [(); 3].map(|()| rng.i64(-4..=4)));
        [n[1] * r[2] - n[2] * r[1], n[2] * r[0] - n[0] * r[2], n[0] * r[1] - n[1] * r[0]]
    }

    /// The cone, or one that is narrower by 1, scaled by a power of two.
    fn cone<V: Vector>(&self, scale: f64, [t_min, t_max]: [f64; 2], narrower: i64) -> Cone<V> {
        let ray = Ray::new(lattice(self.origin, scale), lattice(self.direction, scale))
            .with_range(scalar(t_min), scalar(t_max));
        let [radius, spread] =
            [self.radius - narrower, self.spread].map(|x| scalar(x as f64 * scale));
        Cone::new(ray, radius, spread)
    }
}

fn lattice<V: Vector>(p: Lattice, scale: f64) -> V {
    vector(p.map(|x| x as f64 * scale))
}

/// Cases in which the cone touches one point of a shape, which is all on the other side of the cone's tangent plane there; and,
/// with a radius less by 1, does not. All is integers, so both are certain: and nothing of what decides is lost in rounding.
/// Returns how often the narrower cone was seen to touch, by rounding.
fn tangent_cases<V: Vector>(rng: &mut Rng, cases: u64) {
    // The margin of the kernels is below 2^−44 of the largest coordinate.
    let bits = if V::Scalar::EPSILON.into() < 1e-10 { 34 } else { 20 };
    let (mut touched, mut missed) = (0_u64, 0_u64);
    for case in 0..cases {
        let shape = case % 4;
        // The plane's offset is a product.
        let bits = if shape == 3 { bits - 8 } else { bits };
        let tangent = Tangent::random(rng, bits, shape == 2);
        let (p, t) = (tangent.point, tangent.t as f64);
        let range = match rng.u8(..4) {
            0 => [t, t],
            1 => [0.0, t],
            2 => [t, f64::INFINITY],
            _ => [0.0, f64::INFINITY],
        };
        let scale = 2f64.powi(rng.i32(-30..=30));
        let (exact, narrower) =
            (tangent.cone::<V>(scale, range, 0), tangent.cone::<V>(scale, range, 1));
        let offset = |rng: &mut Rng| {
            let size = 1 << rng.u32(0..bits - 2);
            [(); 3].map(|()| rng.i64(-size..=size))
        };
        let touches: [bool; 2] = match shape {
            0 => {
                let corners = match rng.u8(..3) {
                    // A vertex.
                    0 => {
                        let [a, b] = [(); 2].map(|()| sum(p, tangent.outward(offset(rng)), 1));
                        [p, a, b]
                    }
                    // An edge.
                    1 => {
                        let along = tangent.along(rng);
                        let [a, b] = [rng.i64(0..=9), -rng.i64(0..=9)];
                        let third = sum(p, tangent.outward(offset(rng)), 1);
                        [sum(p, along, a), sum(p, along, b), third]
                    }
                    // The inside, along the tangent plane.
                    _ => {
                        let [a, b] = [(); 2].map(|()| tangent.along(rng));
                        [sum(p, a, 1), sum(p, b, 1), sum(sum(p, a, -1), b, -1)]
                    }
                };
                let mut triangle = corners.map(|p| lattice::<V>(p, scale));
                triangle.rotate_left(rng.usize(..3));
                [exact, narrower].map(|cone| cone_triangle::touches(&cone, &triangle.into()))
            }
            1 => {
                let size = offset(rng).map(i64::abs);
                // Away from the cone on each axis, or to both sides if it is along the tangent plane.
                let end = |sign: i64| {
                    lattice::<V>(
                        [0, 1, 2].map(|i| {
                            let is_on_side = tangent.normal[i].signum() * sign >= 0;
                            p[i] + if is_on_side { sign * size[i] } else { 0 }
                        }),
                        scale,
                    )
                };
                let aabb = Aabb::new(end(-1), end(1));
                [exact, narrower].map(|cone| cone_aabb::touches(&cone, &aabb))
            }
            2 => {
                let (length, spread) = (tangent.length, tangent.spread);
                let root = [1, 3, 5, 7, 13, 25]
                    .into_iter()
                    .find(|root| root * root == length * length + spread * spread)
                    .expect("it is chosen so");
                let most = 1 << rng.u32(0..bits - 10);
                let steps = rng.i64(0..=most);
                let radius = (steps * length * root) as f64 * scale;
                let sphere = |side: i64| {
                    Sphere::new(
                        lattice::<V>(sum(p, tangent.normal, side * steps), scale),
                        scalar(radius),
                    )
                };
                // From the other side, too, it is a point of the sphere in the cone.
                assert!(cone_sphere::touches(&exact, &sphere(-1)), "{exact:?} {:?}", sphere(-1));
                [exact, narrower].map(|cone| cone_sphere::touches(&cone, &sphere(1)))
            }
            _ => {
                let plane = Plane {
                    normal: lattice::<V>(tangent.normal, 1.0),
                    offset: scalar(dot(tangent.normal, p) as f64 * scale),
                };
                // The narrower cone's sides are parallel to the plane as well: it may touch that at infinity.
                [cone_plane::touches(&exact, &plane), false]
            }
        };
        assert!(touches[0], "missed: {shape} {exact:?} {p:?} {:?}", tangent.normal);
        touched += 1;
        // A cone with no radius and no spread is none.
        if tangent.radius >= 1 {
            assert!(!touches[1], "touched: {shape} {narrower:?} {p:?} {:?}", tangent.normal);
            missed += 1;
        }
    }
    println!("{:<6} {touched} cases touched, {missed} not, 0 wrong", name::<V>());
    assert!(missed > cases / 2);
}

fn run_tangent_cases<V: Vector>(cases: u64, seed: u64) {
    tangent_cases::<V>(&mut Rng::with_seed(seed), cases);
}

#[test]
fn none_that_is_touched_is_missed() {
    for_every_vector!(run_tangent_cases, 200_000, SEED);
}

#[test]
#[ignore = "40,000,000 cases for each vector type, or ISECT_MASS_CASES from ISECT_MASS_SEED on"]
fn none_that_is_touched_is_missed_in_many_more() {
    let number = |name: &str, default: u64| {
        std::env::var(name).map_or(default, |text| text.parse().expect("a number"))
    };
    let (cases, seed) = (number("ISECT_MASS_CASES", 40_000_000), number("ISECT_MASS_SEED", 1));
    for_every_vector!(run_tangent_cases, cases, seed);
}
