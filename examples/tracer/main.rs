//! A small reference tracer in the manner of Whitted (1980), on isect's kernels.
//!
//! This file is the command line and the order of events; `scene` says what there is to see,
//! `surface` finds what a ray hits, `shade` what it looks like, `render` makes the picture.
//!
//! ```text
//! cargo run --release --example tracer -- --help
//! ```

mod accelerator;
mod antialias;
mod beams;
mod bench;
mod bvh2;
mod bvh8;
mod camera;
mod compare;
mod failure;
mod fog;
mod kernel;
mod mesh;
mod optics;
mod output;
mod paint;
mod part;
mod picture;
mod render;
mod scene;
mod shade;
mod surface;

use std::fmt::Write as _;
use std::io::Write as _;
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::{Duration, Instant};

use clap::error::ErrorKind;
use clap::parser::ValueSource;
use clap::{CommandFactory, FromArgMatches, Parser, ValueEnum};
use indicatif::{ProgressBar, ProgressStyle};
use isect::Triangle;
use isect::glam::Vec3A;

use accelerator::{Accelerator, NaiveLoop};
use antialias::{Eye, Method};
use beams::Beams;
use bench::bench;
use bvh2::Bvh2;
use bvh8::{Bvh8, InPackets};
use camera::Camera;
use compare::Comparison;
use kernel::{Badouel, Exact, MollerTrumbore, Segura, TriangleKernel, Watertight};
use mesh::Obj;
use output::Output;
use part::{Place, digest, merge, parse_crop};
use picture::srgb;
use render::{Tile, render};
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
  tracer --antialias stochastic --samples 16 --fog exponential
  tracer --antialias cone --lamp-radius 15
  tracer --compare plot.svg
  tracer --scene mesh --mesh icosphere:8 --bench
  parallel tracer --crop 0,{1},960,{2} --output part{1}.png ::: 0 135 270 405 :::+ 135 270 405 540
  tracer --merge part*.png --output whole.png";

// Options with numbers allow hyphens: a negative number is a bad value, not another option.
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
    #[arg(long, allow_hyphen_values = true, value_name = "WxH", default_value = "960x540", value_parser = parse_size)]
    size: [u32; 2],
    /// Renders only the columns X0 to X1 − 1 and the rows Y0 to Y1 − 1, as a part for --merge
    #[arg(long, allow_hyphen_values = true, value_name = "X0,Y0,X1,Y1", value_parser = parse_crop)]
    crop: Option<Tile>,
    /// Instead of rendering, puts together the parts of a picture, in any order
    #[arg(long, value_name = "PART.png", num_args = 1..)]
    merge: Vec<PathBuf>,
    #[command(flatten)]
    antialias: antialias::Options,
    #[command(flatten)]
    fog: fog::Options,
    /// How many times a ray is reflected or refracted at most, 0 to 64
    #[arg(long, allow_hyphen_values = true, value_name = "N", default_value_t = 8, value_parser = clap::value_parser!(u32).range(..=64))]
    depth: u32,
    /// How it is found out what is seen
    #[arg(long, value_enum, default_value = "rays")]
    mode: Mode,
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
    #[arg(long, allow_hyphen_values = true, value_name = "N", default_value_t = 0, value_parser = clap::value_parser!(u16).range(..=1024))]
    threads: u16,
    /// Instead of a picture, tells how fast bvh8, its packets and obvhs's CWBVH find the hits of WxH rays, on one thread
    #[arg(long)]
    bench: bool,
    /// Instead of a picture, a table and a plot of the errors of all methods of --antialias by the time they take, against
    /// 1,024 samples; in a scene that is hard to sample and 240x135 if nothing else is said
    #[arg(long, value_name = "PLOT.svg")]
    compare: Option<PathBuf>,
    /// Where to write the picture, as PNG
    #[arg(long, value_name = "FILE.png", default_value = "tracer.png")]
    output: PathBuf,
}

/// The ways to find out what is seen.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Mode {
    /// Rays, reflected and refracted
    Rays,
    /// Beams, divided by polygons and reflected by mirrors; with '--scene polygons' only
    Beam,
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

    /// How a pixel gets its colour, if the options fit each other.
    fn method(&self) -> Result<Method, String> {
        if self.mesh.is_some() && !self.scene.has_mesh() {
            return Err("there is no mesh in this scene, so '--mesh' has no place".into());
        }
        let is_exact = matches!(self.triangle, KernelName::Exact);
        if matches!(self.accel, Some(AcceleratorName::Bvh8)) && !is_exact {
            return Err("'--accel bvh8' is for '--triangle exact' only".into());
        }
        if self.mode == Mode::Beam && self.scene != SceneName::Polygons {
            return Err("'--mode beam' is for '--scene polygons' only".into());
        }
        if self.packets && self.mode == Mode::Beam {
            return Err("'--packets' has no place with '--mode beam'".into());
        }
        if self.packets && !matches!(self.accelerator(), AcceleratorName::Bvh8) {
            return Err("'--packets' is for '--accel bvh8' only".into());
        }
        if self.bench && !self.scene.has_mesh() {
            return Err("there is no mesh in this scene, so '--bench' has nothing to do".into());
        }
        if let Some(crop) = &self.crop {
            crop.check(self.size).map_err(|reason| format!("'--crop {crop}': {reason}"))?;
        }
        let method = self.antialias.method()?;
        if self.mode == Mode::Beam && matches!(method, Method::Cone { .. }) {
            return Err("'--antialias cone' has no place with '--mode beam'".into());
        }
        if self.packets && !method.has_packets() {
            return Err(format!("'--antialias {}' has no packets", method.name()));
        }
        Ok(method)
    }
}

/// Where a mesh comes from.
#[derive(Clone, Debug)]
enum MeshSource {
    File(PathBuf),
    /// How often the faces of an icosahedron are split in four.
    Icosphere(u32),
}

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

/// The options beside which --merge has a place, itself among them.
const MERGE: &[&str] = &["merge", "output"];

/// Likewise for --bench.
const BENCH: &[&str] = &["bench", "scene", "mesh", "size"];

/// Likewise for --compare.
const COMPARE: &[&str] = &[
    "compare",
    "scene",
    "mesh",
    "size",
    "fog",
    "fog_range",
    "fog_density",
    "fog_color",
    "depth",
    "triangle",
    "accel",
    "threads",
];

/// Reads the command line.
fn parse() -> Result<Arguments, clap::Error> {
    let mut command = Arguments::command();
    let mut matches = command.try_get_matches_from_mut(std::env::args_os())?;
    let is_given = |option: &str| matches.value_source(option) == Some(ValueSource::CommandLine);
    for (mode, has_place) in [("merge", MERGE), ("compare", COMPARE), ("bench", BENCH)] {
        let is_misplaced = |option: &&str| is_given(option) && !has_place.contains(option);
        let mut options = command.get_arguments().map(|argument| argument.get_id().as_str());
        if let (true, Some(option)) = (is_given(mode), options.find(is_misplaced)) {
            let reason = format!("'--{}' has no place with '--{mode}'", option.replace('_', "-"));
            return Err(clap::Error::raw(ErrorKind::ArgumentConflict, reason));
        }
    }
    let [has_scene, has_size] = ["scene", "size"].map(is_given);
    let mut arguments = Arguments::from_arg_matches_mut(&mut matches)?;
    if arguments.compare.is_some() {
        arguments.scene = if has_scene { arguments.scene } else { SceneName::Edges };
        arguments.size = if has_size { arguments.size } else { [240, 135] };
    }
    Ok(arguments)
}

fn main() -> ExitCode {
    let arguments = match parse() {
        Ok(arguments) => arguments,
        Err(error) if error.use_stderr() => {
            // The reason is in the first line; usage and tips follow it.
            eprintln!("{}", error.to_string().lines().next().unwrap_or_default());
            return ExitCode::from(2);
        }
        Err(help) => help.exit(),
    };
    match arguments.method().map_err(Into::into).and_then(|method| run(&arguments, method)) {
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
fn run(arguments: &Arguments, method: Method) -> Result<String, Box<dyn std::error::Error>> {
    if !arguments.merge.is_empty() {
        let output = Output::new(&arguments.output)?;
        let picture = merge(&arguments.merge)?;
        output.write(|file| picture.encode(file, None))?;
        return Ok(format!("{}\n", arguments.output.display()));
    }
    let obj = match &arguments.mesh {
        Some(MeshSource::File(file)) => Obj::read(file)?,
        Some(MeshSource::Icosphere(level)) => Obj::icosphere(*level),
        None => Obj::bunny(),
    };
    if arguments.bench {
        let scene = arguments.scene.build(obj);
        return Ok(bench(&scene, &scene.mesh.triangles(), arguments.size));
    }
    let mut scene = arguments.scene.build(obj);
    scene.fog = arguments.fog.fog(scene.horizon())?;
    let output = Output::new(arguments.compare.as_ref().unwrap_or(&arguments.output))?;
    let triangles = scene.mesh.triangles();

    let start = Instant::now();
    let accelerator = accelerator(arguments, &scene, &triangles);
    let build_time = start.elapsed();

    let [width, height] = arguments.size;
    let camera = Camera::new(&scene.view, width, height);
    let beams = match arguments.mode {
        Mode::Rays => None,
        Mode::Beam => {
            let beams = Beams::new(&scene, &camera, arguments.depth);
            Some(beams.ok_or("a shape of this scene is no polygon")?)
        }
    };
    let tracer = Tracer::new(&scene, &*accelerator, arguments.depth).with_beams(beams.as_ref());
    let has_solids = method.has_solids() || arguments.compare.is_some();
    let hierarchy = has_solids.then(|| Bvh2::<Exact>::new(&triangles, scene.extent()));
    let eye = Eye { tracer: &tracer, camera: &camera, hierarchy: hierarchy.as_ref() };
    let part = arguments.crop.clone().unwrap_or(Tile { x: 0..width, y: 0..height });
    let threads = rayon::ThreadPoolBuilder::new().num_threads(arguments.threads.into()).build()?;
    let tiles = match arguments.compare {
        Some(_) => Comparison::tiles(&part),
        None => part.tiles().len(),
    };
    // It draws on a terminal, and nowhere else.
    let bar = ProgressBar::new(tiles as u64).with_style(
        ProgressStyle::with_template("{bar:40} {percent:>3} %  {eta} left")
            .expect("the template is well formed"),
    );
    if arguments.compare.is_some() {
        let comparison = threads.install(|| Comparison::new(&eye, &part, || bar.inc(1)));
        bar.finish_and_clear();
        let plot = comparison.plot()?;
        output.write(|file| file.write_all(plot.as_bytes()))?;
        return Ok(comparison.table());
    }
    let start = Instant::now();
    let (picture, counts) = threads.install(|| render(&eye, method, &part, srgb, || bar.inc(1)));
    let render_time = start.elapsed();
    bar.finish_and_clear();

    let place = arguments.crop.clone().map(|crop| {
        let &Arguments { size, depth, triangle, mode, .. } = arguments;
        let (version, scene) = (env!("CARGO_PKG_VERSION"), digest(&scene));
        let rendering = format!(
            "isect {version}, scene {scene:016x}, --antialias {method}, depth {depth}, {triangle:?}, {mode:?}"
        );
        Place { crop, size, rendering }
    });
    output.write(|file| picture.encode(file, place.as_ref()))?;
    let beams = beams.map(|beams| beams.count());
    Ok(report(arguments, triangles.len(), beams, build_time, render_time, &counts))
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
    beams: Option<usize>,
    build_time: Duration,
    render_time: Duration,
    counts: &RayCounts,
) -> String {
    let mut table = String::new();
    let mut row = |name: &str, value: String| {
        writeln!(table, "{name:<18}{value:>14}").expect("a string takes any text");
    };
    row("triangles", triangles.to_string());
    if let Some(beams) = beams {
        row("beams", beams.to_string());
    }
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
