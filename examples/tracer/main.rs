//! A small reference tracer in the manner of Whitted (1980), on isect's kernels.
//!
//! This file is the command line and the order of events; `scene` says what there is to see,
//! `surface` finds what a ray hits, `shade` what it looks like, `render` makes the picture.
//!
//! ```text
//! cargo run --release --example tracer -- --help
//! ```

mod accelerator;
mod bench;
mod bvh2;
mod bvh8;
mod camera;
mod failure;
mod kernel;
mod mesh;
mod optics;
mod output;
mod render;
mod scene;
mod shade;
mod surface;

use std::fmt::Write as _;
use std::io::Write as _;
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::{Duration, Instant};

use clap::{Parser, ValueEnum};
use indicatif::{ProgressBar, ProgressStyle};
use isect::Triangle;
use isect::glam::Vec3A;

use accelerator::{Accelerator, NaiveLoop};
use bench::bench;
use bvh2::Bvh2;
use bvh8::{Bvh8, InPackets};
use camera::Camera;
use kernel::{Badouel, Exact, MollerTrumbore, Segura, TriangleKernel, Watertight};
use mesh::Obj;
use output::Output;
use render::{Settings, render};
use scene::{Scene, SceneName};
use shade::{RayCounts, Tracer};

/// The largest picture: 64 Mi pixels, 192 MiB in memory.
const MAX_PIXELS: u32 = 1 << 26;

const EXAMPLES: &str = "\
Examples:
  tracer
  tracer --scene spheres --size 1920x1080 --samples 16
  tracer --scene mesh --mesh teapot.obj --output teapot.png
  tracer --packets
  tracer --size 96x54 --samples 1 --accel none --triangle moller-trumbore
  tracer --scene mesh --mesh icosphere:8 --bench";

/// Renders a scene of a mesh, spheres, boxes and planes, and tells how fast.
#[derive(Debug, Parser)]
#[command(name = "tracer", after_help = EXAMPLES)]
struct Arguments {
    /// What to render
    #[arg(long, value_enum, default_value = "showcase")]
    scene: SceneName,
    /// The mesh of the scene, in place of the bunny: a file, or a sphere of 20·4^N triangles, N up to 9
    #[arg(long, value_name = "FILE.obj|icosphere:N", value_parser = parse_mesh)]
    mesh: Option<MeshSource>,
    /// Width and height of the picture, at most 64 Mi pixels
    #[arg(long, value_name = "WxH", default_value = "960x540", value_parser = parse_size)]
    size: [u32; 2],
    /// Samples per pixel on a regular grid: 1, 4, 9, … 256
    #[arg(long, value_name = "N", default_value = "4", value_parser = parse_samples)]
    samples: SamplesPerEdge,
    /// How many times a ray is reflected or refracted at most, 0 to 64
    #[arg(long, value_name = "N", default_value_t = 8, value_parser = clap::value_parser!(u32).range(..=64))]
    depth: u32,
    /// The ray/triangle kernel
    #[arg(long, value_name = "KERNEL", value_enum, default_value = "exact")]
    triangle: KernelName,
    /// What finds the triangles that a ray may hit [default: bvh8 with the exact kernel, else bvh2]
    #[arg(long, value_enum)]
    accel: Option<AcceleratorName>,
    /// Traces primary rays and their shadow rays in packets of eight; with bvh8 only
    #[arg(long)]
    packets: bool,
    /// Threads, up to 1024; 0 for one per core
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = clap::value_parser!(u16).range(..=1024))]
    threads: u16,
    /// Instead of a picture, tells how fast bvh8, its packets and obvhs's CWBVH find the hits of WxH rays, on one thread
    #[arg(long)]
    bench: bool,
    /// Where to write the picture, as PNG
    #[arg(long, value_name = "FILE.png", default_value = "tracer.png")]
    output: PathBuf,
}

/// The kernels to choose from.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum KernelName {
    /// Never wrong
    Exact,
    /// Woop, Benthin, Wald 2013: no ray slips through an edge
    Watertight,
    /// Möller, Trumbore 1997
    MollerTrumbore,
    /// Badouel 1990, prepared per triangle
    Badouel,
    /// Segura, Feito 1998: shadow rays without a division
    Segura,
}

/// The accelerators to choose from.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum AcceleratorName {
    /// Every ray against every triangle
    None,
    /// A binary bounding volume hierarchy
    Bvh2,
    /// One of eight boxes to a node, in packs; with the exact kernel only
    Bvh8,
}

impl Arguments {
    /// The accelerator that is chosen, or the best for the kernel.
    fn accelerator(&self) -> AcceleratorName {
        self.accel.unwrap_or(match self.triangle {
            KernelName::Exact => AcceleratorName::Bvh8,
            _ => AcceleratorName::Bvh2,
        })
    }
}

/// Where a mesh comes from.
#[derive(Clone, Debug)]
enum MeshSource {
    File(PathBuf),
    /// How often the faces of an icosahedron are split in four.
    Icosphere(u32),
}

/// The square root of the number of samples.
#[derive(Clone, Copy, Debug)]
struct SamplesPerEdge(u16);

/// Reads `960x540`.
fn parse_size(text: &str) -> Result<[u32; 2], String> {
    let size = text.split_once(['x', 'X']).and_then(|(width, height)| {
        let [width, height] = [width.parse::<u32>().ok()?, height.parse::<u32>().ok()?];
        Some([width, height])
    });
    let [width, height] = size.ok_or("not of the form 960x540")?;
    if width == 0 || height == 0 {
        return Err("a picture has at least one pixel".into());
    }
    match width.checked_mul(height) {
        Some(pixels) if pixels <= MAX_PIXELS => Ok([width, height]),
        _ => Err(format!("more than {MAX_PIXELS} pixels")),
    }
}

/// Reads a square number.
fn parse_samples(text: &str) -> Result<SamplesPerEdge, String> {
    let samples: u16 = text.parse().map_err(|_| "not a number from 1 to 256")?;
    (1..=16)
        .find(|edge| edge * edge == samples)
        .map(SamplesPerEdge)
        .ok_or_else(|| "not a square number from 1 to 256".into())
}

/// Reads `icosphere:8`; all else is the name of a file.
fn parse_mesh(text: &str) -> Result<MeshSource, String> {
    let Some(level) = text.strip_prefix("icosphere:") else {
        return Ok(MeshSource::File(text.into()));
    };
    match level.parse() {
        Ok(level @ 0..=9) => Ok(MeshSource::Icosphere(level)),
        _ => Err("not icosphere:0 to icosphere:9".into()),
    }
}

fn main() -> ExitCode {
    let arguments = match Arguments::try_parse() {
        Ok(arguments) => arguments,
        Err(error) if error.use_stderr() => {
            // The reason is in the first line; usage and tips follow it.
            eprintln!("{}", error.to_string().lines().next().unwrap_or_default());
            return ExitCode::from(2);
        }
        Err(help) => help.exit(),
    };
    if arguments.mesh.is_some() && !arguments.scene.has_mesh() {
        eprintln!("error: there is no mesh in this scene, so '--mesh' has no place");
        return ExitCode::from(2);
    }
    let is_exact = matches!(arguments.triangle, KernelName::Exact);
    if matches!(arguments.accel, Some(AcceleratorName::Bvh8)) && !is_exact {
        eprintln!("error: '--accel bvh8' is for '--triangle exact' only");
        return ExitCode::from(2);
    }
    if arguments.packets && !matches!(arguments.accelerator(), AcceleratorName::Bvh8) {
        eprintln!("error: '--packets' is for '--accel bvh8' only");
        return ExitCode::from(2);
    }
    if arguments.bench && !arguments.scene.has_mesh() {
        eprintln!("error: there is no mesh in this scene, so '--bench' has nothing to do");
        return ExitCode::from(2);
    }
    match run(&arguments) {
        Ok(report) => {
            // A reader who has gone does not make the picture worse.
            let _ = std::io::stdout().write_all(report.as_bytes());
            ExitCode::SUCCESS
        }
        Err(reason) => {
            eprintln!("error: {reason}");
            ExitCode::from(2)
        }
    }
}

/// Renders and writes the picture; returns what to say about it.
fn run(arguments: &Arguments) -> Result<String, Box<dyn std::error::Error>> {
    let obj = match &arguments.mesh {
        Some(MeshSource::File(file)) => Obj::read(file)?,
        Some(MeshSource::Icosphere(level)) => Obj::icosphere(*level),
        None => Obj::bunny(),
    };
    if arguments.bench {
        let scene = arguments.scene.build(obj);
        return Ok(bench(&scene, &scene.mesh.triangles(), arguments.size));
    }
    let output = Output::new(&arguments.output)?;
    let scene = arguments.scene.build(obj);
    let triangles = scene.mesh.triangles();

    let start = Instant::now();
    let accelerator = accelerator(arguments, &scene, &triangles);
    let build_time = start.elapsed();

    let [width, height] = arguments.size;
    let settings = Settings { width, height, samples_per_edge: arguments.samples.0 };
    let camera = Camera::new(&scene.view, width, height);
    let tracer = Tracer::new(&scene, &*accelerator, arguments.depth);
    let threads = rayon::ThreadPoolBuilder::new().num_threads(arguments.threads.into()).build()?;
    // It draws on a terminal, and nowhere else.
    let bar = ProgressBar::new(settings.tiles()).with_style(
        ProgressStyle::with_template("{bar:40} {percent:>3} %  {eta} left")
            .expect("the template is well formed"),
    );
    let start = Instant::now();
    let (picture, counts) = threads.install(|| render(&tracer, &camera, &settings, || bar.inc(1)));
    let render_time = start.elapsed();
    bar.finish_and_clear();

    output.write(&picture)?;
    Ok(report(arguments, triangles.len(), build_time, render_time, &counts))
}

/// The chosen accelerator with the chosen kernel compiled into it.
fn accelerator(
    arguments: &Arguments,
    scene: &Scene,
    triangles: &[Triangle<Vec3A>],
) -> Box<dyn Accelerator> {
    fn build<K: TriangleKernel + 'static>(
        name: AcceleratorName,
        scene: &Scene,
        triangles: &[Triangle<Vec3A>],
    ) -> Box<dyn Accelerator> {
        match name {
            AcceleratorName::None => Box::new(NaiveLoop::<K>::new(triangles)),
            // Rays come from as far as the floor can be made out.
            AcceleratorName::Bvh2 => Box::new(Bvh2::<K>::new(triangles, 16.0 * scene.extent())),
            AcceleratorName::Bvh8 => Box::new(Bvh8::new(triangles)),
        }
    }
    let build = match arguments.triangle {
        KernelName::Exact => build::<Exact>,
        KernelName::Watertight => build::<Watertight>,
        KernelName::MollerTrumbore => build::<MollerTrumbore>,
        KernelName::Badouel => build::<Badouel>,
        KernelName::Segura => build::<Segura>,
    };
    match arguments.accelerator() {
        AcceleratorName::Bvh8 if arguments.packets => {
            Box::new(InPackets::new(Bvh8::new(triangles)))
        }
        name => build(name, scene, triangles),
    }
}

/// The table at the end.
fn report(
    arguments: &Arguments,
    triangles: usize,
    build_time: Duration,
    render_time: Duration,
    counts: &RayCounts,
) -> String {
    let mut table = String::new();
    let mut row = |name: &str, value: String| {
        writeln!(table, "{name:<18}{value:>14}").expect("a string takes any text");
    };
    row("triangles", triangles.to_string());
    row("build", format!("{:.3} s", build_time.as_secs_f64()));
    row("render", format!("{:.3} s", render_time.as_secs_f64()));
    let kinds = [
        ("primary rays", counts.primary),
        ("shadow rays", counts.shadow),
        ("reflection rays", counts.reflection),
        ("refraction rays", counts.refraction),
        ("all rays", counts.total()),
    ];
    for (kind, count) in kinds {
        let rate = count as f64 / render_time.as_secs_f64() / 1e6;
        row(kind, format!("{count:>14}{rate:>8.2} Mrays/s"));
    }
    writeln!(table, "{}", arguments.output.display()).expect("a string takes any text");
    table
}
