//! Ray against sphere.
//!
//! All three kernels solve d²·t² − 2(f·d)·t + f² − r² = 0, f the vector from the ray's origin to
//! the centre; they differ in how they come to the roots.
//!
//! | kernel | construction | good for |
//! |---|---|---|
//! | [`robust`] | perpendicular distance, stable roots | everything; the default |
//! | [`geometric`] | closest approach and half chord | rays that start within a few hundred radii |
//! | [`algebraic`] | the quadratic formula | the same |

pub mod algebraic;
pub mod geometric;
pub mod robust;

use super::{Intersect, in_range};
use crate::shape::{Ray, Sphere};
use crate::vector::{Coordinates, Number, Scalar, Vector};

/// Where a ray meets a sphere.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct SphereHit<T> {
    /// The nearest root in the ray's range.
    pub t: T,
    /// Whether it is the far root: the ray leaves the ball there. The two roots of a tangent count
    /// as near ones.
    pub leaving: bool,
}

impl<V: Vector> Intersect<V> for Sphere<V> {
    type Hit = SphereHit<V::Scalar>;
    #[inline]
    fn intersect(&self, ray: &Ray<V>) -> Option<Self::Hit> {
        robust::intersect(ray, self)
    }
}

/// Both roots, near and far, of the whole line, whatever the ray's range; computed as
/// [`robust::intersect`] does. `None` where the line misses the sphere, for bad input, and where a
/// root is beyond the largest float.
///
/// ```
/// use isect::{Ray, Sphere, glam::Vec3, ray::sphere};
///
/// let ray = Ray::new(Vec3::ZERO, Vec3::X);
/// assert_eq!(sphere::roots(&ray, &Sphere::new(Vec3::ZERO, 2.0)), Some([-2.0, 2.0]));
/// ```
#[inline]
#[must_use]
pub fn roots<V: Vector>(ray: &Ray<V>, sphere: &Sphere<V>) -> Option<[V::Scalar; 2]> {
    solve(ray, sphere, robust::solve).filter(|roots| roots.iter().all(|t| t.is_finite()))
}

/// The quadratic as each kernel gets it: `a = d²` and `b = f·d` are computed already.
struct Quadratic<V: Coordinates> {
    /// The direction.
    d: V,
    /// From the origin to the centre.
    f: V,
    /// The radius.
    r: V::Scalar,
    /// d²
    a: V::Scalar,
    /// f²
    f2: V::Scalar,
}

impl<V: Coordinates> Quadratic<V> {
    #[inline(always)]
    fn new(d: V, f: V, r: V::Scalar) -> Self {
        Self { d, f, r, a: d.dot(d), f2: f.dot(f) }
    }
}

/// The roots in order, NaN where there are none.
type Roots<N> = [N; 2];

/// Solves for the roots with one of the kernels; starts again with a scaled problem where squares
/// leave the range of exponents.
#[inline(always)]
fn solve<V: Vector>(
    ray: &Ray<V>,
    sphere: &Sphere<V>,
    kernel: impl Fn(&Quadratic<V>) -> Roots<V::Scalar>,
) -> Option<Roots<V::Scalar>> {
    let q = Quadratic::new(ray.direction, sphere.center - ray.origin, sphere.radius);
    let lengths = q.f2 + q.r * q.r;
    let mid_range = q.a.is_mid_range() & lengths.is_mid_range() & (q.a * lengths).is_mid_range();
    if mid_range & V::Scalar::ZERO.le(q.r) {
        return Some(kernel(&q));
    }
    extreme(ray, sphere, kernel)
}

/// The direction, and the lengths, are brought to about 1 by powers of two.
#[cold]
fn extreme<V: Vector>(
    ray: &Ray<V>,
    sphere: &Sphere<V>,
    kernel: impl Fn(&Quadratic<V>) -> Roots<V::Scalar>,
) -> Option<Roots<V::Scalar>> {
    if !(ray.is_valid() && sphere.is_valid()) {
        return None;
    }
    let f = sphere.center - ray.origin;
    let t_scale = Coordinates::abs(ray.direction).max_element().normalizer();
    let scale = Coordinates::abs(f).max_element().max(sphere.radius).normalizer();
    let q = Quadratic::new(ray.direction * t_scale, f * scale, sphere.radius * scale);
    Some(kernel(&q).map(|t| t.times_ratio(t_scale, scale)))
}

/// The first root that lies in the ray's range.
#[inline(always)]
fn nearest<V: Vector>(ray: &Ray<V>, [near, far]: Roots<V::Scalar>) -> Option<SphereHit<V::Scalar>> {
    if in_range(near, ray.t_min, ray.t_max) {
        Some(SphereHit { t: near, leaving: false })
    } else if in_range(far, ray.t_min, ray.t_max) {
        Some(SphereHit { t: far, leaving: true })
    } else {
        None
    }
}
