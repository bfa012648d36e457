//! The kernels that are compared.

use isect::glam::Vec3A;
use isect::ray::triangle::watertight::ShearedRay;
use isect::ray::triangle::{badouel, exact, moller_trumbore, watertight};
use isect::{Ray, Triangle};

/// A ray/triangle test, reduced to yes or no.
pub(crate) struct Kernel {
    pub(crate) name: &'static str,
    pub(crate) hits: fn(&Ray<Vec3A>, &Triangle<Vec3A>) -> bool,
}

/// In the order of the panels, row by row.
pub(crate) const KERNELS: [Kernel; 6] = [
    Kernel { name: "Möller–Trumbore, textbook", hits: textbook },
    Kernel { name: "obvhs Triangle::intersect", hits: obvhs },
    Kernel {
        name: "isect moller_trumbore",
        hits: |ray, triangle| moller_trumbore::intersect(ray, triangle).is_some(),
    },
    Kernel {
        name: "isect badouel",
        hits: |ray, triangle| badouel::intersect(ray, triangle).is_some(),
    },
    Kernel {
        name: "isect watertight",
        hits: |ray, triangle| watertight::intersect(&ShearedRay::new(ray), triangle).is_some(),
    },
    Kernel { name: "isect exact", hits: exact::hits },
];

/// T. Möller, B. Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection", Journal of Graphics Tools 2.1, 1997, as it
/// is usually written, with the paper's EPSILON.
fn textbook(ray: &Ray<Vec3A>, triangle: &Triangle<Vec3A>) -> bool {
    const EPSILON: f32 = 0.000_001;
    let edge1 = triangle.v1 - triangle.v0;
    let edge2 = triangle.v2 - triangle.v0;
    let pvec = ray.direction.cross(edge2);
    let det = edge1.dot(pvec);
    if det.abs() < EPSILON {
        return false;
    }
    let inv_det = 1.0 / det;
    let tvec = ray.origin - triangle.v0;
    let u = tvec.dot(pvec) * inv_det;
    if !(0.0..=1.0).contains(&u) {
        return false;
    }
    let qvec = tvec.cross(edge1);
    let v = ray.direction.dot(qvec) * inv_det;
    if v < 0.0 || u + v > 1.0 {
        return false;
    }
    edge2.dot(qvec) * inv_det > EPSILON
}

fn obvhs(ray: &Ray<Vec3A>, triangle: &Triangle<Vec3A>) -> bool {
    let Triangle { v0, v1, v2 } = *triangle;
    let ray = obvhs::ray::Ray::new(ray.origin, ray.direction, ray.t_min, ray.t_max);
    obvhs::triangle::Triangle { v0, v1, v2 }.intersect(&ray).is_finite()
}
