//! Cone against plane.
//!
//! J. Amanatides, "Ray Tracing with Cones", SIGGRAPH 1984. Seen from the cone's apex a plane is the half of
//! its section beyond a straight horizon; the ends of the range are lines parallel to that.

use core::f64::consts::PI;

use super::cone::{Axis, ConeHit};
use crate::exact::wide;
use crate::shape::{Cone, Plane};
use crate::vector::{Number, Scalar, Vector, acos};

/// Where the cone touches the plane, and what share of its section the plane covers.
///
/// Let n be the unit normal, nₐ its part along the axis and N the length of its part across it. In the
/// section, a unit disk, the plane at z is the line at (offset − n·o − nₐ·z)/(N·r(z)) from the centre.
/// It covers what lies between the lines of both ends of the range; a line at h cuts off the share
/// (acos h − h·√(1 − h²))/π. t is the least one at which the disk around `ray.at(t)` touches the plane.
///
/// **Grade: conservative** for hit or miss: no plane that the cone touches is missed; let u be 2⁻⁵³: it may be found by
/// a cone that is wider by 64u·((Σ|nᵢ·oᵢ| + |offset|)/|n| + radius + (Σ|nᵢ·dᵢ|/|n| + spread)/|d|·z) at a distance of z
/// from its origin. t is that of such a cone. The coverage is within 20u, and the rounding to the scalar, of that of a plane moved by as much.
///
/// A plane through the apex is seen edge-on and covers nothing. Bad input, which is a cone that touches
/// nothing or a plane that is never hit: `None`.
///
/// ```
/// use isect::{Cone, Plane, Ray, glam::Vec3, overlap::cone_plane};
///
/// // A cylinder that looks along the floor, from a quarter of its width above it.
/// let cone = Cone::new(Ray::new(Vec3::Y * 0.5, Vec3::Z), 1.0, 0.0);
/// let floor = Plane { normal: Vec3::Y, offset: 0.0 };
/// let hit = cone_plane::intersect(&cone, &floor).expect("it is as wide as that");
/// assert_eq!((hit.t, hit.coverage), (0.0, 0.0)); // it stands in the floor, which it sees edge-on
/// // Half of a cone from above.
/// let cone = Cone::new(Ray::new(Vec3::Y * 2.0, Vec3::Z), 0.0, 0.5);
/// let hit = cone_plane::intersect(&cone, &floor).expect("it is wide enough in the end");
/// assert_eq!((hit.t, hit.coverage), (4.0, 0.5));
/// ```
#[must_use]
pub fn intersect<V: Vector>(cone: &Cone<V>, plane: &Plane<V>) -> Option<ConeHit<V::Scalar>> {
    let view = View::new(cone, plane)?;
    let z = view.nearest()?;
    let t = cone.ray.nearest_in_range((z / view.length).max(0.0));
    Some(ConeHit { t, coverage: V::Scalar::ONE.lit(view.coverage()) })
}

/// Whether the cone touches the plane: the verdict of [`intersect`].
///
/// **Grade: conservative**, as [`intersect`].
///
/// ```
/// use isect::{Cone, Plane, Ray, glam::Vec3, overlap::cone_plane};
///
/// let floor = Plane { normal: Vec3::Y, offset: 0.0 };
/// let cone = |t_max| Cone::new(Ray::new(Vec3::Y, Vec3::X).with_range(0.0, t_max), 0.0, 0.5);
/// assert!(cone_plane::touches(&cone(2.0), &floor) && !cone_plane::touches(&cone(1.9), &floor));
/// ```
#[must_use]
pub fn touches<V: Vector>(cone: &Cone<V>, plane: &Plane<V>) -> bool {
    View::new(cone, plane).is_some_and(|view| view.nearest().is_some())
}

/// A plane as a cone sees it.
struct View {
    /// nₐ, the growth of the plane's equation along the axis.
    along: f64,
    /// N
    across: f64,
    /// offset − n·o, the distance of the plane from the cone's origin.
    distance: f64,
    radius: f64,
    slope: f64,
    /// The ends of the range of z.
    near: f64,
    far: f64,
    /// The length of the direction.
    length: f64,
    /// By how much rounding may have moved the plane or the rim of the disk.
    margin: f64,
    /// And by how much more for each unit of z: a plane along the axis stays so.
    turned: f64,
}

impl View {
    fn new<V: Vector>(cone: &Cone<V>, plane: &Plane<V>) -> Option<Self> {
        if !cone.is_valid() || !plane.is_valid() {
            return None;
        }
        let Axis { frame, length, slope } = Axis::new(cone);
        let normal = wide(plane.normal);
        let scale = Vector::normalizer(normal);
        let scaled = normal * scale;
        let size = scaled.length();
        let unit = scaled / size;
        let (origin, offset) = (wide(cone.ray.origin), plane.offset.into() * scale / size);
        let [first, second, along] = frame.map(|e| e.dot(unit));
        let [near, far] = [cone.ray.t_min, cone.ray.t_max].map(|t| t.into().max(0.0) * length);
        let rounding = 16.0 * f64::EPSILON;
        let radius: f64 = cone.radius.into();
        let moved = unit.abs().dot(origin.abs()) + offset.abs() + radius;
        Some(Self {
            along,
            across: Number::sqrt(first * first + second * second),
            distance: offset - unit.dot(origin),
            radius,
            slope,
            near,
            far,
            length,
            margin: rounding * moved,
            turned: rounding * (frame[2].abs().dot(unit.abs()) + slope),
        })
    }

    /// The radius of the section at z, which may be infinite.
    fn radius_at(&self, z: f64) -> f64 {
        if self.slope > 0.0 { self.radius + self.slope * z } else { self.radius }
    }

    /// The least z at which the section meets the plane.
    ///
    /// Over the disk at z the plane's equation n·p − offset takes the values from nₐ·z − distance − N·r(z)
    /// to nₐ·z − distance + N·r(z), both linear in z.
    fn nearest(&self) -> Option<f64> {
        let Self { along, across, distance, near, far, margin, .. } = *self;
        let reach = across * self.slope + self.turned;
        let middle = along * near - distance;
        let extent = across * self.radius + margin + reach * near;
        let gap = middle.abs() - extent;
        if gap <= 0.0 {
            return Some(near);
        }
        // The nearer end of the interval has so far to go to 0, by so much with z.
        let approach = reach - if middle > 0.0 { along } else { -along };
        let z = near + gap / approach;
        (approach > 0.0 && z <= far).then_some(z)
    }

    /// The share of the disk that the plane covers.
    fn coverage(&self) -> f64 {
        let Self { along, across, distance, near, far, .. } = *self;
        // The share on the far side of the line at z, in the direction of the normal.
        let beyond = |z: f64| {
            let height = if z < f64::INFINITY {
                (distance - along * z) / (across * self.radius_at(z))
            } else if self.slope > 0.0 {
                -along / (across * self.slope)
            } else if along == 0.0 {
                distance / (across * self.radius)
            } else {
                -along * z
            };
            let h = height.clamp(-1.0, 1.0);
            (acos(h) - h * Number::sqrt((1.0 - h) * (1.0 + h))) / PI
        };
        let share = (beyond(near) - beyond(far)).abs();
        // Edge-on there is no line.
        if share >= 0.0 { share } else { 0.0 }
    }
}
