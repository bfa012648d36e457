//! Where a secondary ray may start: error bounds of hit points, and origins off the surface.
//!
//! A hit point is rounded: it lies beside its surface, and a ray that starts there may hit the surface
//! that it leaves. A fixed tolerance cures that at one scale and fails at the next. Here the hit says
//! by how much its point may be off, and the ray starts beyond that, hardly farther:
//!
//! ```
//! use isect::{Ray, Triangle, glam::Vec3, spawn};
//!
//! let triangle = Triangle::new(Vec3::ZERO, Vec3::new(3.0, 0.1, 0.2), Vec3::new(0.3, 5.0, 0.7));
//! let ray = Ray::new(Vec3::new(1.0, 1.0, 9.0), Vec3::new(0.01, 0.02, -1.0));
//! let hit = ray.intersect(&triangle).expect("it is aimed at the inside");
//!
//! let (point, error) = hit.point_and_error(&triangle);
//! for direction in [Vec3::Z, Vec3::NEG_Z, Vec3::X, triangle.v1 - point] {
//!     let origin = spawn::offset_origin(point, error, triangle.normal(), direction);
//!     assert!(!Ray::new(origin, direction).hits(&triangle));
//! }
//! ```
//!
//! | shape | point and error | normal to offset along |
//! |---|---|---|
//! | triangle | [`TriangleHit::point_and_error`] | `triangle.normal()`, or that over its length |
//! | sphere | [`SphereHit::point_and_error`] | `sphere.normal_at(point)` or `point - center` |
//! | box | [`AabbHit::point_and_error`] | `face.normal()` of [`AabbHit::surface`] |
//! | plane | [`PlaneHit::point_and_error`] | `plane.normal`, not normalised |
//!
//! # What is promised
//!
//! Let p be the point, δ its error, n the normal, and |v| the vector of the magnitudes of v's
//! components. For the points x of the surface, in exact arithmetic,
//!
//! * some x is within δ of p in each component;
//! * |n·(x − p)| ≤ |n|·δ: no part of a triangle or a plane is farther from p along the normal. (Of a
//!   sphere or a box no part is farther outward; inward there is the rest of it.)
//!
//! [`offset_origin`] puts the origin o where n·(o − p) > |n|·δ, for a direction d with n·d ≥ 0, a sign
//! that it decides exactly. So n·(o + t·d) > n·x for all t ≥ 0: the ray hits none of the surface, however
//! far it goes and however flatly; and likewise on the other side. Into a sphere the origin is strictly
//! inside, and the ray hits but the far side; into a box it is behind the face. (A point on an edge of
//! the box is on another face as well, and the ray may enter by that.)
//!
//! The recommended kernels, which are exact, hit the surface no more than exact arithmetic does. Others
//! may, where the ray is within their own error bounds of it: the errors here leave no room for them.
//!
//! # How far
//!
//! At most 9 ulps of the shape's largest coordinate farther than the least that works: 13 from a sphere that floats
//! cannot tell from a point. The least is that of each hit: the share of the way from p to its two origins, one on
//! either side, from where on none of 1,000 rays hits the surface, be they in any direction, flat, along axes or towards
//! vertices. Measured for hits on shapes of each kind, 3,000 in `f32` and 100 in `f64`, as much farther are
//!
//! | shape | half of them | 99 % | all |
//! |---|---|---|---|
//! | triangle a tenth as large as its distance from zero | 1.1 | 2.5 | 4 |
//! | triangle as large, not narrower than 1 to 8 | 2.9 | 6.5 | 9 |
//! | triangle of any shape, coordinates of 10^±8 | 0.3 | 3.5 | 6 |
//! | sphere, coordinates and radius of 10^±4 | 0.9 | 4 | 5 |
//! | sphere with a radius of 32 to 300 roundings of its centre | 0.5 | 1.5 | 2 |
//! | smaller sphere | 1.5 | 9 | 13 |
//! | box | 0.1 | 0.6 | 0.6 |
//! | plane, ulps of the point's largest coordinate | 0.9 | 7 | 7.5 |
//!
//! After M. Pharr, W. Jakob, G. Humphreys, "Physically Based Rendering", 3rd edition, 2016, 3.9.5,
//! "Robust Spawned Ray Origins". There, errors are bounded in advance, and the side of a flat ray is
//! that of a rounded normal; here what can be computed of the errors is computed, the tilt of the
//! normal with it.

use crate::exact::dot_sign;
use crate::ray::aabb::AabbHit;
use crate::ray::plane::PlaneHit;
use crate::ray::sphere::SphereHit;
use crate::ray::triangle::TriangleHit;
use crate::shape::{Aabb, Affine, Plane, Ray, Sphere, Triangle};
use crate::vector::{Coordinates, Number, Scalar, Vector};

impl<T: Scalar> TriangleHit<T> {
    /// The hit's point, and by how much it may be beside the triangle in each component.
    ///
    /// p = v0 + (u·(v1 − v0) + v·(v2 − v0)), which is in the triangle's plane for any u and v: their
    /// errors do not count. With e and f the two products and u = EPSILON/2, the error is the sum of
    ///
    /// * γ(3)·(|e| + |f|) + u·|p|: a difference, a product and a sum, then the last sum. (4u stand for
    ///   γ(3), and make up for the bound's own rounding.)
    /// * along the normal n, what |n|·δ lacks of the largest of |n·(v_i − p)| + 8u·|n|·|v_i − p|: 4u for
    ///   its own rounding, 4u for a normal that is rounded again, by a normalisation.
    ///
    /// So a triangle as good as flat, of which the normal is all rounding, gets a large error, and one
    /// whose normal over- or underflows an error that covers the whole of it. Where an edge is beyond the
    /// largest float the error is infinite.
    ///
    /// **How large:** [`offset_origin`] moves p by 1.4 ulps of the vertices' largest coordinate, at most 4,
    /// where the triangle is a tenth as large as its distance from zero, or smaller; by 2.7, at most 8,
    /// where it is as large: medians, for triangles not narrower than 1 to 8. A sixteenth of the error would
    /// be too little.
    ///
    /// For a hit on another triangle the result means nothing.
    ///
    /// ```
    /// use isect::{Triangle, glam::Vec3, ray::triangle::TriangleHit};
    ///
    /// let triangle = Triangle::new(Vec3::ZERO, Vec3::X * 4.0, Vec3::Y * 4.0);
    /// let hit = TriangleHit { t: 1.0, u: 0.25, v: 0.5, front: true };
    /// let (point, error) = hit.point_and_error(&triangle);
    /// assert_eq!(point, Vec3::new(1.0, 2.0, 0.0));
    /// assert!(error.max_element() < 1e-5);
    /// ```
    #[must_use]
    pub fn point_and_error<V>(&self, triangle: &Triangle<V>) -> (V, V)
    where
        V: Vector + Coordinates<Scalar = T>,
    {
        let Triangle { v0, v1, v2 } = *triangle;
        let (along1, along2) = ((v1 - v0) * self.u, (v2 - v0) * self.v);
        let point = v0 + (along1 + along2);
        if !point.is_finite() {
            return (self.interpolate(v0, v1, v2), V::INFINITY);
        }
        let epsilon = T::EPSILON;
        let evaluation = (along1.abs() + along2.abs()) * (epsilon + epsilon)
            + point.abs() * (epsilon * epsilon.lit(0.5))
            + V::splat(underflow());

        let vertices = [v0 - point, v1 - point, v2 - point];
        let Some(unit) = normalized(triangle.normal()) else {
            let extent = vertices[0].abs().max(vertices[1].abs()).max(vertices[2].abs());
            return (point, extent * margin::<T>() + evaluation);
        };
        let unit2 = unit.dot(unit);
        let distance = |vertex: V| {
            let rounding = unit.abs().dot(vertex.abs()) * (epsilon * epsilon.lit(4.0));
            unit.dot(vertex).abs() + rounding
        };
        let farthest = vertices.map(distance).into_iter().fold(T::ZERO, Number::max);
        let spread = (farthest + underflow()) * margin::<T>();
        let missing = (spread - unit.abs().dot(evaluation)).max(T::ZERO);
        (point, evaluation + unit.abs() * (missing / unit2 * margin::<T>()))
    }
}

impl<T: Scalar> SphereHit<T> {
    /// The hit's point, moved to the sphere, and by how much it may be beside it in each component.
    ///
    /// p = c + r·a/|a|, a = (o − c) + t·d: the error of t is gone but for its share along the sphere.
    /// What remains is the rounding of p, and that can be computed. With m = p − c and u = EPSILON/2,
    /// the sphere's nearest point is off by ||m| − r| along m, and the error is
    ///
    /// δ = (|r − |m|| + 4u·r + 16u²·P²/r)·|m_i|/|m|, P the largest component of p.
    ///
    /// 4u·r: the computed |m| is off by 3.5u·r. The last term is for rays to the inside: rounding moves
    /// their origin by up to 5.2u·P across m, which takes it (5.2u·P)²/2r outward.
    ///
    /// A sphere that floats cannot tell from a point (r < 32u·P, or below four times the smallest normal number) gets an error that
    /// covers the whole of it: a ray to the inside starts behind it. An eighth of the error would be too little.
    ///
    /// For a hit on another sphere the result means nothing.
    ///
    /// ```
    /// use isect::{Ray, Sphere, glam::Vec3, spawn};
    ///
    /// let sphere = Sphere::new(Vec3::new(100.0, 0.0, 0.0), 0.5);
    /// let ray = Ray::new(Vec3::ZERO, Vec3::new(1.0, 0.003, 0.001));
    /// let hit = ray.intersect(&sphere).expect("it is aimed at the inside");
    /// let (point, error) = hit.point_and_error(&ray, &sphere);
    /// let normal = sphere.normal_at(point);
    /// let mirrored = ray.direction - normal * (2.0 * normal.dot(ray.direction));
    /// let origin = spawn::offset_origin(point, error, normal, mirrored);
    /// assert!(!Ray::new(origin, mirrored).hits(&sphere));
    /// ```
    #[must_use]
    pub fn point_and_error<V>(&self, ray: &Ray<V>, sphere: &Sphere<V>) -> (V, V)
    where
        V: Vector + Coordinates<Scalar = T>,
    {
        let Sphere { center, radius } = *sphere;
        let arm = (ray.origin - center) + ray.direction * self.t;
        let point = match normalized(arm) {
            Some(unit) => center + unit * (radius / unit.dot(unit).sqrt()),
            None => center,
        };
        let epsilon = T::EPSILON;
        let arm = point - center;
        let length = arm.length();
        let rounding = (epsilon + epsilon) * point.abs().max_element();
        let smallest = (rounding * epsilon.lit(8.0)).max(T::MIN_POSITIVE * epsilon.lit(4.0));
        let error = if radius < smallest || length == T::ZERO {
            (arm.abs() + V::splat(radius)) * (T::ONE + epsilon.lit(16.0) * epsilon)
        } else {
            let depth = (radius - length).abs()
                + radius * (epsilon * epsilon.lit(2.0))
                + rounding * (rounding / radius);
            arm.abs() * (depth / length * margin::<T>())
        };
        (point, error + V::splat(underflow()))
    }
}

impl<T: Scalar> AabbHit<T> {
    /// The point of [`Self::surface`], moved to its face, and its error of zero; `None` if the ray
    /// neither enters nor leaves in its range.
    ///
    /// The component on the face's axis is the box's bound, the others are those of o + t·d, not beyond
    /// their own bounds: the point lies on the face exactly.
    ///
    /// For a hit on another box the result means nothing.
    ///
    /// ```
    /// use isect::{Aabb, Ray, glam::Vec3};
    ///
    /// let aabb = Aabb::new(Vec3::ZERO, Vec3::splat(0.3));
    /// let ray = Ray::new(Vec3::new(0.1, 0.2, 7.0), Vec3::NEG_Z);
    /// let hit = ray.intersect(&aabb).expect("it is aimed at the inside");
    /// let (point, error) = hit.point_and_error(&ray, &aabb).expect("it starts outside");
    /// assert_eq!((point, error), (Vec3::new(0.1, 0.2, 0.3), Vec3::ZERO));
    /// ```
    #[must_use]
    pub fn point_and_error<V>(&self, ray: &Ray<V>, aabb: &Aabb<V>) -> Option<(V, V)>
    where
        V: Vector + Coordinates<Scalar = T>,
    {
        let (t, face) = self.surface()?;
        let at = ray.at(t);
        let component = |axis: usize| {
            let (min, max) = (aabb.min.component(axis), aabb.max.component(axis));
            match (face.axis() == axis, face.sign() < 0) {
                (true, true) => min,
                (true, false) => max,
                (false, _) => at.component(axis).max(min).min(max),
            }
        };
        Some((V::new(component(0), component(1), component(2)), V::ZERO))
    }
}

impl<T: Scalar> PlaneHit<T> {
    /// The hit's point, moved to the plane, and by how much it may be beside it in each component;
    /// `None` if the ray lies in the plane.
    ///
    /// q = o + t·d, p = q − n·(n·q − offset)/n²: the error of t is gone but for its share along the plane.
    /// What remains can be computed. With s = n·p − offset, B = Σ|n_i·p_i| + |offset| and u = EPSILON/2,
    /// the plane's nearest point is off by |s|/|n| along the normal, and the error is
    ///
    /// δ = (|s| + 5u·B)·|n_i|/n²
    ///
    /// s is off by at most 4u·B. A sixteenth of the error would be too little.
    ///
    /// A point beyond the largest float is infinite, or has an infinite error. For a hit on another plane
    /// the result means nothing.
    ///
    /// ```
    /// use isect::{Plane, Ray, glam::Vec3, spawn};
    ///
    /// let normal = Vec3::new(0.1, 1.0, 0.2);
    /// let plane = Plane::from_point_normal(Vec3::ONE, normal).expect("the normal is not zero");
    /// let ray = Ray::new(Vec3::new(0.0, 9.0, 0.0), Vec3::new(0.3, -0.7, 0.1));
    /// let hit = ray.intersect(&plane).expect("it looks down");
    /// let (point, error) = hit.point_and_error(&ray, &plane).expect("it is not parallel");
    /// let origin = spawn::offset_origin(point, error, plane.normal, Vec3::Y);
    /// assert!(!Ray::new(origin, Vec3::Y).hits(&plane));
    /// ```
    #[must_use]
    pub fn point_and_error<V>(&self, ray: &Ray<V>, plane: &Plane<V>) -> Option<(V, V)>
    where
        V: Vector + Coordinates<Scalar = T>,
    {
        let Self::At(t) = *self else { return None };
        let unprojected = ray.at(t);
        let Some(unit) = normalized(plane.normal) else {
            return Some((unprojected, V::INFINITY));
        };
        let scale = plane.normal.normalizer();
        let offset = plane.offset * scale;
        let above = |point: V| unit.dot(point) - offset;
        let unit2 = unit.dot(unit);
        let point = unprojected - unit * (above(unprojected) / unit2);
        if !point.is_finite() {
            return Some((unprojected, V::INFINITY));
        }
        let magnitude = unit.abs().dot(point.abs()) + offset.abs();
        let distance =
            above(point).abs() + magnitude * (T::EPSILON * offset.lit(2.5)) + underflow();
        let error = unit.abs() * (distance / unit2 * margin::<T>()) + V::splat(underflow());
        Some((point, error))
    }
}

/// An origin for rays from the surface at `point` in `direction` that do not hit that surface.
///
/// o = p ± k·n, k = |n|·δ/n², each component rounded away from p: so n·(o − p) > |n|·δ on the side to
/// which n·d points. That sign is decided exactly; of zero, either side will do. The normal is of any
/// length and either side; the error is that of `point_and_error`.
///
/// **How far:** by |n|·δ over the length of n along the normal, by 1 or 2 ulps more in each component, and
/// by EPSILON²·P + MIN_POSITIVE, P the point's largest coordinate, so that from a coordinate of zero no t
/// underflows to zero on the way back.
///
/// Of a zero, infinite or NaN normal nothing can be said: the origin is then put outside of the box p ± δ,
/// on the sides to which the direction points. An error that is infinite or NaN puts it at infinity, and
/// rays from there hit nothing.
///
/// ```
/// use isect::{glam::Vec3, spawn};
///
/// let (point, error) = (Vec3::new(1.0, 2.0, 3.0), Vec3::splat(1e-6));
/// let above = spawn::offset_origin(point, error, Vec3::Z * 7.0, Vec3::new(5.0, 0.0, 0.1));
/// let below = spawn::offset_origin(point, error, Vec3::Z * 7.0, Vec3::new(5.0, 0.0, -0.1));
/// assert!(above.z > 3.000_001 && below.z < 2.999_999);
/// assert_eq!(above.truncate(), point.truncate());
/// ```
#[must_use]
pub fn offset_origin<V: Vector>(point: V, error: V, normal: V, direction: V) -> V {
    let (zero, one, epsilon) = (V::Scalar::ZERO, V::Scalar::ONE, V::Scalar::EPSILON);
    // A NaN counts as infinity.
    let error = error.map(|error| error.abs().min(V::Scalar::INFINITY));
    let least = point.abs().max_element() * (epsilon * epsilon) + V::Scalar::MIN_POSITIVE;
    let (sides, steps) = match normalized(normal) {
        Some(unit) => {
            let side = if dot_sign(normal, direction) < zero { -one } else { one };
            let weighted = |axis: usize| {
                let weight = unit.component(axis).abs();
                // An infinite error across the normal does not matter.
                if zero < weight { weight * error.component(axis) } else { zero }
            };
            let reach = weighted(0) + weighted(1) + weighted(2);
            // With the step below nine roundings, for which the margin makes up.
            let k = reach / unit.dot(unit) * margin::<V::Scalar>() + least;
            (unit * side, unit.abs() * k)
        }
        None => (direction, error + V::splat(least)),
    };
    let component = |axis: usize| {
        let (start, side, step) =
            (point.component(axis), sides.component(axis), steps.component(axis));
        // The nearest float is at most half an ulp short: the next one is beyond.
        if zero < side {
            (start + step).next_up()
        } else if side < zero {
            (start - step).next_down()
        } else {
            start
        }
    };
    V::new(component(0), component(1), component(2))
}

/// The segment between two surfaces that hits neither of its ends: a shadow ray, t in [0, 1].
///
/// Each end is moved off its surface by [`offset_origin`], to the side on which the other end is. The
/// range is closed, so the far end has to clear b's surface by more than b's error: by the
/// rounding of the direction d, u·L in each component with u = EPSILON/2, L the largest. And two surfaces
/// that are flat together are so but for the rounding of their vertices. 8u·L are added to the error of
/// either end.
///
/// Where each point is in the plane of the other's surface, up to their errors, both ends come to the same
/// side of it. Where only one is, as at the seam of a wall and a floor, the segment may hit the surface
/// of the other there; and so it may where a normal over- or underflows, and the error is the whole of the
/// triangle.
///
/// Bad input is treated as by [`offset_origin`].
///
/// ```
/// use isect::{Triangle, glam::Vec3, ray::triangle::TriangleHit, spawn};
///
/// let floor = Triangle::new(Vec3::ZERO, Vec3::X, Vec3::Z);
/// let lamp = Triangle::new(Vec3::Y, Vec3::new(1.0, 2.0, 0.0), Vec3::new(0.0, 2.0, 1.0));
/// let hit = TriangleHit { t: 1.0, u: 0.3, v: 0.3, front: true };
/// let (a, a_error) = hit.point_and_error(&floor);
/// let (b, b_error) = hit.point_and_error(&lamp);
/// let shadow = spawn::segment(a, a_error, floor.normal(), b, b_error, lamp.normal());
/// assert!(!shadow.hits(&floor) && !shadow.hits(&lamp));
/// ```
#[must_use]
pub fn segment<V: Vector>(a: V, a_error: V, a_normal: V, b: V, b_error: V, b_normal: V) -> Ray<V> {
    let slack =
        |way: V| V::splat(way.abs().max_element() * (V::Scalar::EPSILON * V::Scalar::ONE.lit(4.0)));
    let from = offset_origin(a, a_error + slack(b - a), a_normal, b - a);
    // Seen from there, not from a: over flat ground the sides may differ.
    let back = from - b;
    let to = offset_origin(b, b_error + slack(back), b_normal, back);
    Ray::segment(from, to)
}

/// The image of a point under an affine map, and by how much it may be off in each component.
///
/// p′ = A·p + c and δ′ = |A|·δ + γ(3)·|A|·|p| + u·|p′|, |A| the matrix of the magnitudes: three roundings
/// for a product and two sums, u = EPSILON/2 for the last. (4u stand for γ(3), and each term is a little
/// larger, which makes up for its own rounding and for underflow.) The exact image of every point within
/// δ of p is within δ′ of p′. The normal n becomes A⁻ᵀ·n, and n′·(x′ − p′) ≤ |n′|·δ′ for the image of
/// the surface, as far as that normal is exact.
///
/// Where a sum is beyond the largest float the image is infinite or NaN, and the error infinite or NaN.
///
/// ```
/// use isect::{glam::{Affine3A, Vec3}, spawn};
///
/// let map = Affine3A::from_scale(Vec3::new(1.0, 2.0, 4.0));
/// let (point, error) = spawn::transform(Vec3::ONE, Vec3::splat(0.125), &map);
/// assert_eq!(point, Vec3::new(1.0, 2.0, 4.0));
/// assert!(error.z >= 0.5 && error.z < 0.50001);
/// ```
#[must_use]
pub fn transform<V: Vector>(point: V, error: V, affine: &impl Affine<V>) -> (V, V) {
    let [x, y, z, translation] = affine.columns();
    let linear = |[x, y, z]: [V; 3], vector: V| x * vector.x() + y * vector.y() + z * vector.z();
    let magnitudes = [x, y, z].map(Coordinates::abs);
    let epsilon = V::Scalar::EPSILON;
    let image = linear([x, y, z], point) + translation;
    let rounding = linear(magnitudes, point.abs()) * (epsilon + epsilon)
        + image.abs() * (epsilon * epsilon.lit(0.5));
    let carried = linear(magnitudes, error.abs());
    (image, (carried + rounding) * margin::<V::Scalar>() + V::splat(V::Scalar::MIN_POSITIVE))
}

/// The vector times the power of two that brings its largest component to [1, 2), as far as that is a
/// normal number; `None` for zero and for vectors that are not finite.
#[inline]
fn normalized<V: Vector>(vector: V) -> Option<V> {
    let longest = vector.abs().max_element();
    let usable = vector.is_finite() && V::Scalar::ZERO < longest;
    usable.then(|| vector * vector.normalizer())
}

/// 1 + 16u, u = EPSILON/2: makes up for 15 roundings of positive terms.
#[inline]
fn margin<T: Scalar>() -> T {
    T::ONE + T::EPSILON.lit(8.0) * T::EPSILON
}

/// Four times the smallest positive number: more than eight underflows take away.
#[inline]
fn underflow<T: Scalar>() -> T {
    T::MIN_POSITIVE * T::EPSILON * T::EPSILON.lit(4.0)
}
