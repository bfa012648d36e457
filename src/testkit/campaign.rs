//! The runner: asks a kernel about many cases and compares its answers with the exact ones.

use std::panic::{AssertUnwindSafe, catch_unwind};

use fastrand::Rng;

use super::answer::Answer;
use super::meshes::{Mesh, Surface, icosphere, lattice_cube};
use super::oracle;
use super::query::{self, Query, ray_source, triangle_source};
use super::report::{Case, Fault, Loss, Report, bucket_end};
use super::shapes::{name, vector, vertices};
use crate::{Aabb, Plane, Ray, Scalar, Sphere, Triangle, Vector};

/// How many cases to run, and which.
///
/// Each method takes a kernel under a name, runs it over the cases of [`super::cases`], and reports. The same seed gives
/// the same cases. A panic of the kernel is caught and counted (the panic hook still prints its message).
///
/// ```
/// use isect::glam::Vec3;
/// use isect::ray::triangle::{exact, moller_trumbore};
/// use isect::testkit::Campaign;
///
/// let campaign = Campaign::new(10_000, 1);
/// let fast = campaign.ray_triangle::<Vec3, _>("moller_trumbore", moller_trumbore::intersect);
/// assert!(fast.is_sound() && !fast.is_exact());
/// println!("{fast}\n{}", fast.examples[0]);
/// assert!(campaign.ray_triangle::<Vec3, _>("exact", exact::hits).is_exact());
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Campaign {
    /// How many cases, or rays out of closed meshes.
    pub cases: u64,
    /// Of the random numbers.
    pub seed: u64,
    /// Whether every ray is a half-line, with t in [0, ∞], for kernels that take no range.
    pub half_lines: bool,
}

impl Campaign {
    /// A campaign of so many cases.
    #[must_use]
    pub const fn new(cases: u64, seed: u64) -> Self {
        Self { cases, seed, half_lines: false }
    }

    /// The same with half-lines for all rays.
    #[must_use]
    pub const fn with_half_lines(self) -> Self {
        Self { half_lines: true, ..self }
    }

    /// The campaign in so many parts, with seeds of their own, for threads: their reports [merge](Report::merged) into one.
    /// Of another number of parts the cases are others.
    pub fn parts(self, count: u32) -> impl Iterator<Item = Self> {
        let mut rng = Rng::with_seed(self.seed);
        let whole = u64::from(count.max(1));
        (0..whole).map(move |part| {
            let cases = self.cases / whole + u64::from(part < self.cases % whole);
            Self { cases, seed: rng.u64(..), ..self }
        })
    }

    /// A ray against a plane; t is that of the crossing.
    #[must_use]
    pub fn ray_plane<V: Vector, A: Answer<V::Scalar>>(
        &self,
        name: &str,
        kernel: impl Fn(&Ray<V>, &Plane<V>) -> A,
    ) -> Report {
        self.run(name, |(ray, plane)| kernel(ray, plane))
    }

    /// A ray against the surface of a sphere; t is that of the nearest root in range.
    #[must_use]
    pub fn ray_sphere<V: Vector, A: Answer<V::Scalar>>(
        &self,
        name: &str,
        kernel: impl Fn(&Ray<V>, &Sphere<V>) -> A,
    ) -> Report {
        self.run(name, |(ray, sphere)| kernel(ray, sphere))
    }

    /// A ray against a box; t is the first that is in the box and in the range.
    #[must_use]
    pub fn ray_aabb<V: Vector, A: Answer<V::Scalar>>(
        &self,
        name: &str,
        kernel: impl Fn(&Ray<V>, &Aabb<V>) -> A,
    ) -> Report {
        self.run(name, |(ray, aabb)| kernel(ray, aabb))
    }

    /// A ray against a triangle, closed and with two sides; t is that of the crossing with its plane.
    ///
    /// Some of the rays lie in the triangle's plane, and some of the triangles are segments or points. They are hit as the
    /// sets of points that they are; a kernel which misses them has false misses.
    #[must_use]
    pub fn ray_triangle<V: Vector, A: Answer<V::Scalar>>(
        &self,
        name: &str,
        kernel: impl Fn(&Ray<V>, &Triangle<V>) -> A,
    ) -> Report {
        self.run(name, |(ray, triangle)| kernel(ray, triangle))
    }

    /// A triangle against a box.
    #[must_use]
    pub fn triangle_aabb<V: Vector>(
        &self,
        name: &str,
        kernel: impl Fn(&Triangle<V>, &Aabb<V>) -> bool,
    ) -> Report {
        self.run(name, |(triangle, aabb)| kernel(triangle, aabb))
    }

    fn run<Q: Query, A>(&self, kernel_name: &str, kernel: impl Fn(&Q) -> A) -> Report
    where
        A: Answer<<Q::Vector as crate::Coordinates>::Scalar>,
    {
        let mut report = Report::new(kernel_name, name::<Q::Vector>());
        let mut rng = Rng::with_seed(self.seed);
        for index in 0..self.cases {
            let mut query = query::random::<Q>(&mut rng);
            if let (true, Some(ray)) = (self.half_lines, query.ray_mut()) {
                *ray = Ray::new(ray.origin, ray.direction);
            }
            report.cases += 1;
            let touches = query.touches();
            let Some(fault) = judge(&query, touches, &kernel, index % 4 == 0, &mut report) else {
                continue;
            };
            *match fault {
                Fault::FalseMiss => &mut report.false_misses,
                Fault::FalseHit => &mut report.false_hits,
                Fault::BadInputHit => &mut report.bad_input_hits,
                Fault::Nan => &mut report.nans,
                Fault::OutOfRange => &mut report.out_of_range,
                Fault::Panic | Fault::Leak => &mut report.panics,
            } += 1;
            report.remember(fault, || Case {
                kernel: kernel_name.to_owned(),
                fault,
                touches,
                shapes: query.source(),
            });
        }
        report
    }

    /// Rays from inside of closed meshes, aimed at points of edges and at vertices, and one in 16 anywhere: each is to be
    /// stopped by a triangle, at a t in its range. The meshes are an icosphere and a cube with vertices on a lattice, both
    /// also far away.
    #[must_use]
    pub fn leaks<V: Vector, A: Answer<V::Scalar>>(
        &self,
        kernel_name: &str,
        kernel: impl Fn(&Ray<V>, &Triangle<V>) -> A,
    ) -> Report {
        let mut report = Report::new(kernel_name, name::<V>());
        let mut rng = Rng::with_seed(self.seed);
        let rooms = rooms::<V>();
        for (_, room) in (0..self.cases).zip(rooms.iter().cycle()) {
            let (ray, aim) = room.ray(&mut rng);
            let mut has_panicked = false;
            let mut stops = |triangle: &Triangle<V>| {
                let answer = catch(|| kernel(&ray, triangle));
                has_panicked |= answer.is_none();
                answer.is_some_and(|answer| {
                    let t = answer.t().map(Into::into);
                    answer.is_hit() && t.is_none_or(|t| (ray, *triangle).has_in_range(t))
                })
            };
            let near = match aim {
                Aim::Edge(vertex) | Aim::Vertex(vertex) => &[vertex][..],
                Aim::Anywhere => &[],
            };
            let is_stopped = room.surface.stops(near, &mut stops);
            let loss = match aim {
                Aim::Edge(_) => &mut report.leaks.at_edges,
                Aim::Vertex(_) => &mut report.leaks.at_vertices,
                Aim::Anywhere => &mut report.leaks.elsewhere,
            };
            *loss = Loss { rays: loss.rays + 1, lost: loss.lost + u64::from(!is_stopped) };
            report.panics += u64::from(has_panicked);
            let case = |fault| Case {
                kernel: kernel_name.to_owned(),
                fault,
                touches: true,
                shapes: room.source(&ray),
            };
            if !is_stopped {
                report.remember(Fault::Leak, || case(Fault::Leak));
            }
            if has_panicked {
                report.remember(Fault::Panic, || case(Fault::Panic));
            }
        }
        report
    }
}

/// The value, or `None` if it panics.
fn catch<T>(f: impl FnOnce() -> T) -> Option<T> {
    // What a kernel leaves behind in a panic is its own affair: the answer is not looked at.
    catch_unwind(AssertUnwindSafe(f)).ok()
}

/// What is wrong with a kernel's answer, if anything; on request also measures its t.
fn judge<Q: Query, A>(
    query: &Q,
    touches: bool,
    kernel: impl Fn(&Q) -> A,
    measures: bool,
    report: &mut Report,
) -> Option<Fault>
where
    A: Answer<<Q::Vector as crate::Coordinates>::Scalar>,
{
    let Some(answer) = catch(|| kernel(query)) else { return Some(Fault::Panic) };
    if answer.has_nan() {
        return Some(Fault::Nan);
    }
    match (answer.is_hit(), touches) {
        (false, true) => Some(Fault::FalseMiss),
        (true, false) if query.is_valid() => Some(Fault::FalseHit),
        (true, false) => Some(Fault::BadInputHit),
        (false, false) => None,
        (true, true) => {
            let t = answer.t()?;
            if !query.has_in_range(t.into()) {
                return Some(Fault::OutOfRange);
            }
            if measures {
                measure(query, t, report);
            }
            None
        }
    }
}

/// Counts by how many floats a computed t is off.
fn measure<Q: Query, T: Scalar>(query: &Q, t: T, report: &mut Report) {
    let within = |ulps: u64| query.t_in(step(t, ulps, false), step(t, ulps, true));
    let Some(bucket) = (0..66).find(|&bucket| within(bucket_end(bucket)) != Some(false)) else {
        return;
    };
    if within(bucket_end(bucket)).is_none() {
        return;
    }
    // Exactly, if it may be the worst.
    let (mut low, mut high) = (bucket.checked_sub(1).map_or(0, bucket_end), bucket_end(bucket));
    while high > report.t_errors.worst && low + 1 < high {
        let middle = low.midpoint(high);
        *if within(middle) == Some(true) { &mut high } else { &mut low } = middle;
    }
    report.t_errors.add(bucket, if high > report.t_errors.worst { high } else { 0 });
}

/// The float so many floats up or down, at most an infinity.
#[expect(
    clippy::cast_possible_truncation,
    reason = "a single-precision number, and bits that are its own"
)]
fn step<T: Scalar>(t: T, ulps: u64, is_up: bool) -> f64 {
    let t: f64 = t.into();
    // Floats in their order are integers in theirs, but for the sign.
    let is_single = size_of::<T>() == 4;
    let magnitude = if is_single {
        i128::from((t as f32).abs().to_bits())
    } else {
        i128::from(t.abs().to_bits())
    };
    let rank = if t.is_sign_negative() { -magnitude } else { magnitude };
    let rank = if is_up { rank + i128::from(ulps) } else { rank - i128::from(ulps) };
    let infinity = if is_single { f32::INFINITY.to_bits().into() } else { f64::INFINITY.to_bits() };
    let bits = rank.unsigned_abs().min(infinity.into());
    let magnitude =
        if is_single { f32::from_bits(bits as u32).into() } else { f64::from_bits(bits as u64) };
    if rank < 0 { -magnitude } else { magnitude }
}

/// What a ray is aimed at.
#[derive(Clone, Copy)]
enum Aim {
    /// A point of an edge from this vertex.
    Edge(usize),
    Vertex(usize),
    Anywhere,
}

/// A closed mesh, seen from inside.
struct Room<V: Vector> {
    surface: Surface<V>,
    /// A cube about this point, half as wide as the other number twice, lies inside.
    center: [f64; 3],
    reach: f64,
}

/// The meshes of [`Campaign::leaks`].
fn rooms<V: Vector>() -> [Room<V>; 4] {
    let (sphere, cube) = (icosphere(3), lattice_cube(8));
    let far = [1024.0, -4096.0, 512.0];
    [
        Room::new(&sphere, [0.0; 3], [0.0; 3], 0.5),
        Room::new(&cube, [0.0; 3], [4.0; 3], 3.0),
        Room::new(&sphere, far, far, 0.5),
        // Coordinates have few bits left for the shape.
        Room::new(&cube, [1e6; 3], [1e6 + 4.0; 3], 3.0),
    ]
}

impl<V: Vector> Room<V> {
    fn new(mesh: &Mesh, offset: [f64; 3], center: [f64; 3], reach: f64) -> Self {
        // Rounded to the vector type alone.
        let moved = |p: &[f64; 3]| std::array::from_fn(|k| p[k] + offset[k]);
        let vertices = mesh.vertices.iter().map(moved).collect();
        let surface = Surface::new(&Mesh { vertices, faces: mesh.faces.clone() });
        Self { surface, center, reach }
    }

    /// A ray from inside.
    fn ray(&self, rng: &mut Rng) -> (Ray<V>, Aim) {
        let origin: V = vector(self.center.map(|x| x + (2.0 * rng.f64() - 1.0) * self.reach));
        let (target, aim) = match rng.u8(..16) {
            0 => (
                vector(self.center.map(|x| x + (rng.f64() - 0.5) * 4.0 * self.reach)),
                Aim::Anywhere,
            ),
            1..=7 => {
                let (vertex, target) = self.surface.vertex(rng);
                (target, Aim::Vertex(vertex))
            }
            _ => {
                let ([vertex, _], target) = self.surface.edge_point(rng);
                (target, Aim::Edge(vertex))
            }
        };
        if target == origin { self.ray(rng) } else { (Ray::new(origin, target - origin), aim) }
    }

    /// The ray, and the triangles that it meets.
    fn source(&self, ray: &Ray<V>) -> String {
        let exact_ray = oracle::Ray::from(ray);
        let triangles = self.surface.triangles.iter();
        let met = triangles.filter(|t| oracle::triangle(&exact_ray, vertices(t)).hits());
        let met: Vec<_> = met.map(triangle_source).collect();
        format!("{}let triangles = [{}];\n", ray_source(ray), met.join(", "))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::glam::{DVec3, Vec3, Vec3A};
    use crate::ray::triangle::{TriangleHit, exact, moller_trumbore, watertight};
    use crate::testkit::shapes::scalar;
    use crate::testkit::{TErrors, table};

    const CAMPAIGN: Campaign = Campaign::new(20_000, 3);

    #[test]
    fn an_exact_kernel_has_no_fault_and_a_refined_t_is_within_an_ulp() {
        fn check<V: Vector>() {
            let report = CAMPAIGN.ray_triangle::<V, _>("exact", |ray, triangle| {
                exact::hits(ray, triangle).then(|| exact::refine(ray, triangle))
            });
            assert!(report.is_exact() && report.examples.is_empty(), "{report}");
            assert!(report.t_errors.worst <= 1 && report.t_errors.measured() > 1000, "{report}");
            let report = CAMPAIGN.leaks::<V, _>("exact", exact::hits);
            assert!(report.is_watertight(), "{report}");
            assert_eq!(report.leaks.at_edges.rays.min(report.leaks.at_vertices.rays) / 8_000, 1);
        }
        check::<Vec3>();
        check::<Vec3A>();
        check::<DVec3>();
    }

    /// Each kind of fault, made by a kernel that has only this one.
    #[test]
    fn every_fault_is_found_and_told_from_the_others() {
        type Kernel = fn(&Ray, &Triangle) -> Option<TriangleHit<f32>>;
        let right: Kernel = exact::intersect;
        let at = |t: f32| TriangleHit { t, u: 0.0, v: 0.0, front: true };
        let report = |kernel: &dyn Fn(&Ray, &Triangle) -> Option<TriangleHit<f32>>| {
            let report = CAMPAIGN.ray_triangle("kernel", kernel);
            let counts = [
                report.false_misses,
                report.false_hits,
                report.bad_input_hits,
                report.nans,
                report.panics,
            ];
            let examples: Vec<_> = report.examples.iter().map(|case| case.fault).collect();
            (counts.map(|count| count > 0), examples)
        };
        let one = |index: usize| std::array::from_fn(|k| k == index);
        let none = report(&right);
        assert_eq!(none, ([false; 5], vec![]));
        let misses_backs =
            |ray: &Ray, triangle: &Triangle| right(ray, triangle).filter(|hit| hit.front);
        assert_eq!(report(&misses_backs), (one(0), vec![Fault::FalseMiss]));
        let is_valid = |ray: &Ray, triangle: &Triangle| (*ray, *triangle).is_valid();
        let hits_all =
            |ray: &Ray, triangle: &Triangle| is_valid(ray, triangle).then(|| at(ray.t_min));
        assert_eq!(report(&hits_all), (one(1), vec![Fault::FalseHit, Fault::OutOfRange]));
        let hits_bad = |ray: &Ray, triangle: &Triangle| {
            if is_valid(ray, triangle) { right(ray, triangle) } else { Some(at(1.0)) }
        };
        assert_eq!(report(&hits_bad), (one(2), vec![Fault::BadInputHit]));
        let nan = |ray: &Ray, triangle: &Triangle| right(ray, triangle).map(|_| at(f32::NAN));
        assert_eq!(report(&nan), (one(3), vec![Fault::Nan]));
        let beyond =
            |ray: &Ray, triangle: &Triangle| right(ray, triangle).map(|_| at(f32::INFINITY));
        assert_eq!(report(&beyond), ([false; 5], vec![Fault::OutOfRange]));
        let panics = |ray: &Ray, triangle: &Triangle| {
            let hit = right(ray, triangle);
            if !is_valid(ray, triangle) {
                std::panic::resume_unwind(Box::new("without the hook's message"));
            }
            hit
        };
        assert_eq!(report(&panics), (one(4), vec![Fault::Panic]));
    }

    #[test]
    fn leaks_are_counted_by_what_the_ray_was_aimed_at() {
        let fast = CAMPAIGN.leaks::<Vec3, _>("fast", moller_trumbore::intersect);
        assert!(fast.leaks.at_edges.lost > 20 && fast.leaks.at_vertices.lost > 5, "{fast}");
        assert_eq!(fast.leaks.elsewhere.lost, 0);
        let kernel = |ray: &Ray, triangle: &Triangle| {
            watertight::intersect(&watertight::ShearedRay::new(ray), triangle)
        };
        assert!(CAMPAIGN.leaks("watertight", kernel).is_watertight());
        // What is behind the origin stops no ray.
        let line = |ray: &Ray, triangle: &Triangle| {
            let line = ray.with_range(f32::NEG_INFINITY, f32::INFINITY);
            moller_trumbore::intersect(&line, triangle)
        };
        assert_eq!(CAMPAIGN.leaks("line", line).leaks, fast.leaks);
        let nan = CAMPAIGN.leaks("nan", |_: &Ray, _: &Triangle| Some(f32::NAN)).leaks;
        assert_eq!(nan.lost(), CAMPAIGN.cases);
        let none = CAMPAIGN.leaks("blind", |_: &Ray, _: &Triangle| false).leaks;
        assert_eq!(none.lost(), CAMPAIGN.cases);
        assert!(none.elsewhere.lost > 1000);
    }

    #[test]
    fn other_pairs_are_asked_as_well() {
        use crate::overlap::triangle_aabb;
        use crate::ray::{aabb, plane, sphere};
        fn check<V: Vector>() {
            let boxes = |ray: &Ray<V>, aabb: &Aabb<V>| {
                aabb::exact::intersect(&aabb::BoxRay::new(ray), aabb)
            };
            let reports = [
                CAMPAIGN.ray_aabb("box", boxes),
                CAMPAIGN.ray_sphere::<V, _>("sphere", sphere::robust::intersect),
                CAMPAIGN.ray_plane::<V, _>("plane", plane::intersect),
                CAMPAIGN.triangle_aabb::<V>("overlap", triangle_aabb::exact::overlaps),
            ];
            assert!(reports.iter().all(Report::is_exact), "\n{}", table(&reports));
            let lost =
                |pair: [bool; 4]| pair.map(|is_lost| u64::from(is_lost) * CAMPAIGN.cases / 4);
            let misses = [
                CAMPAIGN.ray_aabb::<V, _>("blind", |_, _| false),
                CAMPAIGN.ray_sphere::<V, _>("blind", |_, _| false),
                CAMPAIGN.ray_plane::<V, _>("blind", |_, _| false),
                CAMPAIGN.triangle_aabb::<V>("blind", |_, _| false),
            ]
            .map(|report| report.false_misses);
            assert!(
                misses.iter().zip(lost([true; 4])).all(|(found, least)| *found > least),
                "{misses:?}"
            );
        }
        check::<Vec3>();
        check::<DVec3>();
    }

    #[test]
    fn half_lines_are_for_kernels_that_take_no_range() {
        let without_range = |ray: &Ray, triangle: &Triangle| {
            exact::hits(&Ray::new(ray.origin, ray.direction), triangle)
        };
        assert!(!CAMPAIGN.ray_triangle("all", without_range).is_exact());
        assert!(CAMPAIGN.with_half_lines().ray_triangle("half", without_range).is_exact());
    }

    #[test]
    fn errors_of_t_are_measured_in_floats() {
        // By so many floats beside the nearest one.
        for ulps in [0, 1, 3, 100] {
            let report = CAMPAIGN.ray_triangle::<Vec3, _>("off", |ray, triangle| {
                exact::hits(ray, triangle).then(|| {
                    let t = exact::refine(ray, triangle).t;
                    (0..ulps).fold(t, |t, _| t.next_up())
                })
            });
            let TErrors { worst, .. } = report.t_errors;
            assert!((ulps..=ulps + 1).contains(&worst), "{ulps}: {worst}");
            assert!(report.t_errors.quantile(0.5) >= ulps);
        }
        let walk = |t: f32, ulps| (step(t, ulps, false), step(t, ulps, true));
        let smallest = f64::from(f32::from_bits(1));
        assert_eq!(walk(0.0, 1), (-smallest, smallest));
        assert_eq!(walk(-1.0, 0), (-1.0, -1.0));
        assert_eq!(walk(1.0, u64::MAX), (f64::NEG_INFINITY, f64::INFINITY));
        assert_eq!(step(-1.0, 1, true), (-1.0_f64).next_up());
    }

    #[test]
    fn the_same_seed_gives_the_same_report_and_parts_add_up() {
        let kernel = moller_trumbore::intersect::<Vec3>;
        let part = |seed| Campaign::new(5_000, seed).ray_triangle("fast", kernel);
        assert_eq!(part(1), part(1));
        assert_ne!(part(1), part(2));
        let (a, b) = (part(1), part(2));
        let whole = a.clone().merged(b.clone());
        assert_eq!(whole.cases, 10_000);
        assert_eq!(whole.false_misses, a.false_misses + b.false_misses);
        assert_eq!(whole.t_errors.measured(), a.t_errors.measured() + b.t_errors.measured());
        assert_eq!(whole.t_errors.worst, a.t_errors.worst.max(b.t_errors.worst));
        assert_eq!(whole.examples[0], a.examples[0]);
        let parts: Vec<_> = Campaign::new(11, 7).with_half_lines().parts(3).collect();
        assert_eq!(parts.iter().map(|part| part.cases).collect::<Vec<_>>(), [4, 4, 3]);
        assert!(parts[0].seed != parts[1].seed && parts.iter().all(|part| part.half_lines));
    }

    /// What is printed is what was asked: read back, it is the same to the last bit.
    #[test]
    fn a_case_is_printed_to_the_last_bit() {
        fn read(source: &str) -> Vec<u64> {
            let parts = source.split("from_bits(0x").skip(1);
            let digits = parts.map(|part| &part[..part.find(')').expect("a closed parenthesis")]);
            digits.map(|digits| u64::from_str_radix(digits, 16).expect("a number")).collect()
        }
        let mut rng = Rng::with_seed(9);
        for _ in 0..100 {
            let single: (Ray, Sphere) = query::random(&mut rng);
            let bits: Vec<u64> =
                single.numbers().iter().map(|&x| (scalar::<f32>(x)).to_bits().into()).collect();
            assert_eq!(read(&single.source()), bits);
            let double: (Ray<DVec3>, Triangle<DVec3>) = query::random(&mut rng);
            let bits: Vec<u64> = double.numbers().iter().map(|x| x.to_bits()).collect();
            assert_eq!(read(&double.source()), bits);
        }
        let ray = Ray::new(Vec3::ZERO, Vec3::Z);
        let case = Case {
            kernel: "mine".to_owned(),
            fault: Fault::FalseMiss,
            touches: true,
            shapes: (ray, Sphere::new(Vec3::ONE, -2.0)).source(),
        };
        let zero = "f32::from_bits(0x00000000)";
        let one = "f32::from_bits(0x3f800000)";
        let expected = format!(
            "// mine: false miss.\nlet ray = Ray::new(\n    Vec3::new({zero}, {zero}, {zero}),\n    \
             Vec3::new({zero}, {zero}, {one}),\n)\n.with_range({zero}, f32::from_bits(0x7f800000));\n\
             let sphere = Sphere::new(Vec3::new({one}, {one}, {one}), f32::from_bits(0xc0000000));\n\
             let touches = true;"
        );
        assert_eq!(case.to_string(), expected);
    }
}
