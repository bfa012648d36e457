//! The beam of the rays from an apex through a convex polygon.

use super::Polygon;
use crate::vector::{Number, Scalar, Vector};

/// The rays from an apex through a convex polygon, its base, as far as they lie beyond that: solid, closed, and without
/// an end.
///
/// P. S. Heckbert, P. Hanrahan, "Beam Tracing Polygonal Objects", SIGGRAPH 1984. A beam from the eye has a part of the
/// picture for its base, a reflected one the polygon that mirrors, with its apex behind that.
/// [`crate::overlap::beam_polygon`] divides beams.
///
/// ```
/// use isect::{Beam, Polygon, glam::Vec3};
///
/// let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
/// let base = Polygon::<Vec3, 8>::new(&corners.map(|(x, y)| Vec3::new(x, y, 1.0))).expect("four are no more than eight");
/// let beam = Beam::new(Vec3::ZERO, base).expect("the apex is not in the plane of the base");
/// assert!(beam.contains(Vec3::new(3.0, 2.0, 4.0)));
/// assert!(!beam.contains(Vec3::new(5.0, 2.0, 4.0)) && !beam.contains(Vec3::new(0.0, 0.0, 0.5)));
///
/// let mirror = Polygon::<Vec3, 8>::new(&corners.map(|(x, y)| Vec3::new(x, y, 3.0))).expect("four are no more than eight");
/// let reflected = beam.reflected(&mirror).expect("it is not seen edge-on");
/// assert_eq!(reflected.apex, Vec3::new(0.0, 0.0, 6.0));
/// assert!(reflected.contains(Vec3::ZERO) && !reflected.contains(Vec3::Z * 4.0));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Beam<V: Vector, const N: usize> {
    /// Where the rays start, or would if no mirror had turned them.
    pub apex: V,
    /// The polygon that they enter through, its vertices counter-clockwise seen from beyond.
    pub base: Polygon<V, N>,
}

impl<V: Vector, const N: usize> Beam<V, N> {
    /// The beam from `apex` through `base`, of which the vertices may go either way around. `None` if a value is not
    /// finite, or if, as computed, the base has no area or the apex lies in its plane.
    #[must_use]
    pub fn new(apex: V, base: Polygon<V, N>) -> Option<Self> {
        let is_finite = apex.is_finite() && base.vertices().iter().all(|v| v.is_finite());
        let height = height_of(apex, &base);
        let is_below = height > V::Scalar::ZERO;
        let is_above = height < V::Scalar::ZERO;
        let base = if is_above { base.reversed() } else { base };
        (is_finite && (is_below || is_above)).then_some(Self { apex, base })
    }

    /// Whether `point` lies in the beam, as computed: nearer to its surface than
    /// the rounding of the products, the answer may be wrong. False for a NaN.
    #[inline]
    #[must_use]
    pub fn contains(&self, point: V) -> bool {
        let is_beyond = height_of(point, &self.base) <= V::Scalar::ZERO;
        is_beyond && self.sides().all(|side| side.normal.dot(point - self.apex) >= V::Scalar::ZERO)
    }

    /// What a mirror, or a part of one, makes of the beam: with the apex mirrored in its plane, a′ = a − 2n·(n·(a − v₀))/n², and the
    /// mirror for its base. `None` as for [`Self::new`].
    ///
    /// The polygon is what [`crate::overlap::beam_polygon::clip`] leaves of the mirror; its normal is Newell's. In units of
    /// u = EPSILON/2 and of the largest coordinate, the apex is off by no more than a few times its distance from the
    /// polygon over the polygon's narrowest width.
    #[must_use]
    pub fn reflected<const M: usize>(&self, mirror: &Polygon<V, M>) -> Option<Beam<V, M>> {
        let &first = mirror.vertices().first()?;
        let normal = mirror.normal();
        let normal = normal * normal.normalizer();
        let height = normal.dot(self.apex - first) / normal.dot(normal);
        Beam::new(self.apex - normal * (height + height), *mirror)
    }

    /// The planes through the apex and the edges of the base.
    #[inline]
    pub(crate) fn sides(&self) -> impl Iterator<Item = Side<V>> + '_ {
        self.base.edges().map(|edge| Side::through(self.apex, edge))
    }
}

/// How high the plane of a polygon lies above a point, times a positive number; 0 if it has no vertex.
pub(crate) fn height_of<V: Vector, const N: usize>(apex: V, polygon: &Polygon<V, N>) -> V::Scalar {
    let first = polygon.vertices().first().map_or(V::ZERO, |&v| v - apex);
    let normal = polygon.normal();
    (normal * normal.normalizer()).dot(first)
}

/// A plane through an apex and an edge.
#[derive(Clone, Copy)]
pub(crate) struct Side<V: Vector> {
    pub(crate) normal: V,
    /// The sum of the magnitudes of its terms.
    pub(crate) magnitude: V,
}

impl<V: Vector> Side<V> {
    /// With the normal (from − apex) × (to − from), which points to the left of the edge as seen from beyond.
    #[inline]
    pub(crate) fn through(apex: V, [from, to]: [V; 2]) -> Self {
        let (arm, edge) = (from - apex, to - from);
        Self::new(arm.cross(edge), Self::terms(arm, edge))
    }

    /// The sums of the magnitudes of the two terms of each component of a × b.
    #[inline]
    pub(crate) fn terms(a: V, b: V) -> V {
        let (a, b) = (a.abs(), b.abs());
        a.yzx().scaled(b.zxy()) + a.zxy().scaled(b.yzx())
    }

    /// The plane with a normal and the magnitudes of its terms, brought to a length of about 1.
    #[inline]
    pub(crate) fn new(normal: V, magnitude: V) -> Self {
        let scale = normal.normalizer();
        Self { normal: normal * scale, magnitude: magnitude * scale }
    }

    /// The height of a point above the plane, times a positive number; 0 where the rounding of the point's coordinates
    /// and of this sum may be as large.
    ///
    /// With u = EPSILON/2 the normal has four roundings, the product four more: 8u of the magnitudes. A vertex that lies on two
    /// planes is off by 4u of its coordinates on each: 16u in all.
    #[inline]
    pub(crate) fn height(&self, apex: V, point: V) -> V::Scalar {
        let height = self.normal.dot(point - apex);
        let unit = V::Scalar::EPSILON;
        let rounding = self.magnitude.dot(point.abs() + apex.abs()) * (unit.lit(8.0) * unit);
        if height.abs() > rounding { height } else { V::Scalar::ZERO }
    }
}
