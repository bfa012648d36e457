//! The traits of other crates: what is written can be read, what is bad is refused or harmless, what is cast is the same bytes.
//!
//! `cargo test --all-features --test interop`, or one feature at a time with `--features proptest,serde`, as proptest draws the shapes
//! (approx with serde, which reaches each of their numbers); the target is left out of a plain `cargo test`.
#![cfg_attr(
    not(all(feature = "approx", feature = "bytemuck", feature = "serde")),
    allow(unused_imports, dead_code, unused_macros)
)]

use std::fmt::Debug;

#[cfg(all(feature = "approx", feature = "serde"))]
use approx::{AbsDiffEq, RelativeEq, UlpsEq};
#[cfg(feature = "bytemuck")]
use bytemuck::{AnyBitPattern, Pod, Zeroable};
use isect::glam::{DVec3, Vec3, Vec3A};
use isect::interop::Extent;
use isect::overlap::{ConeHit, Containment};
use isect::ray::aabb::AabbHit;
use isect::ray::plane::PlaneHit;
use isect::ray::polygon::PolygonHit;
use isect::ray::sphere::SphereHit;
use isect::ray::triangle::TriangleHit;
use isect::ray::triangle::exact::Verdict;
use isect::simd::{AabbPack, TrianglePack};
use isect::{
    Aabb, Beam, Cone, Coordinates, Face, Number, Plane, Polygon, Pyramid, Ray, Scalar, Sphere,
    Triangle, Vector,
};
use proptest::prelude::{Arbitrary, Strategy, any, any_with};
use proptest::strategy::ValueTree;
use proptest::test_runner::{Config, RngSeed, TestError, TestRunner};
#[cfg(feature = "serde")]
use serde::Serialize;
#[cfg(feature = "serde")]
use serde::de::DeserializeOwned;
#[cfg(feature = "serde")]
use serde_json::{Value, json};

/// Runs a generic check with all three vector types.
macro_rules! for_every_vector {
    ($check:ident) => {
        $check::<Vec3>();
        $check::<Vec3A>();
        $check::<DVec3>();
    };
}

fn runner(cases: u32) -> TestRunner {
    let rng_seed = RngSeed::Fixed(1);
    TestRunner::new(Config { cases, rng_seed, failure_persistence: None, ..Config::default() })
}

/// Calls `check` with a number of shapes.
fn draw<T: Debug>(cases: u32, strategy: &impl Strategy<Value = T>, mut check: impl FnMut(T)) {
    let mut runner = runner(cases);
    for _ in 0..cases {
        check(strategy.new_tree(&mut runner).expect("few are rejected").current());
    }
}

fn x<T: Scalar>(value: f64) -> T {
    T::ONE.lit(value)
}

fn vector<V: Vector>([a, b, c]: [f64; 3]) -> V {
    V::new(x(a), x(b), x(c))
}

fn square<V: Vector>() -> Polygon<V, 5> {
    let corners = [[1.0, 1.0, 1.0], [3.0, 1.0, 1.0], [3.0, 3.0, 1.0], [1.0, 3.0, 1.0]];
    Polygon::new(&corners.map(vector)).expect("four of five")
}

/// One of each type with numbers in it: from 1/4 to 9, or from −9 to −1/4.
macro_rules! for_every_type {
    ($check:ident, $v:ty) => {{
        type T = <$v as Coordinates>::Scalar;
        let [a, b, c] = [[1.5, 2.5, -3.0], [-4.0, 5.0, 6.0], [7.0, -8.0, 9.0]].map(vector::<$v>);
        let ray = Ray::new(a, b).with_range(x(0.5), x(8.0));
        let (t, u, v, front) = (x::<T>(1.5), x(0.25), x(0.5), true);
        let (enter_face, exit_face) = (Some(Face::NegX), Some(Face::PosZ));
        $check(ray);
        $check(Plane { normal: a, offset: x(2.0) });
        $check(Sphere::new(a, x(2.0)));
        $check(Aabb::new(a, b));
        $check(Triangle::new(a, b, c));
        $check(Cone::new(ray, x(2.0), x(0.5)));
        $check(Pyramid { apex: a, corners: [a, b, c, a], normals: [b, c, a, b] });
        $check(square::<$v>());
        $check(Beam::new(a, square()).expect("the apex is not in the plane"));
        $check(PlaneHit::At(t));
        $check(SphereHit { t, leaving: true });
        $check(AabbHit { t_enter: t, t_exit: x(3.0), enter_face, exit_face });
        $check(TriangleHit { t, u, v, front });
        $check(PolygonHit { t, triangle: 1, u, v, front });
        $check(ConeHit { t, coverage: x(0.5) });
    }};
}

#[cfg(feature = "serde")]
mod stored {
    use super::*;

    fn to_bytes(value: &impl Serialize) -> Vec<u8> {
        let mut bytes = vec![];
        ciborium::into_writer(value, &mut bytes).expect("it can be written");
        bytes
    }

    /// To the last bit, so that a NaN is one again and −0 is not 0.
    fn survives<T: Serialize + DeserializeOwned + Debug>(value: &T) {
        let text = serde_json::to_string(value).expect("it can be written");
        let read: T = serde_json::from_str(&text).expect(&text);
        assert_eq!(format!("{read:?}"), format!("{value:?}"), "{text}");
        let bytes = to_bytes(value);
        let read: T = ciborium::from_reader(&*bytes).expect("it was written so");
        assert_eq!(format!("{read:?}"), format!("{value:?}"), "{bytes:?}");
    }

    #[test]
    fn every_type_survives_text_and_bytes() {
        fn one<T: Serialize + DeserializeOwned + Debug>(value: T) {
            survives(&value);
        }
        for_every_type!(one, Vec3);
        for_every_type!(one, Vec3A);
        for_every_type!(one, DVec3);
        one(PlaneHit::<f32>::Contained);
        for containment in [Containment::Outside, Containment::Partial, Containment::Inside] {
            one(containment);
        }
        for verdict in [Verdict::Miss, Verdict::Edge(2), Verdict::Vertex(1), Verdict::Coplanar] {
            one(verdict);
        }
    }

    #[test]
    fn shapes_of_any_digits_survive() {
        fn check<V>()
        where
            V: Vector<Scalar: Serialize + DeserializeOwned>,
        {
            fn of<T: Arbitrary + Serialize + DeserializeOwned>() {
                draw(200, &any::<T>(), |shape| survives(&shape));
            }
            of::<Ray<V>>();
            of::<Plane<V>>();
            of::<Sphere<V>>();
            of::<Aabb<V>>();
            of::<Triangle<V>>();
            of::<Cone<V>>();
            of::<Pyramid<V>>();
            of::<Polygon<V, 6>>();
            of::<Beam<V, 6>>();
        }
        for_every_vector!(check);
    }

    #[test]
    fn infinities_and_nan_survive() {
        fn check<V>()
        where
            V: Vector<Scalar: Serialize + DeserializeOwned>,
        {
            let [infinity, nan] = [V::Scalar::INFINITY, V::Scalar::NAN];
            let ray = Ray::new(V::ZERO, vector([0.0, -0.0, 1.0]));
            survives(&ray);
            survives(&ray.with_range(-infinity, infinity));
            survives(&ray.with_range(nan, x(1e-38)));
            survives(&Aabb::<V>::EMPTY);
            survives(&Aabb::new(V::NEG_INFINITY, vector([1.0, f64::INFINITY, f64::NAN])));
            survives(&Sphere::new(V::ZERO, nan));
            survives(&ConeHit { t: infinity, coverage: V::Scalar::MAX });
        }
        for_every_vector!(check);
    }

    #[test]
    fn the_text_is_as_documented() {
        let ray = Ray::new(Vec3::new(0.1, 2.0, -3.0), Vec3::Z);
        assert_eq!(
            serde_json::to_string(&ray).unwrap(),
            r#"{"origin":[0.1,2.0,-3.0],"direction":[0.0,0.0,1.0],"t_min":0.0,"t_max":"Infinity"}"#
        );
        let unbounded = Aabb::new(Vec3A::NEG_INFINITY, Vec3A::splat(f32::NAN));
        assert_eq!(
            serde_json::to_string(&unbounded).unwrap(),
            r#"{"min":["-Infinity","-Infinity","-Infinity"],"max":["NaN","NaN","NaN"]}"#
        );
        let hit = AabbHit {
            t_enter: 1.0_f32,
            t_exit: 2.0,
            enter_face: None,
            exit_face: Some(Face::NegY),
        };
        assert_eq!(
            serde_json::to_string(&hit).unwrap(),
            r#"{"t_enter":1.0,"t_exit":2.0,"enter_face":null,"exit_face":"NegY"}"#
        );
        assert_eq!(
            serde_json::to_string(&[PlaneHit::At(1.5_f64), PlaneHit::Contained]).unwrap(),
            r#"[{"At":1.5},"Contained"]"#
        );
        let point = Polygon::<DVec3, 3>::new(&[DVec3::X]).expect("one of three");
        assert_eq!(serde_json::to_string(&point).unwrap(), "[[1.0,0.0,0.0]]");
        // Integers are numbers too.
        let text = r#"{"center":[1,-2,0],"radius":3}"#;
        let sphere: Sphere = serde_json::from_str(text).unwrap();
        assert_eq!(sphere, Sphere::new(Vec3::new(1.0, -2.0, 0.0), 3.0));
    }

    #[test]
    fn a_vector_is_what_glam_makes_of_it() {
        let (center, radius) = (DVec3::new(0.1, 1e300, -0.0), 0.5);
        let text = serde_json::to_value(Sphere::new(center, radius)).unwrap();
        assert_eq!(text, json!({ "center": center, "radius": radius }));
        let point = Polygon::<DVec3, 1>::new(&[center]).expect("one of one");
        assert_eq!(to_bytes(&point), to_bytes(&[center]));
    }

    fn refused<T: DeserializeOwned + Debug>(value: &Value, because: &str) {
        let error = serde_json::from_value::<T>(value.clone()).expect_err(because).to_string();
        assert!(error.contains(because), "{value}: {error}");
    }

    #[test]
    fn what_is_no_shape_is_refused() {
        let sphere = |center: Value, radius: Value| json!({ "center": center, "radius": radius });
        refused::<Sphere>(&json!({ "center": [0, 0, 0] }), "missing field `radius`");
        refused::<Sphere>(&sphere(json!([0, 0]), json!(1)), "array of length 3");
        refused::<Sphere>(&sphere(json!([0, 0, 0, 0]), json!(1)), "array");
        refused::<Sphere>(&sphere(json!([0, 0, null]), json!(1)), "null");
        refused::<Sphere>(&sphere(json!([0, 0, 0]), json!("inf")), r#"or "NaN""#);
        refused::<Sphere>(&sphere(json!([0, 0, 0]), json!(1e40)), "a number up to ±3.40");
        refused::<Sphere>(&sphere(json!([0, -1e39, 0]), json!(1)), "-1e+39");
        refused::<Sphere>(&sphere(json!([0, 0, 0]), json!(true)), "boolean");
        refused::<Ray>(&json!([[0, 0, 0], [1, 0, 0], 0]), "expected struct Ray with 4 elements");
        refused::<AabbHit<f32>>(
            &json!({ "t_enter": 0, "t_exit": 1, "enter_face": "Top", "exit_face": null }),
            "unknown variant `Top`",
        );
        let text = r#"{"center":[0,0,0],"radius":1e999}"#;
        assert!(serde_json::from_str::<Sphere<DVec3>>(text).is_err());
        // Of an f64, 1e40 is one.
        let sphere: Sphere<DVec3> =
            serde_json::from_value(sphere(json!([0, 0, 0]), json!(1e40))).unwrap();
        assert_eq!(sphere.radius, 1e40);
    }

    #[test]
    fn a_polygon_has_no_more_vertices_than_it_has_room_for() {
        let vertices = json!([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]);
        refused::<Polygon<Vec3, 3>>(
            &vertices,
            "invalid length 4, expected no more than 3 vertices",
        );
        let polygon: Polygon<Vec3, 4> = serde_json::from_value(vertices).unwrap();
        assert_eq!((polygon.vertices().len(), polygon.area()), (4, 1.0));
        let polygon: Polygon<Vec3, 0> = serde_json::from_value(json!([])).unwrap();
        assert_eq!(polygon, Polygon::EMPTY);
        let bytes = to_bytes(&square::<Vec3>());
        assert!(ciborium::from_reader::<Polygon<Vec3, 5>, _>(&*bytes).is_ok());
        assert!(ciborium::from_reader::<Polygon<Vec3, 3>, _>(&*bytes).is_err());
        assert!(ciborium::from_reader::<Polygon<Vec3, 5>, _>(&bytes[..bytes.len() - 1]).is_err());
    }

    #[test]
    fn a_beam_is_one_or_is_refused() {
        let base = json!([[0, 0, 1], [1, 0, 1], [1, 1, 1]]);
        let beam = |apex: Value, base: &Value| json!({ "apex": apex, "base": base });
        let read = |value: &Value| serde_json::from_value::<Beam<Vec3, 3>>(value.clone());
        let expected = read(&beam(json!([0, 0, 0]), &base)).unwrap();
        assert!(expected.contains(Vec3::new(1.5, 0.5, 2.0)));
        // Clockwise as well as counter-clockwise.
        let reversed = json!([[1, 1, 1], [1, 0, 1], [0, 0, 1]]);
        assert_eq!(read(&beam(json!([0, 0, 0]), &reversed)).unwrap(), expected);
        for (apex, base) in [
            (json!([5, 0, 1]), &base),
            (json!(["NaN", 0, 0]), &base),
            (json!([0, 0, "Infinity"]), &base),
            (json!([0, 0, 0]), &json!([])),
            (json!([0, 0, 0]), &json!([[0, 0, 1], [1, 0, 1], [2, 0, 1]])),
        ] {
            refused::<Beam<Vec3, 3>>(&beam(apex, base), "a base without area");
        }
    }

    #[test]
    fn bad_input_that_can_be_read_is_never_hit() {
        let aimed = Ray::new(Vec3::new(0.2, 0.2, -2.0), Vec3::Z);
        fn read<T: DeserializeOwned>(value: Value) -> T {
            serde_json::from_value(value).expect("it is a shape")
        }
        // The same with good numbers is hit.
        let sphere =
            |radius: Value| read::<Sphere>(json!({ "center": [0, 0, 0], "radius": radius }));
        assert!(aimed.hits(&sphere(json!(1))));
        for radius in [json!(-1), json!("NaN"), json!("Infinity")] {
            assert!(!aimed.hits(&sphere(radius)));
        }
        let ray = |direction: Value, t_max: Value| {
            read::<Ray>(
                json!({ "origin": [0.2, 0.2, -2], "direction": direction, "t_min": 0, "t_max": t_max }),
            )
        };
        let triangle = Triangle::new(Vec3::ZERO, Vec3::X, Vec3::Y);
        assert!(ray(json!([0, 0, 1]), json!("Infinity")).hits(&triangle));
        for (direction, t_max) in [
            (json!([0, 0, 0]), json!("Infinity")),
            (json!([0, 0, "NaN"]), json!("Infinity")),
            (json!([0, 0, "Infinity"]), json!("Infinity")),
            (json!([0, 0, 1]), json!("NaN")),
            (json!([0, 0, 1]), json!(-1)),
        ] {
            let ray = ray(direction, t_max);
            assert!(!ray.hits(&triangle) && !ray.hits(&sphere(json!(1))), "{ray:?}");
        }
        let plane = |normal: Value| read::<Plane>(json!({ "normal": normal, "offset": 0 }));
        assert!(aimed.hits(&plane(json!([0, 0, 2]))));
        assert!(!aimed.hits(&plane(json!([0, 0, 0]))) && !aimed.hits(&plane(json!([0, "NaN", 1]))));
        let pyramid = Pyramid::new(
            Vec3::ZERO,
            [[-1, -1], [1, -1], [1, 1], [-1, 1]].map(|[x, y]| Vec3::new(x as f32, y as f32, 2.0)),
        );
        let pyramid = pyramid.expect("it is convex");
        assert!(pyramid.contains(Vec3::Z));
        let mut value = serde_json::to_value(pyramid).unwrap();
        value["normals"][2][1] = json!("NaN");
        assert!(!read::<Pyramid>(value).contains(Vec3::Z));
    }
}

#[cfg(feature = "bytemuck")]
mod cast {
    use super::*;

    /// Of `numbers` numbers and nothing else, as good as an array of them.
    fn pod<T: Pod, Number: Pod>(numbers: usize) {
        assert_eq!(size_of::<T>(), numbers * size_of::<Number>());
        assert_eq!(align_of::<T>(), align_of::<Number>());
    }

    #[test]
    fn shapes_are_as_large_as_their_numbers() {
        macro_rules! check {
            ($v:ty, $number:ty) => {
                pod::<Ray<$v>, $number>(8);
                pod::<Plane<$v>, $number>(4);
                pod::<Sphere<$v>, $number>(4);
                pod::<Aabb<$v>, $number>(6);
                pod::<Triangle<$v>, $number>(9);
                pod::<Pyramid<$v>, $number>(27);
                pod::<Cone<$v>, $number>(10);
            };
        }
        check!(Vec3, f32);
        check!(DVec3, f64);
        pod::<TrianglePack<f32, 8>, f32>(72);
        pod::<TrianglePack<f64, 2>, f64>(18);
        pod::<AabbPack<f32, 16>, f32>(96);
        pod::<AabbPack<f64, 4>, f64>(24);
        // What is aligned to 16 bytes is padded to them.
        fn padded<T: AnyBitPattern>(bytes: usize) {
            assert_eq!((size_of::<T>(), align_of::<T>()), (bytes, 16));
        }
        padded::<Ray<Vec3A>>(48);
        padded::<Plane<Vec3A>>(32);
        padded::<Sphere<Vec3A>>(32);
        padded::<Cone<Vec3A>>(64);
        // glam's vector is `Pod` wherever it is one of the processor's.
        #[cfg(any(target_feature = "sse2", target_feature = "neon"))]
        {
            pod::<Aabb<Vec3A>, Vec3A>(2);
            pod::<Triangle<Vec3A>, Vec3A>(3);
            pod::<Pyramid<Vec3A>, Vec3A>(9);
        }
    }

    #[test]
    fn numbers_follow_each_other_in_the_order_of_the_fields() {
        let ray = Ray::new(Vec3::new(1.0, 2.0, 3.0), Vec3::new(4.0, 5.0, 6.0)).with_range(7.0, 8.0);
        let cone = Cone::new(ray, 9.0, 10.0);
        let numbers = [1.0_f32, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0, 10.0];
        assert_eq!(bytemuck::cast::<Cone, [f32; 10]>(cone), numbers);
        assert_eq!(bytemuck::cast::<[f32; 10], Cone>(numbers), cone);
        let wide: [f64; 10] = numbers.map(f64::from);
        assert_eq!(bytemuck::cast::<[f64; 10], Cone<DVec3>>(wide), cone.into());

        let triangles = [Triangle::new(Vec3::X, Vec3::Y, Vec3::Z); 3];
        let bytes: &[u8] = bytemuck::cast_slice(&triangles);
        assert_eq!(bytes.len(), 3 * 36);
        assert_eq!(bytemuck::cast_slice::<u8, Triangle>(bytes), triangles);

        let padded: Ray<Vec3A> = ray.into();
        let mut words = [f32::NAN; 12];
        words[..3].copy_from_slice(&numbers[..3]);
        words[4..7].copy_from_slice(&numbers[3..6]);
        words[8..10].copy_from_slice(&numbers[6..8]);
        assert_eq!(bytemuck::pod_read_unaligned::<Ray<Vec3A>>(bytemuck::bytes_of(&words)), padded);
    }

    #[test]
    fn packs_are_arrays_by_axis_and_lane() {
        let triangles = [Triangle::new(Vec3::ZERO, Vec3::X, Vec3::Y); 4];
        let pack = TrianglePack::<f32, 4>::from_triangles(&triangles);
        let lanes: [[[f32; 4]; 3]; 3] = bytemuck::cast(pack);
        assert_eq!((lanes[1][0], lanes[2][1], lanes[1][1]), ([1.0; 4], [1.0; 4], [0.0; 4]));
        assert_eq!(bytemuck::cast::<_, TrianglePack<f32, 4>>(lanes).get::<Vec3>(3), triangles[3]);
        let aabb = Aabb::new(DVec3::ZERO, DVec3::new(1.0, 2.0, 3.0));
        let bounds: [[[f64; 2]; 2]; 3] = bytemuck::cast(AabbPack::<f64, 2>::from_aabbs(&[aabb; 2]));
        assert_eq!(bounds, [[[0.0; 2], [1.0; 2]], [[0.0; 2], [2.0; 2]], [[0.0; 2], [3.0; 2]]]);
    }

    #[test]
    fn zeroed_shapes_are_zero() {
        fn check<V: Vector + Zeroable>()
        where
            V::Scalar: Zeroable,
        {
            let zero = V::Scalar::ZERO;
            assert_eq!(Ray::<V>::zeroed(), Ray::new(V::ZERO, V::ZERO).with_range(zero, zero));
            assert_eq!(Plane::<V>::zeroed(), Plane { normal: V::ZERO, offset: zero });
            assert_eq!(Sphere::<V>::zeroed(), Sphere::new(V::ZERO, zero));
            assert_eq!(Aabb::<V>::zeroed(), Aabb::new(V::ZERO, V::ZERO));
            assert_eq!(Triangle::<V>::zeroed(), Triangle::default());
            assert_eq!(Cone::<V>::zeroed(), Cone::new(Ray::zeroed(), zero, zero));
            let (corners, normals) = ([V::ZERO; 4], [V::ZERO; 4]);
            assert_eq!(Pyramid::<V>::zeroed(), Pyramid { apex: V::ZERO, corners, normals });
            assert_eq!(Polygon::<V, 7>::zeroed(), Polygon::EMPTY);
        }
        for_every_vector!(check);
    }
}

#[cfg(all(feature = "approx", feature = "serde"))] // serde reaches each number
mod close {
    use super::*;

    /// Every number of a value, one after the other, moved by a step: the values that differ in that number alone.
    fn moved<T: Serialize + DeserializeOwned>(value: &T, step: f64) -> Vec<T> {
        fn leaves<'a>(value: &'a mut Value, all: &mut Vec<&'a mut Value>) {
            match value {
                Value::Array(values) => values.iter_mut().for_each(|value| leaves(value, all)),
                Value::Object(values) => values.values_mut().for_each(|value| leaves(value, all)),
                Value::Number(number) if number.is_f64() => all.push(value),
                _ => {}
            }
        }
        let value = serde_json::to_value(value).expect("it can be written");
        let count = {
            let (mut value, mut all) = (value.clone(), vec![]);
            leaves(&mut value, &mut all);
            all.len()
        };
        let changed = (0..count).map(|index| {
            let (mut value, mut all) = (value.clone(), vec![]);
            leaves(&mut value, &mut all);
            let number = all[index].as_f64().expect("it is a number");
            *all[index] = json!(number + step);
            serde_json::from_value(value).expect("it is as good as before")
        });
        changed.collect()
    }

    #[test]
    fn every_number_counts() {
        fn one<T>(value: T)
        where
            T: Serialize + DeserializeOwned + Debug + Copy,
            T: UlpsEq<Epsilon: From<f32>> + RelativeEq,
        {
            let epsilon = |x: f32| T::Epsilon::from(x);
            assert!(value.abs_diff_eq(&value, epsilon(0.0)), "{value:?}");
            assert!(value.ulps_eq(&value, epsilon(0.0), 0), "{value:?}");
            let near = moved(&value, 1.0 / 1024.0);
            assert!(!near.is_empty());
            for near in near {
                // 1/1024 is exact beside such numbers: a relative difference from 1/9217 to 1/255.
                assert!(value.abs_diff_eq(&near, epsilon(1.0 / 512.0)), "{near:?}");
                assert!(!value.abs_diff_eq(&near, epsilon(1.0 / 2048.0)), "{near:?}");
                assert!(value.relative_eq(&near, epsilon(0.0), epsilon(1.0 / 128.0)), "{near:?}");
                assert!(!value.relative_eq(&near, epsilon(0.0), epsilon(1.0 / 16384.0)));
                // 1/1024 is at least 2¹⁰ ulps of numbers below 16 in f32, and is within the epsilon.
                assert!(!value.ulps_eq(&near, epsilon(0.0), 1000), "{near:?}");
                assert!(value.ulps_eq(&near, epsilon(1.0 / 512.0), 0), "{near:?}");
            }
        }
        for_every_type!(one, Vec3);
        for_every_type!(one, Vec3A);
        for_every_type!(one, DVec3);
    }

    #[test]
    fn what_is_no_number_has_to_be_equal() {
        let far = 1e30_f32; // any number is close
        let hit = TriangleHit { t: 1.0, u: 0.5, v: 0.5, front: true };
        assert!(hit.abs_diff_eq(&TriangleHit { t: 9.0, ..hit }, far));
        assert!(hit.abs_diff_ne(&TriangleHit { front: false, ..hit }, far));
        let hit = SphereHit { t: 1.0, leaving: true };
        assert!(hit.abs_diff_ne(&SphereHit { leaving: false, ..hit }, far));
        let (enter_face, exit_face) = (Some(Face::NegX), None);
        let hit = AabbHit { t_enter: 1.0, t_exit: 2.0, enter_face, exit_face };
        assert!(hit.abs_diff_ne(&AabbHit { enter_face: None, ..hit }, far));
        assert!(hit.abs_diff_ne(&AabbHit { exit_face: Some(Face::NegX), ..hit }, far));
        let hit = PolygonHit { t: 1.0, triangle: 1, u: 0.5, v: 0.5, front: true };
        assert!(hit.abs_diff_ne(&PolygonHit { triangle: 0, ..hit }, far));
        assert!(hit.abs_diff_ne(&PolygonHit { front: false, ..hit }, far));
        assert!(PlaneHit::At(1.0).abs_diff_ne(&PlaneHit::Contained, far));
        assert!(PlaneHit::Contained.abs_diff_eq(&PlaneHit::Contained, 0.0_f32));
        let polygon = |count| Polygon::<Vec3, 3>::new(&[Vec3::ZERO; 3][..count]);
        let [two, three] = [2, 3].map(|count| polygon(count).expect("it has room"));
        assert!(two.abs_diff_ne(&three, far) && three.abs_diff_eq(&three, 0.0));
    }

    #[test]
    fn equal_infinities_are_close_and_a_nan_is_not() {
        let ray = Ray::new(Vec3::ZERO, Vec3::X);
        let other = Ray::new(Vec3::ZERO, Vec3::X * 1.001);
        approx::assert_abs_diff_eq!(ray, other, epsilon = 0.01);
        approx::assert_relative_eq!(ray, other, max_relative = 0.01);
        approx::assert_ulps_eq!(ray, other, max_ulps = 10_000); // 0.001 is about 8389 ulps of 1
        approx::assert_abs_diff_ne!(ray, ray.with_range(0.0, 1e38), epsilon = 0.01);
        approx::assert_abs_diff_ne!(ray, ray.with_range(f32::NEG_INFINITY, f32::INFINITY));
        let nan = ray.with_range(0.0, f32::NAN);
        assert!(nan.abs_diff_ne(&nan, 1.0) && nan.relative_ne(&nan, 1.0, 1.0));
        assert!(nan.ulps_ne(&nan, 1.0, u32::MAX));
    }

    #[test]
    fn defaults_are_those_of_the_scalar() {
        assert_eq!(Ray::<Vec3A>::default_epsilon(), f32::EPSILON);
        assert_eq!(Aabb::<DVec3>::default_epsilon(), f64::EPSILON);
        assert_eq!(Sphere::<DVec3>::default_max_relative(), f64::EPSILON);
        assert_eq!(TriangleHit::<f32>::default_max_ulps(), f32::default_max_ulps());
    }
}

mod drawn {
    use super::*;

    /// Vectors whose components are finite and no farther from zero than that, give or take the rounding of as much.
    fn reach<V: Vector>(vectors: &[V], extent: f64) {
        for v in vectors {
            assert!(v.is_finite());
            let largest: f64 = Coordinates::abs(*v).max_element().into();
            let epsilon: f64 = V::Scalar::EPSILON.into();
            // Sums of three, of factors below 1: no more than four roundings, each of EPSILON/2.
            assert!(largest <= extent * (1.0 + 2.0 * epsilon), "{v:?}");
        }
    }

    fn of<T: Arbitrary<Parameters = Extent>>(mut check: impl FnMut(T)) {
        draw(500, &any::<T>(), &mut check);
    }

    #[test]
    fn shapes_are_well_formed() {
        fn check<V: Vector>() {
            let zero = V::Scalar::ZERO;
            of(|Ray::<V> { origin, direction, t_min, t_max }| {
                reach(&[origin, direction], 1024.0);
                assert!(direction != V::ZERO && t_min <= t_max);
            });
            of(|Plane::<V> { normal, offset }| {
                reach(&[normal, V::splat(offset)], 1024.0);
                assert!(Plane::from_hesse(normal, offset).is_some());
            });
            of(|Sphere::<V> { center, radius }| {
                reach(&[center, V::splat(radius)], 1024.0);
                assert!(radius >= zero);
            });
            of(|aabb: Aabb<V>| {
                reach(&[aabb.min, aabb.max], 1024.0);
                assert!(!aabb.is_empty());
            });
            of(|triangle: Triangle<V>| {
                reach(&<[V; 3]>::from(triangle), 1024.0);
                assert!(triangle.area() > zero);
            });
            of(|Cone::<V> { ray, radius, spread }| {
                reach(&[ray.origin, V::splat(radius), V::splat(spread)], 1024.0);
                assert!(ray.t_min <= ray.t_max && ray.t_max >= zero);
                assert!(radius >= zero && spread >= zero && radius.max(spread) > zero);
            });
            of(|pyramid: Pyramid<V>| {
                reach(&[pyramid.apex], 1024.0);
                assert!(Pyramid::new(pyramid.apex, pyramid.corners) == Some(pyramid));
            });
            of(|polygon: Polygon<V, 7>| {
                reach(polygon.vertices(), 3.0 * 1024.0);
                assert!((3..=7).contains(&polygon.vertices().len()) && polygon.area() > zero);
            });
            of(|beam: Beam<V, 4>| {
                reach(&[beam.apex], 1024.0);
                assert_eq!(Beam::new(beam.apex, beam.base), Some(beam));
            });
            of(|polygon: Polygon<V, 2>| assert_eq!(polygon, Polygon::EMPTY));
        }
        for_every_vector!(check);
    }

    #[test]
    fn three_zeros_make_no_normal_and_two_no_cone() {
        // A number is zero one time in 34: three are once in 39,304, two once in 1156. Each comes up.
        draw(200_000, &any::<Plane>(), |plane| assert!(plane.normal != Vec3::ZERO));
        draw(10_000, &any::<Cone>(), |cone| assert!(cone.radius.max(cone.spread) > 0.0));
    }

    #[test]
    fn polygons_are_convex_and_planar() {
        of(|polygon: Polygon<DVec3, 7>| {
            let vertices = polygon.vertices();
            let normal = polygon.normal().normalize();
            for i in 0..vertices.len() {
                let [a, b, c] = [0, 1, 2].map(|next| vertices[(i + next) % vertices.len()]);
                // The coordinates are off by a few times their rounding, 2⁻⁵³ · 3072 < 4e-13, and so are the distances, of
                // which the three products of a normal of length 1 and the sines of its angles make no more than 100 times that,
                // but where the ellipse is a needle.
                if polygon.area() > 1.0 {
                    assert!(normal.dot(b - a).abs() < 1e-8 * (1.0 + 1e6 / polygon.area()));
                    assert!(normal.dot((b - a).cross(c - b)) > 0.0, "{polygon:?}");
                }
            }
        });
    }

    #[test]
    fn every_kind_of_range_and_face_is_drawn() {
        let mut kinds = [0; 4];
        of(|ray: Ray| {
            let kind = match (ray.t_min, ray.t_max) {
                (0.0, f32::INFINITY) => 0,
                (0.0, 1.0) => 1,
                (f32::NEG_INFINITY, f32::INFINITY) => 2,
                _ => 3,
            };
            kinds[kind] += 1;
        });
        // Of 500, with chances of 1/2 and 1/6 a deviation of 11 and 8: five of them.
        assert!((195..305).contains(&kinds[0]), "{kinds:?}");
        assert!(kinds[1..].iter().all(|kind| (43..124).contains(kind)), "{kinds:?}");
        let mut faces = std::collections::HashSet::new();
        draw(500, &any::<Face>(), |face| {
            faces.insert(face);
        });
        assert_eq!(faces.len(), 6);
    }

    #[test]
    fn half_of_the_coordinates_are_multiples_of_an_eighth_of_the_extent() {
        for extent in [2.0_f64.powi(-30), 1.0, 1024.0, 2.0_f64.powi(30)] {
            let mut multiples = 0;
            draw(500, &any_with::<Triangle<DVec3>>(Extent(extent)), |triangle| {
                for v in <[DVec3; 3]>::from(triangle) {
                    reach(&[v], extent);
                    multiples +=
                        v.to_array().iter().filter(|x| (*x / extent * 8.0).fract() == 0.0).count();
                }
            });
            // Of 4500 a half, with a deviation of 34, less some collinear ones, which are mostly multiples.
            assert!((2000..2420).contains(&multiples), "{multiples} of {extent}");
        }
    }

    #[test]
    fn shapes_shrink_to_multiples_of_an_eighth() {
        let failure = runner(100).run(&any::<Sphere>(), |sphere| {
            proptest::prop_assert!(sphere.radius < 100.0);
            Ok(())
        });
        let Err(TestError::Fail(_, sphere)) = failure else { panic!("{failure:?}") };
        assert_eq!(sphere, Sphere::new(Vec3::ZERO, 128.0));
    }

    #[test]
    fn an_extent_has_bounds() {
        for bad in [0.0, -1.0, f64::NAN, f64::INFINITY, 2.0_f64.powi(31), 2.0_f64.powi(-31)] {
            let drawn = std::panic::catch_unwind(|| any_with::<Aabb>(Extent(bad)));
            assert!(drawn.is_err(), "{bad}");
        }
    }
}
