//! Shapes in the peers' own types.

use isect::glam::{Vec3, Vec3A};
use isect::{Aabb, Ray, Triangle};
use nalgebra::{Point3, Vector3};

fn obvhs_vector(v: Vec3) -> Vec3A {
    v.to_array().into()
}

/// obvhs prepares the reciprocals of the direction in its ray.
pub fn obvhs_ray(ray: &Ray) -> obvhs::ray::Ray {
    obvhs::ray::Ray::new_inf(obvhs_vector(ray.origin), obvhs_vector(ray.direction))
}

/// A triangle of obvhs.
pub fn obvhs_triangle(triangle: &Triangle) -> obvhs::triangle::Triangle {
    obvhs::triangle::Triangle {
        v0: obvhs_vector(triangle.v0),
        v1: obvhs_vector(triangle.v1),
        v2: obvhs_vector(triangle.v2),
    }
}

/// A box of obvhs.
pub fn obvhs_aabb(aabb: &Aabb) -> obvhs::aabb::Aabb {
    obvhs::aabb::Aabb::new(obvhs_vector(aabb.min), obvhs_vector(aabb.max))
}

fn parry_vector(v: Vec3) -> parry3d::math::Vector {
    v.to_array().into()
}

/// A ray of parry3d.
pub fn parry_ray(ray: &Ray) -> parry3d::query::Ray {
    parry3d::query::Ray::new(parry_vector(ray.origin), parry_vector(ray.direction))
}

/// A triangle of parry3d.
pub fn parry_triangle(triangle: &Triangle) -> parry3d::shape::Triangle {
    let [a, b, c] = <[Vec3; 3]>::from(*triangle).map(parry_vector);
    parry3d::shape::Triangle::new(a, b, c)
}

/// A box of parry3d.
pub fn parry_aabb(aabb: &Aabb) -> parry3d::bounding_volume::Aabb {
    parry3d::bounding_volume::Aabb::new(parry_vector(aabb.min), parry_vector(aabb.max))
}

fn bvh_point(v: Vec3) -> Point3<f32> {
    v.to_array().into()
}

/// The bvh crate prepares the reciprocals of the direction in its ray.
pub fn bvh_ray(ray: &Ray) -> bvh::ray::Ray<f32, 3> {
    bvh::ray::Ray::new(bvh_point(ray.origin), Vector3::from(ray.direction.to_array()))
}

/// The bvh crate culls back faces: the triangle, turned to the ray's origin.
pub fn bvh_triangle(ray: &Ray, triangle: &Triangle) -> [Point3<f32>; 3] {
    let [a, b, c] = <[Vec3; 3]>::from(*triangle).map(bvh_point);
    if triangle.normal().dot(ray.direction) < 0.0 { [a, b, c] } else { [a, c, b] }
}

/// A box of the bvh crate.
pub fn bvh_aabb(aabb: &Aabb) -> bvh::aabb::Aabb<f32, 3> {
    bvh::aabb::Aabb::with_bounds(bvh_point(aabb.min), bvh_point(aabb.max))
}

/// The triangle/box test as users write it from T. Akenine-Möller, "Fast 3D Triangle-Box Overlap
/// Testing", 2001: the triangle relative to the box's centre, the nine cross products of axes with early
/// exits first, then the faces, then the plane.
pub fn akenine_moller(center: Vec3A, half: Vec3A, triangle: &Triangle<Vec3A>) -> bool {
    let v = [triangle.v0 - center, triangle.v1 - center, triangle.v2 - center];
    let edges = [v[1] - v[0], v[2] - v[1], v[0] - v[2]];
    // The axis (0, −e.z, e.y) and its turns: an edge projects to one number, the vertex across to another.
    for i in 0..3 {
        let (edge, on_edge, across) = (edges[i], v[i], v[(i + 2) % 3]);
        let size = edge.abs();
        for axis in 0..3 {
            let (j, k) = ((axis + 1) % 3, (axis + 2) % 3);
            let p = edge[k] * on_edge[j] - edge[j] * on_edge[k];
            let q = edge[k] * across[j] - edge[j] * across[k];
            let radius = size[k] * half[j] + size[j] * half[k];
            if p.min(q) > radius || p.max(q) < -radius {
                return false;
            }
        }
    }
    let (low, high) = (v[0].min(v[1]).min(v[2]), v[0].max(v[1]).max(v[2]));
    if low.cmpgt(half).any() || high.cmplt(-half).any() {
        return false;
    }
    let normal = edges[0].cross(edges[1]);
    let distance = normal.dot(v[0]);
    distance.abs() <= normal.abs().dot(half)
}
