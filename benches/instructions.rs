//! How many instructions does a kernel take? A guard: a kernel that is no longer inlined, or a pack that has lost its
//! lanes, takes several times as many.
//!
//! Counts repeat, where times on a shared machine do not. Valgrind counts a run with few rounds and one with many; the
//! difference is that of the kernel and its loop. Without Valgrind the guard is skipped.
//!
//! `cargo bench --bench instructions`; exit code 1 if a kernel is above its limit.

use std::hint::black_box;
use std::process::{Command, ExitCode};

use isect::glam::{Vec3, Vec3A};
use isect::ray::aabb::{BoxRay, conservative, slab};
use isect::ray::triangle::watertight::{self, ShearedRay};
use isect::ray::triangle::{exact, moller_trumbore};
use isect::simd::fearless_simd::{Level, dispatch};
use isect::simd::{AabbPack, TrianglePack};
use isect::{Aabb, Ray, Triangle};

/// A kernel, and how many instructions it may take for a triangle or a box: about a fifth more than it does (rustc 1.95,
/// x86-64 with AVX2, the default target), so that another compiler has some room.
const KERNELS: [(&str, f64); 9] = [
    ("moller_trumbore::intersect", 115.0),
    ("watertight::intersect", 140.0),
    ("exact::intersect", 140.0),
    ("slab::hits", 52.0),
    ("conservative::hits", 52.0),
    ("TrianglePack::moller_trumbore", 19.0),
    ("TrianglePack::watertight", 19.0),
    ("TrianglePack::exact", 23.0),
    ("AabbPack::conservative", 5.5),
];

/// Rays, and shapes for each of them.
const RAYS: usize = 32;
const SHAPES: usize = 64;

/// How often all pairs are asked in the longer of two runs; in the shorter it is once.
const ROUNDS: usize = 5;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().collect();
    if let [_, kernel, rounds] = arguments.as_slice()
        && let (Ok(kernel), Ok(rounds)) = (kernel.parse(), rounds.parse())
    {
        run(kernel, rounds);
        return ExitCode::SUCCESS;
    }
    if Command::new("valgrind").arg("--version").output().is_err() {
        println!("skipped: valgrind is not installed");
        return ExitCode::SUCCESS;
    }
    if Level::new().as_avx2().is_none() {
        println!("skipped: the limits are those of a processor with AVX2");
        return ExitCode::SUCCESS;
    }
    let mut is_sound = true;
    for (kernel, (name, limit)) in KERNELS.iter().enumerate() {
        let (Some(few), Some(many)) = (count(kernel, 1), count(kernel, ROUNDS)) else {
            println!("{name}: no count; does valgrind run here?");
            return ExitCode::FAILURE;
        };
        let count = (many - few) / ((ROUNDS - 1) * RAYS * SHAPES) as f64;
        let verdict = if count <= *limit { "" } else { ": TOO MANY" };
        println!("{name}: {count:.1} instructions, limit {limit}{verdict}");
        is_sound &= count <= *limit;
    }
    if is_sound { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

/// The instructions of this program with so many rounds of the kernel.
fn count(kernel: usize, rounds: usize) -> Option<f64> {
    let output = Command::new("valgrind")
        .args(["--tool=cachegrind", "--cache-sim=no", "--cachegrind-out-file=/dev/null"])
        .arg(std::env::current_exe().ok()?)
        .args([kernel.to_string(), rounds.to_string()])
        .output()
        .ok()?;
    let report = String::from_utf8_lossy(&output.stderr).into_owned();
    let line = report.lines().find(|line| line.contains("refs:"))?;
    line.rsplit(' ').next()?.replace(',', "").parse().ok()
}

/// Asks one kernel about all pairs.
fn run(kernel: usize, rounds: usize) {
    let mut random = fastrand::Rng::with_seed(1);
    let mut point =
        |size: f32| Vec3::from_array([(); 3].map(|()| (2.0 * random.f32() - 1.0) * size));
    let rays: Vec<Ray> = (0..RAYS).map(|_| Ray::new(point(3.0), point(1.0))).collect();
    let triangles: Vec<Triangle> =
        (0..SHAPES).map(|_| [point(1.0), point(1.0), point(1.0)].into()).collect();
    let boxes: Vec<Aabb> = triangles.iter().map(Triangle::aabb).collect();
    let scalar: Vec<Triangle<Vec3A>> = triangles.iter().map(|&t| t.into()).collect();
    let scalar_boxes: Vec<Aabb<Vec3A>> = boxes.iter().map(|&aabb| aabb.into()).collect();
    let packs: Vec<_> = triangles.chunks(8).map(TrianglePack::<f32, 8>::from_triangles).collect();
    let box_packs: Vec<_> = boxes.chunks(8).map(AabbPack::<f32, 8>::from_aabbs).collect();
    let rays: Vec<Ray<Vec3A>> = rays.iter().map(|&ray| ray.into()).collect();
    let sheared: Vec<_> = rays.iter().map(ShearedRay::new).collect();
    let box_rays: Vec<_> = rays.iter().map(BoxRay::new).collect();
    let level = Level::new();
    for _ in 0..rounds {
        match kernel {
            0 => ask(&rays, &scalar, moller_trumbore::intersect),
            1 => ask(&sheared, &scalar, watertight::intersect),
            2 => ask(&rays, &scalar, exact::intersect),
            3 => ask(&box_rays, &scalar_boxes, slab::hits),
            4 => ask(&box_rays, &scalar_boxes, conservative::hits),
            5 => dispatch!(level, simd => ask(
                &rays,
                &packs,
                #[inline(always)]
                |ray, pack| pack.moller_trumbore(simd, ray),
            )),
            6 => dispatch!(level, simd => ask(
                &sheared,
                &packs,
                #[inline(always)]
                |ray, pack| pack.watertight(simd, ray),
            )),
            7 => dispatch!(level, simd => ask(
                &rays,
                &packs,
                #[inline(always)]
                |ray, pack| pack.exact(simd, ray),
            )),
            _ => dispatch!(level, simd => ask(
                &box_rays,
                &box_packs,
                #[inline(always)]
                |ray, pack| pack.conservative(simd, ray),
            )),
        }
    }
}

/// Asks about each pair, and keeps the answers.
#[inline(always)]
fn ask<A: Copy, B, T>(rays: &[A], shapes: &[B], query: impl Fn(&A, &B) -> T) {
    for ray in rays {
        let ray = *black_box(ray);
        for shape in shapes {
            black_box(&query(&ray, shape));
        }
    }
}
