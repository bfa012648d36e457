//! Claim: what a hit says is consistent in itself, whatever the shape; and shapes keep their own promises.

use std::sync::Arc;

use approx::{abs_diff_eq, assert_abs_diff_eq};
use isect::glam::{Affine3A, DAffine3, DVec3, EulerRot, Mat4, Quat, Vec3, Vec3A};
use isect::ray::aabb::{BoxRay, slab};
use isect::ray::plane::{self, PlaneHit};
use isect::ray::sphere;
use isect::{Aabb, Intersect, Number, Plane, Ray, Scalar, Sphere, Triangle, Vector};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

use crate::bounds::check_triangle;
use crate::support::bounds::unit_roundoff;
use crate::support::kernels::{sphere_kernels, triangle_kernels};
use crate::support::{
    aabb, array, for_every_vector, name, oracle, ray, scalar, sphere as sphere_of, triangle, vector,
};

const SEED: u64 = 7;

/// A coordinate that `f32` holds: an integer, any number in a range, or of any magnitude.
fn coordinate() -> impl Strategy<Value = f64> {
    prop_oneof![
        (-4..=4_i8).prop_map(f64::from),
        (-4.0..4.0_f32).prop_map(f64::from),
        ((-1.0..1.0_f32), -20..20_i32).prop_map(|(x, e)| f64::from(x) * 2_f64.powi(e)),
    ]
}

fn point() -> impl Strategy<Value = [f64; 3]> {
    [coordinate(), coordinate(), coordinate()]
}

/// A ray from one point towards another.
fn rays() -> impl Strategy<Value = oracle::Ray> {
    (point(), point(), prop::bool::ANY).prop_map(|(origin, direction, line)| oracle::Ray {
        origin,
        direction,
        t_min: if line { f64::NEG_INFINITY } else { 0.0 },
        t_max: f64::INFINITY,
    })
}

proptest! {
    #![proptest_config(ProptestConfig {
        failure_persistence: None,
        rng_seed: RngSeed::Fixed(SEED),
        ..ProptestConfig::with_cases(20_000)
    })]

    /// o + t·d is the weighted mean of the vertices: within the bounds of t times the direction, of the weights times the
    /// vertices, and 8u of the magnitudes for recomputing both sides.
    #[test]
    fn the_hit_point_is_the_weighted_mean(exact_ray in rays(), vertices in [point(), point(), point()]) {
        fn check<V: Vector>(exact_ray: &oracle::Ray, vertices: &[[f64; 3]; 3]) {
            let unit = unit_roundoff::<V::Scalar>();
            let (ray, triangle) = (ray::<V>(exact_ray), triangle::<V>(vertices));
            for kernel in triangle_kernels::<V>() {
                let Some(bound) = (kernel.bound)(unit, exact_ray, vertices) else { continue };
                let Some(hit) = (kernel.intersect)(&ray, &triangle) else { continue };
                let [w, u, v] = hit.barycentric();
                assert!([w, u, v].iter().all(|&x| x >= V::Scalar::ZERO));
                let (along, mean) = (array(ray.at(hit.t)), array(triangle.at(u, v)));
                for i in 0..3 {
                    let weights: f64 = (0..3).map(|k| (bound.weights[k] + 8.0 * unit) * vertices[k][i].abs()).sum();
                    let t: f64 = hit.t.into();
                    let direction = exact_ray.direction[i].abs();
                    let step = direction * (bound.t + 8.0 * unit * t.abs()) + 8.0 * unit * exact_ray.origin[i].abs();
                    let tolerance = weights + step;
                    assert!(
                        abs_diff_eq!(along[i], mean[i], epsilon = tolerance),
                        "{} {}: {exact_ray:?} {vertices:?} {hit:?} {along:?} {mean:?} {tolerance}",
                        kernel.name,
                        name::<V>()
                    );
                }
            }
        }
        for_every_vector!(check, &exact_ray, &vertices);
    }

    /// The two that bring a `hits` of their own: a box, also for ranges that end where it is entered and left, where rounding
    /// could tell the two apart; and pointers, which must pass on that of their shape.
    #[test]
    fn any_hit_is_a_closest_hit(exact_ray in rays(), a in point(), b in point()) {
        /// A shape whose two answers differ.
        struct Marked;

        impl<V: Vector> Intersect<V> for Marked {
            type Hit = u8;
            fn intersect(&self, _: &Ray<V>) -> Option<u8> {
                Some(7)
            }
            fn hits(&self, _: &Ray<V>) -> bool {
                false
            }
        }

        fn check<V: Vector>(exact_ray: &oracle::Ray, a: &[f64; 3], b: &[f64; 3]) {
            let ray = ray::<V>(exact_ray);
            let shape = Aabb::from_points([vector::<V>(*a), vector(*b)]);
            let hit = ray.intersect(&shape);
            assert_eq!(ray.hits(&shape), hit.is_some());
            if let Some(hit) = hit {
                for t in [hit.t_enter, hit.t_exit] {
                    for ray in [ray.with_range(ray.t_min, t), ray.with_range(t, ray.t_max), ray.before(t), ray.after(t)] {
                        assert_eq!(ray.hits(&shape), ray.intersect(&shape).is_some());
                    }
                }
            }
            let pointers: [&dyn Intersect<V, Hit = u8>; 3] = [&&Marked, &Box::new(Marked), &Arc::new(Marked)];
            for pointer in pointers {
                assert_eq!((ray.intersect(pointer), ray.hits(pointer)), (Some(7), false));
            }
        }
        for_every_vector!(check, &exact_ray, &a, &b);
    }

    /// `after` and `before` open the range: the hit that was found is no longer in it. (The exact kernel compares the exact
    /// t with the ends: the open ranges start beyond the error of the reported one.)
    #[test]
    fn open_ranges_leave_out_their_ends(exact_ray in rays(), vertices in [point(), point(), point()]) {
        fn check<V: Vector>(exact_ray: &oracle::Ray, vertices: &[[f64; 3]; 3]) {
            let (ray, triangle) = (ray::<V>(exact_ray), triangle::<V>(vertices));
            for kernel in triangle_kernels::<V>() {
                let Some(hit) = (kernel.intersect)(&ray, &triangle) else { continue };
                let error = if kernel.name == "exact" {
                    let unit = unit_roundoff::<V::Scalar>();
                    let Some(bound) = (kernel.bound)(unit, exact_ray, vertices) else { continue };
                    // In a float, and of a sum that is rounded.
                    scalar::<V::Scalar>(bound.t + 2.0 * unit * hit.t.abs().into()).next_up()
                } else {
                    V::Scalar::ZERO
                };
                let (first, last) = (hit.t - error, hit.t + error);
                assert!((kernel.intersect)(&ray.with_range(first, last), &triangle).is_some());
                assert_eq!((kernel.intersect)(&ray.after(last), &triangle), None);
                assert_eq!((kernel.intersect)(&ray.before(first), &triangle), None);
            }
        }
        for_every_vector!(check, &exact_ray, &vertices);
    }

    /// The nearest root in the range is reported, `leaving` says which; both are those of `roots` for the default.
    #[test]
    fn the_nearest_root_in_range_wins(exact_ray in rays(), center in point(), radius in 0.0..4.0_f32, cut in 0.0..1.0_f32) {
        fn check<V: Vector>(exact_ray: &oracle::Ray, center: &[f64; 3], radius: f32, cut: f32) {
            let (ray, ball) = (ray::<V>(exact_ray), sphere_of::<V>(center, radius.into()));
            let Some([near, far]) = sphere::roots(&ray, &ball) else {
                assert_eq!(ray.intersect(&ball), None);
                return;
            };
            assert!(near <= far);
            // Ends between the roots and on either side, at a quarter of their distance or more, which is far beyond
            // their errors unless the chord is short.
            let chord = far - near;
            let thousandth = near.abs().max(far.abs()) * scalar(1e-3);
            if chord > thousandth {
                let (before, after) = (near - chord, far + chord);
                let cut = near + chord * scalar(0.25 + 0.5 * f64::from(cut));
                for (t_min, t_max) in [(before, after), (cut, after), (before, cut)] {
                    let found = ray.with_range(t_min, t_max).intersect(&ball).expect("a root is in range");
                    let expected = if t_min <= near { near } else { far };
                    assert_eq!((found.t, found.leaving), (expected, t_min > near));
                }
                assert_eq!(ray.with_range(cut, cut).intersect(&ball), None);
            }
            for kernel in sphere_kernels::<V>() {
                let line = ray.with_range(-V::Scalar::INFINITY, V::Scalar::INFINITY);
                if let Some(hit) = (kernel.intersect)(&line, &ball) {
                    assert!(!hit.leaving, "a line meets the near root first");
                }
            }
        }
        for_every_vector!(check, &exact_ray, &center, radius, cut);
    }

    /// The exit is the least of the exits, the entry the greatest of the entries, in the range; and `surface` is the first.
    #[test]
    fn a_box_is_entered_before_it_is_left(exact_ray in rays(), a in point(), b in point()) {
        fn check<V: Vector>(exact_ray: &oracle::Ray, a: &[f64; 3], b: &[f64; 3]) {
            let ray = ray::<V>(exact_ray);
            let bounds = Aabb::from_points([vector::<V>(*a), vector(*b)]);
            let Some(hit) = slab::intersect(&BoxRay::new(&ray), &bounds) else { return };
            assert!(ray.t_min <= hit.t_enter && hit.t_enter <= hit.t_exit && hit.t_exit <= ray.t_max);
            match hit.surface() {
                Some((t, face)) if Some(face) == hit.enter_face => assert_eq!(t, hit.t_enter),
                Some((t, face)) => assert_eq!((hit.enter_face, Some(face), t), (None, hit.exit_face, hit.t_exit)),
                None => assert_eq!((hit.enter_face, hit.exit_face), (None, None)),
            }
            // A middle point between the crossings lies in the box, but for the rounding of three products and sums.
            if hit.t_exit.is_finite() && hit.t_enter.is_finite() {
                let unit = unit_roundoff::<V::Scalar>();
                let half = scalar::<V::Scalar>(0.5);
                let middle = array(ray.at(hit.t_enter * half + hit.t_exit * half));
                let (enter, exit): (f64, f64) = (hit.t_enter.into(), hit.t_exit.into());
                let longest = enter.abs().max(exit.abs());
                for i in 0..3 {
                    let slack = 8.0 * unit * (exact_ray.origin[i].abs() + longest * exact_ray.direction[i].abs());
                    assert!(a[i].min(b[i]) - slack <= middle[i] && middle[i] <= a[i].max(b[i]) + slack);
                }
            }
        }
        for_every_vector!(check, &exact_ray, &a, &b);
    }

    /// A plane through three points holds them: n·p − offset is a difference of sums that are within 9u of the terms.
    #[test]
    fn a_plane_goes_through_its_points(points in [point(), point(), point()]) {
        fn check<V: Vector>(points: &[[f64; 3]; 3]) {
            let unit = unit_roundoff::<V::Scalar>();
            let [a, b, c] = points.map(vector::<V>);
            let Some(plane) = Plane::from_points(a, b, c) else { return };
            let spans = [array(b - a), array(c - a)];
            for p in points {
                let terms: f64 = (0..3)
                    .map(|i| {
                        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
                        let normal = (spans[0][j] * spans[1][k]).abs() + (spans[0][k] * spans[1][j]).abs();
                        normal * (p[i].abs() + points[0][i].abs())
                    })
                    .sum();
                let distance: f64 = (plane.normal.dot(vector(*p)) - plane.offset).into();
                assert_abs_diff_eq!(distance, 0.0, epsilon = 9.0 * unit * terms);
            }
            let above = Ray::new(a + plane.normal, -plane.normal);
            if let Some(PlaneHit::At(t)) = plane::intersect(&above, &plane) {
                assert!(t >= V::Scalar::ZERO);
            }
        }
        for_every_vector!(check, &points);
    }

    /// The image of every corner, computed in f64, lies in the transformed box.
    #[test]
    fn a_transformed_box_holds_the_images(a in point(), b in point(), angles in [-4.0..4.0_f32, -4.0..4.0_f32, -4.0..4.0_f32], shift in point()) {
        let [x, y, z] = angles;
        let map = Affine3A::from_scale_rotation_translation(
            Vec3::new(x, 1.0, z),
            Quat::from_euler(EulerRot::XYZ, x, y, z),
            vector(shift),
        );
        let bounds = Aabb::<Vec3A>::from_points([vector(a), vector(b)]);
        let image = Aabb::<DVec3>::from(bounds.transformed(&map));
        let exact = DAffine3::from_mat3_translation(map.matrix3.as_dmat3(), map.translation.as_dvec3());
        for corner in Aabb::<DVec3>::from(bounds).corners() {
            // f64 rounds too, by 2⁻²⁹ of the margin that f32 leaves.
            prop_assert!(image.contains(exact.transform_point3(corner)), "{:?} {:?}", image, corner);
        }
        prop_assert_eq!(bounds.transformed(&Mat4::from(map)), bounds.transformed(&map));
    }

    /// Rounded outward: the exact sphere lies in its box.
    #[test]
    fn a_sphere_lies_in_its_box(center in point(), radius in 0.0..4.0_f32) {
        let bounds = Aabb::<DVec3>::from(Sphere::<Vec3>::new(vector(center), radius).aabb());
        let radius = f64::from(radius);
        let (min, max) = (array(bounds.min), array(bounds.max));
        for ((min, max), center) in min.into_iter().zip(max).zip(center) {
            // Sums of two f32 whose exponents differ by less than 29 are exact in f64.
            prop_assert!(min <= center - radius && center + radius <= max);
            // And no further than the next float.
            let spacing = |x: f64| {
                let x = scalar::<f32>(x).abs();
                f64::from(x.next_up() - x)
            };
            prop_assert!(center - radius - min <= spacing(min) && max - center - radius <= spacing(max));
        }
    }

    /// A ray and its image meet a shape and its image at the same t: each to the bound of the kernel, which decides the
    /// verdict too.
    #[test]
    fn t_keeps_its_meaning_in_another_space(vertices in [point(), point(), point()], shift in [-4..4_i8, -4..4_i8, -4..4_i8]) {
        // Powers of two and integers: the map is exact.
        let map = Affine3A::from_scale_rotation_translation(Vec3::new(2.0, 0.5, -4.0), Quat::IDENTITY, Vec3::from(shift.map(f32::from)));
        let [a, b, c] = vertices.map(|v| v.map(|x| x.round().clamp(-64.0, 64.0))).map(vector::<Vec3A>);
        let map_point = |p: Vec3A| map.transform_point3a(p);
        let ray = Ray::new(Vec3A::new(0.25, 0.5, 8.0), Vec3A::new(0.0, 0.25, -1.0));
        let image = ray.transformed(&map);
        prop_assert_eq!(image.at(2.0), map_point(ray.at(2.0)));
        let [here, there] = [(ray, [a, b, c]), (image, [a, b, c].map(map_point))].map(|(ray, vertices)| {
            let exact_ray = oracle::Ray {
                origin: array(ray.origin),
                direction: array(ray.direction),
                t_min: 0.0,
                t_max: f64::INFINITY,
            };
            (exact_ray, vertices.map(array), ray.intersect(&Triangle::from(vertices)).map(|hit| f64::from(hit.t)))
        });
        prop_assert_eq!(oracle::triangle(&here.0, here.1), oracle::triangle(&there.0, there.1));
        let [_, _, _, watertight, _] = triangle_kernels::<Vec3A>();
        let unit = unit_roundoff::<f32>();
        let bounds = [&here, &there].map(|(ray, vertices, _)| (watertight.bound)(unit, ray, vertices));
        if let [Some(bound_here), Some(bound_there)] = bounds {
            check_triangle(&watertight, &here.0, here.1, bound_here);
            check_triangle(&watertight, &there.0, there.1, bound_there);
            if let (Some(t), Some(image_t)) = (here.2, there.2) {
                prop_assert!((t - image_t).abs() <= bound_here.t + bound_there.t, "{t} {image_t}");
            }
        }
    }

    /// Unions hold both, intersections lie in both.
    #[test]
    fn boxes_form_a_lattice(points in [point(), point(), point(), point()], probe in point()) {
        fn check<V: Vector>([a, b, c, d]: &[[f64; 3]; 4], probe: &[f64; 3]) {
            let [a, b, c, d] = [a, b, c, d].map(|p| vector::<V>(*p));
            let (first, second) = (Aabb::from_points([a, b]), Aabb::from_points([c, d]));
            let (union, common) = (first.union(&second), first.intersection(&second));
            let probe = vector::<V>(*probe);
            assert!([a, b, c, d].iter().all(|&p| union.contains(p)));
            assert_eq!(common.contains(probe), first.contains(probe) && second.contains(probe));
            assert!(union.contains(probe) || !(first.contains(probe) || second.contains(probe)));
            assert_eq!(common.is_empty(), !first.overlaps(&second));
            assert_eq!(first.union(&Aabb::EMPTY), first);
            assert_eq!(Aabb::EMPTY.union(&first), first);
        }
        for_every_vector!(check, &points, &probe);
    }

    /// `Vec3` and `Vec3A` are two layouts of the same numbers, which `DVec3` holds too; and its verdict on a triangle is that
    /// of `f32` where the bound of `f32` decides.
    #[test]
    fn conversions_lose_nothing(exact_ray in rays(), vertices in [point(), point(), point()]) {
        let (a, b) = (ray::<Vec3>(&exact_ray), ray::<Vec3A>(&exact_ray));
        prop_assert_eq!(Ray::<Vec3A>::from(a), b);
        prop_assert_eq!(Ray::<Vec3>::from(b), a);
        prop_assert_eq!(Ray::<DVec3>::from(b), ray::<DVec3>(&exact_ray));
        let (s, t) = (triangle::<Vec3>(&vertices), triangle::<Vec3A>(&vertices));
        prop_assert_eq!(Triangle::<Vec3A>::from(s), t);
        prop_assert_eq!(s.aabb(), Aabb::<Vec3>::from(t.aabb()));
        let (min, max) = (array(t.aabb().min), array(t.aabb().max));
        prop_assert_eq!(aabb::<Vec3>(&min, &max), s.aabb());
        let narrow = triangle_kernels::<Vec3>();
        for (narrow, wide) in narrow.iter().zip(triangle_kernels::<DVec3>()) {
            let Some(bound) = (narrow.bound)(unit_roundoff::<f32>(), &exact_ray, &vertices) else { continue };
            check_triangle(narrow, &exact_ray, vertices, bound);
            check_triangle(&wide, &exact_ray, vertices, bound);
        }
    }
}
