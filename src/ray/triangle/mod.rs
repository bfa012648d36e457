//! Ray against triangle.
//!
//! | kernel | grade | for |
//! |---|---|---|
//! | [`exact`] | exact | everything; the default |
//! | [`watertight`] | watertight | many triangles in the order of a mesh, prepared once per ray |
//! | [`moller_trumbore`] | fast | leaves where a lost ray does not matter |
//! | [`badouel`] | fast | many rays against few triangles, prepared once |
//! | [`segura`] | fast | yes or no without a division |
//!
//! A hit is a t along the ray, and a u and v on the triangle: the weights of `v1` and `v2`, and also the shares of the area
//! that lie across from them ([`TriangleHit`]).
//!
#![doc = include_str!("../../doc/barycentric.svg")]

pub mod badouel;
pub mod exact;
pub mod moller_trumbore;
pub mod segura;
pub mod watertight;

use core::ops::{Add, Mul};

use super::{Intersect, in_range};
use crate::shape::{Ray, Triangle};
use crate::vector::{Coordinates, Number, Scalar, Vector};

/// Where a ray meets a triangle: the point (1 − u − v)·v0 + u·v1 + v·v2 = o + t·d.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct TriangleHit<T> {
    /// The ray's parameter.
    pub t: T,
    /// The weight of `v1`.
    pub u: T,
    /// The weight of `v2`.
    pub v: T,
    /// Whether the direction runs against the normal: for t ≥ 0, whether the vertices run
    /// counter-clockwise seen from the ray's origin. No kernel culls: to cull back faces, filter on it.
    pub front: bool,
}

impl<T: Scalar> TriangleHit<T> {
    /// The weights of the three vertices, (1 − u − v, u, v); none is negative.
    #[inline]
    #[must_use]
    pub fn barycentric(&self) -> [T; 3] {
        // Where the kernel divides each weight by itself, 1 − u − v may round to just below zero.
        [(T::ONE - (self.u + self.v)).max(T::ZERO), self.u, self.v]
    }

    /// The weighted mean of a quantity (a normal, a colour, texture coordinates) that is `a`, `b`
    /// and `c` at the vertices.
    ///
    /// ```
    /// use isect::{glam::Vec2, ray::triangle::TriangleHit};
    ///
    /// let hit = TriangleHit { t: 1.0, u: 0.25, v: 0.5, front: true };
    /// assert_eq!(hit.interpolate(Vec2::ZERO, Vec2::X, Vec2::Y), Vec2::new(0.25, 0.5));
    /// ```
    #[inline]
    #[must_use]
    pub fn interpolate<A: Mul<T, Output = A> + Add<Output = A>>(&self, a: A, b: A, c: A) -> A {
        let [w, u, v] = self.barycentric();
        a * w + b * u + c * v
    }
}

impl<V: Vector> Intersect<V> for Triangle<V> {
    type Hit = TriangleHit<V::Scalar>;
    #[inline]
    fn intersect(&self, ray: &Ray<V>) -> Option<Self::Hit> {
        exact::intersect(ray, self)
    }
    #[inline]
    fn hits(&self, ray: &Ray<V>) -> bool {
        exact::hits(ray, self)
    }
}

/// What a kernel body finds, in one lane or several: the numbers count where `hit` holds.
pub(crate) struct Found<N: Number> {
    pub(crate) hit: N::Mask,
    pub(crate) t: N,
    pub(crate) u: N,
    pub(crate) v: N,
    pub(crate) front: N::Mask,
}

impl<T: Scalar> Found<T> {
    #[inline(always)]
    fn into_option(self) -> Option<TriangleHit<T>> {
        // Written so that it compiles to a conditional move and not to a branch, which random rays
        // would mispredict.
        let mut hit = Some(TriangleHit { t: self.t, u: self.u, v: self.v, front: self.front });
        if !self.hit {
            hit = None;
        }
        hit
    }
}

/// The line through the ray, with respect to the triangle: what the kernels compute with that
/// work on edges.
#[derive(Clone, Copy)]
pub(crate) struct Frame<V: Coordinates> {
    /// The ray's direction.
    pub(crate) direction: V,
    /// v1 − v0
    pub(crate) edge1: V,
    /// v2 − v0
    pub(crate) edge2: V,
    /// From v0 to the ray's origin.
    pub(crate) offset: V,
}

impl<V: Coordinates> Frame<V> {
    #[inline(always)]
    pub(crate) fn new(ray: &Ray<V>, triangle: &Triangle<V>) -> Self {
        Self {
            direction: ray.direction,
            edge1: triangle.v1 - triangle.v0,
            edge2: triangle.v2 - triangle.v0,
            offset: ray.origin - triangle.v0,
        }
    }
}

impl<V: Vector> Frame<V> {
    /// The same problem with the direction, and the longest of the other vectors, scaled by powers of
    /// two to a length of which the products do not overflow, and those of small components hardly
    /// underflow; with the two factors, which cancel but in t.
    fn normalized(&self) -> (Self, V::Scalar, V::Scalar) {
        let longest = self.edge1.abs().max(self.edge2.abs()).max(self.offset.abs()).max_element();
        let (scale, t_scale) = (longest.normalizer(), self.direction.normalizer());
        let large = longest.large_length();
        let frame = Self {
            direction: self.direction.times_powers(t_scale, large),
            edge1: self.edge1.times_powers(scale, large),
            edge2: self.edge2.times_powers(scale, large),
            offset: self.offset.times_powers(scale, large),
        };
        (frame, t_scale, scale)
    }
}

/// t, u, v of the point where the ray's line meets the triangle's plane.
pub(crate) struct Solution<N: Number> {
    /// A positive multiple of −d·n, n the triangle's normal.
    determinant: N,
    /// t as a fraction of the determinant, before the division.
    numerator: N,
    t: N,
    u: N,
    v: N,
}

impl<N: Number> Solution<N> {
    /// Whether no product that matters has over- or underflowed: those of the most lengths lie in the
    /// middle of the range of exponents, and the weights are finite.
    #[inline(always)]
    pub(crate) fn is_trustworthy(&self) -> N::Mask {
        self.determinant.are_mid_range(self.numerator) & self.weight0().abs().le(self.t.largest())
    }

    /// The weight of v0. (The sum first: so the order of the other two does not matter.)
    #[inline(always)]
    fn weight0(&self) -> N {
        self.t.lit(1.0) - (self.u + self.v)
    }

    /// Keeps the point if it lies in the triangle and in the range. Any NaN is a miss.
    #[inline(always)]
    pub(crate) fn clipped(self, t_min: N, t_max: N) -> Found<N> {
        let zero = self.t.lit(0.0);
        let inside = zero.le(self.u) & zero.le(self.v) & zero.le(self.weight0());
        let Self { determinant, t, u, v, .. } = self;
        let hit = inside & in_range(t, t_min, t_max);
        Found { hit, t, u, v, front: zero.lt(determinant) }
    }
}

/// Whether origin, direction and vertices are finite, and the direction is not zero.
fn is_valid<V: Vector>(ray: &Ray<V>, triangle: &Triangle<V>) -> bool {
    let vertices: [V; 3] = (*triangle).into();
    ray.is_valid() && vertices.iter().all(|v| v.is_finite())
}

/// Runs a kernel that works on edges.
///
/// Where its products may have over- or underflowed the kernel runs again on a scaled problem.
#[inline(always)]
fn intersect_frame<V: Vector>(
    ray: &Ray<V>,
    triangle: &Triangle<V>,
    solve: impl Fn(&Frame<V>) -> Solution<V::Scalar>,
) -> Option<TriangleHit<V::Scalar>> {
    let solution = solve(&Frame::new(ray, triangle));
    if !solution.is_trustworthy() {
        return extreme(ray, triangle, solve);
    }
    solution.clipped(ray.t_min, ray.t_max).into_option()
}

#[cold]
fn extreme<V: Vector>(
    ray: &Ray<V>,
    triangle: &Triangle<V>,
    solve: impl Fn(&Frame<V>) -> Solution<V::Scalar>,
) -> Option<TriangleHit<V::Scalar>> {
    if !is_valid(ray, triangle) {
        return None;
    }
    let (frame, t_scale, scale) = Frame::new(ray, triangle).normalized();
    let mut solution = solve(&frame);
    solution.t = solution.t.times_ratio(t_scale, scale);
    let flat = solution.determinant == V::Scalar::ZERO;
    solution.clipped(ray.t_min, ray.t_max).into_option().filter(|_| !flat)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DVec3, Vec3, Vec3A};

    type Kernel<V> = fn(&Ray<V>, &Triangle<V>) -> Option<TriangleHit<<V as Coordinates>::Scalar>>;

    fn kernels<V: Vector>() -> [Kernel<V>; 5] {
        [
            badouel::intersect,
            moller_trumbore::intersect,
            segura::intersect,
            |ray, triangle| watertight::intersect(&watertight::ShearedRay::new(ray), triangle),
            |ray, triangle| ray.intersect(triangle),
        ]
    }

    /// Along each axis, from both sides.
    #[test]
    fn the_weights_belong_to_their_vertices() {
        fn check<V: Vector>() {
            let number = |x: f64| V::Scalar::ONE.lit(x);
            let turn = |axis: usize, [x, y, z]: [f64; 3]| -> V {
                let p = [x, y, z];
                let component = |i: usize| number(p[(i + axis) % 3]);
                V::new(component(0), component(1), component(2))
            };
            for axis in 0..3 {
                let corners = [[0.0, 0.0, 1.0], [4.0, 0.0, 1.0], [0.0, 4.0, 1.0]];
                let triangle = Triangle::from(corners.map(|p| turn(axis, p)));
                for (z, direction, front) in [(3.0, -2.0, true), (-1.0, 2.0, false)] {
                    let ray =
                        Ray::new(turn(axis, [1.0, 2.0, z]), turn(axis, [0.0, 0.0, direction]));
                    for intersect in kernels::<V>() {
                        let hit = intersect(&ray, &triangle).expect("it is aimed at the inside");
                        let expected =
                            TriangleHit { t: number(1.0), u: number(0.25), v: number(0.5), front };
                        assert_eq!(hit, expected);
                        assert_eq!(hit.barycentric(), [0.25, 0.25, 0.5].map(number));
                        let away = Ray { direction: -ray.direction, ..ray };
                        assert!(intersect(&away, &triangle).is_none());
                        let line = away.with_range(-V::Scalar::INFINITY, V::Scalar::ZERO);
                        let behind = intersect(&line, &triangle).expect("on the line");
                        assert_eq!((behind.t, behind.front), (number(-1.0), !front));
                        assert!(
                            intersect(&away.with_range(number(-1.0), number(-1.0)), &triangle)
                                .is_some()
                        );
                    }
                }
            }
        }
        check::<Vec3>();
        check::<Vec3A>();
        check::<DVec3>();
    }

    #[test]
    fn edges_and_vertices_belong_to_the_triangle() {
        let triangle = Triangle::new(Vec3::ZERO, Vec3::X * 4.0, Vec3::Y * 4.0);
        for intersect in kernels::<Vec3>() {
            let down =
                |x: f32, y: f32| intersect(&Ray::new(Vec3::new(x, y, 1.0), Vec3::NEG_Z), &triangle);
            for (x, y) in [(0.0, 0.0), (4.0, 0.0), (0.0, 4.0), (2.0, 0.0), (0.0, 1.0), (1.0, 3.0)] {
                assert!(down(x, y).is_some(), "{x} {y}");
            }
            for (x, y) in [(-0.01, 0.0), (4.01, 0.0), (0.0, 4.01), (2.01, 2.0), (-1.0, -1.0)] {
                assert!(down(x, y).is_none(), "{x} {y}");
            }
        }
    }

    #[test]
    fn parallel_rays_and_triangles_without_area_miss() {
        let triangle = Triangle::new(Vec3::ZERO, Vec3::X, Vec3::Y);
        let along = Ray::new(Vec3::new(-1.0, 0.25, 0.0), Vec3::X);
        let above = Ray::new(Vec3::new(-1.0, 0.25, 0.5), Vec3::X);
        let down = Ray::new(Vec3::new(0.5, 0.0, 1.0), Vec3::NEG_Z);
        // All but the exact one, the default, which takes them as the point sets that they are.
        let [kernels @ .., exact] = kernels::<Vec3>();
        assert!(exact(&along, &triangle).is_some() && exact(&above, &triangle).is_none());
        for intersect in kernels {
            assert!(
                intersect(&along, &triangle).is_none() && intersect(&above, &triangle).is_none()
            );
            for degenerate in [
                [Vec3::ZERO, Vec3::X, Vec3::X],
                [Vec3::X, Vec3::ZERO, Vec3::X],
                [Vec3::ZERO, Vec3::X, Vec3::X * 2.0],
                [Vec3::X * 0.5; 3],
            ] {
                assert!(intersect(&down, &degenerate.into()).is_none(), "{degenerate:?}");
            }
        }
    }

    /// Where det is 1e-40, or e1·e2 is.
    #[test]
    fn lengths_of_any_size() {
        for (size, length) in [
            (1.0, 1e-37_f32),
            (1e-3, 1e-40),
            (1e-20, 1.0),
            (1e-30, 1e30),
            (1e20, 1e-5),
            (1e30, 1e3),
            (1e12, 1e30),
        ] {
            let triangle = Triangle::new(Vec3A::ZERO, Vec3A::X * size, Vec3A::Y * size);
            let ray = Ray::new(Vec3A::new(0.25, 0.5, 2.0) * size, Vec3A::NEG_Z * length);
            for (i, intersect) in kernels().into_iter().enumerate() {
                let hit =
                    intersect(&ray, &triangle).unwrap_or_else(|| panic!("{i}: {size} {length}"));
                // The direction itself may be subnormal, and is what it is.
                let t = 2.0 * size / -ray.direction.z;
                assert!(
                    (hit.t - t).abs() <= 8.0 * f32::EPSILON * t,
                    "{i}: {size} {length} {}",
                    hit.t
                );
                assert!(
                    (hit.u - 0.25).abs() <= 8.0 * f32::EPSILON
                        && (hit.v - 0.5).abs() <= 8.0 * f32::EPSILON
                );
            }
        }
    }

    #[test]
    fn an_infinite_vertex_is_a_miss() {
        for (i, intersect) in kernels::<Vec3>().into_iter().enumerate() {
            for vertex in 0..3 {
                for bad in [f32::INFINITY, f32::NEG_INFINITY, f32::NAN] {
                    for axis in 0..3 {
                        let mut corners = [Vec3::ZERO, Vec3::X, Vec3::Y];
                        corners[vertex][axis] = bad;
                        let ray = Ray::new(Vec3::new(0.25, 0.25, 1.0), Vec3::NEG_Z);
                        assert!(intersect(&ray, &corners.into()).is_none(), "{i}: {corners:?}");
                    }
                }
            }
        }
    }
}
