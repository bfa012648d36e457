//! Where does a ray meet a triangle? All kernels, at two hit rates, for large and small triangles.

mod data;
#[path = "data/kernels.rs"]
mod kernels;

use criterion::Criterion;
use isect::glam::{DVec3, Vec3, Vec3A};
use isect::ray::triangle::watertight::ShearedRay;
use isect::ray::triangle::{badouel, exact, moller_trumbore, segura, watertight};
use isect::{Ray, Triangle, Vector};

use data::Pairs;
use kernels::Kernels;

fn main() {
    let mut criterion = Criterion::default().configure_from_args();
    for (hit_rate, size) in [(0.1, 1.0), (0.5, 1.0), (0.1, 0.01), (0.5, 0.01)] {
        let pairs = data::ray_triangle(data::FEW, hit_rate, size);
        let name = format!("ray_triangle, {:.0} % hits, size {size}", 100.0 * hit_rate);
        let mut kernels = Kernels::new(&mut criterion, &name);
        time(&mut kernels, "Vec3A", &converted::<Vec3A>(&pairs));
        time(&mut kernels, "Vec3", &converted::<Vec3>(&pairs));
        time(&mut kernels, "DVec3", &converted::<DVec3>(&pairs));
    }
    criterion.final_summary();
}

fn converted<V: Vector>(pairs: &Pairs<Ray, Triangle>) -> Pairs<Ray<V>, Triangle<V>>
where
    Ray<V>: From<Ray>,
    Triangle<V>: From<Triangle>,
{
    pairs.map(|ray| (*ray).into(), |_, triangle| (*triangle).into())
}

fn time<V: Vector>(kernels: &mut Kernels<'_>, vector: &str, pairs: &Pairs<Ray<V>, Triangle<V>>) {
    let name = |kernel| format!("{kernel}, {vector}");
    let prepared = pairs.map(|ray| *ray, |_, triangle| badouel::Prepared::new(triangle));
    let sheared = pairs.map(ShearedRay::new, |_, triangle| *triangle);
    kernels
        .time(&name("moller_trumbore::intersect"), pairs, moller_trumbore::intersect)
        .time(&name("badouel::intersect"), pairs, badouel::intersect)
        .time(&name("badouel::Prepared::intersect"), &prepared, |ray, triangle| {
            triangle.intersect(ray)
        })
        .time(&name("segura::intersect"), pairs, segura::intersect)
        .time(&name("segura::detects"), pairs, segura::detects)
        .time(&name("watertight::intersect"), &sheared, watertight::intersect)
        .time(&name("exact::intersect"), pairs, exact::intersect)
        .time(&name("exact::hits"), pairs, exact::hits)
        .time(&name("exact::classify"), pairs, exact::classify)
        .time(&name("exact::refine"), pairs, exact::refine);
}
