//! Does a ray meet a box, and where? All kernels, at two hit rates.

mod data;
#[path = "data/kernels.rs"]
mod kernels;

use criterion::Criterion;
use isect::glam::{DVec3, Vec3, Vec3A};
use isect::ray::aabb::{BoxRay, conservative, exact, slab};
use isect::{Aabb, Ray, Vector};

use data::Pairs;
use kernels::Kernels;

fn main() {
    let mut criterion = Criterion::default().configure_from_args();
    for hit_rate in [0.1, 0.5] {
        let pairs = data::ray_box(data::FEW, hit_rate);
        let name = format!("ray_box, {:.0} % hits", 100.0 * hit_rate);
        let mut kernels = Kernels::new(&mut criterion, &name);
        time(&mut kernels, "Vec3A", &converted::<Vec3A>(&pairs));
        time(&mut kernels, "Vec3", &converted::<Vec3>(&pairs));
        time(&mut kernels, "DVec3", &converted::<DVec3>(&pairs));
    }
    criterion.final_summary();
}

fn converted<V: Vector>(pairs: &Pairs<Ray, Aabb>) -> Pairs<Ray<V>, Aabb<V>>
where
    Ray<V>: From<Ray>,
    Aabb<V>: From<Aabb>,
{
    pairs.map(|ray| (*ray).into(), |_, aabb| (*aabb).into())
}

fn time<V: Vector>(kernels: &mut Kernels<'_>, vector: &str, pairs: &Pairs<Ray<V>, Aabb<V>>) {
    let name = |kernel| format!("{kernel}, {vector}");
    let prepared = pairs.map(BoxRay::new, |_, aabb| *aabb);
    kernels
        .time(&name("slab::hits"), &prepared, slab::hits)
        .time(&name("slab::intersect"), &prepared, slab::intersect)
        .time(&name("conservative::hits"), &prepared, conservative::hits)
        .time(&name("conservative::interval"), &prepared, conservative::interval)
        .time(&name("exact::hits"), &prepared, exact::hits)
        .time(&name("exact::intersect"), &prepared, exact::intersect)
        .time(&name("Ray::intersect"), pairs, Ray::intersect::<Aabb<V>>);
}
