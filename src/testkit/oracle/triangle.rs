//! Ray against closed triangle: the signs of three determinants, and a clipped range where all three vanish.

use num_bigint::BigInt;

use super::integer::{Integer, Interval, Ratio, Vector, cross, dot, ratio_bits, sub};
use super::{Frame, Ray, fits_i128, is_finite};

/// Where a ray meets a triangle; edge i joins vertex i and vertex i + 1 (modulo 3).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum TriangleVerdict {
    /// No common point.
    Miss,
    /// A point inside, off the edges.
    Interior,
    /// A point of this edge, off the vertices.
    Edge(u8),
    /// This vertex.
    Vertex(u8),
    /// The ray lies in the plane of the triangle and touches it.
    Coplanar,
    /// The triangle is a segment or a point, and the ray touches that.
    Degenerate,
}

impl TriangleVerdict {
    /// Whether the ray and the triangle have a point in common.
    #[must_use]
    pub fn hits(self) -> bool {
        self != Self::Miss
    }
}

/// A ray against a closed two-sided triangle.
#[must_use]
pub fn triangle(ray: &Ray, vertices: [[f64; 3]; 3]) -> TriangleVerdict {
    if !ray.is_valid() || !is_finite(&vertices) {
        return TriangleVerdict::Miss;
    }
    let frame = Frame::new(ray, vertices);
    if fits_i128(bits(&frame, frame.range_bits())) {
        Case::<i128>::new(&frame, vertices).verdict()
    } else {
        Case::<BigInt>::new(&frame, vertices).verdict()
    }
}

/// Whether the line meets the triangle's plane at a t in the closed range from `lo` to `hi`; `None` where it does not cross it.
///
/// The ray's own range does not matter, nor whether the point lies in the triangle.
#[must_use]
pub fn triangle_t_in(ray: &Ray, vertices: [[f64; 3]; 3], lo: f64, hi: f64) -> Option<bool> {
    coordinate_in(ray, vertices, Coordinate::T, lo, hi)
}

/// Whether the u of the point where the line meets the triangle's plane lies in the closed range from `lo` to `hi`, for
/// `p = (1 − u − v)·v0 + u·v1 + v·v2`; `None` where the line does not cross the plane.
#[must_use]
pub fn triangle_u_in(ray: &Ray, vertices: [[f64; 3]; 3], lo: f64, hi: f64) -> Option<bool> {
    coordinate_in(ray, vertices, Coordinate::U, lo, hi)
}

/// The same for v.
#[must_use]
pub fn triangle_v_in(ray: &Ray, vertices: [[f64; 3]; 3], lo: f64, hi: f64) -> Option<bool> {
    coordinate_in(ray, vertices, Coordinate::V, lo, hi)
}

/// Whether the line crosses the triangle's plane against the normal, so that the front is seen; `None` where it does not cross it.
#[must_use]
pub fn triangle_front(ray: &Ray, vertices: [[f64; 3]; 3]) -> Option<bool> {
    if !ray.has_line() || !is_finite(&vertices) {
        return None;
    }
    let frame = Frame::new(ray, vertices);
    let sign = if fits_i128(bits(&frame, 0)) {
        Integer::signum(&Case::<i128>::new(&frame, vertices).denominator())
    } else {
        Integer::signum(&Case::<BigInt>::new(&frame, vertices).denominator())
    };
    (sign != 0).then_some(sign < 0)
}

#[derive(Clone, Copy, PartialEq)]
enum Coordinate {
    T,
    U,
    V,
}

fn coordinate_in(
    ray: &Ray,
    vertices: [[f64; 3]; 3],
    which: Coordinate,
    lo: f64,
    hi: f64,
) -> Option<bool> {
    if !ray.has_line() || !is_finite(&vertices) {
        return None;
    }
    let frame = Frame::new(ray, vertices);
    let shift = if which == Coordinate::T { frame.t_shift() } else { 0 };
    if fits_i128(bits(&frame, ratio_bits(lo, shift).max(ratio_bits(hi, shift)))) {
        Case::<i128>::new(&frame, vertices).coordinate_in(which, lo, hi, shift)
    } else {
        Case::<BigInt>::new(&frame, vertices).coordinate_in(which, lo, hi, shift)
    }
}

/// An upper bound on the bit length of everything that is computed, for bounds on t, u or v of a given bit length.
fn bits(frame: &Frame, range_bits: u32) -> u32 {
    // An offset between points has p + 1 bits, a normal 2p + 3, a clipping plane 2p + 3 above p + d + 2.
    let (p, d) = (frame.points.bits, frame.directions.bits);
    range_bits + range_bits.max(3 * p + d + 6)
}

/// The triangle in integers, as seen from the ray's origin.
struct Case<'a, I> {
    frame: &'a Frame,
    direction: Vector<I>,
    vertices: [Vector<I>; 3],
    /// Twice the signed areas that the line spans with the edge opposite each vertex, as the direction sees them.
    weights: [I; 3],
}

impl<'a, I: Integer> Case<'a, I> {
    #[inline]
    fn new(frame: &'a Frame, vertices: [[f64; 3]; 3]) -> Self {
        let direction = frame.direction();
        let vertices = frame.relative(vertices);
        let [a, b, c] = &vertices;
        let weights = [(b, c), (c, a), (a, b)].map(|(p, q)| dot(&cross(p, q), &direction));
        Self { frame, direction, vertices, weights }
    }

    fn normal(&self) -> Vector<I> {
        let [a, b, c] = &self.vertices;
        cross(&sub(b, a), &sub(c, a))
    }

    /// The weights' sum, which is also `direction · normal`.
    fn denominator(&self) -> I {
        let [a, b, c] = &self.weights;
        a.clone() + b + c
    }

    /// The t at which the line meets the plane.
    fn plane_t(&self, denominator: I) -> Ratio<I> {
        Ratio::new(dot(&self.vertices[0], &self.normal()), denominator)
    }

    #[inline]
    fn verdict(&self) -> TriangleVerdict {
        use TriangleVerdict::*;
        let signs = self.weights.each_ref().map(I::signum);
        if signs.contains(&1) && signs.contains(&-1) {
            return Miss;
        }
        if signs == [0; 3] {
            return self.verdict_in_plane();
        }
        if !self.frame.range().contains(&self.plane_t(self.denominator())) {
            return Miss;
        }
        match signs.map(|sign| sign == 0) {
            [false, false, false] => Interior,
            [false, false, true] => Edge(0),
            [true, false, false] => Edge(1),
            [false, true, false] => Edge(2),
            [_, true, true] => Vertex(0),
            [true, _, true] => Vertex(1),
            [true, true, _] => Vertex(2),
        }
    }

    /// The line lies in the triangle's plane, or the triangle has none.
    fn verdict_in_plane(&self) -> TriangleVerdict {
        let normal = self.normal();
        let Some(axis) = (0..3).find(|&k| normal[k].signum() != 0) else {
            return self.verdict_of_segment();
        };
        // Any axis along which the normal does not vanish projects the triangle to one of the same shape.
        let flip = normal[axis].signum() < 0;
        let facing = |x: Vector<I>| {
            if flip { -x[axis].clone() } else { x[axis].clone() }
        };
        let mut range = self.frame.range();
        for k in 0..3 {
            let (p, q) = (&self.vertices[k], &self.vertices[(k + 1) % 3]);
            range.clip(facing(cross(p, q)), facing(cross(&sub(q, p), &self.direction)));
        }
        if range.is_empty() { TriangleVerdict::Miss } else { TriangleVerdict::Coplanar }
    }

    /// A triangle of zero area is the part of a line that lies in the box of its vertices.
    fn verdict_of_segment(&self) -> TriangleVerdict {
        let mut range = self.frame.range();
        let [a, b, c] = &self.vertices;
        for edge in [sub(b, a), sub(c, a)] {
            let (at_zero, slope) = (cross(&edge, a), cross(&self.direction, &edge));
            for (at_zero, slope) in at_zero.into_iter().zip(slope) {
                range.clip_to_root(at_zero, slope);
            }
        }
        for (k, slope) in self.direction.iter().enumerate() {
            let min = (&a[k]).min(&b[k]).min(&c[k]);
            let max = (&a[k]).max(&b[k]).max(&c[k]);
            range.clip(-min.clone(), slope.clone());
            range.clip(max.clone(), -slope.clone());
        }
        if range.is_empty() { TriangleVerdict::Miss } else { TriangleVerdict::Degenerate }
    }

    fn coordinate_in(&self, which: Coordinate, lo: f64, hi: f64, shift: i32) -> Option<bool> {
        let denominator = self.denominator();
        if denominator.signum() == 0 {
            return None;
        }
        let value = match which {
            Coordinate::T => self.plane_t(denominator),
            Coordinate::U => Ratio::new(self.weights[1].clone(), denominator),
            Coordinate::V => Ratio::new(self.weights[2].clone(), denominator),
        };
        Some(lo <= hi && Interval::new(lo, hi, shift).contains(&value))
    }
}

#[cfg(test)]
mod tests {
    use super::super::{lattice_point, on_lattices};
    use super::TriangleVerdict::*;
    use super::*;

    const INF: f64 = f64::INFINITY;
    const TRIANGLE: [[f64; 3]; 3] = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]];

    fn ray(origin: [f64; 3], direction: [f64; 3]) -> Ray {
        Ray { origin, direction, t_min: 0.0, t_max: INF }
    }

    fn down(x: f64, y: f64) -> TriangleVerdict {
        triangle(&ray([x, y, 2.0], [0.0, -0.0, -2.0]), TRIANGLE)
    }

    #[test]
    fn a_crossing_is_located() {
        assert_eq!(down(1.0, 1.0), Interior);
        assert_eq!([down(1.0, 0.0), down(2.0, 2.0), down(0.0, 3.0)], [Edge(0), Edge(1), Edge(2)]);
        assert_eq!(
            [down(0.0, 0.0), down(4.0, 0.0), down(0.0, 4.0)],
            [Vertex(0), Vertex(1), Vertex(2)]
        );
        assert_eq!(down(1.0, -5e-324), Miss);
        assert_eq!(down(2.0, 2f64.next_up()), Miss);
        assert_eq!(down(5.0, 0.0), Miss);
    }

    #[test]
    fn the_range_of_t_is_closed() {
        let oblique = ray([1.0, 1.0, 2.0], [0.0, 0.0, -2.0]);
        assert_eq!(triangle(&oblique.with_range(1.0, 1.0), TRIANGLE), Interior);
        assert_eq!(triangle(&oblique.with_range(1f64.next_up(), INF), TRIANGLE), Miss);
        assert_eq!(triangle(&oblique.with_range(-INF, 1f64.next_down()), TRIANGLE), Miss);
        assert_eq!(triangle(&ray([1.0, 1.0, 0.0], [9.0, 9.0, 5e-324]), TRIANGLE), Interior);
        let away = ray([1.0, 1.0, -1.0], [0.0, 0.0, -1.0]);
        assert_eq!(triangle(&away, TRIANGLE), Miss);
        assert_eq!(triangle(&away.with_range(-INF, INF), TRIANGLE), Interior);
    }

    #[test]
    fn a_coplanar_ray_is_clipped() {
        assert_eq!(triangle(&ray([-1.0, 1.0, 0.0], [1.0, 0.0, 0.0]), TRIANGLE), Coplanar);
        assert_eq!(
            triangle(&ray([-1.0, 4.0, 0.0], [1.0, 0.0, 0.0]), TRIANGLE),
            Coplanar,
            "a vertex"
        );
        assert_eq!(
            triangle(&ray([-1.0, 0.0, 0.0], [1.0, 0.0, 0.0]), TRIANGLE),
            Coplanar,
            "along an edge"
        );
        assert_eq!(triangle(&ray([-1.0, 4f64.next_up(), 0.0], [1.0, 0.0, 0.0]), TRIANGLE), Miss);
        assert_eq!(triangle(&ray([-1.0, 1.0, 5e-324], [1.0, 0.0, 0.0]), TRIANGLE), Miss, "above");
        let inside = ray([1.0, 1.0, 0.0], [1.0, 0.0, 0.0]);
        assert_eq!(triangle(&inside.with_range(0.5, 0.75), TRIANGLE), Coplanar);
        assert_eq!(triangle(&inside.with_range(2.0, 3.0), TRIANGLE), Coplanar);
        assert_eq!(triangle(&inside.with_range(2f64.next_up(), 3.0), TRIANGLE), Miss);
    }

    #[test]
    fn a_degenerate_triangle_is_a_segment_or_a_point() {
        let [a, b, c] = [[0.0; 3], [1.0; 3], [3.0; 3]];
        let across = |x: f64| ray([x, x, x + 1.0], [0.0, 0.0, -1.0]);
        for segment in [[a, b, c], [c, a, b], [b, a, c], [a, a, c], [a, c, c]] {
            assert_eq!(triangle(&across(2.0), segment), Degenerate);
            assert_eq!(triangle(&across(3.0), segment), Degenerate);
            assert_eq!(triangle(&across(-5e-324), segment), Miss);
            assert_eq!(triangle(&across(3f64.next_up()), segment), Miss);
            let along = ray([4.0; 3], [-1.0; 3]);
            assert_eq!(triangle(&along, segment), Degenerate);
            assert_eq!(triangle(&along.with_range(0.0, 1.0), segment), Degenerate);
            assert_eq!(triangle(&along.with_range(4f64.next_up(), INF), segment), Miss);
            assert_eq!(triangle(&ray([1.0, 1.0, 2.0], [1.0; 3]), segment), Miss, "parallel");
        }
        assert_eq!(triangle(&across(1.0), [b, b, b]), Degenerate);
        assert_eq!(triangle(&across(1f64.next_up()), [b, b, b]), Miss);
    }

    #[test]
    fn bad_input_misses_a_triangle() {
        let good = ray([1.0, 1.0, 2.0], [0.0, 0.0, -1.0]);
        for bad in [f64::NAN, INF, -INF] {
            let mut vertices = TRIANGLE;
            vertices[1][2] = bad;
            assert_eq!(triangle(&good, vertices), Miss);
            assert_eq!(triangle_t_in(&good, vertices, -INF, INF), None);
            assert_eq!(triangle(&Ray { direction: [0.0, bad, -1.0], ..good }, TRIANGLE), Miss);
            assert_eq!(triangle(&Ray { origin: [bad, 1.0, 2.0], ..good }, TRIANGLE), Miss);
        }
        assert_eq!(triangle(&Ray { direction: [0.0; 3], ..good }, TRIANGLE), Miss);
        for (t_min, t_max) in
            [(1.0, 0.0), (f64::NAN, INF), (0.0, f64::NAN), (INF, INF), (-INF, -INF)]
        {
            assert_eq!(triangle(&good.with_range(t_min, t_max), TRIANGLE), Miss);
        }
    }

    #[test]
    fn t_u_and_v_are_bracketed() {
        let slanted = ray([1.0, 2.0, 3.0], [0.0, 0.0, -7.0]).with_range(5.0, 4.0);
        let t = 3.0 / 7.0;
        assert_eq!(
            triangle_t_in(&slanted, TRIANGLE, f64::next_down(t), f64::next_up(t)),
            Some(true)
        );
        assert_eq!(triangle_t_in(&slanted, TRIANGLE, t, t), Some(false), "not a dyadic number");
        assert_eq!(triangle_u_in(&slanted, TRIANGLE, 0.25, 0.25), Some(true));
        assert_eq!(triangle_u_in(&slanted, TRIANGLE, 0.25f64.next_up(), INF), Some(false));
        assert_eq!(triangle_v_in(&slanted, TRIANGLE, -INF, 0.5), Some(true));
        assert_eq!(triangle_v_in(&slanted, TRIANGLE, f64::NAN, 0.5), Some(false));
        assert_eq!(triangle_v_in(&ray([0.0; 3], [1.0, 0.0, 0.0]), TRIANGLE, -INF, INF), None);
    }

    #[test]
    fn a_triangle_has_a_front() {
        let [a, b, c] = TRIANGLE;
        let slanted = ray([9.0, 9.0, -2.0], [7.0, 0.0, -5e-324]);
        assert_eq!(triangle_front(&slanted, [a, b, c]), Some(true));
        assert_eq!(triangle_front(&slanted, [a, c, b]), Some(false));
        assert_eq!(triangle_front(&slanted.reversed(), [a, b, c]), Some(false));
        assert_eq!(triangle_front(&slanted, [a, b, b]), None);
        assert_eq!(triangle_front(&ray([0.0; 3], [7.0, 1.0, 0.0]), TRIANGLE), None);
        assert_eq!(triangle_front(&ray([0.0; 3], [0.0; 3]), TRIANGLE), None);
        assert_eq!(triangle_front(&slanted, [a, b, [f64::NAN; 3]]), None);
    }

    #[test]
    fn tiers_agree_and_symmetries_change_nothing() {
        on_lattices(4, 40_000, [2, 1 << 23], |rng, radius, ray| {
            let [a, b, c] = [(); 3].map(|()| lattice_point(rng, radius));
            let verdict = triangle(&ray, [a, b, c]);
            if ray.is_valid() {
                let frame = Frame::new(&ray, [a, b, c]);
                assert!(fits_i128(bits(&frame, frame.range_bits())));
                assert_eq!(Case::<i128>::new(&frame, [a, b, c]).verdict(), verdict);
                assert_eq!(Case::<BigInt>::new(&frame, [a, b, c]).verdict(), verdict);
            }
            let cycled = match verdict {
                Edge(k) => Edge((k + 2) % 3),
                Vertex(k) => Vertex((k + 2) % 3),
                other => other,
            };
            assert_eq!(triangle(&ray, [b, c, a]), cycled);
            let wound = match verdict {
                Edge(k) => Edge(2 - k),
                Vertex(k) => Vertex((3 - k) % 3),
                other => other,
            };
            assert_eq!(triangle(&ray, [a, c, b]), wound);
            let turn = |[x, y, z]: [f64; 3]| [y, z, x].map(|x| x * 2f64.powi(-400));
            let turned = Ray { origin: turn(ray.origin), direction: turn(ray.direction), ..ray };
            assert_eq!(triangle(&turned, [a, b, c].map(turn)), verdict);
            assert_eq!(triangle(&ray.reversed(), [a, b, c]), verdict);
            // The vertices mirrored in a plane, and a direction of another length.
            let half = Ray {
                direction: ray.direction.map(|x| x / 2.0),
                ..ray.with_range(2.0 * ray.t_min, 2.0 * ray.t_max)
            };
            assert_eq!(triangle(&half, [a, b, c]), verdict);
        });
    }

    #[test]
    fn the_fast_tier_holds_the_largest_numbers_it_admits() {
        let mut rng = fastrand::Rng::with_seed(5);
        // 2^k − 1 in every coordinate, both signs: overflow would panic in a debug build and disagree in any.
        for (points, direction) in [(24, 48), (25, 45), (36, 12), (39, 3)] {
            for _ in 0..3_000 {
                let mut extreme = |k: i32| {
                    [0; 3].map(|_| (2f64.powi(k) - 1.0) * if rng.bool() { 1.0 } else { -1.0 })
                };
                let ray = ray(extreme(points), extreme(direction)).with_range(-INF, INF);
                let vertices = [extreme(points), extreme(points), extreme(points)];
                let frame = Frame::new(&ray, vertices);
                assert_eq!(bits(&frame, frame.range_bits()), super::super::I128_BITS);
                let big = Case::<BigInt>::new(&frame, vertices).verdict();
                assert_eq!(Case::<i128>::new(&frame, vertices).verdict(), big);
            }
        }
    }
}
