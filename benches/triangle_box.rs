//! Do a triangle and a box overlap? All kernels, at two rates of overlap.

mod data;
#[path = "data/kernels.rs"]
mod kernels;

use criterion::Criterion;
use isect::glam::{DVec3, Vec3, Vec3A};
use isect::overlap::triangle_aabb::{clip, exact, sat};
use isect::{Aabb, Triangle, Vector};

use data::Pairs;
use kernels::Kernels;

fn main() {
    let mut criterion = Criterion::default().configure_from_args();
    for overlap_rate in [0.02, 0.33] {
        let pairs = data::triangle_box(overlap_rate);
        let name = format!("triangle_box, {:.0} % overlaps", 100.0 * overlap_rate);
        let mut kernels = Kernels::new(&mut criterion, &name);
        time(&mut kernels, "Vec3A", &converted::<Vec3A>(&pairs));
        time(&mut kernels, "Vec3", &converted::<Vec3>(&pairs));
        time(&mut kernels, "DVec3", &converted::<DVec3>(&pairs));
    }
    criterion.final_summary();
}

fn converted<V: Vector>(pairs: &Pairs<Aabb, Triangle>) -> Pairs<Aabb<V>, Triangle<V>>
where
    Aabb<V>: From<Aabb>,
    Triangle<V>: From<Triangle>,
{
    pairs.map(|aabb| (*aabb).into(), |_, triangle| (*triangle).into())
}

fn time<V: Vector>(kernels: &mut Kernels<'_>, vector: &str, pairs: &Pairs<Aabb<V>, Triangle<V>>) {
    let name = |kernel| format!("{kernel}, {vector}");
    kernels
        .time(&name("sat::overlaps"), pairs, |aabb, triangle| sat::overlaps(triangle, aabb))
        .time(&name("exact::overlaps"), pairs, |aabb, triangle| exact::overlaps(triangle, aabb))
        .time(&name("clip::overlaps"), pairs, |aabb, triangle| clip::overlaps(triangle, aabb))
        .time(&name("clip::clip"), pairs, |aabb, triangle| clip::clip(triangle, aabb));
}
