//! Ray against convex polygon.
//!
//! D. Badouel, "An Efficient Ray-Polygon Intersection", Graphics Gems, 1990, in its general form: the plane, the
//! projection along its dominant axis, and there the fan of triangles from the first vertex.

use super::triangle::TriangleHit;
use super::{Intersect, in_range};
use crate::shape::{Polygon, Ray, Triangle};
use crate::vector::{Coordinates, Number, Scalar, Vector};

/// Where a ray meets a polygon: in the triangle of the vertices 0, `triangle` + 1 and `triangle` + 2, at the point
/// (1 − u − v)·v₀ + u·vᵢ₊₁ + v·vᵢ₊₂ = o + t·d.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PolygonHit<T> {
    /// The ray's parameter.
    pub t: T,
    /// The place in [`Polygon::triangles`].
    pub triangle: usize,
    /// The weight of the triangle's second vertex.
    pub u: T,
    /// The weight of the triangle's third vertex.
    pub v: T,
    /// Whether the direction runs against the normal: for t ≥ 0, whether the vertices run counter-clockwise seen
    /// from the ray's origin.
    pub front: bool,
}

impl<T: Scalar> PolygonHit<T> {
    /// The same hit as one of the triangle, to interpolate with.
    #[inline]
    #[must_use]
    pub fn in_triangle(&self) -> TriangleHit<T> {
        let Self { t, u, v, front, .. } = *self;
        TriangleHit { t, u, v, front }
    }

    /// The hit's point, moved to its triangle, and by how much it may be off in each component: see
    /// [`TriangleHit::point_and_error`]. A NaN if the hit is not one of this polygon.
    #[must_use]
    pub fn point_and_error<V, const N: usize>(&self, polygon: &Polygon<V, N>) -> (V, V)
    where
        V: Vector + Coordinates<Scalar = T>,
    {
        let nothing = Triangle::from([V::splat(T::NAN); 3]);
        let triangle = polygon.triangles().nth(self.triangle).unwrap_or(nothing);
        self.in_triangle().point_and_error(&triangle)
    }
}

impl<V: Vector, const N: usize> Intersect<V> for Polygon<V, N> {
    type Hit = PolygonHit<V::Scalar>;
    #[inline]
    fn intersect(&self, ray: &Ray<V>) -> Option<Self::Hit> {
        intersect(ray, self)
    }
}

/// Where the ray meets the polygon, in the closed range of the ray.
///
/// With eᵢ = vᵢ − v₀ and n = Σ eᵢ × eᵢ₊₁ (Newell's normal), t = (v₀ − o)·n / d·n. The point q = o + t·d − v₀ lies in the
/// triangle of eᵢ and eᵢ₊₁ if, with the two axes that are not that of the largest component of n,
/// u = (q × eᵢ₊₁)/(eᵢ × eᵢ₊₁) ≥ 0, v = (eᵢ × q)/(eᵢ × eᵢ₊₁) ≥ 0 and u + v ≤ 1. Both triangles at a diagonal decide by the
/// same product, so none is lost between them.
///
/// **Grade: fast.** Let m be the number of vertices, u' = EPSILON/2, s = o − v₀, and M the sum of the magnitudes of the
/// terms of n, component by component. To first order t is off by at most δt = (m + 6)u'·(M·|s| + |t|·M·|d|)/|d·n|; component
/// j of q by δqⱼ = u'·(2|sⱼ| + 3|t·dⱼ|) + |dⱼ|·δt; and u, with e = eᵢ₊₁ and D the sum of the magnitudes of the terms
/// of the determinant eᵢ × eᵢ₊₁, by (4u'·(|eₓ·qᵧ| + |eᵧ·qₓ| + |u|·D) + |eₓ|·δqᵧ + |eᵧ|·δqₓ)/|eᵢ × eᵢ₊₁|; v alike with eᵢ. Within
/// that distance of the polygon's edge, or of an end of the range, the verdict may be wrong. The polygon's plane is the one through
/// v₀ with the normal n; vertices that do not lie in it count as projected along the axis.
///
/// Fewer than three vertices, no area as computed, a ray parallel to the plane, a zero direction, a NaN or infinite
/// field: a miss.
///
/// ```
/// use isect::{Polygon, Ray, glam::Vec3, ray::polygon};
///
/// let corners = [Vec3::ZERO, Vec3::X * 2.0, Vec3::new(2.0, 1.0, 0.0), Vec3::Y];
/// let rectangle = Polygon::<Vec3, 4>::new(&corners).expect("four are no more than four");
/// let hit = polygon::intersect(&Ray::new(Vec3::new(0.5, 0.75, 3.0), Vec3::NEG_Z), &rectangle);
/// let hit = hit.expect("it is aimed at the inside");
/// assert_eq!((hit.t, hit.triangle, hit.u, hit.v, hit.front), (3.0, 1, 0.25, 0.5, true));
/// ```
#[must_use]
pub fn intersect<V: Vector, const N: usize>(
    ray: &Ray<V>,
    polygon: &Polygon<V, N>,
) -> Option<PolygonHit<V::Scalar>> {
    let (zero, one) = (V::Scalar::ZERO, V::Scalar::ONE);
    let (&first, others) = polygon.vertices().split_first()?;
    if !(ray.is_valid() && others.iter().all(|v| v.is_finite())) {
        return None;
    }
    // Powers of two, so that products neither over- nor underflow: of the edges, the direction and the offset.
    let largest = others.iter().fold(V::ZERO, |largest, &v| largest.max((v - first).abs()));
    let scale = largest.normalizer();
    let edge = |i: usize| (others[i] - first) * scale;
    let fan = 1..others.len();
    let normal = fan.clone().fold(V::ZERO, |sum, i| sum + edge(i - 1).cross(edge(i)));
    let t_scale = ray.direction.normalizer();
    let direction = ray.direction * t_scale;
    let offset = ray.origin - first;
    let offset_scale = offset.normalizer();
    let offset = offset * offset_scale;

    let determinant = -normal.dot(direction);
    let scaled_t = normal.dot(offset) / determinant;
    let t = scaled_t.times_ratio(t_scale, offset_scale);
    if !(determinant.abs() > zero && in_range(t, ray.t_min, ray.t_max)) {
        return None;
    }
    let point = (offset + direction * scaled_t).map(|x| x.times_ratio(scale, offset_scale));
    let [x, y, z] = [normal.x().abs(), normal.y().abs(), normal.z().abs()];
    let axis = if x >= y && x >= z {
        0
    } else if y >= z {
        1
    } else {
        2
    };
    // The component of a cross product along the axis, positive where b lies counter-clockwise of a.
    let sign = if normal.component(axis) < zero { -one } else { one };
    let (j, k) = ((axis + 1) % 3, (axis + 2) % 3);
    let turn =
        |a: V, b: V| (a.component(j) * b.component(k) - a.component(k) * b.component(j)) * sign;
    let mut before = turn(edge(0), point);
    for i in fan {
        let after = turn(edge(i), point);
        if before >= zero && after <= zero {
            let area = turn(edge(i - 1), edge(i));
            let (u, v) = (-after / area, before / area);
            // False for a triangle without area, which gives a NaN or an infinity.
            if u + v <= one && area > zero {
                let front = determinant > zero;
                return Some(PolygonHit { t, triangle: i - 1, u: u + zero, v: v + zero, front });
            }
        }
        before = after;
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DVec3, Vec3, Vec3A};

    fn octagon<V: Vector>() -> Polygon<V, 8> {
        let one = V::Scalar::ONE;
        let corners = [(1, 0), (2, 0), (3, 1), (3, 2), (2, 3), (1, 3), (0, 2), (0, 1)];
        let corners = corners.map(|(x, y)| {
            V::new(one.lit(f64::from(x)), one.lit(f64::from(y)), one.lit(f64::from(x + y)))
        });
        Polygon::new(&corners).expect("eight are no more than eight")
    }

    /// Down at a grid of points that lie inside, on edges, at vertices, on diagonals, and outside.
    #[test]
    fn inside_edges_and_vertices_are_hit_and_the_rest_is_not() {
        fn check<V: Vector>() {
            let polygon = octagon::<V>();
            let number = |x: f64| V::Scalar::ONE.lit(x);
            let mut hits = 0;
            for (i, j) in (-1..8).flat_map(|i| (-1..8).map(move |j| (i, j))) {
                let (x, y) = (f64::from(i) / 2.0, f64::from(j) / 2.0);
                let ray = Ray::new(
                    V::new(number(x), number(y), number(9.0)),
                    V::new(number(0.0), number(0.0), number(-2.0)),
                );
                let inside = (0.0..=3.0).contains(&x)
                    && (0.0..=3.0).contains(&y)
                    && (1.0..=5.0).contains(&(x + y))
                    && (-2.0..=2.0).contains(&(x - y));
                let hit = ray.intersect(&polygon);
                assert_eq!(hit.is_some(), inside, "{x} {y}");
                if let Some(hit) = hit {
                    hits += 1;
                    assert_eq!((hit.t, hit.front), (number((9.0 - x - y) / 2.0), true));
                    assert_eq!(hit.point_and_error(&polygon).0, ray.at(hit.t));
                    let below = Ray::new(ray.origin, -ray.direction).with_range(-hit.t, -hit.t);
                    assert_eq!(below.intersect(&polygon).map(|hit| hit.front), Some(false));
                }
            }
            assert_eq!(hits, 37);
        }
        check::<Vec3>();
        check::<Vec3A>();
        check::<DVec3>();
    }

    #[test]
    fn what_is_no_polygon_is_missed() {
        let ray = Ray::new(Vec3::new(0.25, 0.25, 1.0), Vec3::NEG_Z);
        let hit = |vertices: &[Vec3]| {
            ray.hits(&Polygon::<Vec3, 4>::new(vertices).expect("no more than four"))
        };
        assert!(hit(&[Vec3::ZERO, Vec3::X, Vec3::Y]));
        assert!(!hit(&[]) && !hit(&[Vec3::ZERO]) && !hit(&[Vec3::ZERO, Vec3::ONE]));
        assert!(!hit(&[Vec3::ZERO, Vec3::new(0.5, 0.5, 0.0), Vec3::new(1.0, 1.0, 0.0)]));
        assert!(!hit(&[Vec3::new(0.25, 0.25, 0.0); 4]));
        for bad in [f32::NAN, f32::INFINITY] {
            for (vertex, axis) in (0..4).flat_map(|v| (0..3).map(move |axis| (v, axis))) {
                let mut corners = [Vec3::ZERO, Vec3::X, Vec3::ONE.with_z(0.0), Vec3::Y];
                assert!(hit(&corners));
                corners[vertex][axis] = bad;
                assert!(!hit(&corners), "{corners:?}");
            }
        }
        let square = [Vec3::ZERO, Vec3::X, Vec3::ONE.with_z(0.0), Vec3::Y];
        let square = Polygon::<Vec3, 4>::new(&square).expect("four");
        let directions = [Vec3::ZERO, Vec3::X, Vec3::new(1.0, 1.0, 0.0), Vec3::NAN, Vec3::INFINITY];
        for direction in directions {
            assert!(!Ray::new(Vec3::ZERO, direction).hits(&square), "{direction}");
        }
        assert!(!ray.with_range(0.0, 0.5).hits(&square) && !ray.with_range(2.0, 1.0).hits(&square));
        assert!(
            !ray.with_range(f32::NAN, 2.0).hits(&square) && ray.with_range(1.0, 1.0).hits(&square)
        );
    }

    #[test]
    fn sizes_of_any_exponent() {
        let octagon = octagon::<Vec3>();
        for exponent in [-140, -100, -40, 40, 100, 124] {
            let scaled =
                |v: Vec3| v * 2.0_f32.powi(exponent / 2) * 2.0_f32.powi(exponent - exponent / 2);
            let polygon = octagon.map(scaled);
            for length in [-126, -60, 0, 60, 120] {
                let direction = Vec3::NEG_Z * 2.0_f32.powi(length);
                let ray = |x: f32| Ray::new(scaled(Vec3::new(x, 1.5, 6.0)), direction);
                let t = 2.0_f64.powi(exponent - length);
                if let Some(hit) = ray(1.5).intersect(&polygon) {
                    assert_eq!(hit.t, 1.0_f32.lit(3.0 * t)); // 0 where that underflows
                } else {
                    assert!(t > 2.0_f64.powi(125), "{exponent} {length}");
                }
                assert!(!ray(3.5).hits(&polygon), "{exponent} {length}");
            }
        }
    }
}
