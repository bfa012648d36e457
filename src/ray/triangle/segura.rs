//! Ray against triangle by the signs of three volumes.
//!
//! R. J. Segura, F. R. Feito, "An algorithm for determining intersection segment-polygon in 3D",
//! Computers & Graphics 22.5, 1998: the line passes inside if it passes all three edges on the same
//! side. Each volume is computed from its edge alone, so that two triangles with a common edge get
//! exactly opposite numbers for it.

use super::{Found, TriangleHit, in_range, is_valid};
use crate::shape::{Ray, Triangle};
use crate::vector::{Coordinates, Number, Scalar, Vector};

/// Whether the ray meets the triangle, in the closed range of the ray, without a division.
///
/// With a_i = v_i − o and s_i = (a_(i+1) × a_(i+2))·d, the line passes inside if no two of the
/// s_i have opposite signs; t = (Σ s_i·a_i)·d / (d²·Σ s_i) is compared as a fraction.
///
/// **Grade: fast.** Each s_i is off by at most 7u times the sum of the magnitudes of its six terms,
/// u = EPSILON/2, which grows with the square of the distance of the origin; its sign is certain
/// beyond that. Neighbours agree about the sign at a common edge, but a ray may slip through at a vertex.
/// At an end of the range, and where t is beyond the largest float, the verdict may differ from that of
/// [`intersect`], which divides.
///
/// A triangle without area as computed, a zero direction, a NaN or infinite field: `false`.
///
/// ```
/// use isect::{Ray, Triangle, glam::Vec3, ray::triangle::segura};
///
/// let triangle = Triangle::new(Vec3::ZERO, Vec3::X, Vec3::Y);
/// let light = Vec3::new(0.25, 0.25, 1.0);
/// assert!(segura::detects(&Ray::segment(light, Vec3::new(0.25, 0.25, -1.0)), &triangle));
/// assert!(!segura::detects(&Ray::segment(light, Vec3::new(0.25, 0.25, 0.5)), &triangle));
/// ```
#[inline]
#[must_use]
pub fn detects<V: Vector>(ray: &Ray<V>, triangle: &Triangle<V>) -> bool {
    let volumes = Volumes::new(&corners(ray, triangle), ray.direction);
    if !volumes.is_trustworthy() {
        return Extreme::new(ray, triangle).is_some_and(|extreme| extreme.detects(ray));
    }
    volumes.detect(ray.t_min, ray.t_max)
}

/// Where the ray meets the triangle, in the closed range of the ray: [`detects`], then the weights
/// s_i / Σ s and t with two divisions.
///
/// **Grade: fast**, as [`detects`]. With P_i the sum of the magnitudes of the six terms of s_i, the
/// weight s_i / Σ s, at most 1, is off by at most 12u·(P_i + Σ P)/|Σ s|; and t by the sum over i of what
/// the weight's error, and 12u more, make of Σ_k |a_ik·d_k| / d².
///
/// A triangle without area as computed, a zero direction, a NaN or infinite field: a miss.
///
/// ```
/// use isect::{Ray, Triangle, glam::Vec3, ray::triangle::segura};
///
/// let triangle = Triangle::new(Vec3::ZERO, Vec3::X, Vec3::Y);
/// let ray = Ray::new(Vec3::new(0.25, 0.5, 3.0), Vec3::NEG_Z);
/// let hit = segura::intersect(&ray, &triangle).expect("it is aimed at the inside");
/// assert_eq!((hit.t, hit.u, hit.v, hit.front), (3.0, 0.25, 0.5, true));
/// ```
#[inline]
#[must_use]
pub fn intersect<V: Vector>(
    ray: &Ray<V>,
    triangle: &Triangle<V>,
) -> Option<TriangleHit<V::Scalar>> {
    let volumes = Volumes::new(&corners(ray, triangle), ray.direction);
    if !volumes.is_trustworthy() {
        return Extreme::new(ray, triangle)?.intersect(ray);
    }
    volumes.found(volumes.t(), ray.t_min, ray.t_max).into_option()
}

/// The vertices as seen from the origin.
#[inline(always)]
fn corners<V: Coordinates>(ray: &Ray<V>, triangle: &Triangle<V>) -> [V; 3] {
    [triangle.v0 - ray.origin, triangle.v1 - ray.origin, triangle.v2 - ray.origin]
}

/// Six times the volumes that the ray's direction spans with each edge and the origin.
struct Volumes<N: Number> {
    /// By the vertex across from the edge.
    s: [N; 3],
    /// Σ s = d·n
    sum: N,
    /// (Σ s_i·a_i)·d
    along: N,
    /// d²
    d2: N,
}

impl<N: Number> Volumes<N> {
    #[inline(always)]
    fn new<V: Coordinates<Scalar = N>>(&[a0, a1, a2]: &[V; 3], direction: V) -> Self {
        let [s0, s1, s2] =
            [a1.cross(a2).dot(direction), a2.cross(a0).dot(direction), a0.cross(a1).dot(direction)];
        Self {
            s: [s0, s1, s2],
            sum: s0 + s1 + s2,
            along: (a0 * s0 + a1 * s1 + a2 * s2).dot(direction),
            d2: direction.dot(direction),
        }
    }

    /// Whether no product that matters has over- or underflowed: all lie in the middle of the range of
    /// exponents.
    #[inline(always)]
    fn is_trustworthy(&self) -> N::Mask {
        self.sum.are_mid_range(self.d2) & self.along.are_mid_range(self.sum * self.d2)
    }

    /// Whether no two volumes have opposite signs.
    #[inline(always)]
    fn line_passes_inside(&self) -> N::Mask {
        let zero = self.sum.lit(0.0);
        let [s0, s1, s2] = self.s;
        let one_way = zero.le(s0) & zero.le(s1) & zero.le(s2);
        let other_way = s0.le(zero) & s1.le(zero) & s2.le(zero);
        one_way | other_way
    }

    /// Whether the line passes inside, at a t in the range: t is compared as a fraction.
    #[inline(always)]
    fn detect(&self, t_min: N, t_max: N) -> N::Mask {
        let numerator = N::select(self.sum.lt(self.sum.lit(0.0)), -self.along, self.along);
        let denominator = self.d2 * self.sum.abs();
        // Both ends of an empty range may round to the same product.
        self.line_passes_inside()
            & t_min.le(t_max)
            & (t_min * denominator).le(numerator)
            & numerator.le(t_max * denominator)
    }

    #[inline(always)]
    fn t(&self) -> N {
        self.along * (self.sum.lit(1.0) / self.sum) / self.d2
    }

    #[inline(always)]
    fn found(&self, t: N, t_min: N, t_max: N) -> Found<N> {
        let inverse = self.sum.lit(1.0) / self.sum;
        let [_, u, v] = self.s.map(|s| s * inverse);
        let hit = self.line_passes_inside() & in_range(t, t_min, t_max);
        Found { hit, t, u, v, front: self.sum.lt(self.sum.lit(0.0)) }
    }
}

/// Where products may have over- or underflowed: the direction brought to about 1 and the corners to a
/// length of which the products do neither, by powers of two.
struct Extreme<T: Scalar> {
    volumes: Volumes<T>,
    t_scale: T,
    scale: T,
}

impl<T: Scalar> Extreme<T> {
    /// `None` for bad input, and for a triangle without area as computed.
    #[cold]
    fn new<V: Vector<Scalar = T>>(ray: &Ray<V>, triangle: &Triangle<V>) -> Option<Self> {
        if !is_valid(ray, triangle) {
            return None;
        }
        let corners = corners(ray, triangle);
        let [a0, a1, a2] = corners.map(Coordinates::abs);
        let scale = a0.max(a1.max(a2)).max_element().normalizer();
        let t_scale = ray.direction.normalizer();
        let large = scale.large_length();
        let corners = corners.map(|a| a.times_powers(scale, large));
        let volumes = Volumes::new(&corners, ray.direction * t_scale);
        (volumes.sum != T::ZERO).then_some(Self { volumes, t_scale, scale })
    }

    fn detects<V: Vector<Scalar = T>>(&self, ray: &Ray<V>) -> bool {
        let large = self.scale.large_length();
        let scaled = |t: T| t.times_ratio(self.scale, self.t_scale) * large;
        // An empty range would not be noticed where both of its ends underflow.
        ray.t_min <= ray.t_max && self.volumes.detect(scaled(ray.t_min), scaled(ray.t_max))
    }

    fn intersect<V: Vector<Scalar = T>>(&self, ray: &Ray<V>) -> Option<TriangleHit<T>> {
        let t = self.volumes.t() / self.scale.large_length();
        let t = t.times_ratio(self.t_scale, self.scale);
        self.volumes.found(t, ray.t_min, ray.t_max).into_option()
    }
}
