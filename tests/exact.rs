//! Claim: the exact kernels' verdicts are those of exact arithmetic, for every finite input.

use std::cmp::Ordering;

use isect::glam::{DVec3, Vec3, Vec3A};
use isect::overlap::triangle_aabb::exact as overlap_exact;
use isect::ray::aabb::{BoxRay, conservative, exact as box_exact};
use isect::ray::plane::{self, PlaneHit};
use isect::ray::sphere::{self, robust};
use isect::ray::triangle::exact::{self, Verdict};
use isect::{Number, Plane, Ray, Scalar, Vector};

use crate::support::oracle::TriangleVerdict;
use crate::support::{
    aabb, for_every_vector, generators, meshes, name, oracle, ray, scalar, sphere as sphere_of,
    triangle, vector, verdicts,
};

const SEED: u64 = 11;

/// Powers of two by which the points, and the direction, of a case are multiplied: one of them at random.
fn magnify<V: Vector>(rng: &mut fastrand::Rng) -> (f64, f64) {
    let most = if size_of::<V::Scalar>() == 4 { 60 } else { 900 };
    let power = |rng: &mut fastrand::Rng| 2f64.powi(rng.i32(-most..=most));
    if rng.u8(..4) == 0 { (power(rng), power(rng)) } else { (1.0, 1.0) }
}

/// A ray and a triangle that the vector type holds exactly: of all magnitudes.
fn triangle_case<V: Vector>(rng: &mut fastrand::Rng) -> (oracle::Ray, [[f64; 3]; 3]) {
    let (mut ray, mut vertices) = generators::ray_triangle(rng);
    let (points, direction) = magnify::<V>(rng);
    let fits = |x: f64| exactly::<V>(x);
    let scaled = |p: [f64; 3], by: f64| p.map(|x| fits(x * by));
    ray.origin = scaled(ray.origin, points);
    ray.direction = scaled(ray.direction, direction);
    vertices = vertices.map(|v| scaled(v, points));
    (ray.t_min, ray.t_max) = scaled_range::<V>(&ray, points, direction);
    (ray, vertices)
}

/// The range of a ray of which the points and the direction are multiplied. (One after the other: the quotient of the factors may
/// be no float.)
fn scaled_range<V: Vector>(ray: &oracle::Ray, points: f64, direction: f64) -> (f64, f64) {
    let t = |x: f64| {
        if x.is_finite() { exactly::<V>(exactly::<V>(x * points) / direction) } else { x }
    };
    (t(ray.t_min), t(ray.t_max))
}

/// The finite scalar of the vector type nearest to a double.
fn exactly<V: Vector>(x: f64) -> f64 {
    if size_of::<V::Scalar>() == 4 { generators::single(x) } else { x.clamp(f64::MIN, f64::MAX) }
}

#[test]
fn classify_agrees_with_the_oracle() {
    fn check<V: Vector>() {
        let mut rng = fastrand::Rng::with_seed(SEED);
        let mut counts = [0_u32; 6];
        for _ in 0..400_000 {
            let (case, v) = triangle_case::<V>(&mut rng);
            let verdict = exact::classify::<V>(&ray(&case), &triangle(&v));
            let expected = oracle::triangle(&case, v);
            let agrees = verdicts::agrees(verdict, expected, &case, &v);
            assert!(agrees, "{} {case:?} {v:?}: {verdict:?}, not {expected:?}", name::<V>());
            assert_eq!(exact::hits::<V>(&ray(&case), &triangle(&v)), expected.hits());
            counts[verdicts::kind(expected)] += 1;
        }
        println!(
            "{:<6} miss, interior, edge, vertex, coplanar, degenerate: {counts:?}",
            name::<V>()
        );
        assert!(counts.iter().all(|&count| count > 1_000), "{counts:?}");
    }
    for_every_vector!(check);
}

/// So small a triangle and so short a direction that the determinant is barely a normal number, with a range that ends close to
/// t: there underflow moves t by more than rounding does.
#[test]
fn underflow_is_within_the_bounds() {
    fn check<V: Vector>() {
        let (size, length) = if size_of::<V::Scalar>() == 4 { (-40, -56) } else { (-320, -330) };
        let mut rng = fastrand::Rng::with_seed(SEED + 9);
        let mut decided = 0_u32;
        for _ in 0..60_000 {
            let shift = rng.i32(0..=8);
            let size = 2f64.powi(size + shift + rng.i32(-1..4));
            let length = 2f64.powi(length + shift + rng.i32(-2..8));
            let corner = |rng: &mut fastrand::Rng, k: usize| {
                std::array::from_fn(|i| {
                    exactly::<V>(size * (f64::from(u8::from(i == k)) + (rng.f64() - 0.5) / 2.0))
                })
            };
            let v = [0, 1, 2].map(|k| corner(&mut rng, k));
            let direction = [(); 3].map(|()| exactly::<V>(length * (2.0 * rng.f64() - 1.0)));
            let t = 2.0 * rng.f64() * size / length;
            let origin: [f64; 3] = std::array::from_fn(|i| {
                exactly::<V>((v[0][i] + v[1][i] + v[2][i]) / 3.0 - t * direction[i])
            });
            let line = Ray::<V>::new(vector(origin), vector(direction))
                .with_range(-V::Scalar::INFINITY, V::Scalar::INFINITY);
            let triangle = triangle::<V>(&v);
            let Some(hit) = exact::intersect(&line, &triangle) else { continue };
            decided += u32::from(exact::stage(&line, &triangle) == 0);
            let mut end = exact::refine(&line, &triangle).t;
            for _ in 0..rng.u32(1..64) {
                end = end.next_down();
            }
            let short = Ray { t_max: end, ..line };
            let case =
                oracle::Ray { origin, direction, t_min: f64::NEG_INFINITY, t_max: end.into() };
            let expected = oracle::triangle(&case, v).hits();
            assert_eq!(
                exact::hits(&short, &triangle),
                expected,
                "{} {case:?} {v:?} {hit:?}",
                name::<V>()
            );
        }
        println!("{:<6} {decided} decided in floats", name::<V>());
        assert!(decided > 1_000, "{decided}");
    }
    for_every_vector!(check);
    // One of them: the exact t is 31810.027, just after the end of the range.
    let bits = |bits: [u32; 3]| Vec3::from_array(bits.map(f32::from_bits));
    let triangle = isect::Triangle::new(
        bits([0x2b89_ae10, 0x2a4d_dd73, 0x2a68_8f95]),
        bits([0x28e0_21cc, 0x2b49_e353, 0x2917_1492]),
        bits([0x2957_36af, 0xa9e8_eb75, 0x2b95_9835]),
    );
    let ray = Ray::new(
        bits([0x2b1c_9d81, 0xaba3_442f, 0xab63_50c6]),
        bits([0xa2ef_077c, 0x244e_ae91, 0x2434_0cd8]),
    );
    assert!(!ray.with_range(0.0, f32::from_bits(0x46f8_840d)).hits(&triangle));
}

/// Rays aimed at vertices, at edges and along faces, from inside and outside, of closed meshes.
#[test]
fn crossings_of_closed_meshes_have_the_right_parity() {
    fn check<V: Vector>(
        mesh: &meshes::Mesh,
        cases: u32,
        point: impl Fn(&mut fastrand::Rng) -> [f64; 3],
        is_inside: impl Fn([f64; 3]) -> Option<bool>,
    ) {
        assert!(mesh.is_closed());
        let triangles: Vec<_> = mesh.triangles().map(|v| triangle::<V>(&v)).collect();
        let mut rng = fastrand::Rng::with_seed(SEED + 1);
        let (mut inside, mut on_edges) = (0_u32, 0_u32);
        for _ in 0..cases {
            let face = mesh.faces[rng.usize(..mesh.faces.len())];
            let [a, b, _] = face.map(|k| mesh.vertices[k as usize]);
            let mut origin = point(&mut rng);
            let middle = std::array::from_fn(|k| generators::single((a[k] + b[k]) / 2.0));
            let target = if rng.bool() { a } else { middle };
            let mut direction: [f64; 3] =
                std::array::from_fn(|k| generators::single(target[k] - origin[k]));
            if rng.u8(..3) == 0 {
                // Through a vertex, along an edge of some face or an axis.
                let along = std::array::from_fn(|k| generators::single(b[k] - a[k]));
                direction = if rng.bool() { along } else { [0.0, 0.0, 1.0] };
                origin = std::array::from_fn(|k| generators::single(a[k] - 3.0 * direction[k]));
            }
            if direction == [0.0; 3] {
                continue;
            }
            let ray = Ray::<V>::new(vector(origin), vector(direction));
            let line = ray.with_range(-V::Scalar::INFINITY, V::Scalar::INFINITY);
            let split = scalar(rng.f64() * 4.0);
            let (mut from_origin, mut of_line, mut of_parts, mut touched) = (0, 0, 0, 0);
            for triangle in &triangles {
                let Some(front) = exact::crosses(&line, triangle) else { continue };
                of_line += if front { 1 } else { -1 };
                assert!(exact::hits(&line, triangle));
                from_origin += u32::from(exact::crosses(&ray, triangle).is_some());
                let parts = [ray.with_range(V::Scalar::ZERO, split), Ray { t_min: split, ..ray }];
                of_parts += parts.iter().filter_map(|part| exact::crosses(part, triangle)).count();
                let verdict = exact::classify(&line, triangle);
                touched += u32::from(matches!(verdict, Verdict::Edge(_) | Verdict::Vertex(_)));
            }
            assert_eq!(of_line, 0, "{} {ray:?}", name::<V>());
            assert_eq!(of_parts, from_origin as usize, "{} {ray:?} {split:?}", name::<V>());
            if let Some(expected) = is_inside(origin) {
                assert_eq!(from_origin % 2 == 1, expected, "{} {ray:?}", name::<V>());
            }
            // So many the other way as well, and across.
            let across = [direction[1] + 0.5, -direction[2] - 1.5, direction[0] - 0.25].map(scalar);
            for other in [-ray.direction, V::new(across[0], across[1], across[2])] {
                let other = Ray { direction: other, ..ray };
                let crossed = triangles.iter().filter(|t| exact::crosses(&other, t).is_some());
                assert_eq!(crossed.count() % 2, from_origin as usize % 2, "{other:?}");
            }
            inside += from_origin % 2;
            on_edges += u32::from(touched > 0);
        }
        println!("{:<6} {cases} rays, {inside} from inside, {on_edges} on edges", name::<V>());
        assert!(inside > cases / 100 && on_edges > cases / 3, "{inside} {on_edges}");
    }
    let quarters = |rng: &mut fastrand::Rng| [(); 3].map(|()| f64::from(rng.i32(-6..=10)) / 4.0);
    let cube = meshes::lattice_cube(2);
    // An origin on the surface is moved towards positive x, y and z.
    let in_cube = |p: [f64; 3]| Some(p.iter().all(|x| (0.0..2.0).contains(x)));
    check::<Vec3>(&cube, 40_000, quarters, in_cube);
    check::<Vec3A>(&cube, 5_000, quarters, in_cube);
    check::<DVec3>(&cube, 40_000, quarters, in_cube);
    // The facets lie between a sphere of radius 0.79 and that of the vertices.
    let sphere = meshes::icosphere(0);
    let in_sphere = |p: [f64; 3]| {
        let square = p.iter().map(|x| x * x).sum::<f64>();
        if square < 0.62 { Some(true) } else { (square > 1.0).then_some(false) }
    };
    check::<Vec3>(&sphere, 40_000, quarters, in_sphere);
    check::<Vec3A>(&sphere, 5_000, quarters, in_sphere);
    check::<DVec3>(&sphere, 40_000, quarters, in_sphere);
    // Finer ones on a lattice of integers, where rays go through vertices exactly, near and far; some triangles of the
    // bunny have no area there.
    let bunny = meshes::parse_obj(include_str!("../examples/tracer/bunny.obj"));
    for (mesh, cases) in [(meshes::icosphere(3), 3_000), (bunny, 1_000)] {
        let bound = |f: fn(f64, f64) -> f64| {
            [0, 1, 2].map(|k| mesh.vertices.iter().map(|v| v[k]).reduce(f).expect("vertices"))
        };
        let (min, max) = (bound(f64::min), bound(f64::max));
        let size = (0..3).map(|k| max[k] - min[k]).fold(0.0, f64::max);
        for far in [0.0, 1_048_576.0] {
            let lattice = |p: &[f64; 3]| {
                std::array::from_fn(|k| ((p[k] - min[k]) / size * 1_000.0).round() + far)
            };
            let vertices = mesh.vertices.iter().map(lattice).collect();
            let mesh = meshes::Mesh { vertices, faces: mesh.faces.clone() };
            let around =
                |rng: &mut fastrand::Rng| [(); 3].map(|()| f64::from(rng.i32(-100..=1_100)) + far);
            for_every_vector!(check, &mesh, cases, around, |_| None);
        }
    }
}

#[test]
fn refined_hits_are_within_an_ulp() {
    fn check<V: Vector>() {
        let mut rng = fastrand::Rng::with_seed(SEED + 2);
        let mut counts = [0_u32; 3];
        for _ in 0..300_000 {
            let (case, v) = triangle_case::<V>(&mut rng);
            let (ray, triangle) = (ray::<V>(&case), triangle::<V>(&v));
            let verdict = exact::classify(&ray, &triangle);
            let hit = exact::refine(&ray, &triangle);
            let (t, u, v_weight): (f64, f64, f64) = (hit.t.into(), hit.u.into(), hit.v.into());
            if verdict == Verdict::Miss {
                assert!([t, u, v_weight] == [0.0; 3] && !hit.front);
                counts[0] += 1;
                continue;
            }
            let context = || format!("{} {case:?} {v:?} {hit:?}", name::<V>());
            assert!(case.t_min <= t && t <= case.t_max && t.is_finite(), "{}", context());
            let below = |x: V::Scalar| x.next_down().into();
            let above = |x: V::Scalar| x.next_up().into();
            match oracle::triangle_t_in(&case, v, below(hit.t), above(hit.t)) {
                Some(is_near) => {
                    assert!(is_near, "{}", context());
                    let near = |lo, hi, test: fn(&oracle::Ray, _, f64, f64) -> Option<bool>| {
                        test(&case, v, lo, hi) == Some(true)
                    };
                    assert!(
                        near(below(hit.u), above(hit.u), oracle::triangle_u_in),
                        "{}",
                        context()
                    );
                    assert!(
                        near(below(hit.v), above(hit.v), oracle::triangle_v_in),
                        "{}",
                        context()
                    );
                    counts[1] += 1;
                }
                None => {
                    // Nothing of the triangle before, and something at it.
                    let up_to = |t_max| oracle::Ray { t_max, ..case };
                    let before: f64 = below(hit.t);
                    let is_first =
                        before < case.t_min || !oracle::triangle(&up_to(before), v).hits();
                    let reached = oracle::triangle(&up_to(above(hit.t)), v).hits();
                    assert!(is_first && reached, "{}", context());
                    // Each is within an ulp, which is at most EPSILON of it: so is the sum, also as rounded here.
                    let most = 1.0 + V::Scalar::EPSILON.into();
                    assert!(u >= 0.0 && v_weight >= 0.0 && u + v_weight <= most, "{}", context());
                    assert!(!hit.front);
                    // A t beyond the largest float is not the one of the point.
                    let is_at = hit.t.abs() == V::Scalar::MAX
                        || is_close(&case, &v, [t, u, v_weight], V::Scalar::MIN_POSITIVE.into());
                    assert!(is_at, "{}", context());
                    counts[2] += 1;
                }
            }
        }
        println!("{:<6} misses, crossings, in the plane or degenerate: {counts:?}", name::<V>());
        assert!(counts.iter().all(|&count| count > 10_000), "{counts:?}");
    }
    for_every_vector!(check);
}

/// Whether o + t·d and the weighted vertices are the same point but for rounding: 2⁻²⁰ of the largest terms, for single
/// precision's 2⁻²⁴ in t and the weights and as much again in what is computed here, 16 times; and what a t loses that
/// underflows.
fn is_close(case: &oracle::Ray, v: &[[f64; 3]; 3], [t, u, w]: [f64; 3], smallest: f64) -> bool {
    (0..3).all(|k| {
        let (on_ray, step) = (case.origin[k] + t * case.direction[k], t * case.direction[k]);
        let on_triangle = (1.0 - u - w) * v[0][k] + u * v[1][k] + w * v[2][k];
        let largest = [case.origin[k], step, v[0][k], v[1][k], v[2][k]].map(f64::abs);
        let largest = largest.into_iter().fold(f64::MIN_POSITIVE, f64::max);
        let underflow = smallest * case.direction[k].abs();
        (on_ray - on_triangle).abs() <= largest * 2f64.powi(-20) + underflow || !largest.is_finite()
    })
}

/// A point multiplied by a factor, to the nearest that the vector type holds; what is infinite or NaN stays so.
fn scaled_exactly<V: Vector>(p: [f64; 3], by: f64) -> [f64; 3] {
    p.map(|x| if x.is_finite() { exactly::<V>(x * by) } else { x })
}

#[test]
fn overlaps_agrees_with_the_oracles() {
    fn check<V: Vector>() {
        let mut rng = fastrand::Rng::with_seed(SEED + 3);
        let mut overlapping = 0_u32;
        for _ in 0..300_000 {
            let (vertices, min, max) = generators::triangle_aabb(&mut rng);
            let (by, _) = magnify::<V>(&mut rng);
            let v = vertices.map(|v| scaled_exactly::<V>(v, by));
            let (mut min, mut max) = (scaled_exactly::<V>(min, by), scaled_exactly::<V>(max, by));
            match rng.u8(..16) {
                0 => min[rng.usize(..3)] = f64::NEG_INFINITY,
                1 => max[rng.usize(..3)] = f64::INFINITY,
                2 => (min, max) = (max, min),
                _ => {}
            }
            let overlaps = overlap_exact::overlaps::<V>(&triangle(&v), &aabb(&min, &max));
            let expected = oracle::triangle_aabb_sat(v, min, max);
            assert_eq!(overlaps, expected, "{} {v:?} {min:?} {max:?}", name::<V>());
            overlapping += u32::from(expected);
        }
        println!("{:<6} 300000 cases, {overlapping} overlap", name::<V>());
        assert!((75_000..225_000).contains(&overlapping), "{overlapping}");
    }
    for_every_vector!(check);
}

#[test]
fn box_hits_agree_with_the_oracle() {
    fn check<V: Vector>() {
        let mut rng = fastrand::Rng::with_seed(SEED + 4);
        let (mut touching, mut lowered) = (0_u32, 0_u32);
        for _ in 0..400_000 {
            let (mut case, min, max) = generators::ray_aabb(&mut rng);
            let (points, direction) = magnify::<V>(&mut rng);
            case.origin = scaled_exactly::<V>(case.origin, points);
            case.direction = scaled_exactly::<V>(case.direction, direction);
            (case.t_min, case.t_max) = scaled_range::<V>(&case, points, direction);
            let (mut min, mut max) =
                (scaled_exactly::<V>(min, points), scaled_exactly::<V>(max, points));
            if rng.u8(..32) == 0 {
                (min, max) = (max, min);
            }
            let mut box_ray = BoxRay::<V>::new(&ray(&case));
            let hits = box_exact::hits(&box_ray, &aabb(&min, &max));
            let expected = oracle::aabb(&case, min, max);
            assert_eq!(hits, expected, "{} {case:?} {min:?} {max:?}", name::<V>());
            touching += u32::from(expected);
            // A traversal lowers the end.
            let Some([enter, _]) = conservative::interval(&box_ray, &aabb(&min, &max)) else {
                continue;
            };
            box_ray.t_max = if rng.bool() { enter } else { enter.next_down() };
            case.t_max = box_ray.t_max.into();
            let hits = box_exact::hits(&box_ray, &aabb(&min, &max));
            let expected = oracle::aabb(&case, min, max);
            assert_eq!(hits, expected, "{} {case:?} {min:?} {max:?}", name::<V>());
            lowered += u32::from(expected);
        }
        println!("{:<6} 400000 cases, {touching} hit, {lowered} up to the entry", name::<V>());
        assert!((100_000..300_000).contains(&touching) && lowered > 20_000, "{touching} {lowered}");
    }
    for_every_vector!(check);
}

#[test]
fn plane_verdicts_agree_with_the_oracle() {
    fn check<V: Vector>() {
        let mut rng = fastrand::Rng::with_seed(SEED + 5);
        let mut counts = [0_u32; 3];
        for _ in 0..300_000 {
            let (mut case, normal, offset) = generators::ray_plane(&mut rng);
            let (points, direction) = magnify::<V>(&mut rng);
            case.origin = scaled_exactly::<V>(case.origin, points);
            case.direction = scaled_exactly::<V>(case.direction, direction);
            (case.t_min, case.t_max) = scaled_range::<V>(&case, points, direction);
            let offset = exactly::<V>(offset * points);
            let plane = Plane::<V> { normal: vector(normal), offset: scalar(offset) };
            let hit = plane::intersect(&ray(&case), &plane);
            let verdict = hit.map(|hit| match hit {
                PlaneHit::At(t) => {
                    let t: f64 = t.into();
                    assert!(case.t_min <= t && t <= case.t_max && t.is_finite());
                    PlaneHit::At(())
                }
                PlaneHit::Contained => PlaneHit::Contained,
            });
            let (kind, expected) = match oracle::plane(&case, normal, offset) {
                oracle::PlaneVerdict::Miss => (0, None),
                oracle::PlaneVerdict::At => (1, Some(PlaneHit::At(()))),
                oracle::PlaneVerdict::Contained => (2, Some(PlaneHit::Contained)),
            };
            assert_eq!(verdict, expected, "{} {case:?} {normal:?} {offset}", name::<V>());
            counts[kind] += 1;
        }
        println!("{:<6} miss, at, contained: {counts:?}", name::<V>());
        assert!(counts.iter().all(|&count| count > 4_000), "{counts:?}");
    }
    for_every_vector!(check);
}

/// Hit or miss, of the ray and its line, and which of the roots it is.
#[test]
fn sphere_hits_agree_with_the_oracle() {
    fn check<V: Vector>() {
        let mut rng = fastrand::Rng::with_seed(SEED + 6);
        let (mut hits, mut between, mut missed) = (0_u32, 0_u32, 0_u32);
        for _ in 0..300_000 {
            let (mut case, center, radius) = generators::ray_sphere(&mut rng);
            let (points, direction) = magnify::<V>(&mut rng);
            case.origin = scaled_exactly::<V>(case.origin, points);
            case.direction = scaled_exactly::<V>(case.direction, direction);
            (case.t_min, case.t_max) = scaled_range::<V>(&case, points, direction);
            let center = scaled_exactly::<V>(center, points);
            let radius = exactly::<V>(radius * points);
            let (ray, sphere) = (ray::<V>(&case), sphere_of::<V>(&center, radius));
            let hit = robust::intersect(&ray, &sphere);
            let context = || format!("{} {case:?} {center:?} {radius} {hit:?}", name::<V>());
            let expected = oracle::sphere(&case, center, radius);
            assert_eq!(hit.is_some(), expected, "{}", context());
            let line = ray.with_range(-V::Scalar::INFINITY, V::Scalar::INFINITY);
            let [begin, end] = [f64::NEG_INFINITY, f64::INFINITY];
            let of_line = oracle::Ray { t_min: begin, t_max: end, ..case };
            let line_hits = oracle::sphere(&of_line, center, radius);
            assert_eq!(robust::intersect(&line, &sphere).is_some(), line_hits, "{}", context());
            if sphere::roots(&ray, &sphere).is_some() {
                assert!(line_hits, "{}", context());
            }
            missed += u32::from(!line_hits);
            let Some(hit) = hit else { continue };
            hits += 1;
            let t: f64 = hit.t.into();
            assert!(case.t_min <= t && t <= case.t_max && t.is_finite(), "{}", context());
            // From inside the first root in the range is the far one, from outside the near one.
            let side = oracle::sphere_side(&of_line, center, radius, case.t_min);
            match side.filter(|_| case.t_min.is_finite()) {
                Some(Ordering::Less) => {
                    between += 1;
                    assert!(hit.leaving, "{}", context());
                }
                // It is the near one if there is another after it.
                Some(Ordering::Equal) => {
                    let after = oracle::Ray { t_min: case.t_min.next_up(), t_max: end, ..case };
                    let is_near = oracle::sphere(&after, center, radius);
                    assert!(!(is_near && hit.leaving), "{}", context());
                }
                Some(Ordering::Greater) | None => assert!(!hit.leaving, "{}", context()),
            }
        }
        println!(
            "{:<6} 300000 cases: {hits} hit, {between} begin inside, {missed} lines miss",
            name::<V>()
        );
        assert!(hits > 50_000 && between > 10_000 && missed > 10_000, "{hits} {between} {missed}");
    }
    for_every_vector!(check);
}

/// Numbers of which few are different, so that coordinates coincide: zeros, powers of two, any finite bits, now and then
/// an infinity or a NaN.
struct Pool([f64; 4]);

impl Pool {
    fn new<V: Vector>(rng: &mut fastrand::Rng) -> Self {
        Self([(); 4].map(|()| match rng.u8(..8) {
            0 => 0.0,
            1 => exactly::<V>(2f64.powi(rng.i32(-1074..=1023))),
            2 => exactly::<V>(f64::MAX),
            3 if rng.u8(..8) == 0 => generators::hostile(rng),
            _ if size_of::<V::Scalar>() == 4 => {
                let x = f32::from_bits(rng.u32(..));
                if x.is_finite() { x.into() } else { 1.0 }
            }
            _ => {
                let x = f64::from_bits(rng.u64(..));
                if x.is_finite() { x } else { 1.0 }
            }
        }))
    }

    fn number(&self, rng: &mut fastrand::Rng) -> f64 {
        let x = self.0[rng.usize(..4)];
        if rng.bool() { x } else { -x }
    }

    fn point(&self, rng: &mut fastrand::Rng) -> [f64; 3] {
        [(); 3].map(|()| self.number(rng))
    }
}

/// From the smallest numbers to the largest in one case, which takes the integers to their capacity.
#[test]
fn all_verdicts_agree_at_the_ends_of_the_exponents() {
    fn check<V: Vector>() {
        let mut rng = fastrand::Rng::with_seed(SEED + 7);
        let mut counts = [0_u32; 5];
        for _ in 0..40_000 {
            let pool = Pool::new::<V>(&mut rng);
            let (origin, direction) = (pool.point(&mut rng), pool.point(&mut rng));
            let (t_min, t_max) = match rng.u8(..4) {
                0 => (f64::NEG_INFINITY, f64::INFINITY),
                1 => (pool.number(&mut rng), pool.number(&mut rng)),
                2 => (f64::NEG_INFINITY, pool.number(&mut rng)),
                _ => (0.0, f64::INFINITY),
            };
            let case = oracle::Ray { origin, direction, t_min, t_max };
            let v = [(); 3].map(|()| pool.point(&mut rng));
            let (a, b) = (pool.point(&mut rng), pool.point(&mut rng));
            let min: [f64; 3] = std::array::from_fn(|k| a[k].min(b[k]));
            let max: [f64; 3] = std::array::from_fn(|k| a[k].max(b[k]));
            let radius = pool.number(&mut rng).abs();
            let (ray, triangle, aabb) = (ray::<V>(&case), triangle(&v), aabb(&min, &max));
            let context = || format!("{} {case:?} {v:?} {min:?} {max:?}", name::<V>());

            let expected = oracle::triangle(&case, v);
            let verdict = exact::classify(&ray, &triangle);
            assert_eq!(verdict != Verdict::Miss, expected.hits(), "{}", context());
            if let TriangleVerdict::Edge(i) = expected {
                assert_eq!(verdict, Verdict::Edge(i));
            }
            let hit = exact::refine(&ray, &triangle);
            let t = hit.t.into();
            let is_between = (t_min <= t && t <= t_max) || verdict == Verdict::Miss;
            assert!(is_between && t.is_finite(), "{}", context());
            let weights: [f64; 3] = hit.barycentric().map(Into::into);
            assert!(weights.iter().all(|w| (0.0..=1.0).contains(w)), "{} {hit:?}", context());
            let _ = exact::crosses(&ray, &triangle);

            let expected_box = oracle::aabb(&case, min, max);
            assert_eq!(box_exact::hits(&BoxRay::new(&ray), &aabb), expected_box, "{}", context());
            let expected_overlap = oracle::triangle_aabb_sat(v, min, max);
            assert_eq!(
                overlap_exact::overlaps(&triangle, &aabb),
                expected_overlap,
                "{}",
                context()
            );
            let expected_sphere = oracle::sphere(&case, min, radius);
            let sphere = sphere_of::<V>(&min, radius);
            let hit = robust::intersect(&ray, &sphere);
            assert_eq!(hit.is_some(), expected_sphere, "{}", context());
            assert!(hit.is_none_or(|hit| hit.t.is_finite()), "{}", context());
            let plane = Plane { normal: vector::<V>(max), offset: scalar(radius) };
            let on_plane = oracle::plane(&case, max, radius) != oracle::PlaneVerdict::Miss;
            let hit = plane::intersect(&ray, &plane);
            assert_eq!(hit.is_some(), on_plane, "{}", context());
            let outcomes =
                [expected.hits(), expected_box, expected_overlap, expected_sphere, on_plane];
            for (count, outcome) in counts.iter_mut().zip(outcomes) {
                *count += u32::from(outcome);
            }
        }
        println!(
            "{:<6} of 40000, hits of triangle, box, overlap, sphere, plane: {counts:?}",
            name::<V>()
        );
        assert!(counts.iter().all(|&count| count > 1_000), "{counts:?}");
    }
    for_every_vector!(check);
}

/// Nearly ±2^bits in most coordinates and ±1 in one, which need a grid of so many bits.
fn extreme_point(rng: &mut fastrand::Rng, bits: i32) -> [f64; 3] {
    let most = 2f64.powi(bits).next_down();
    let mut point = [(); 3].map(|()| if rng.bool() { most } else { -most });
    point[rng.usize(..3)] = if rng.bool() { 1.0 } else { -1.0 };
    point
}

/// Numbers as long as each capacity of the integers admits, and a little longer: from 254 bits on, and from 512.
#[test]
fn every_capacity_holds_the_largest_numbers_that_it_admits() {
    let mut rng = fastrand::Rng::with_seed(SEED + 8);
    let mut counts = [0_u32; 5];
    for _ in 0..100_000 {
        let p = if rng.bool() { rng.i32(53..=66) } else { rng.i32(116..=132) };
        let d = if rng.bool() { rng.i32(53..=66) } else { rng.i32(100..=132) };
        let origin = extreme_point(&mut rng, p);
        let v = [(); 3].map(|()| extreme_point(&mut rng, p));
        let case = oracle::Ray {
            origin,
            direction: extreme_point(&mut rng, d),
            t_min: f64::NEG_INFINITY,
            t_max: f64::INFINITY,
        };
        let (a, b) = (extreme_point(&mut rng, p), extreme_point(&mut rng, p));
        let min: [f64; 3] = std::array::from_fn(|k| a[k].min(b[k]));
        let max: [f64; 3] = std::array::from_fn(|k| a[k].max(b[k]));
        // Up to the hit of the triangle, as rounded, and from there on.
        let (line, triangle, aabb) = (ray::<DVec3>(&case), triangle(&v), aabb(&min, &max));
        let t = exact::refine(&line, &triangle).t;
        let radius = 2f64.powi(p).next_down();
        for (t_min, t_max) in [(case.t_min, t), (t, case.t_max), (-t, 1.0 / t)] {
            if t == 0.0 {
                continue;
            }
            let case = oracle::Ray { t_min, t_max, ..case };
            let ray = ray::<DVec3>(&case);
            let outcomes = [
                (exact::hits(&ray, &triangle), oracle::triangle(&case, v).hits()),
                (box_exact::hits(&BoxRay::new(&ray), &aabb), oracle::aabb(&case, min, max)),
                (ray.hits(&sphere_of::<DVec3>(&a, radius)), oracle::sphere(&case, a, radius)),
                (
                    ray.hits(&Plane::<DVec3> { normal: vector(b), offset: radius }),
                    oracle::plane(&case, b, radius) != oracle::PlaneVerdict::Miss,
                ),
                (overlap_exact::overlaps(&triangle, &aabb), oracle::triangle_aabb_sat(v, min, max)),
            ];
            for (count, (verdict, expected)) in counts.iter_mut().zip(outcomes) {
                assert_eq!(verdict, expected, "{p} {d} {case:?} {v:?} {min:?} {max:?}");
                *count += u32::from(expected);
            }
        }
    }
    println!("hits of triangle, box, sphere, plane, overlap: {counts:?}");
    assert!(counts.iter().all(|&count| count > 1_000), "{counts:?}");
}
