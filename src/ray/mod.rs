//! A ray against a shape.
//!
//! One module per shape, with a file per algorithm, named after
//! it, each with its grade, its bounds and its paper. [`Intersect`] is the door to the recommended
//! kernel of each shape, and open to shapes of your own.

pub mod aabb;
pub mod plane;
pub mod polygon;
pub mod sphere;
pub mod triangle;

#[cfg(feature = "alloc")]
use alloc::{boxed::Box, sync::Arc};

use crate::shape::Ray;
use crate::vector::{Number, Vector};
use glam::Vec3;

/// A shape that a ray can hit.
///
/// The crate's shapes implement it with the kernel that it recommends; implement it for your own to
/// use them with [`Ray::intersect`] and [`Ray::hits`]. It can be made into an object
/// (`dyn Intersect<Vec3, Hit = f32>`), and references, `Box` and `Arc` have it where their
/// shape does.
///
/// ```
/// use isect::{Aabb, Intersect, Ray, glam::Vec3};
///
/// struct Instance { bounds: Aabb, offset: Vec3 }
///
/// impl Intersect for Instance {
///     type Hit = f32;
///     fn intersect(&self, ray: &Ray) -> Option<f32> {
///         let local = Ray { origin: ray.origin - self.offset, ..*ray };
///         local.intersect(&self.bounds).map(|hit| hit.t_enter)
///     }
/// }
///
/// let bounds = Aabb::new(Vec3::ZERO, Vec3::ONE);
/// let instance = Instance { bounds, offset: Vec3::new(0.0, 0.0, 4.0) };
/// let ray = Ray::new(Vec3::new(0.5, 0.5, 0.0), Vec3::Z);
/// assert_eq!(ray.intersect(&instance), Some(4.0));
/// ```
pub trait Intersect<V: Vector = Vec3> {
    /// What a hit tells.
    type Hit;

    /// The closest hit in the ray's range, or `None`.
    #[must_use]
    fn intersect(&self, ray: &Ray<V>) -> Option<Self::Hit>;

    /// Whether there is any hit in the ray's range: the same verdict as [`Self::intersect`], which
    /// may be cheaper to come by.
    #[must_use]
    fn hits(&self, ray: &Ray<V>) -> bool {
        self.intersect(ray).is_some()
    }
}

macro_rules! through_pointer {
    ($($pointer:ty),+) => {
        $(impl<V: Vector, S: Intersect<V> + ?Sized> Intersect<V> for $pointer {
            type Hit = S::Hit;
            #[inline]
            fn intersect(&self, ray: &Ray<V>) -> Option<S::Hit> {
                (**self).intersect(ray)
            }
            #[inline]
            fn hits(&self, ray: &Ray<V>) -> bool {
                (**self).hits(ray)
            }
        })+
    };
}

through_pointer!(&S);
#[cfg(feature = "alloc")]
through_pointer!(Box<S>, Arc<S>);

impl<V: Vector> Ray<V> {
    /// The closest hit of `shape` in the ray's range, by the kernel that the crate recommends for
    /// it.
    ///
    /// Sets are closed: a ray that starts on a surface hits it at t = 0.
    ///
    /// ```
    /// use isect::{Ray, Sphere, glam::Vec3};
    ///
    /// let ray = Ray::new(Vec3::new(0.0, 0.0, -3.0), Vec3::Z);
    /// let hit = ray.intersect(&Sphere::new(Vec3::ZERO, 1.0)).expect("it is aimed at the centre");
    /// assert_eq!(hit.t, 2.0);
    /// ```
    #[inline]
    #[must_use]
    pub fn intersect<S: Intersect<V> + ?Sized>(&self, shape: &S) -> Option<S::Hit> {
        shape.intersect(self)
    }

    /// Whether `shape` has any hit in the ray's range, as a shadow ray asks.
    ///
    /// ```
    /// use isect::{Aabb, Ray, glam::Vec3};
    ///
    /// let aabb = Aabb::new(Vec3::ZERO, Vec3::ONE);
    /// let to_lamp = Ray::segment(Vec3::new(0.5, 0.5, -1.0), Vec3::new(0.5, 0.5, 9.0));
    /// assert!(to_lamp.hits(&aabb) && !to_lamp.after(0.25).hits(&aabb));
    /// ```
    #[inline]
    #[must_use]
    pub fn hits<S: Intersect<V> + ?Sized>(&self, shape: &S) -> bool {
        shape.hits(self)
    }
}

/// Whether t is finite and lies in the closed range. False if any of the three is NaN.
#[inline(always)]
fn in_range<N: Number>(t: N, t_min: N, t_max: N) -> N::Mask {
    // A NaN at either end survives `max` and `min` as their second operand.
    (-t.largest()).max(t_min).le(t) & t.le(t.largest().min(t_max))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::{Aabb, Sphere, Triangle};

    /// A shape of a user's: the nearest of some others, which are objects.
    #[cfg(feature = "alloc")]
    struct Group<'a>([Box<dyn Intersect<Vec3, Hit = f32> + 'a>; 2]);

    #[cfg(feature = "alloc")]
    impl Intersect for Group<'_> {
        type Hit = f32;
        fn intersect(&self, ray: &Ray) -> Option<f32> {
            self.0.iter().filter_map(|shape| ray.intersect(shape)).reduce(f32::min)
        }
    }

    /// Reports t alone.
    struct Distance<S>(S);

    impl<S: Intersect<Hit = sphere::SphereHit<f32>>> Intersect for Distance<S> {
        type Hit = f32;
        fn intersect(&self, ray: &Ray) -> Option<f32> {
            ray.intersect(&self.0).map(|hit| hit.t)
        }
    }

    #[cfg(feature = "alloc")]
    #[test]
    fn shapes_of_users_nest_and_may_be_objects() {
        let far = Distance(Arc::new(Sphere::new(Vec3::Z * 9.0, 1.0)));
        let near = Sphere::new(Vec3::Z * 4.0, 1.0);
        let group = Group([Box::new(far), Box::new(Distance(&near))]);
        let ray = Ray::new(Vec3::ZERO, Vec3::Z);
        assert_eq!(ray.intersect(&group), Some(3.0));
        assert!(ray.after(6.0).hits(&group) && !ray.before(3.0).hits(&group));
    }

    #[test]
    fn hits_is_intersect_for_every_shape() {
        let triangle = Triangle::new(Vec3::ZERO, Vec3::X, Vec3::Y);
        let (aabb, sphere) = (Aabb::new(Vec3::ZERO, Vec3::ONE), Sphere::new(Vec3::ZERO, 0.5));
        for x in 0_u8..8 {
            let ray = Ray::new(Vec3::new(f32::from(x) * 0.25, 0.25, 3.0), Vec3::NEG_Z);
            assert_eq!(ray.hits(&triangle), ray.intersect(&triangle).is_some());
            assert_eq!(ray.hits(&aabb), ray.intersect(&aabb).is_some());
            assert_eq!(ray.hits(&Distance(sphere)), ray.intersect(&sphere).is_some());
        }
    }

    #[test]
    fn a_range_is_closed_and_finite() {
        assert!(in_range(1.0_f32, 1.0, 1.0) && in_range(-3.0, f32::NEG_INFINITY, f32::INFINITY));
        assert!(!in_range(1.0_f32, 1.5, 2.0) && !in_range(1.0_f32, 0.0, 0.5));
        assert!(!in_range(1.0_f32, 2.0, 0.0));
        for t in [f32::INFINITY, f32::NEG_INFINITY, f32::NAN] {
            assert!(!in_range(t, f32::NEG_INFINITY, f32::INFINITY));
        }
        assert!(!in_range(1.0, f32::NAN, 2.0) && !in_range(1.0, 0.0, f32::NAN));
    }
}
