//! Ray against sphere without the cancellations.
//!
//! E. Haines, J. Günther, T. Akenine-Möller, "Precision Improvements for Ray/Sphere Intersection",
//! Ray Tracing Gems, 2019, chapter 7: the discriminant from the vector that is perpendicular to the
//! ray, and the root that would cancel from the product of the roots.

use super::{Quadratic, Roots, SphereHit, nearest};
use crate::shape::{Ray, Sphere};
use crate::vector::{Coordinates, Number, Vector};

/// The nearest root in the ray's range, accurate for far origins and for spheres of any size.
///
/// With q = f − (f·d/d²)·d, the vector from the line's closest point to the centre, the
/// discriminant is d²·(r + |q|)·(r − |q|), and with s = f·d ± its root, the sign that of
/// f·d, the roots are s/d² and (f² − r²)/s, where f² − r² = (|f| + r)·(|f| − r).
///
/// **Grade: fast**, with errors in proportion to the distance and no longer to its square: each
/// computed root is the exact one for a radius that differs by at most 16u·(|f| + r),
/// u = EPSILON/2. So hit or miss is certain unless the line passes the surface within that distance.
///
/// A zero direction, a negative radius, a NaN or infinite field: a miss; a root beyond the largest
/// float does not count. A radius of zero is a point.
///
/// ```
/// use isect::{Ray, Sphere, glam::Vec3, ray::sphere::robust};
///
/// let ray = Ray::new(Vec3::new(0.0, 0.0, -1.0e6), Vec3::Z);
/// let hit = robust::intersect(&ray, &Sphere::new(Vec3::ZERO, 1.0)).expect("a hit");
/// assert_eq!((hit.t, hit.leaving), (999_999.0, false));
/// ```
#[inline]
#[must_use]
pub fn intersect<V: Vector>(ray: &Ray<V>, sphere: &Sphere<V>) -> Option<SphereHit<V::Scalar>> {
    nearest(ray, super::solve(ray, sphere, solve)?)
}

#[inline(always)]
pub(super) fn solve<V: Coordinates>(q: &Quadratic<V>) -> Roots<V::Scalar> {
    let zero = q.a.lit(0.0);
    let b = q.f.dot(q.d);
    let perpendicular = q.f - q.d * (b / q.a);
    let h = perpendicular.dot(perpendicular).sqrt();
    let root = (q.a * ((q.r + h) * (q.r - h))).sqrt();
    let f = q.f2.sqrt();
    let c = (f + q.r) * (f - q.r);
    let s = V::Scalar::select(b.lt(zero), b - root, b + root);
    let first = s / q.a;
    // s is zero only where the ray starts at a tangent's touching point: both roots are zero then.
    let second = V::Scalar::select(zero.lt(s.abs()), c / s, s);
    // `min` and `max` would drop a NaN in their first operand, but where there is no root both
    // operands are NaN.
    [first.min(second), first.max(second)]
}
