//! Ray against sphere by the quadratic formula, as in A. S. Glassner (ed.), "An Introduction to Ray
//! Tracing", 1989, chapter 2.

use super::{Quadratic, Roots, SphereHit, nearest};
use crate::shape::{Ray, Sphere};
use crate::vector::{Coordinates, Number, Vector};

/// The nearest root of the quadratic formula in the ray's range.
///
/// t = (f·d ∓ √((f·d)² − d²·(f² − r²))) / d²
///
/// **Grade: fast.** The discriminant is a difference of large numbers: it is off by up to
/// 12u·d²·(f² + r²), u = EPSILON/2, as if r² were off by 12u·(f² + r²). With f32 and an origin
/// more than about a thousand radii away little is left of the radius: use
/// [`super::robust`] there. The root adds 6u·(|f| + r)/|d|.
///
/// A zero direction, a negative radius, a NaN or infinite field: a miss; a root beyond the largest
/// float does not count.
///
/// ```
/// use isect::{Ray, Sphere, glam::Vec3, ray::sphere::algebraic};
///
/// let ray = Ray::new(Vec3::new(0.0, 0.0, -3.0), Vec3::Z);
/// let hit = algebraic::intersect(&ray, &Sphere::new(Vec3::ZERO, 1.0)).expect("a hit");
/// assert_eq!((hit.t, hit.leaving), (2.0, false));
/// ```
#[inline]
#[must_use]
pub fn intersect<V: Vector>(ray: &Ray<V>, sphere: &Sphere<V>) -> Option<SphereHit<V::Scalar>> {
    nearest(ray, super::solve(ray, sphere, solve)?)
}

#[inline(always)]
fn solve<V: Coordinates>(q: &Quadratic<V>) -> Roots<V::Scalar> {
    let b = q.f.dot(q.d);
    let c = q.f2 - q.r * q.r;
    let root = (b * b - q.a * c).sqrt();
    [(b - root) / q.a, (b + root) / q.a]
}
