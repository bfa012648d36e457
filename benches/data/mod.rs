//! Random queries with a steered hit rate, for the benches.
//!
//! A branch predictor learns the answers of a short loop and flatters kernels with early exits. So
//! there are 32,768 pairs, and the order of hits and misses is shuffled. As in a traversal, each
//! ray meets a few shapes in a row: streaming a new ray for each pair would measure the cache.
#![allow(dead_code)] // each bench draws its own queries

use isect::glam::{DVec3, Vec3};
use isect::overlap::triangle_aabb::sat;
use isect::ray::aabb::{BoxRay, slab};
use isect::ray::triangle::moller_trumbore;
use isect::{Aabb, Ray, Triangle};

/// The number of pairs in a set of queries.
pub(crate) const PAIRS: usize = 32_768;

/// The number of pairs with the same first part, as a rule.
pub(crate) const FEW: usize = 8;

/// A set of queries: each of the first parts (rays, say) against some second parts (triangles).
pub(crate) struct Pairs<A, B> {
    first: Vec<A>,
    /// How many second parts each first one has.
    per_first: usize,
    /// How often all pairs are asked: `PAIRS` times in all.
    rounds: usize,
    /// Those of the first `first`, then those of the second, and so on.
    second: Vec<B>,
}

impl<A, B> Pairs<A, B> {
    /// The same queries in other types.
    pub(crate) fn map<C, D>(
        &self,
        first: impl Fn(&A) -> C,
        second: impl Fn(&A, &B) -> D,
    ) -> Pairs<C, D> {
        let mut seconds = Vec::with_capacity(self.second.len());
        self.for_each_once(|a, b| seconds.push(second(a, b)));
        Pairs {
            first: self.first.iter().map(first).collect(),
            per_first: self.per_first,
            rounds: self.rounds,
            second: seconds,
        }
    }

    /// Each of the first parts with its second parts, packed by so many.
    pub(crate) fn packed<C, D>(
        &self,
        lanes: usize,
        first: impl Fn(&A) -> C,
        pack: impl Fn(&[B]) -> D,
    ) -> Vec<(C, Vec<D>)> {
        let packs = self
            .second
            .chunks_exact(self.per_first)
            .map(|some| some.chunks(lanes).map(&pack).collect());
        self.first.iter().map(first).zip(packs).collect()
    }

    /// Only the first of the first parts with its second parts, over and over: they stay in the cache that is closest to the
    /// processor.
    pub(crate) fn of_first(mut self) -> Self {
        self.first.truncate(1);
        self.second.truncate(self.per_first);
        self.rounds = PAIRS / self.per_first;
        self
    }

    /// Another order: of the first parts, and of the second parts of each.
    pub(crate) fn shuffle(&mut self, random: &mut fastrand::Rng) {
        for i in (1..self.first.len()).rev() {
            let j = random.usize(..=i);
            self.first.swap(i, j);
            for k in 0..self.per_first {
                self.second.swap(i * self.per_first + k, j * self.per_first + k);
            }
        }
        for some in self.second.chunks_exact_mut(self.per_first) {
            random.shuffle(some);
        }
    }

    /// How often all pairs are asked.
    pub(crate) fn rounds(&self) -> usize {
        self.rounds
    }

    /// Calls `visit` with each pair in turn, as often as they are asked.
    #[inline(always)]
    pub(crate) fn for_each(&self, mut visit: impl FnMut(&A, &B)) {
        for _ in 0..self.rounds {
            self.for_each_once(&mut visit);
        }
    }

    #[inline(always)]
    fn for_each_once(&self, mut visit: impl FnMut(&A, &B)) {
        for (a, some) in self.first.iter().zip(self.second.chunks_exact(self.per_first)) {
            for b in some {
                visit(a, b);
            }
        }
    }
}

/// Draws pairs, of which the fraction `rate` has the verdict `true`.
fn draw<A, B>(
    rate: f32,
    per_first: usize,
    mut first: impl FnMut(&mut Random) -> A,
    mut second: impl FnMut(&mut Random, &A, bool) -> B,
) -> Pairs<A, B> {
    let mut random = Random(fastrand::Rng::with_seed(1));
    let mut verdicts: Vec<bool> = (0..PAIRS).map(|i| (i as f32) < rate * PAIRS as f32).collect();
    random.0.shuffle(&mut verdicts);
    let mut pairs = Pairs { first: Vec::new(), per_first, rounds: 1, second: Vec::new() };
    for verdicts in verdicts.chunks(per_first) {
        let a = first(&mut random);
        pairs.second.extend(verdicts.iter().map(|&hit| second(&mut random, &a, hit)));
        pairs.first.push(a);
    }
    pairs
}

/// Rays of unit direction, and triangles with vertices in a cube of side `size` at a distance of
/// 1 to 3, of which they hit the fraction `hit_rate`: so many triangles for each ray.
///
/// The triangle is placed so that the ray goes for a given point of its plane: one inside for a
/// hit; for a miss one outside with weights within 1.5 of the centroid's, or, one in eight, a
/// triangle behind the origin.
pub(crate) fn ray_triangle(per_ray: usize, hit_rate: f32, size: f32) -> Pairs<Ray, Triangle> {
    draw(hit_rate, per_ray, Random::ray, |random, ray, hit| {
        loop {
            let shape: Triangle = [(); 3].map(|()| random.point(0.5 * size)).into();
            let behind = !hit && random.one_in(8);
            let reach = if hit || behind { 0.5 } else { 1.5 };
            let [u, v] = [(); 2].map(|()| 1.0 / 3.0 + random.within(reach));
            let move_by = ray.at(random.distance(behind)) - shape.at(u, v);
            let triangle = Triangle::from(<[Vec3; 3]>::from(shape).map(|vertex| vertex + move_by));
            let (exact_ray, exact_triangle) = (Ray::<DVec3>::from(*ray), triangle.into());
            if moller_trumbore::intersect(&exact_ray, &exact_triangle).is_some() == hit {
                return triangle;
            }
        }
    })
}

/// Rays of unit direction, and boxes with sides of 0.1 to 1 at a distance of 1 to 3, of which they
/// hit the fraction `hit_rate`: so many boxes for each ray.
///
/// The box is placed so that the ray goes for a point in it for a hit, or for one in a box of
/// three times the size for a miss, or, one miss in eight, it lies behind the origin.
pub(crate) fn ray_box(per_ray: usize, hit_rate: f32) -> Pairs<Ray, Aabb> {
    draw(hit_rate, per_ray, Random::ray, |random, ray, hit| {
        loop {
            let half = random.half_extents();
            let behind = !hit && random.one_in(8);
            let reach = if hit || behind { 1.0 } else { 3.0 };
            let center = ray.at(random.distance(behind)) - half * random.point(reach);
            let aabb = Aabb::new(center - half, center + half);
            let exact_ray = BoxRay::new(&Ray::<DVec3>::from(*ray));
            if slab::hits(&exact_ray, &aabb.into()) == hit {
                return aabb;
            }
        }
    })
}

/// Boxes with sides of 0.1 to 1, and triangles with vertices in a cube of side 1, of which the
/// fraction `overlap_rate` overlaps them.
///
/// The triangle's cube is anywhere in a cube around the box which is so large that chance comes
/// near to the wanted rate; then it is drawn again until the verdict is the wanted one.
pub(crate) fn triangle_box(overlap_rate: f32) -> Pairs<Aabb, Triangle> {
    // About 1.2 is the volume of the centres with which a triangle overlaps.
    let reach = 0.5 * (1.2 / overlap_rate).cbrt();
    let aabb = |random: &mut Random| {
        let (center, half) = (random.point(1.0), random.half_extents());
        Aabb::new(center - half, center + half)
    };
    draw(overlap_rate, FEW, aabb, |random, aabb, overlap| {
        loop {
            let center = aabb.center() + random.point(reach);
            let triangle: Triangle = [(); 3].map(|()| center + random.point(0.5)).into();
            if sat::overlaps::<DVec3>(&triangle.into(), &(*aabb).into()) == overlap {
                return triangle;
            }
        }
    })
}

/// The source of the random numbers: the same ones in every run.
struct Random(fastrand::Rng);

impl Random {
    /// A number in [-reach, reach).
    fn within(&mut self, reach: f32) -> f32 {
        (2.0 * self.0.f32() - 1.0) * reach
    }

    /// A point in the cube [-reach, reach)³.
    fn point(&mut self, reach: f32) -> Vec3 {
        Vec3::from_array([(); 3].map(|()| self.within(reach)))
    }

    /// True once in `n` times.
    fn one_in(&mut self, n: u32) -> bool {
        self.0.u32(..n) == 0
    }

    /// Where on a ray to put a shape.
    fn distance(&mut self, behind: bool) -> f32 {
        let distance = 2.0 + self.within(1.0);
        if behind { -distance } else { distance }
    }

    /// Half the sides of a box.
    fn half_extents(&mut self) -> Vec3 {
        Vec3::splat(0.275) + self.point(0.225)
    }

    /// A ray in a random direction.
    fn ray(&mut self) -> Ray {
        loop {
            let direction = self.point(1.0);
            if (0.1..1.0).contains(&direction.length_squared()) {
                return Ray::new(self.point(1.0), direction.normalize());
            }
        }
    }
}
