//! proptest's `Arbitrary` for the shapes: one of each, well-formed. (The testkit draws pairs, and bad input too.)

use std::f64::consts::TAU;

use proptest::array::{uniform2, uniform3};
use proptest::collection::vec;
use proptest::prelude::{Arbitrary, BoxedStrategy, Just, Strategy, any_with};
use proptest::prop_oneof;
use proptest::sample::select;

use crate::{
    Aabb, Beam, Cone, Face, Number, Plane, Polygon, Pyramid, Ray, Scalar, Sphere, Triangle, Vector,
};

/// How far from zero the coordinates of a shape reach: the parameter of `any_with`, from 2⁻³⁰ to 2³⁰, by default 1024.
///
/// Of the coordinates one half are multiples of an eighth of the extent, so that shapes touch, align and
/// coincide; the others are any floats in between, with all their digits. All are in [−extent, extent], but for those that are made of
/// others, in [−3·extent, 3·extent] (within rounding). A shape shrinks towards zero, and to those multiples.
///
/// | shape | what is drawn |
/// |---|---|
/// | `Ray` | a direction that is not zero, and half of the time t in [0, ∞], else in [0, 1], (−∞, ∞), or between two coordinates |
/// | `Plane` | a normal that is not zero |
/// | `Sphere` | a radius of at least zero |
/// | `Aabb` | not empty, but perhaps flat |
/// | `Triangle` | with an area, as computed |
/// | `Cone` | around such a ray, of which the range holds a t that is not negative; radius and spread not negative, nor both zero |
/// | `Pyramid` | through a parallelogram, with corners made of three vectors |
/// | `Polygon` | from three vertices to N on an ellipse, made of three vectors, with an area, as computed; the empty one if N is less than 3 |
/// | `Beam` | through such a polygon, from a point outside of its plane; N is at least 3 |
///
/// ```
/// use isect::interop::Extent;
/// use isect::{Ray, Triangle, glam::DVec3, overlap, ray::triangle::exact};
/// use proptest::prelude::*;
///
/// proptest!(|(ray: Ray<DVec3>, triangle in any_with::<Triangle<DVec3>>(Extent(1.0)))| {
///     prop_assert!(triangle.area() > 0.0);
///     prop_assert_eq!(ray.hits(&triangle), exact::classify(&ray, &triangle) != exact::Verdict::Miss);
/// });
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extent(pub f64);

impl Default for Extent {
    fn default() -> Self {
        Self(1024.0)
    }
}

impl Extent {
    /// A coordinate, of double precision.
    ///
    /// # Panics
    ///
    /// If the extent is out of its range.
    fn number(self) -> BoxedStrategy<f64> {
        let Self(extent) = self;
        let largest = f64::from(1 << 30);
        assert!(
            (1.0 / largest..=largest).contains(&extent),
            "the extent {extent} is not in [2^-30, 2^30]"
        );
        prop_oneof![
            (-8..=8).prop_map(move |step| f64::from(step) * extent / 8.0),
            -extent..=extent,
        ]
        .boxed()
    }

    fn scalar<T: Scalar>(self) -> BoxedStrategy<T> {
        self.number().prop_map(|x| T::ONE.lit(x)).boxed()
    }

    fn vector<V: Vector>(self) -> BoxedStrategy<V> {
        uniform3(self.scalar()).prop_map(|[x, y, z]| V::new(x, y, z)).boxed()
    }

    /// Not zero: (0, 0, extent) instead.
    fn direction<V: Vector>(self) -> BoxedStrategy<V> {
        let [zero, extent] = [0.0, self.0].map(|x| V::Scalar::ONE.lit(x));
        let instead = V::new(zero, zero, extent);
        self.vector().prop_map(move |v| if v == V::ZERO { instead } else { v }).boxed()
    }

    /// In ascending order.
    fn range<T: Scalar>(self) -> BoxedStrategy<[T; 2]> {
        uniform2(self.scalar()).prop_map(|[a, b]: [T; 2]| [a.min(b), a.max(b)]).boxed()
    }
}

/// `Arbitrary` with an [`Extent`].
macro_rules! arbitrary {
    ([$($generics:tt)+] $shape:ty, |$extent:ident| $strategy:expr) => {
        impl<$($generics)+> Arbitrary for $shape {
            type Parameters = Extent;
            type Strategy = BoxedStrategy<Self>;
            fn arbitrary_with($extent: Extent) -> Self::Strategy {
                $strategy.boxed()
            }
        }
    };
}

arbitrary!([V: Vector] Ray<V>, |extent| {
    let [zero, one, infinity] = [V::Scalar::ZERO, V::Scalar::ONE, V::Scalar::INFINITY];
    let range = prop_oneof![
        3 => Just([zero, infinity]),
        1 => Just([zero, one]),
        1 => Just([-infinity, infinity]),
        1 => extent.range(),
    ];
    let line = (extent.vector(), extent.direction());
    (line, range).prop_map(|((origin, direction), [t_min, t_max])| {
        Self::new(origin, direction).with_range(t_min, t_max)
    })
});

arbitrary!([V: Vector] Plane<V>, |extent| {
    (extent.direction(), extent.scalar()).prop_map(|(normal, offset)| Self { normal, offset })
});

arbitrary!([V: Vector] Sphere<V>, |extent| {
    let radius = extent.scalar().prop_map(Number::abs);
    (extent.vector(), radius).prop_map(|(center, radius)| Self { center, radius })
});

arbitrary!([V: Vector] Aabb<V>, |extent| {
    uniform2(extent.vector()).prop_map(Self::from_points)
});

arbitrary!([V: Vector] Triangle<V>, |extent| {
    let triangle = uniform3(extent.vector()).prop_map(Self::from);
    triangle.prop_filter("collinear", |triangle| triangle.area() > V::Scalar::ZERO)
});

arbitrary!([V: Vector] Cone<V>, |extent| {
    let size = || extent.scalar::<V::Scalar>().prop_map(Number::abs);
    (any_with::<Ray<V>>(extent), size(), size()).prop_map(|(ray, radius, spread)| {
        let (zero, one) = (V::Scalar::ZERO, V::Scalar::ONE);
        let ray = ray.with_range(ray.t_min, ray.t_max.max(zero));
        let is_ray = radius == zero && spread == zero;
        Self { ray, radius: if is_ray { one } else { radius }, spread }
    })
});

arbitrary!([V: Vector] Pyramid<V>, |extent| {
    (extent.vector(), uniform3(extent.vector())).prop_filter_map(
        "flat",
        |(apex, [center, x, y]): (V, [V; 3])| {
            Self::new(apex, [center + x + y, center - x + y, center - x - y, center + x - y])
        },
    )
});

arbitrary!([V: Vector, const N: usize] Polygon<V, N>, |extent| {
    if N < 3 {
        return Just(Self::EMPTY).boxed();
    }
    // By how much of the step between them the vertices are moved on: their order stays, and their distance.
    let moves = vec(0.0..0.75, 3..=N);
    (uniform3(extent.vector()), moves).prop_filter_map(
        "without area",
        |([center, x, y], moves): ([V; 3], Vec<f64>)| {
            let one = V::Scalar::ONE;
            let step = TAU / moves.len() as f64;
            let vertices = moves.iter().zip(0..).map(|(by, i)| {
                let (sin, cos) = ((f64::from(i) + by) * step).sin_cos();
                center + x * one.lit(cos) + y * one.lit(sin)
            });
            let polygon = Self::new(&vertices.collect::<Vec<_>>())?;
            (polygon.area() > V::Scalar::ZERO).then_some(polygon)
        },
    )
});

arbitrary!([V: Vector, const N: usize] Beam<V, N>, |extent| {
    (extent.vector(), any_with::<Polygon<V, N>>(extent))
        .prop_filter_map("flat", |(apex, base)| Self::new(apex, base))
});

impl Arbitrary for Face {
    type Parameters = ();
    type Strategy = BoxedStrategy<Self>;
    fn arbitrary_with((): ()) -> Self::Strategy {
        select(vec![Self::NegX, Self::PosX, Self::NegY, Self::PosY, Self::NegZ, Self::PosZ]).boxed()
    }
}
