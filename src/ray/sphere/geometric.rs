//! Ray against sphere by the closest approach and the half chord, as in A. S. Glassner (ed.), "An
//! Introduction to Ray Tracing", 1989, chapter 2.

use super::{Quadratic, Roots, SphereHit, nearest};
use crate::shape::{Ray, Sphere};
use crate::vector::{Coordinates, Number, Vector};

/// The point of the line closest to the centre, then half a chord to either side.
///
/// With l = |d|: s = f·d / l along the unit direction, h² = f² − s² the squared distance of the
/// line from the centre, t = (s ∓ √(r² − h²)) / l.
///
/// **Grade: fast.** h² is a difference of large numbers: it is off by up to 16u·f²,
/// u = EPSILON/2, as if r² were off by that much. With f32 and an origin more than about a
/// thousand radii away little is left of the radius: use [`super::robust`] there. The root adds
/// 6u·(|f| + r)/|d|.
///
/// A zero direction, a negative radius, a NaN or infinite field: a miss; a root beyond the largest
/// float does not count.
///
/// ```
/// use isect::{Ray, Sphere, glam::Vec3, ray::sphere::geometric};
///
/// let ray = Ray::new(Vec3::ZERO, Vec3::new(0.0, 0.0, 2.0));
/// let hit = geometric::intersect(&ray, &Sphere::new(Vec3::ZERO, 1.0)).expect("from inside");
/// assert_eq!((hit.t, hit.leaving), (0.5, true));
/// ```
#[inline]
#[must_use]
pub fn intersect<V: Vector>(ray: &Ray<V>, sphere: &Sphere<V>) -> Option<SphereHit<V::Scalar>> {
    nearest(ray, super::solve(ray, sphere, solve)?)
}

#[inline(always)]
fn solve<V: Coordinates>(q: &Quadratic<V>) -> Roots<V::Scalar> {
    let length = q.a.sqrt();
    let approach = q.f.dot(q.d) / length;
    let h2 = q.f2 - approach * approach;
    let half_chord = (q.r * q.r - h2).sqrt();
    [(approach - half_chord) / length, (approach + half_chord) / length]
}
