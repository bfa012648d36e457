//! Queries drawn from a fuzzer's bytes, and the rules that hold for all kernels.

use isect::testkit::oracle::PlaneVerdict;
use isect::testkit::verdict;
use isect::{Aabb, Cone, Plane, Polygon, Pyramid, Ray, Scalar, Sphere, Triangle, Vector};
use libfuzzer_sys::arbitrary::{self, Arbitrary, Unstructured};

/// A float that bytes can make.
pub trait Float: Scalar {
    /// The float with these bits; the upper ones are dropped where there are too many.
    fn from_raw_bits(bits: u64) -> Self;
}

impl Float for f32 {
    fn from_raw_bits(bits: u64) -> Self {
        Self::from_bits(bits as u32)
    }
}

impl Float for f64 {
    fn from_raw_bits(bits: u64) -> Self {
        Self::from_bits(bits)
    }
}

/// What the floats of a query are like. Random bits alone would seldom get past the first
/// comparison: they hardly ever meet.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Style {
    /// Any bits.
    Bits,
    /// Integers from −8 to 7: every product in a kernel is exact, and much of it meets.
    Integers,
    /// Powers of two of either sign, with any exponent, but small ones more often.
    PowersOfTwo,
    /// A new style for each float.
    Mixed,
}

/// Two shapes, in single or in double precision.
#[derive(Debug)]
pub enum Query<S, D> {
    /// To be asked with `Vec3` and with `Vec3A`, which have to agree.
    Single {
        /// The two shapes.
        shapes: S,
        /// Whether all floats but those of the ray's range are small integers.
        is_integral: bool,
    },
    /// To be asked with `DVec3`.
    Double {
        /// The two shapes.
        shapes: D,
        /// Whether all floats but those of the ray's range are small integers.
        is_integral: bool,
    },
}

impl<'a, S: Draw, D: Draw> Arbitrary<'a> for Query<S, D> {
    fn arbitrary(bytes: &mut Unstructured<'a>) -> arbitrary::Result<Self> {
        let is_single = bytes.arbitrary()?;
        let style =
            *bytes.choose(&[Style::Bits, Style::Integers, Style::PowersOfTwo, Style::Mixed])?;
        let is_integral = style == Style::Integers;
        let mut source = Source { bytes, style };
        Ok(if is_single {
            let shapes = S::draw(&mut source);
            Self::Single { shapes, is_integral }
        } else {
            let shapes = D::draw(&mut source);
            Self::Double { shapes, is_integral }
        })
    }
}

/// Where a query's floats come from.
#[derive(Debug)]
pub struct Source<'s, 'a> {
    bytes: &'s mut Unstructured<'a>,
    style: Style,
}

impl<'a> Source<'_, 'a> {
    /// Some value; the default one where the bytes have run out.
    fn raw<T: Arbitrary<'a> + Default>(&mut self) -> T {
        self.bytes.arbitrary().unwrap_or_default()
    }

    /// A float.
    fn float<T: Float>(&mut self) -> T {
        let style = match self.style {
            Style::Mixed => match self.raw::<u8>() % 4 {
                0 => Style::Bits,
                1 => Style::PowersOfTwo,
                _ => Style::Integers,
            },
            style => style,
        };
        match style {
            Style::Bits | Style::Mixed => T::from_raw_bits(self.raw()),
            Style::Integers => T::ONE.lit(f64::from(self.raw::<u8>() % 16) - 8.0),
            Style::PowersOfTwo => {
                let exponent = match self.raw() {
                    true => i32::from(self.raw::<i8>()),
                    false => i32::from(self.raw::<i16>() % 1100),
                };
                let sign = if self.raw() { 1.0 } else { -1.0 };
                T::ONE.lit(sign * 2.0_f64.powi(exponent))
            }
        }
    }

    /// Three floats.
    fn vector<V: Vector<Scalar: Float>>(&mut self) -> V {
        V::new(self.float(), self.float(), self.float())
    }
}

/// Something that can be drawn from a source.
pub trait Draw {
    /// Draws it.
    fn draw(source: &mut Source<'_, '_>) -> Self;
}

impl<A: Draw, B: Draw> Draw for (A, B) {
    fn draw(source: &mut Source<'_, '_>) -> Self {
        (A::draw(source), B::draw(source))
    }
}

/// With one of the usual ranges, or any.
impl<V: Vector<Scalar: Float>> Draw for Ray<V> {
    fn draw(source: &mut Source<'_, '_>) -> Self {
        let ray = Self::new(source.vector(), source.vector());
        let infinity = V::Scalar::INFINITY;
        match source.raw::<u8>() % 4 {
            0 => ray,
            1 => ray.with_range(V::Scalar::ZERO, V::Scalar::ONE),
            2 => ray.with_range(-infinity, infinity),
            _ => ray.with_range(source.float(), source.float()),
        }
    }
}

impl<V: Vector<Scalar: Float>> Draw for Plane<V> {
    fn draw(source: &mut Source<'_, '_>) -> Self {
        Self { normal: source.vector(), offset: source.float() }
    }
}

impl<V: Vector<Scalar: Float>> Draw for Sphere<V> {
    fn draw(source: &mut Source<'_, '_>) -> Self {
        Self::new(source.vector(), source.float())
    }
}

/// Some have two vertices in common.
impl<V: Vector<Scalar: Float>> Draw for Triangle<V> {
    fn draw(source: &mut Source<'_, '_>) -> Self {
        let [v0, v1, v2] = [source.vector(), source.vector(), source.vector()];
        match source.raw::<u8>() % 16 {
            1 => Self::new(v0, v0, v2),
            2 => Self::new(v0, v1, v1),
            3 => Self::new(v0, v1, v0),
            _ => Self::new(v0, v1, v2),
        }
    }
}

/// With its corners in order more often than not.
impl<V: Vector<Scalar: Float>> Draw for Aabb<V> {
    fn draw(source: &mut Source<'_, '_>) -> Self {
        let (a, b): (V, V) = (source.vector(), source.vector());
        if source.raw::<u8>() % 8 == 1 { Self::new(a, b) } else { Self::new(a.min(b), b.max(a)) }
    }
}

impl<V: Vector<Scalar: Float>> Draw for Cone<V> {
    fn draw(source: &mut Source<'_, '_>) -> Self {
        Self::new(Ray::draw(source), source.float(), source.float())
    }
}

/// Of any corners, if they go round a pyramid, else with any sides.
impl<V: Vector<Scalar: Float>> Draw for Pyramid<V> {
    fn draw(source: &mut Source<'_, '_>) -> Self {
        let apex: V = source.vector();
        let corners = [(); 4].map(|()| source.vector());
        Self::new(apex, corners).unwrap_or_else(|| {
            let normals = [(); 4].map(|()| source.vector());
            Self { apex, corners, normals }
        })
    }
}

/// Of up to four vertices, convex or not.
impl<V: Vector<Scalar: Float>> Draw for Polygon<V, 8> {
    fn draw(source: &mut Source<'_, '_>) -> Self {
        let vertices = [(); 4].map(|()| source.vector());
        let len = usize::from(source.raw::<u8>() % 5);
        Self::new(&vertices[..len]).unwrap_or_default()
    }
}

/// One of the shapes.
#[derive(Debug)]
pub enum Shape<V: Vector> {
    /// A plane.
    Plane(Plane<V>),
    /// A sphere.
    Sphere(Sphere<V>),
    /// A box.
    Aabb(Aabb<V>),
    /// A triangle.
    Triangle(Triangle<V>),
}

impl<V: Vector<Scalar: Float>> Draw for Shape<V> {
    fn draw(source: &mut Source<'_, '_>) -> Self {
        match source.raw::<u8>() % 4 {
            0 => Self::Plane(Plane::draw(source)),
            1 => Self::Sphere(Sphere::draw(source)),
            2 => Self::Aabb(Aabb::draw(source)),
            _ => Self::Triangle(Triangle::draw(source)),
        }
    }
}

impl<V: Vector> Shape<V> {
    /// Whether the ray hits it, in exact arithmetic.
    pub fn is_hit(&self, ray: &Ray<V>) -> bool {
        match self {
            Self::Plane(plane) => verdict::ray_plane(ray, plane) != PlaneVerdict::Miss,
            Self::Sphere(sphere) => verdict::ray_sphere(ray, sphere),
            Self::Aabb(aabb) => verdict::ray_aabb(ray, aabb),
            Self::Triangle(triangle) => verdict::ray_triangle(ray, triangle).hits(),
        }
    }
}

/// Whether anything can be hit by the ray: finite origin and direction, not zero, and a range that
/// holds a number.
pub fn can_hit<V: Vector>(ray: &Ray<V>) -> bool {
    ray.origin.is_finite()
        && ray.direction.is_finite()
        && ray.direction != V::ZERO
        && ray.t_min <= ray.t_max
}

/// Whether all vertices are finite.
pub fn is_finite<V: Vector>(triangle: &Triangle<V>) -> bool {
    <[V; 3]>::from(*triangle).iter().all(|v| v.is_finite())
}

/// Whether the point lies in the box.
pub fn contains<V: Vector>(aabb: &Aabb<V>, point: V) -> bool {
    aabb.min.all_le(point) && point.all_le(aabb.max)
}

/// A hit's t is finite and in the closed range.
pub fn assert_in_range<V: Vector>(kernel: &str, t: V::Scalar, ray: &Ray<V>) {
    assert!(t.is_finite(), "{kernel}: t = {t:?}");
    assert!(ray.t_min <= t && t <= ray.t_max, "{kernel}: t = {t:?} is out of range");
}

/// The same ray with all coordinates multiplied.
pub fn scaled_ray<V: Vector>(ray: &Ray<V>, factor: V::Scalar) -> Ray<V> {
    Ray { origin: ray.origin * factor, direction: ray.direction * factor, ..*ray }
}

/// Powers of two which keep small integers, and what kernels compute of them, in the middle of the
/// range of exponents.
pub const FACTORS: [f32; 2] = [1.0 / 1024.0, 1024.0];
