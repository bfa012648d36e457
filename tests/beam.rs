//! Claim: rays hit a polygon within the bounds that the documentation states, and beams that a polygon divides lose nothing.

use fastrand::Rng;
use isect::glam::{DVec3, Vec3, Vec3A};
use isect::overlap::beam_polygon::{self, Division};
use isect::ray::polygon;
use isect::{Beam, Polygon, Ray, Vector};

use crate::support::bounds::unit_roundoff;
use crate::support::{array, for_every_vector, name, oracle, ray, scalar, vector};

/// Whether an exact value of a ray and a triangle is between two numbers.
type IsWithin = fn(&oracle::Ray, [[f64; 3]; 3], f64, f64) -> Option<bool>;

/// A convex polygon with corners that are integers, counter-clockwise.
fn lattice_polygon(rng: &mut Rng, radius: i64, most: usize) -> Vec<[i64; 2]> {
    loop {
        let mut points: Vec<_> = (0..rng.usize(3..=2 * most))
            .map(|_| [(); 2].map(|()| rng.i64(-radius..=radius)))
            .collect();
        points.sort_unstable();
        points.dedup();
        // Andrew's chains, from left to right below, and back above.
        let turn = |a: [i64; 2], b: [i64; 2], c: [i64; 2]| {
            (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
        };
        let chain = |points: &mut dyn Iterator<Item = [i64; 2]>| {
            let mut chain: Vec<[i64; 2]> = Vec::new();
            for p in points {
                while let [.., a, b] = chain[..]
                    && turn(a, b, p) <= 0
                {
                    chain.pop();
                }
                chain.push(p);
            }
            chain.pop();
            chain
        };
        let mut hull = chain(&mut points.iter().copied());
        hull.extend(chain(&mut points.iter().rev().copied()));
        if (3..=most).contains(&hull.len()) {
            let start = rng.usize(..hull.len());
            hull.rotate_left(start);
            return hull;
        }
    }
}

/// A bound on t and, for the triangle that is hit, on the weights (w, u, v), as `polygon::intersect` states it, with a tenth on
/// top for what is of second order and for its own rounding.
fn bound(
    unit: f64,
    ray: &oracle::Ray,
    vertices: &[DVec3],
    triangle: usize,
) -> Option<(f64, [f64; 3])> {
    let edges: Vec<_> = vertices.iter().map(|&v| v - vertices[0]).collect();
    let (mut n, mut m) = (DVec3::ZERO, DVec3::ZERO);
    for pair in edges[1..].windows(2) {
        let (a, b) = (pair[0], pair[1]);
        n += a.cross(b);
        let (a, b) = (a.abs(), b.abs());
        m += DVec3::new(a.y * b.z + a.z * b.y, a.z * b.x + a.x * b.z, a.x * b.y + a.y * b.x);
    }
    let (d, s) = (DVec3::from(ray.direction), DVec3::from(ray.origin) - vertices[0]);
    let det = n.dot(d).abs();
    let rounding = (vertices.len() + 6) as f64 * unit;
    if rounding * m.dot(d.abs()) > det / 16.0 {
        return None;
    }
    let t = -n.dot(s) / n.dot(d);
    let t_error = rounding * (m.dot(s.abs()) + t.abs() * m.dot(d.abs())) / det;
    let q = s + d * t;
    let q_error = (s.abs() * 2.0 + (d * t).abs() * 3.0) * unit + d.abs() * t_error;
    let size = n.abs();
    let (x, y) = if size.x >= size.y && size.x >= size.z {
        (1, 2)
    } else if size.y >= size.z {
        (2, 0)
    } else {
        (0, 1)
    };
    let (a, b) = (edges[triangle + 1], edges[triangle + 2]);
    let area = a[x] * b[y] - a[y] * b[x];
    let terms = (a[x] * b[y]).abs() + (a[y] * b[x]).abs();
    if 4.0 * unit * terms > area.abs() / 16.0 {
        return None;
    }
    let weight = |e: DVec3| {
        let product = e[x] * q[y] - e[y] * q[x];
        let terms_of_product = (e[x] * q[y]).abs() + (e[y] * q[x]).abs();
        (4.0 * unit * (terms_of_product + (product / area).abs() * terms)
            + e[x].abs() * q_error[y]
            + e[y].abs() * q_error[x])
            / area.abs()
    };
    let (u, v) = (weight(b), weight(a));
    Some((t_error * 1.1, [u + v + 4.0 * unit, u, v].map(|x| x * 1.1)))
}

/// Rays at lattice polygons in any plane: the numbers of a hit are those of the exact hit of its triangle, within the bounds, and
/// a miss is no clear hit.
#[test]
fn rays_hit_polygons_within_the_bounds() {
    fn check<V: Vector>(bits: u32) {
        let mut rng = Rng::with_seed(21);
        let unit = unit_roundoff::<V::Scalar>();
        let (mut hits, mut misses, mut wrong) = (0, 0, 0);
        for _ in 0..40_000 {
            // Of so many bits each that the vertices are exact.
            let (radius, spans, far) =
                (1 << (bits / 4), 1_i64 << (bits / 2 - 1), 1_i64 << (bits - 1));
            let flat = lattice_polygon(&mut rng, radius, 8);
            let point = |rng: &mut Rng, most: i64| [(); 3].map(|()| rng.i64(-most..=most));
            let (a, b) = (point(&mut rng, spans), point(&mut rng, spans));
            let reach = if rng.bool() { far } else { spans };
            let start = point(&mut rng, reach / 2);
            let vertices: Vec<DVec3> = flat
                .iter()
                .map(|[x, y]| {
                    DVec3::from_array(std::array::from_fn(|k| {
                        (start[k] + x * a[k] + y * b[k]) as f64
                    }))
                })
                .collect();
            let polygon = Polygon::<V, 8>::new(
                &vertices.iter().map(|v| vector(v.to_array())).collect::<Vec<_>>(),
            )
            .expect("eight at most");

            // At a point of the plane in a triangle or on a line of the fan, or beside.
            let i = rng.usize(1..vertices.len() - 1);
            let mut weight =
                || if rng.bool() { rng.f64() } else { f64::from(rng.u32(0..=2)) / 2.0 };
            let (u, v) = (weight() * 1.25, weight());
            let target =
                vertices[0] + (vertices[i] - vertices[0]) * u + (vertices[i + 1] - vertices[0]) * v;
            let origin = DVec3::from_array(point(&mut rng, reach).map(|x| x as f64));
            let cast = oracle::Ray {
                origin: origin.to_array(),
                direction: array(vector::<V>((target - origin).to_array())),
                t_min: f64::NEG_INFINITY,
                t_max: f64::INFINITY,
            };
            let corners =
                |i: usize| [vertices[0], vertices[i + 1], vertices[i + 2]].map(|v| v.to_array());
            let exact =
                (0..vertices.len() - 2).find(|&i| oracle::triangle(&cast, corners(i)).hits());
            let hit = polygon::intersect(&ray::<V>(&cast), &polygon);
            let case = || format!("{} {cast:?} {vertices:?} {hit:?} {exact:?}", name::<V>());
            if let Some(hit) = hit {
                let Some((t_error, errors)) = bound(unit, &cast, &vertices, hit.triangle) else {
                    continue;
                };
                let [w, u, v] = hit.in_triangle().barycentric().map(Into::into);
                let t: f64 = hit.t.into();
                let [v0, v1, v2] = corners(hit.triangle);
                let around = |answer: IsWithin, c, x: f64, error: f64| {
                    answer(&cast, c, x - error, x + error) == Some(true)
                };
                assert!(around(oracle::triangle_t_in, [v0, v1, v2], t, t_error), "{}", case());
                assert!(around(oracle::triangle_u_in, [v0, v1, v2], u, errors[1]), "{}", case());
                assert!(around(oracle::triangle_v_in, [v0, v1, v2], v, errors[2]), "{}", case());
                assert!(around(oracle::triangle_v_in, [v1, v2, v0], w, errors[0]), "{}", case());
                assert_eq!(
                    oracle::triangle_front(&cast, [v0, v1, v2]),
                    Some(hit.front),
                    "{}",
                    case()
                );
                hits += 1;
                wrong += u32::from(exact.is_none());
            } else if let Some(i) = exact {
                let Some((_, errors)) = bound(unit, &cast, &vertices, i) else { continue };
                let [v0, v1, v2] = corners(i);
                // Near the edge across the first vertex, or the first or the last of all.
                let is_near = |answer: Option<bool>| answer == Some(true);
                let near = is_near(oracle::triangle_v_in(&cast, [v1, v2, v0], 0.0, errors[0]))
                    || i == 0
                        && is_near(oracle::triangle_v_in(&cast, [v0, v1, v2], 0.0, errors[2]))
                    || i + 3 == vertices.len()
                        && is_near(oracle::triangle_u_in(&cast, [v0, v1, v2], 0.0, errors[1]));
                assert!(near, "{}", case());
                wrong += 1;
                misses += 1;
            } else {
                misses += 1;
            }
        }
        println!(
            "{:<6} {hits} hits, {misses} misses, {wrong} wrong within the bounds",
            name::<V>()
        );
        assert!(hits > 10_000 && misses > 5_000 && wrong > 0);
    }
    for bits in [12, 20] {
        check::<Vec3>(bits);
        check::<Vec3A>(bits);
    }
    check::<DVec3>(48);
}

/// A convex polygon on an ellipse about a centre, its vertices rounded.
fn ellipse<V: Vector, const N: usize>(
    rng: &mut Rng,
    center: DVec3,
    size: f64,
    most: usize,
) -> Polygon<V, N> {
    let direction = |rng: &mut Rng| DVec3::from_array([(); 3].map(|()| 2.0 * rng.f64() - 1.0));
    let (a, b) = (direction(rng) * size, direction(rng) * size);
    let count = rng.usize(3..=most);
    let start = rng.f64();
    let vertices: Vec<V> = (0..count)
        .map(|i| {
            let angle =
                std::f64::consts::TAU * (start + (i as f64 + 0.6 * rng.f64()) / count as f64);
            vector((center + a * angle.cos() + b * angle.sin()).to_array())
        })
        .collect();
    Polygon::new(&vertices).expect("no more than there is room for")
}

fn wide<V: Vector>(v: V) -> DVec3 {
    DVec3::from_array(array(v))
}

const CAPACITY: usize = 24;
type Piece<V> = Beam<V, CAPACITY>;
type Face<V> = Polygon<V, CAPACITY>;

fn random_beam<V: Vector>(rng: &mut Rng) -> (Piece<V>, Face<V>) {
    loop {
        let point = |rng: &mut Rng| DVec3::from_array([(); 3].map(|()| 2.0 * rng.f64() - 1.0));
        let apex = point(rng);
        let (center, beyond) = (apex + point(rng), 1.0 + 3.0 * rng.f64());
        let size = 0.1 + 0.5 * rng.f64();
        let base = ellipse(rng, center, size, 8);
        let aim = apex + (center - apex) * beyond + point(rng) * size;
        let size = size * beyond * (0.25 + 2.0 * rng.f64());
        if let Some(beam) = Beam::new(vector(apex.to_array()), base) {
            return (beam, ellipse(rng, aim, size, 8));
        }
    }
}

/// The planes that bound a beam, each by a point and its inward normal, with |M|/|n|.
fn planes<V: Vector>(beam: &Piece<V>) -> Vec<(DVec3, DVec3, f64)> {
    let apex = wide(beam.apex);
    let vertices: Vec<_> = beam.base.vertices().iter().map(|&v| wide(v)).collect();
    let plane = |at: DVec3, terms: &[(DVec3, DVec3)]| {
        let n: DVec3 = terms.iter().map(|(a, b)| a.cross(*b)).sum();
        let m: DVec3 = terms
            .iter()
            .map(|(a, b)| (a.abs(), b.abs()))
            .map(|(a, b)| {
                DVec3::new(a.y * b.z + a.z * b.y, a.z * b.x + a.x * b.z, a.x * b.y + a.y * b.x)
            })
            .sum();
        (at, n.normalize(), m.length() / n.length())
    };
    let count = vertices.len();
    let side = |i: usize| {
        let (from, to) = (vertices[i], vertices[(i + 1) % count]);
        plane(apex, &[(from - apex, to - from)])
    };
    let fan: Vec<_> = vertices[1..].windows(2).map(|w| (w[0] - vertices[0], w[1] - w[0])).collect();
    (0..count).map(side).chain([plane(vertices[0], &fan)]).collect()
}

/// What is lit lies in the polygon and in the beam, and all of both is lit.
#[test]
fn what_is_lit_is_what_polygon_and_beam_share() {
    fn check<V: Vector>() {
        let mut rng = Rng::with_seed(22);
        let unit = unit_roundoff::<V::Scalar>();
        let (mut lit_some, mut inside, mut most) = (0, 0, [0.0_f64; 2]);
        for _ in 0..10_000 {
            let (beam, face) = random_beam::<V>(&mut rng);
            let lit = beam_polygon::clip(&beam, &face).expect("there is room");
            let planes = planes(&beam);
            let vertices: Vec<_> = face.vertices().iter().map(|&v| wide(v)).collect();
            let largest = vertices
                .iter()
                .chain(beam.base.vertices().iter().map(|&v| wide(v)).collect::<Vec<_>>().iter())
                .chain([&wide(beam.apex)])
                .fold(0.0, |m, v| v.abs().max_element().max(m));
            let steepest = planes.iter().fold(0.0, |k, plane| plane.2.max(k));
            let outside = 60.0 * unit * steepest * largest;
            let beside = 4.0 * unit * largest * (beam.base.vertices().len() + 1) as f64;
            let normal: DVec3 = vertices[1..]
                .windows(2)
                .map(|w| (w[0] - vertices[0]).cross(w[1] - vertices[0]))
                .sum();
            let count = vertices.len();
            let edges: Vec<_> = (0..count)
                .map(|i| {
                    (vertices[i], normal.cross(vertices[(i + 1) % count] - vertices[i]).normalize())
                })
                .collect();
            lit_some += u32::from(!lit.vertices().is_empty());
            for &p in lit.vertices() {
                let p = wide(p);
                for &(at, n, _) in &planes {
                    let beyond = -n.dot(p - at);
                    most[0] = most[0].max(beyond / outside);
                    assert!(beyond <= outside, "{beam:?} {face:?} {p}: {beyond} {outside}");
                }
                for &(at, n) in &edges {
                    let beyond = -n.dot(p - at);
                    most[1] = most[1].max(beyond / beside);
                    assert!(beyond <= beside, "{beam:?} {face:?} {p}: {beyond} {beside}");
                }
            }
            // A point of the polygon is lit just if the beam has it, but near its sides.
            for _ in 0..8 {
                let i = rng.usize(1..count - 1);
                let (u, v) = (rng.f64(), rng.f64());
                let (u, v) = if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (u, v) };
                let p = vertices[0]
                    + (vertices[i] - vertices[0]) * u
                    + (vertices[i + 1] - vertices[0]) * v;
                let depth = planes.iter().fold(f64::INFINITY, |d, (at, n, _)| n.dot(p - at).min(d));
                let lit_vertices: Vec<_> = lit.vertices().iter().map(|&v| wide(v)).collect();
                let reach = (0..lit_vertices.len()).fold(f64::INFINITY, |d, k| {
                    let (from, to) = (lit_vertices[k], lit_vertices[(k + 1) % lit_vertices.len()]);
                    normal.cross(to - from).normalize_or(normal.normalize()).dot(p - from).min(d)
                });
                let reach = if lit_vertices.is_empty() { f64::NEG_INFINITY } else { reach };
                // Where the polygon is seen at an angle, its own distance is longer than the plane's: sines of a hundredth suffice here.
                let slack = 100.0 * (outside + beside);
                if depth > slack {
                    inside += 1;
                    assert!(reach > -slack, "{beam:?} {face:?} {lit:?} {p}");
                } else if depth < -slack {
                    assert!(reach < slack, "{beam:?} {face:?} {lit:?} {p}");
                }
            }
        }
        println!(
            "{:<6} {lit_some} lit, {inside} points, at most {most:?} of the bounds",
            name::<V>()
        );
        assert!(lit_some > 5_000 && inside > 10_000);
    }
    for_every_vector!(check);
}

fn parts<V: Vector>(division: &Division<V, CAPACITY, CAPACITY>) -> Vec<Piece<V>> {
    division.stopped.iter().chain(division.passing()).copied().collect()
}

/// The bases of the parts have the area of the whole: a new vertex beside its edge adds or takes half of 4u·s times an edge of
/// length l, two for each of M cuts; and the sum of a part's m triangles is off by (m + 4)u times those of the products, at most l² each.
fn area_error<V: Vector>(base: &Face<V>, cuts: usize, count: usize) -> f64 {
    let unit = unit_roundoff::<V::Scalar>();
    let vertices: Vec<_> = base.vertices().iter().map(|&v| wide(v)).collect();
    let longest = vertices
        .iter()
        .flat_map(|a| vertices.iter().map(move |b| a.distance(*b)))
        .fold(0.0, f64::max);
    let largest = vertices.iter().fold(0.0, |m, v| v.abs().max_element().max(m));
    let corners = (vertices.len() + cuts) as f64;
    unit * (4.0 * cuts as f64 * largest * longest
        + count as f64 * corners * (corners + 4.0) * longest * longest)
}

#[test]
fn what_is_lit_and_what_goes_on_are_the_whole() {
    fn check<V: Vector>() {
        let mut rng = Rng::with_seed(23);
        let (mut stopped, mut passing, mut points) = (0, 0, [0; 2]);
        let mut most = 0.0_f64;
        for _ in 0..10_000 {
            let (beam, face) = random_beam::<V>(&mut rng);
            let lit = beam_polygon::clip(&beam, &face).expect("there is room");
            let division = beam_polygon::divide(&beam, &lit).expect("there is room");
            let parts = parts(&division);
            let area = |face: &Face<V>| -> f64 { face.area().into() };
            let sum: f64 = parts.iter().map(|part| area(&part.base)).sum();
            let error = area_error(&beam.base, lit.vertices().len(), parts.len() + 1);
            most = most.max((sum - area(&beam.base)).abs() / error);
            assert!((sum - area(&beam.base)).abs() <= error, "{beam:?} {face:?} {sum} {error}");
            assert_eq!(division.stopped.is_some(), !lit.vertices().is_empty(), "{beam:?} {face:?}");
            stopped += usize::from(division.stopped.is_some());
            passing += division.passing().len();

            // A ray from the apex meets the polygon if its part is stopped, and passes if not.
            let corners: Vec<_> = beam.base.vertices().iter().map(|&v| wide(v)).collect();
            for _ in 0..4 {
                let weights: Vec<f64> = corners.iter().map(|_| -rng.f64().ln()).collect();
                let total: f64 = weights.iter().sum();
                let p: DVec3 = corners.iter().zip(&weights).map(|(&v, w)| v * (w / total)).sum();
                let apex = wide(beam.apex);
                let sight = Ray::new(apex, p - apex).with_range(1.0, f64::INFINITY);
                let double = Polygon::<DVec3, CAPACITY>::new(
                    &face.vertices().iter().map(|&v| wide(v)).collect::<Vec<_>>(),
                );
                let meets = |scale: f64| {
                    // The polygon shrunk or grown about its middle, to leave out what is too close to its edge.
                    let face = double.expect("as many");
                    let middle =
                        face.vertices().iter().sum::<DVec3>() / face.vertices().len() as f64;
                    let grown: Vec<_> =
                        face.vertices().iter().map(|&v| middle + (v - middle) * scale).collect();
                    sight.hits(&Polygon::<DVec3, CAPACITY>::new(&grown).expect("as many"))
                };
                let (inner, outer) = (meets(1.0 - 1e-3), meets(1.0 + 1e-3));
                if inner != outer {
                    continue;
                }
                let margin = |part: &Piece<V>| {
                    planes(part).iter().fold(f64::INFINITY, |d, (at, n, _)| n.dot(p - at).min(d))
                };
                // Of the parts' margins, the greatest is that of the part that has the ray. (All have the base's plane.)
                let of =
                    |beams: &[Piece<V>]| beams.iter().map(margin).fold(f64::NEG_INFINITY, f64::max);
                let (hit, missed) = (of(division.stopped.as_slice()), of(division.passing()));
                let is_hit = hit > missed;
                if (hit - missed).abs() > 1e-3 {
                    assert_eq!(is_hit, inner, "{beam:?} {face:?} {p}");
                    points[usize::from(is_hit)] += 1;
                }
            }
        }
        println!(
            "{:<6} {stopped} stopped, {passing} parts pass, {points:?} rays, at most {most} of the bound",
            name::<V>()
        );
        assert!(stopped > 5_000 && passing > 10_000);
    }
    for_every_vector!(check);
}

/// A wall of tiles that share their edges, before a beam: when each has stopped its part, nothing goes on, no sliver either.
#[test]
fn nothing_passes_between_the_tiles_of_a_wall() {
    fn check<V: Vector>() {
        let mut rng = Rng::with_seed(24);
        let mut most = 0;
        for _ in 0..1_000 {
            let (beam, _) = random_beam::<V>(&mut rng);
            let corners: Vec<_> = beam.base.vertices().iter().map(|&v| wide(v)).collect();
            let apex = wide(beam.apex);
            let middle = corners.iter().sum::<DVec3>() / corners.len() as f64;
            // Beyond the base, tilted a little, and wide enough.
            let normal: DVec3 =
                corners[1..].windows(2).map(|w| (w[0] - corners[0]).cross(w[1] - corners[0])).sum();
            let tilted =
                normal.normalize() + DVec3::from_array([(); 3].map(|()| 0.2 * rng.f64() - 0.1));
            let (a, b) = tilted.any_orthonormal_pair();
            let center = apex + (middle - apex) * 2.0;
            let reach = corners.iter().map(|v| v.distance(middle)).fold(0.0, f64::max) * 8.0;
            let tiles = rng.usize(1..=6);
            let at = |i: usize, j: usize| -> V {
                let share = |i: usize| 2.0 * i as f64 / tiles as f64 - 1.0;
                vector((center + (a * share(i) + b * share(j)) * reach).to_array())
            };
            let wall = at(0, 0) + at(tiles, tiles);
            let face = Face::<V>::new(&[at(0, 0), at(tiles, 0), at(tiles, tiles), at(0, tiles)]);
            let cover = beam_polygon::clip(&beam, &face.expect("four")).expect("there is room");
            let cover = beam_polygon::divide(&beam, &cover).expect("there is room");
            if !cover.passing().is_empty() {
                continue; // the beam passes the wall by
            }
            most += 1;
            let mut open = vec![beam];
            for (i, j) in (0..tiles).flat_map(|i| (0..tiles).map(move |j| (i, j))) {
                let tile =
                    Face::<V>::new(&[at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)])
                        .expect("four");
                open = open
                    .iter()
                    .flat_map(|beam| {
                        let lit = beam_polygon::clip(beam, &tile).expect("there is room");
                        beam_polygon::divide(beam, &lit).expect("there is room").passing().to_vec()
                    })
                    .collect();
            }
            assert!(open.is_empty(), "{beam:?} {wall:?} {tiles} {open:?}");
        }
        println!("{:<6} {most} walls", name::<V>());
        assert!(most > 300);
    }
    for_every_vector!(check);
}

/// What a mirror sends on lies on the lines to the mirrored apex, on the side that the light came from.
#[test]
fn a_reflected_beam_is_the_mirror_image() {
    fn check<V: Vector>() {
        let mut rng = Rng::with_seed(25);
        let unit = unit_roundoff::<V::Scalar>();
        let mut found = 0;
        for _ in 0..10_000 {
            let (beam, face) = random_beam::<V>(&mut rng);
            let lit = beam_polygon::clip(&beam, &face).expect("there is room");
            let Some(reflected) = beam.reflected(&lit) else { continue };
            let vertices: Vec<_> = lit.vertices().iter().map(|&v| wide(v)).collect();
            let n: DVec3 = vertices[1..]
                .windows(2)
                .map(|w| (w[0] - vertices[0]).cross(w[1] - vertices[0]))
                .sum();
            let m: f64 = vertices[1..]
                .windows(2)
                .map(|w| w[0].distance(vertices[0]) * w[1].distance(vertices[0]))
                .sum();
            // Slivers have no direction that is worth the name.
            let steep = m / n.length();
            if steep > 100.0 {
                continue;
            }
            let n = n.normalize();
            found += 1;
            let (apex, mirrored) = (wide(beam.apex), wide(reflected.apex));
            let height = n.dot(apex - vertices[0]);
            let expected = apex - n * (2.0 * height);
            // With m triangles a component of n is off by (m + 4)u of its terms; it is used twice, along with the height; and the
            // apex and the vertices are rounded to within u of their coordinates, three times.
            let largest = apex.abs().max_element().max(mirrored.abs().max_element()).max(2.0);
            let error = unit
                * (4.0 * (vertices.len() + 8) as f64 * steep * apex.distance(vertices[0])
                    + 8.0 * largest);
            assert!(
                mirrored.distance(expected) <= error,
                "{beam:?} {lit:?} {mirrored} {expected} {error}"
            );
            assert!(reflected.base == lit || reflected.base == lit.reversed());
            // The mirror image of a point of the beam before the mirror is in the reflected one.
            let middle = vertices.iter().sum::<DVec3>() / vertices.len() as f64;
            let before = middle + (apex - middle) * 0.5;
            let image = before - n * (2.0 * n.dot(before - vertices[0]));
            let through = middle + (middle - image) * 0.5;
            if height.abs() > 0.01 {
                assert!(
                    reflected.contains(vector(through.to_array())),
                    "{beam:?} {lit:?} {through}"
                );
                assert!(!reflected.contains(vector(image.to_array())), "{beam:?} {lit:?} {image}");
            }
        }
        assert!(found > 5_000, "{found}");
    }
    for_every_vector!(check);
}

fn square<V: Vector, const N: usize>(size: f64, z: f64) -> Polygon<V, N> {
    let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    Polygon::new(&corners.map(|[x, y]| vector([x * size, y * size, z]))).expect("four")
}

#[test]
fn what_needs_more_room_is_none() {
    // The octagon that two squares share, one of them turned, needs eight corners.
    let diamond =
        [[0.0, -2.5], [2.5, 0.0], [0.0, 2.5], [-2.5, 0.0]].map(|[x, y]| Vec3::new(x, y, 2.0));
    let beam = Beam::<Vec3, 5>::new(Vec3::ZERO, square(1.0, 1.0)).expect("it has a volume");
    let eight = Polygon::<Vec3, 8>::new(&diamond).expect("four");
    let seven = Polygon::<Vec3, 7>::new(&diamond).expect("four");
    let found = beam_polygon::clip(&beam, &eight).expect("eight are no more than eight");
    assert_eq!(found.vertices().len(), 8);
    assert_eq!(beam_polygon::clip(&beam, &seven), None);
    // What meets it has eight corners as well, and the base has room for five.
    assert!(beam_polygon::divide(&beam, &found).is_none());
    let wider = Beam::<Vec3, 8>::new(Vec3::ZERO, square(1.0, 1.0)).expect("it has a volume");
    let division = beam_polygon::divide(&wider, &found).expect("there is room");
    assert_eq!(division.stopped.map(|part| part.base.vertices().len()), Some(8));
    assert_eq!(division.passing().len(), 4);
}

#[test]
fn powers_of_two_change_nothing_in_a_beam() {
    fn check<V: Vector>() {
        let mut rng = Rng::with_seed(26);
        let exponents = if size_of::<V::Scalar>() == 4 { [-40, 40] } else { [-300, 300] };
        for _ in 0..1_000 {
            let (beam, face) = random_beam::<V>(&mut rng);
            let outcome = |exponent: i32| {
                let to = |face: &Face<V>, exponent: i32| -> Face<V> {
                    let scale = scalar::<V::Scalar>(2_f64.powi(exponent));
                    Polygon::new(&face.vertices().iter().map(|&v| v * scale).collect::<Vec<_>>())
                        .expect("as many")
                };
                let apex = beam.apex * scalar(2_f64.powi(exponent));
                let beam = Beam::new(apex, to(&beam.base, exponent)).expect("it has a volume");
                let lit = beam_polygon::clip(&beam, &to(&face, exponent)).expect("there is room");
                let division = beam_polygon::divide(&beam, &lit).expect("there is room");
                let parts = parts(&division)
                    .iter()
                    .map(|part| to(&part.base, -exponent))
                    .collect::<Vec<_>>();
                (to(&lit, -exponent), parts)
            };
            for exponent in exponents {
                assert_eq!(outcome(exponent), outcome(0), "{exponent}");
            }
        }
    }
    for_every_vector!(check);
}

#[test]
fn bad_beams_and_polygons_are_answered() {
    fn check<V: Vector>() {
        let beam = Beam::<V, 8>::new(V::ZERO, square(1.0, 1.0)).expect("it has a volume");
        let reversed = Beam::<V, 8>::new(V::ZERO, square(1.0, 1.0).reversed());
        assert_eq!(reversed.map(|beam| beam.base.normal()), Some(beam.base.normal()));
        for number in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let bad = vector::<V>([0.0, number, 1.0]);
            assert!(Beam::<V, 8>::new(bad, square(1.0, 1.0)).is_none());
            for i in 0..4 {
                let mut corners = square::<V, 8>(1.0, 1.0).vertices().to_vec();
                corners[i] = bad;
                let polygon = Polygon::<V, 8>::new(&corners).expect("four");
                assert!(Beam::new(V::ZERO, polygon).is_none());
                assert_eq!(beam_polygon::clip(&beam, &polygon), Some(Polygon::EMPTY));
                let division = beam_polygon::divide(&beam, &polygon).expect("there is room");
                assert!(division.stopped.is_none() && division.passing() == [beam]);
                assert!(beam.reflected(&polygon).is_none());
            }
        }
        // In the plane of its apex, or without an area.
        assert!(Beam::<V, 8>::new(V::ZERO, square(1.0, 0.0)).is_none());
        for count in 0..3 {
            let few = Polygon::<V, 8>::new(&square::<V, 8>(1.0, 1.0).vertices()[..count])
                .expect("two at most");
            assert!(Beam::new(V::ZERO, few).is_none() && beam.reflected(&few).is_none());
            let division = beam_polygon::divide(&beam, &few).expect("there is room");
            assert!(division.stopped.is_none() && division.passing() == [beam]);
        }
        // Edge-on, behind the apex, before the base, in it, beside it, and along an edge.
        let edge_on = [[0.0, 0.0, 2.0], [0.0, 0.0, 4.0], [0.0, 1.0, 4.0]].map(vector::<V>);
        let edge_on = Polygon::<V, 8>::new(&edge_on).expect("three");
        let lit = beam_polygon::clip(&beam, &edge_on).expect("there is room");
        let division = beam_polygon::divide(&beam, &lit).expect("there is room");
        assert!(!lit.vertices().is_empty() && division.stopped.is_none());
        for z in [-2.0, 0.0, 0.5, 1.0] {
            let behind = square::<V, 8>(1.0, z);
            assert_eq!(beam_polygon::clip(&beam, &behind), Some(Polygon::EMPTY));
        }
        for offset in [4.0, 3.0] {
            let shifted = square::<V, 8>(1.0, 2.0)
                .vertices()
                .iter()
                .map(|&v| v + vector([offset, 0.0, 0.0]))
                .collect::<Vec<_>>();
            let beside = Polygon::<V, 8>::new(&shifted).expect("four");
            let lit = beam_polygon::clip(&beam, &beside).expect("there is room");
            assert_eq!((lit, offset), (Polygon::EMPTY, offset));
        }
    }
    for_every_vector!(check);
}
