//! Ray against sphere.
//!
//! All three kernels solve d²·t² − 2(f·d)·t + f² − r² = 0, f the vector from the ray's origin to
//! the centre; they differ in how they come to the roots.
//!
//! | kernel | grade | construction | good for |
//! |---|---|---|---|
//! | [`robust`] | exact | perpendicular distance, stable roots | everything; the default |
//! | [`geometric`] | fast | closest approach and half chord | rays that start within a few hundred radii |
//! | [`algebraic`] | fast | the quadratic formula | the same |

pub mod algebraic;
mod decide;
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
/// [`robust::intersect`] does. `None` where the line misses the sphere, exactly; for bad input; and
/// where a root is beyond the largest float.
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
    robust::roots(ray, sphere).filter(|roots| roots.iter().all(|t| t.is_finite()))
}

/// The quadratic as each kernel gets it: `a = d²` and `b = f·d` are computed already.
pub(crate) struct Quadratic<V: Coordinates> {
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
    pub(crate) fn new(d: V, f: V, r: V::Scalar) -> Self {
        Self { d, f, r, a: d.dot(d), f2: f.dot(f) }
    }

    /// Whether the radius is not negative, and squares and products stay in the middle of the range of
    /// exponents.
    #[inline(always)]
    pub(crate) fn is_mid_range(&self) -> <V::Scalar as Number>::Mask {
        let lengths = self.f2 + self.r * self.r;
        self.a.is_mid_range()
            & lengths.is_mid_range()
            & (self.a * lengths).is_mid_range()
            & self.r.lit(0.0).le(self.r)
    }
}

/// The roots in order, NaN where there are none.
type Roots<N> = [N; 2];

/// The quadratic, if it stays in the middle of the range of exponents.
#[inline(always)]
fn quadratic<V: Vector>(ray: &Ray<V>, sphere: &Sphere<V>) -> Option<Quadratic<V>> {
    let q = Quadratic::new(ray.direction, sphere.center - ray.origin, sphere.radius);
    q.is_mid_range().then_some(q)
}

/// The quadratic with the direction, and the lengths, brought to about 1 by powers of two, and these. `None`
/// for bad input.
fn scaled<V: Vector>(
    ray: &Ray<V>,
    sphere: &Sphere<V>,
) -> Option<(Quadratic<V>, V::Scalar, V::Scalar)> {
    if !(ray.is_valid() && sphere.is_valid()) {
        return None;
    }
    let one = V::Scalar::ONE;
    let halved = |by| (sphere.center * by - ray.origin * by, sphere.radius * by, by);
    let (mut f, mut radius, mut by) = halved(one);
    if !f.is_finite() {
        (f, radius, by) = halved(one.lit(0.5));
    }
    let t_scale = ray.direction.normalizer();
    let scale = Coordinates::abs(f).max_element().max(radius).normalizer();
    let q = Quadratic::new(ray.direction * t_scale, f * scale, radius * scale);
    Some((q, t_scale, scale * by))
}

/// Solves for the roots with one of the kernels; starts again with a scaled problem where squares
/// leave the range of exponents.
#[inline(always)]
fn solve<V: Vector>(
    ray: &Ray<V>,
    sphere: &Sphere<V>,
    kernel: impl Fn(&Quadratic<V>) -> Roots<V::Scalar>,
) -> Option<Roots<V::Scalar>> {
    if let Some(q) = quadratic(ray, sphere) {
        return Some(kernel(&q));
    }
    extreme(ray, sphere, kernel)
}

#[cold]
fn extreme<V: Vector>(
    ray: &Ray<V>,
    sphere: &Sphere<V>,
    kernel: impl Fn(&Quadratic<V>) -> Roots<V::Scalar>,
) -> Option<Roots<V::Scalar>> {
    let (q, t_scale, scale) = scaled(ray, sphere)?;
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

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DVec3, Vec3, Vec3A};

    type Kernel<V> = fn(&Ray<V>, &Sphere<V>) -> Option<SphereHit<<V as Coordinates>::Scalar>>;

    fn kernels<V: Vector>() -> [Kernel<V>; 3] {
        [algebraic::intersect, geometric::intersect, robust::intersect]
    }

    #[test]
    fn near_far_tangent_and_miss() {
        let unit = Sphere::new(Vec3A::ZERO, 1.0);
        let along = |x: f32, z: f32| Ray::new(Vec3A::new(x, 0.0, z), Vec3A::Z * 2.0);
        for intersect in kernels() {
            let hit = |t, leaving| Some(SphereHit { t, leaving });
            assert_eq!(intersect(&along(0.0, -3.0), &unit), hit(1.0, false));
            assert_eq!(intersect(&along(0.0, 0.0), &unit), hit(0.5, true));
            assert_eq!(intersect(&along(1.0, -3.0), &unit), hit(1.5, false), "tangent");
            assert_eq!(intersect(&along(1.01, -3.0), &unit), None);
            assert_eq!(intersect(&along(0.0, 3.0), &unit), None, "behind");
            assert_eq!(intersect(&along(0.0, -3.0).after(1.0), &unit), hit(2.0, true));
            assert_eq!(intersect(&along(0.0, -1.0), &unit), hit(0.0, false), "on the surface");
            assert_eq!(
                intersect(&along(0.0, -3.0), &Sphere::new(Vec3A::ZERO, 0.0)),
                hit(1.5, false)
            );
            assert_eq!(intersect(&along(0.0, -3.0), &Sphere::new(Vec3A::ZERO, -1.0)), None);
        }
    }

    #[test]
    fn a_tangent_at_the_origin_of_the_ray() {
        let sphere = Sphere::new(Vec3::X, 1.0);
        let hit = robust::intersect(&Ray::new(Vec3::ZERO, Vec3::Y), &sphere);
        assert_eq!(hit, Some(SphereHit { t: 0.0, leaving: false }));
    }

    /// The textbook discriminant loses all of the radius here.
    #[test]
    fn robust_is_accurate_from_afar() {
        let ray = Ray::new(Vec3::new(0.0, 0.5, -1.0e5), Vec3::Z);
        let [near, far] = roots(&ray, &Sphere::new(Vec3::ZERO, 1.0)).expect("a hit");
        let half_chord = 0.75_f32.sqrt();
        // Two ulps of 1e5.
        assert!(
            (near - (1.0e5 - half_chord)).abs() <= 0.016
                && (far - (1.0e5 + half_chord)).abs() <= 0.016
        );
    }

    #[test]
    fn lengths_of_any_size() {
        // From three radii away, far from the cancellations: within a few ulps.
        for scale in [1e-18_f32, 1e18, 1e-37, 1e37] {
            for (length, t) in [(1.0, 2.0 * scale), (scale, 2.0)] {
                let ray = Ray::new(Vec3::new(0.0, 0.0, -3.0 * scale), Vec3::Z * length);
                let sphere = Sphere::new(Vec3::ZERO, scale);
                for intersect in kernels() {
                    let hit = intersect(&ray, &sphere).expect("a hit");
                    assert!((hit.t - t).abs() <= 8.0 * f32::EPSILON * t, "{scale} {length}");
                }
                for intersect in kernels::<DVec3>() {
                    let hit = intersect(&ray.into(), &sphere.into()).expect("a hit");
                    assert!((hit.t - f64::from(t)).abs() <= f64::from(f32::EPSILON * t));
                }
            }
        }
    }
}
