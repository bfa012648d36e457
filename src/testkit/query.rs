//! A pair of shapes of which a kernel is asked: drawn at random, decided exactly, taken apart and printed.

use fastrand::Rng;

use super::oracle::{self, PlaneVerdict};
use super::shapes::{self, array, scalar, vector, vertices};
use super::{generators, verdict};
use crate::{Aabb, Plane, Ray, Sphere, Triangle, Vector};

/// Two shapes, in the order in which a kernel takes them.
pub(super) trait Query: Copy + std::fmt::Debug {
    /// Of both shapes.
    type Vector: Vector;

    /// A hard case, of finite numbers.
    fn random(rng: &mut Rng) -> Self;

    /// The ray, if one of them is one.
    fn ray_mut(&mut self) -> Option<&mut Ray<Self::Vector>>;

    /// Whether a t is finite and in the range of the ray, if there is one.
    fn has_in_range(mut self, t: f64) -> bool {
        self.ray_mut().is_none_or(|ray| {
            let range: [f64; 2] = [ray.t_min.into(), ray.t_max.into()];
            t.is_finite() && range[0] <= t && t <= range[1]
        })
    }

    /// Whether the shapes have a point in common, exactly.
    fn touches(&self) -> bool;

    /// Whether the t that a kernel is to report lies in the closed range; `None` where there is no one such t.
    fn t_in(&self, lo: f64, hi: f64) -> Option<bool>;

    /// Whether both are proper shapes; if not, the verdict is a miss.
    fn is_valid(&self) -> bool;

    /// All numbers, exactly.
    fn numbers(&self) -> Vec<f64>;

    /// The query of such numbers.
    ///
    /// # Panics
    ///
    /// If there are not as many as the query has.
    fn from_numbers(numbers: &[f64]) -> Self;

    /// Declarations of both shapes in Rust, to the last bit.
    fn source(&self) -> String;
}

/// A hard case, or one time in 32 such with a number replaced by any at all.
pub(super) fn random<Q: Query>(rng: &mut Rng) -> Q {
    let query = Q::random(rng);
    if rng.u8(..32) != 0 {
        return query;
    }
    let mut numbers = query.numbers();
    let index = rng.usize(..numbers.len());
    numbers[index] = generators::hostile(rng);
    Q::from_numbers(&numbers)
}

/// By what the single-precision numbers of a case are multiplied, to reach all that a scalar can hold.
struct Scale {
    points: f64,
    directions: f64,
}

impl Scale {
    /// Powers of two, one time in four; in double precision also a third, which fills the mantissas and moves what
    /// coincided a rounding apart.
    fn random<V: Vector>(rng: &mut Rng) -> Self {
        let is_single = is_single::<V>();
        let most = if is_single { 60 } else { 900 };
        let part = if !is_single && rng.u8(..4) == 0 { 1.0 / 3.0 } else { 1.0 };
        let is_moved = rng.u8(..4) == 0;
        let mut factor = || if is_moved { part * 2f64.powi(rng.i32(-most..=most)) } else { part };
        Self { points: factor(), directions: factor() }
    }

    fn ray<V: Vector>(&self, ray: &oracle::Ray) -> Ray<V> {
        // One after the other: the quotient of the factors may be no number.
        let t = |x| {
            let scaled = multiplied::<V>(x, self.points);
            scalar(multiplied::<V>(scaled, 1.0 / self.directions))
        };
        Ray::new(
            self.point(ray.origin),
            vector(ray.direction.map(|x| multiplied::<V>(x, self.directions))),
        )
        .with_range(t(ray.t_min), t(ray.t_max))
    }

    fn point<V: Vector>(&self, p: [f64; 3]) -> V {
        vector(p.map(|x| multiplied::<V>(x, self.points)))
    }
}

fn is_single<V: Vector>() -> bool {
    size_of::<V::Scalar>() == 4
}

/// The product of a number and a factor, finite if the number is.
fn multiplied<V: Vector>(x: f64, factor: f64) -> f64 {
    match x * factor {
        _ if x.is_infinite() => x,
        product if is_single::<V>() => generators::single(product),
        product => product.clamp(f64::MIN, f64::MAX),
    }
}

/// Takes numbers off the front of a slice.
struct Numbers<'a>(&'a [f64]);

impl Numbers<'_> {
    fn next<const N: usize>(&mut self) -> [f64; N] {
        let (first, rest) = self.0.split_first_chunk().expect("as many numbers as the query has");
        self.0 = rest;
        *first
    }

    fn vector<V: Vector>(&mut self) -> V {
        vector(self.next())
    }

    fn ray<V: Vector>(&mut self) -> Ray<V> {
        let (origin, direction, [t_min, t_max]) = (self.vector(), self.vector(), self.next());
        Ray::new(origin, direction).with_range(scalar(t_min), scalar(t_max))
    }

    fn triangle<V: Vector>(&mut self) -> Triangle<V> {
        Triangle::new(self.vector(), self.vector(), self.vector())
    }

    fn aabb<V: Vector>(&mut self) -> Aabb<V> {
        Aabb::new(self.vector(), self.vector())
    }
}

fn ray_numbers<V: Vector>(ray: &Ray<V>) -> Vec<f64> {
    let mut numbers = [array(ray.origin), array(ray.direction)].concat();
    numbers.extend([ray.t_min.into(), ray.t_max.into()]);
    numbers
}

/// A number in Rust, to the last bit.
#[expect(clippy::cast_possible_truncation, reason = "the number is one of single precision")]
fn number_source<V: Vector>(x: f64) -> String {
    if is_single::<V>() {
        format!("f32::from_bits({:#010x})", (x as f32).to_bits())
    } else {
        format!("f64::from_bits({:#018x})", x.to_bits())
    }
}

fn vector_source<V: Vector>(v: V) -> String {
    let [x, y, z] = array(v).map(number_source::<V>);
    format!("{}::new({x}, {y}, {z})", shapes::name::<V>())
}

/// A ray's declaration in Rust.
pub(super) fn ray_source<V: Vector>(ray: &Ray<V>) -> String {
    let [t_min, t_max] = [ray.t_min, ray.t_max].map(|t| number_source::<V>(t.into()));
    format!(
        "let ray = Ray::new(\n    {},\n    {},\n)\n.with_range({t_min}, {t_max});\n",
        vector_source(ray.origin),
        vector_source(ray.direction),
    )
}

/// A triangle in Rust.
pub(super) fn triangle_source<V: Vector>(triangle: &Triangle<V>) -> String {
    let [a, b, c] = <[V; 3]>::from(*triangle).map(vector_source);
    format!("Triangle::new(\n    {a},\n    {b},\n    {c},\n)")
}

fn aabb_source<V: Vector>(aabb: &Aabb<V>) -> String {
    let [min, max] = [aabb.min, aabb.max].map(vector_source);
    format!("let aabb = Aabb::new(\n    {min},\n    {max},\n);\n")
}

impl<V: Vector> Query for (Ray<V>, Triangle<V>) {
    type Vector = V;

    fn random(rng: &mut Rng) -> Self {
        let (ray, triangle) = generators::ray_triangle(rng);
        let scale = Scale::random::<V>(rng);
        (scale.ray(&ray), triangle.map(|v| scale.point::<V>(v)).into())
    }

    fn ray_mut(&mut self) -> Option<&mut Ray<V>> {
        Some(&mut self.0)
    }

    fn touches(&self) -> bool {
        verdict::ray_triangle(&self.0, &self.1).hits()
    }

    fn t_in(&self, lo: f64, hi: f64) -> Option<bool> {
        // In the plane, and where there is none, the line does not cross it.
        oracle::triangle_t_in(&(&self.0).into(), vertices(&self.1), lo, hi)
    }

    fn is_valid(&self) -> bool {
        oracle::Ray::from(&self.0).is_valid() && oracle::is_finite(&vertices(&self.1))
    }

    fn numbers(&self) -> Vec<f64> {
        [ray_numbers(&self.0).as_slice(), vertices(&self.1).as_flattened()].concat()
    }

    fn from_numbers(numbers: &[f64]) -> Self {
        let mut numbers = Numbers(numbers);
        (numbers.ray(), numbers.triangle())
    }

    fn source(&self) -> String {
        format!("{}let triangle = {};\n", ray_source(&self.0), triangle_source(&self.1))
    }
}

impl<V: Vector> Query for (Ray<V>, Aabb<V>) {
    type Vector = V;

    fn random(rng: &mut Rng) -> Self {
        let (ray, min, max) = generators::ray_aabb(rng);
        let scale = Scale::random::<V>(rng);
        (scale.ray(&ray), Aabb::new(scale.point(min), scale.point(max)))
    }

    fn ray_mut(&mut self) -> Option<&mut Ray<V>> {
        Some(&mut self.0)
    }

    fn touches(&self) -> bool {
        verdict::ray_aabb(&self.0, &self.1)
    }

    /// A line may come from infinity, in a box without bounds.
    fn has_in_range(self, t: f64) -> bool {
        let range: [f64; 2] = [self.0.t_min.into(), self.0.t_max.into()];
        range[0] <= t && t <= range[1] && t < f64::INFINITY
    }

    fn t_in(&self, lo: f64, hi: f64) -> Option<bool> {
        let (min, max) = (array(self.1.min), array(self.1.max));
        Some(oracle::aabb_enter_in(&(&self.0).into(), min, max, lo, hi))
    }

    fn is_valid(&self) -> bool {
        oracle::Ray::from(&self.0).is_valid()
            && oracle::is_box(array(self.1.min), array(self.1.max))
    }

    fn numbers(&self) -> Vec<f64> {
        [ray_numbers(&self.0).as_slice(), &array(self.1.min), &array(self.1.max)].concat()
    }

    fn from_numbers(numbers: &[f64]) -> Self {
        let mut numbers = Numbers(numbers);
        (numbers.ray(), numbers.aabb())
    }

    fn source(&self) -> String {
        ray_source(&self.0) + &aabb_source(&self.1)
    }
}

impl<V: Vector> Query for (Ray<V>, Sphere<V>) {
    type Vector = V;

    fn random(rng: &mut Rng) -> Self {
        let (ray, center, radius) = generators::ray_sphere(rng);
        let scale = Scale::random::<V>(rng);
        let radius = scalar(multiplied::<V>(radius, scale.points));
        (scale.ray(&ray), Sphere::new(scale.point(center), radius))
    }

    fn ray_mut(&mut self) -> Option<&mut Ray<V>> {
        Some(&mut self.0)
    }

    fn touches(&self) -> bool {
        verdict::ray_sphere(&self.0, &self.1)
    }

    fn t_in(&self, lo: f64, hi: f64) -> Option<bool> {
        // Some root lies there, and what is before it and in range is none.
        let ray = oracle::Ray::from(&self.0);
        let hits = |t_min, t_max| {
            let ray = oracle::Ray { t_min, t_max, ..ray };
            oracle::sphere(&ray, array(self.1.center), self.1.radius.into())
        };
        Some(hits(lo, hi) && !(ray.t_min < lo && hits(ray.t_min, lo.next_down())))
    }

    fn is_valid(&self) -> bool {
        let Sphere { center, radius } = self.1;
        let radius: f64 = radius.into();
        oracle::Ray::from(&self.0).is_valid()
            && oracle::is_finite(&[array(center), [radius; 3]])
            && radius >= 0.0
    }

    fn numbers(&self) -> Vec<f64> {
        let radius = [self.1.radius.into()];
        [ray_numbers(&self.0).as_slice(), &array(self.1.center), &radius].concat()
    }

    fn from_numbers(numbers: &[f64]) -> Self {
        let mut numbers = Numbers(numbers);
        let (ray, center, [radius]) = (numbers.ray(), numbers.vector(), numbers.next());
        (ray, Sphere::new(center, scalar(radius)))
    }

    fn source(&self) -> String {
        let Sphere { center, radius } = self.1;
        let (center, radius) = (vector_source(center), number_source::<V>(radius.into()));
        format!("{}let sphere = Sphere::new({center}, {radius});\n", ray_source(&self.0))
    }
}

impl<V: Vector> Query for (Ray<V>, Plane<V>) {
    type Vector = V;

    fn random(rng: &mut Rng) -> Self {
        let (ray, normal, offset) = generators::ray_plane(rng);
        let scale = Scale::random::<V>(rng);
        let offset = scalar(multiplied::<V>(offset, scale.points));
        (scale.ray(&ray), Plane { normal: vector(normal), offset })
    }

    fn ray_mut(&mut self) -> Option<&mut Ray<V>> {
        Some(&mut self.0)
    }

    fn touches(&self) -> bool {
        verdict::ray_plane(&self.0, &self.1) != PlaneVerdict::Miss
    }

    fn t_in(&self, lo: f64, hi: f64) -> Option<bool> {
        let ray = oracle::Ray { t_min: lo, t_max: hi, ..(&self.0).into() };
        match oracle::plane(&ray, array(self.1.normal), self.1.offset.into()) {
            PlaneVerdict::At => Some(true),
            PlaneVerdict::Miss => Some(false),
            PlaneVerdict::Contained => None,
        }
    }

    fn is_valid(&self) -> bool {
        let (normal, offset) = (array(self.1.normal), self.1.offset.into());
        oracle::Ray::from(&self.0).is_valid()
            && oracle::is_finite(&[normal, [offset; 3]])
            && normal != [0.0; 3]
    }

    fn numbers(&self) -> Vec<f64> {
        let offset = [self.1.offset.into()];
        [ray_numbers(&self.0).as_slice(), &array(self.1.normal), &offset].concat()
    }

    fn from_numbers(numbers: &[f64]) -> Self {
        let mut numbers = Numbers(numbers);
        let (ray, normal, [offset]) = (numbers.ray(), numbers.vector(), numbers.next());
        (ray, Plane { normal, offset: scalar(offset) })
    }

    fn source(&self) -> String {
        let Plane { normal, offset } = self.1;
        let (normal, offset) = (vector_source(normal), number_source::<V>(offset.into()));
        format!(
            "{}let plane = Plane {{ normal: {normal}, offset: {offset} }};\n",
            ray_source(&self.0)
        )
    }
}

impl<V: Vector> Query for (Triangle<V>, Aabb<V>) {
    type Vector = V;

    fn random(rng: &mut Rng) -> Self {
        let (triangle, min, max) = generators::triangle_aabb(rng);
        let scale = Scale::random::<V>(rng);
        let aabb = Aabb::new(scale.point(min), scale.point(max));
        (triangle.map(|v| scale.point::<V>(v)).into(), aabb)
    }

    fn ray_mut(&mut self) -> Option<&mut Ray<V>> {
        None
    }

    fn touches(&self) -> bool {
        verdict::triangle_aabb(&self.0, &self.1)
    }

    fn t_in(&self, _: f64, _: f64) -> Option<bool> {
        None
    }

    fn is_valid(&self) -> bool {
        oracle::is_finite(&vertices(&self.0))
            && oracle::is_box(array(self.1.min), array(self.1.max))
    }

    fn numbers(&self) -> Vec<f64> {
        [vertices(&self.0).as_flattened(), &array(self.1.min), &array(self.1.max)].concat()
    }

    fn from_numbers(numbers: &[f64]) -> Self {
        let mut numbers = Numbers(numbers);
        (numbers.triangle(), numbers.aabb())
    }

    fn source(&self) -> String {
        format!("let triangle = {};\n{}", triangle_source(&self.0), aabb_source(&self.1))
    }
}
