//! Ray against sphere without the cancellations, and never wrong.
//!
//! E. Haines, J. Günther, T. Akenine-Möller, "Precision Improvements for Ray/Sphere Intersection",
//! Ray Tracing Gems, 2019, chapter 7: the discriminant from the vector that is perpendicular to the
//! ray, and the root that would cancel from the product of the roots. Its error bound tells where hit
//! or miss, and an end of the range, are certain; where they are not, integers decide.

use core::cmp::Ordering;

use super::{Quadratic, SphereHit, decide};
use crate::shape::{Ray, Sphere};
use crate::vector::{Coordinates, Number, Scalar, Vector};

/// The nearest root in the ray's range, accurate for far origins and for spheres of any size.
///
/// With q = f − (f·d/d²)·d, the vector from the line's closest point to the centre, the
/// discriminant is d²·(r + |q|)·(r − |q|), and with s = f·d ± its root, the sign that of
/// f·d, the roots are s/d² and (f² − r²)/s, where f² − r² = (|f| + r)·(|f| − r).
///
/// **Grade: exact** for hit or miss, and for which root it is, for every finite input. t has an error in
/// proportion to the distance and not to its square: it is the exact one for a radius that differs by at
/// most 16u·(|f| + r), u = EPSILON/2, unless it is subnormal; it is in the range, and the largest float where it is beyond that.
///
/// A zero direction, a negative radius, a NaN or infinite field, an empty range: a miss. A radius of zero is
/// a point.
///
/// ```
/// use isect::{Ray, Sphere, glam::Vec3, ray::sphere::robust};
///
/// let ray = Ray::new(Vec3::new(0.0, 0.0, -1.0e6), Vec3::Z);
/// let hit = robust::intersect(&ray, &Sphere::new(Vec3::ZERO, 1.0)).expect("a hit");
/// assert_eq!((hit.t, hit.leaving), (999_999.0, false));
/// // A tangent is a hit, the next float is a miss.
/// let at = |x| Ray::new(Vec3::new(x, 0.0, -1.0e6), Vec3::Z);
/// assert!(robust::intersect(&at(1.0), &Sphere::new(Vec3::ZERO, 1.0)).is_some());
/// assert!(robust::intersect(&at(1.000_000_1), &Sphere::new(Vec3::ZERO, 1.0)).is_none());
/// ```
#[inline]
#[must_use]
pub fn intersect<V: Vector>(ray: &Ray<V>, sphere: &Sphere<V>) -> Option<SphereHit<V::Scalar>> {
    certain(ray, sphere).unwrap_or_else(|| undecided(ray, sphere))
}

/// How closely a line passes the centre of a sphere, in one lane or several.
pub(crate) struct Approach<N> {
    /// f·d
    b: N,
    /// |q|
    distance: N,
    /// |f|
    f: N,
    /// How much further from the centre the surface is than the line; it is off by at most `error`.
    clearance: N,
    /// 16u·(|f| + r)
    error: N,
}

/// The roots, and by how much each may be off, if the clearance is more than four errors.
struct Roots<N> {
    near: N,
    far: N,
    error: N,
}

/// **The bounds.** u is EPSILON/2 and |f| stands for the distance from the origin to the centre. f has
/// one rounding; f·d is off by 4u|f||d|, (f·d)/d² by 8u|f|/|d|, and q in all by 11u|f|. So |q| is off by
/// 14u|f|, and r − |q| by less than 16u(|f| + r). Let c be half the chord: c² = (r + |q|)(r − |q|). If
/// r − |q| is large against its error, the root of the discriminant, |d|c, is off by
/// |d|(14u|f|r/c + 4uc); s with it by 4u|f||d| more; s/d² by at most 24u(|f| + r)(r/c)/|d|, as c ≤ r.
/// Of the other root, |f| − r is off by 3.5u|f|, which |s| ≥ |d|c, or ≥ |f·d| where the origin is far away,
/// divides; it is the lesser one, so that
/// the error of s counts no more than in the first: in all at most 48u(|f| + r)(r/c)/|d|. Taken are 64u.
impl<N: Number> Approach<N> {
    #[inline(always)]
    pub(crate) fn new<V: Coordinates<Scalar = N>>(q: &Quadratic<V>, epsilon: N) -> Self {
        let b = q.f.dot(q.d);
        let perpendicular = q.f - q.d * (b / q.a);
        let distance = perpendicular.dot(perpendicular).sqrt();
        let f = q.f2.sqrt();
        let error = (f + q.r) * (epsilon * b.lit(8.0));
        Self { b, distance, f, clearance: q.r - distance, error }
    }

    /// Whether the line passes by, for certain.
    #[inline(always)]
    fn misses(&self) -> N::Mask {
        self.clearance.lt(-self.error)
    }

    #[inline(always)]
    fn roots<V: Coordinates<Scalar = N>>(&self, q: &Quadratic<V>) -> Roots<N> {
        let Self { b, distance, f, clearance, error } = *self;
        let zero = b.lit(0.0);
        // Of a line that passes by: as if it were a tangent.
        let root = (q.a * ((q.r + distance) * clearance)).max(zero).sqrt();
        let c = (f + q.r) * (f - q.r);
        let s = b + N::select(b.lt(zero), -root, root);
        let first = s / q.a;
        // s is zero only where the ray starts at a tangent's touching point: both roots are zero then.
        let second = N::select(s.abs().le(zero), s, c / s);
        let error = error * b.lit(4.0) * (q.r / root);
        Roots { near: first.min(second), far: first.max(second), error }
    }

    /// The verdict where it is certain, for a quadratic in the middle of the range of exponents.
    #[inline(always)]
    pub(crate) fn certain<V: Coordinates<Scalar = N>>(
        &self,
        q: &Quadratic<V>,
        [t_min, t_max]: [N; 2],
    ) -> Certain<N> {
        let Roots { near, far, error } = self.roots(q);
        let (zero, four) = (error.lit(0.0), error.lit(4.0));
        let crosses = (self.error * four).lt(self.clearance) & t_min.le(t_max);
        // In the range or not, and whether that is certain.
        let near_within = (near - t_min).min(t_max - near);
        let far_within = (far - t_min).min(t_max - far);
        let (near_hits, far_hits) = (zero.lt(near_within), zero.lt(far_within));
        let near_is_certain = error.lt(near_within.abs());
        let far_is_certain = error.lt(far_within.abs());
        let decided = crosses & near_is_certain & (near_hits | far_is_certain);
        Certain {
            open: !(self.misses() | decided),
            hit: decided & (near_hits | far_hits),
            t: N::select(near_hits, near, far),
            leaving: !near_hits,
        }
    }
}

/// What is certain, in one lane or several: where `open` holds, nothing.
pub(crate) struct Certain<N: Number> {
    pub(crate) open: N::Mask,
    pub(crate) hit: N::Mask,
    pub(crate) t: N,
    pub(crate) leaving: N::Mask,
}

/// The verdict if it is certain.
#[inline(always)]
fn certain<V: Vector>(ray: &Ray<V>, sphere: &Sphere<V>) -> Option<Option<SphereHit<V::Scalar>>> {
    let q = super::quadratic(ray, sphere)?;
    let approach = Approach::new(&q, V::Scalar::EPSILON);
    if approach.misses() {
        return Some(None);
    }
    let Certain { open, hit, t, leaving } = approach.certain(&q, [ray.t_min, ray.t_max]);
    (!open).then(|| hit.then_some(SphereHit { t, leaving }))
}

/// Which stage decides a case, for measurements: 0 are floats, 2 are integers.
#[doc(hidden)]
#[must_use]
pub fn stage<V: Vector>(ray: &Ray<V>, sphere: &Sphere<V>) -> usize {
    if certain(ray, sphere).is_some() { 0 } else { 2 }
}

/// The verdict where floats leave it open, and for bad input.
#[cold]
#[inline(never)]
pub(crate) fn undecided<V: Vector>(
    ray: &Ray<V>,
    sphere: &Sphere<V>,
) -> Option<SphereHit<V::Scalar>> {
    let leaving = match decide::classify(ray, sphere)? {
        [Ordering::Equal, _] => false,
        [_, Ordering::Equal] => true,
        _ => return None,
    };
    let [near, far] = scaled_roots(ray, sphere)?;
    let t = ray.nearest_in_range(if leaving { far } else { near }.into());
    Some(SphereHit { t, leaving })
}

/// Both roots of the line, or those of a tangent where it seems to pass by. `None` for bad input.
fn scaled_roots<V: Vector>(ray: &Ray<V>, sphere: &Sphere<V>) -> Option<[V::Scalar; 2]> {
    let (q, t_scale, scale) = super::scaled(ray, sphere)?;
    let Roots { near, far, .. } = Approach::new(&q, V::Scalar::EPSILON).roots(&q);
    Some([near, far].map(|t| t.times_ratio(t_scale, scale)))
}

/// Both roots of the line, `None` where it misses.
pub(super) fn roots<V: Vector>(ray: &Ray<V>, sphere: &Sphere<V>) -> Option<[V::Scalar; 2]> {
    if let Some(q) = super::quadratic(ray, sphere) {
        let approach = Approach::new(&q, V::Scalar::EPSILON);
        if approach.clearance.abs() > approach.error {
            let Roots { near, far, .. } = approach.roots(&q);
            return (approach.clearance > V::Scalar::ZERO).then_some([near, far]);
        }
    }
    let line = ray.with_range(-V::Scalar::INFINITY, V::Scalar::INFINITY);
    decide::classify(&line, sphere).and_then(|_| scaled_roots(ray, sphere))
}
