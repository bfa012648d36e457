//! The reference tracer as its user meets it: bad input costs one clear line and exit code 2, and
//! never a picture.

#![expect(clippy::unwrap_used, reason = "in a test, a panic is the report")]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::OnceLock;

/// The example's binary, built in the profile of this test. (A plain `cargo test` builds an example
/// that has tests only as their harness, and `cargo test --test tracer_cli` not at all.)
fn tracer() -> &'static Path {
    static BUILT: OnceLock<PathBuf> = OnceLock::new();
    BUILT.get_or_init(|| {
        let this = std::env::current_exe().unwrap(); // target/<profile>/deps/tracer_cli-…
        let folder = this.ancestors().nth(2).unwrap();
        let profile = match folder.file_name().unwrap().to_str().unwrap() {
            "debug" => "dev",
            other => other,
        };
        let status = Command::new(env!("CARGO"))
            .args(["build", "--quiet", "--example", "tracer", "--profile", profile])
            .arg("--target-dir")
            .arg(folder.parent().unwrap())
            .current_dir(env!("CARGO_MANIFEST_DIR"))
            .status()
            .unwrap();
        assert!(status.success());
        folder.join("examples/tracer").with_extension(std::env::consts::EXE_EXTENSION)
    })
}

/// A folder of a test's own, removed at its end.
struct Folder(PathBuf);

impl Folder {
    fn new(test: &str) -> Self {
        let folder = std::env::temp_dir().join(format!("isect-{test}-{}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        Self(folder)
    }

    fn file(&self, name: &str, contents: impl AsRef<[u8]>) {
        fs::write(self.0.join(name), contents).unwrap();
    }

    fn names(&self) -> Vec<String> {
        let entries = fs::read_dir(&self.0).unwrap();
        let mut names: Vec<_> =
            entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    /// Runs the tracer here, for a picture small enough for a debug build.
    fn run(&self, arguments: &[&str]) -> Output {
        let is_given = |option| arguments.contains(&option);
        let samples: &[&str] = if is_given("--antialias") { &[] } else { &["--samples", "1"] };
        let size: &[&str] = if is_given("--size") { &[] } else { &["--size", "16x9"] };
        Command::new(tracer())
            .args(["--depth", "2"])
            .args(samples)
            .args(size)
            .args(arguments)
            .current_dir(&self.0)
            .output()
            .unwrap()
    }

    /// Runs the tracer on bad input and returns the first line of what it says.
    fn refused(&self, arguments: &[&str]) -> String {
        let before = self.names();
        let output = self.run(arguments);
        let said = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {said}");
        assert!(output.stdout.is_empty());
        assert_eq!(self.names(), before, "{arguments:?} left something behind");
        said.lines().next().unwrap().to_owned()
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

#[test]
fn a_bad_mesh_is_named_with_the_reason() {
    let folder = Folder::new("mesh");
    let square = "v 0 0 0\nv 1 0 0\nv 1 1 0\n";
    folder.file("binary.obj", [0xff, 0xfe, 0x00]);
    folder.file("empty.obj", "");
    folder.file("no-faces.obj", square);
    folder.file("malformed.obj", format!("{square}f 1 2 x\n"));
    folder.file("nan.obj", format!("{square}v nan 0 0\nf 1 2 4\n"));
    folder.file("range.obj", format!("{square}f 1 2 4\n"));
    let cases = [
        ("missing.obj", ""),
        (".", ""),
        ("binary.obj", "not a text file: byte 0 is not UTF-8"),
        ("empty.obj", "no triangles in it"),
        ("no-faces.obj", "no triangles in it"),
        ("malformed.obj", "line 4: face parse error"),
        ("nan.obj", "line 4: not finite: v nan 0 0"),
        ("range.obj", "face vertex index out of bounds"),
    ];
    for (file, reason) in cases {
        let line = folder.refused(&["--mesh", file]);
        let expected = format!("error: {file}: {reason}");
        assert!(line.starts_with(&expected), "{line}");
        assert!(line.len() > format!("error: {file}: ").len(), "{line}");
    }
}

#[test]
fn bad_options_are_named_with_the_reason() {
    let folder = Folder::new("options");
    let cases: [(&[&str], &str); 65] = [
        (&["--size", "0x9"], "at least one pixel"),
        (&["--size", "100000x100000"], "more than 67108864 pixels"),
        (&["--size", "wide"], "not of the form 960x540"),
        (&["--samples", "0"], "'--samples"),
        (&["--samples", "8"], "not a square number from 1 to 1024"),
        (&["--samples", "1089"], "not a square number from 1 to 1024"),
        (&["--crop", "0,0,9"], "not of the form 0,0,480,270"),
        (&["--crop", "0,0,-9,9"], "not of the form 0,0,480,270"),
        (&["--crop", "5,5,9,5"], "no pixels in it"),
        (&["--crop", "0,0,9,541"], "'--crop 0,0,9,541': there are no pixels beyond 960x540"),
        (&["--crop", "-1,0,3,3"], "not of the form 0,0,480,270"),
        (&["--samples", "-1"], "'--samples"),
        (&["--fog", "linear", "--fog-range", "-3,4"], "not 0 ≤ DMIN < DMAX"),
        (&["--fog", "exponential", "--fog-density", "-1"], "not a number greater than 0"),
        (&["--depth", "-1"], "'--depth"),
        (&["--threads", "-1"], "'--threads"),
        (&["--seed", "-1"], "'--seed"),
        (&["--merge"], "a value is required for '--merge"),
        (&["--merge", "a.png", "--crop", "0,0,9,9"], "'--crop' has no place with '--merge'"),
        (&["--merge", "a.png", "--seed", "1"], "'--seed' has no place with '--merge'"),
        (&["--compare"], "a value is required for '--compare"),
        (&["--compare", "none/plot.svg"], "none/plot.svg: "),
        (&["--compare", "a.svg", "--samples", "4"], "'--samples' has no place with '--compare'"),
        (&["--compare", "a.svg", "--output", "a.png"], "'--output' has no place"),
        (&["--compare", "a.svg", "--merge", "a.png"], "'--compare' has no place with '--merge'"),
        (&["--antialias", "some"], "'--antialias"),
        (&["--fog", "thick"], "'--fog"),
        (&["--fog", "linear", "--fog-range", "4"], "not of the form 4,24"),
        (&["--fog", "linear", "--fog-range", "4,4"], "not 0 ≤ DMIN < DMAX"),
        (
            &["--fog", "linear", "--fog-density", "1"],
            "'--fog-density' has no place with '--fog linear'",
        ),
        (&["--fog", "exponential", "--fog-density", "0"], "not a number greater than 0"),
        (&["--fog", "exponential", "--fog-range", "1,2"], "'--fog-range' has no place"),
        (&["--fog", "linear", "--fog-color", "1,1,2"], "not three numbers from 0 to 1"),
        (&["--fog-color", "1,1,1"], "'--fog-color' has no place with '--fog none'"),
        (&["--scene", "textures", "--mesh", "x.obj"], "no mesh in this scene"),
        (&["--antialias", "none", "--samples", "4"], "'--samples' has no place"),
        (&["--antialias", "adaptive", "--samples", "4"], "'--samples' has no place"),
        (&["--antialias", "adaptive", "--max-level", "7"], "not in 0..=6"),
        (&["--antialias", "adaptive", "--packets"], "'--antialias adaptive' has no packets"),
        (&["--antialias", "pyramid", "--samples", "4"], "'--samples' has no place"),
        (&["--antialias", "pyramid", "--max-level", "7"], "not in 0..=6"),
        (&["--antialias", "pyramid", "--packets"], "'--antialias pyramid' has no packets"),
        (&["--antialias", "cone", "--max-level", "2"], "'--max-level' has no place"),
        (&["--antialias", "cone", "--packets"], "'--antialias cone' has no packets"),
        (&["--antialias", "cone", "--lamp-radius", "-1"], "not a number from 0 to 10000"),
        (&["--antialias", "cone", "--lamp-radius", "inf"], "not a number from 0 to 10000"),
        (&["--lamp-radius", "1"], "'--lamp-radius' has no place with '--antialias uniform'"),
        (&["--compare", "a.svg", "--lamp-radius", "1"], "'--lamp-radius' has no place"),
        (&["--max-level", "2"], "'--max-level' has no place with '--antialias uniform'"),
        (&["--antialias", "stochastic", "--seed", "one"], "'--seed"),
        (&["--seed", "1"], "'--seed' has no place with '--antialias uniform'"),
        (&["--mode", "beam"], "'--mode beam' is for '--scene polygons' only"),
        (&["--scene", "polygons", "--mode", "beam", "--packets"], "'--packets' has no place"),
        (
            &["--scene", "polygons", "--mode", "beam", "--antialias", "cone"],
            "'--antialias cone' has no place with '--mode beam'",
        ),
        (&["--mode", "waves"], "'--mode"),
        (&["--depth", "65"], "not in 0..=64"),
        (&["--threads", "2000"], "not in 0..=1024"),
        (&["--triangle", "none"], "'--triangle"),
        (&["--scene", "none"], "'--scene"),
        (&["--scene", "spheres", "--mesh", "x.obj"], "no mesh in this scene"),
        (&["--scene", "spheres", "--bench"], "no mesh in this scene"),
        (&["--mesh", "icosphere:10"], "not icosphere:0 to icosphere:9"),
        (&["--accel", "bvh8", "--triangle", "watertight"], "for '--triangle exact' only"),
        (&["--packets", "--accel", "bvh2"], "for '--accel bvh8' only"),
        (&["--packets", "--triangle", "watertight"], "for '--accel bvh8' only"),
    ];
    for (arguments, reason) in cases {
        // An option may be given once: leave out the test's own.
        let output =
            Command::new(tracer()).args(arguments).current_dir(&folder.0).output().unwrap();
        let said = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{said}");
        let line = said.lines().next().unwrap();
        assert!(line.starts_with("error: ") && line.contains(reason), "{line}");
        assert!(folder.names().is_empty());
    }
}

#[test]
fn an_output_that_cannot_be_written_is_refused() {
    let folder = Folder::new("output");
    folder.file("occupied", "a file");
    folder.file("kept.png", "precious");
    fs::create_dir(folder.0.join("folder")).unwrap();
    let mut permissions = fs::metadata(folder.0.join("kept.png")).unwrap().permissions();
    permissions.set_readonly(true);
    fs::set_permissions(folder.0.join("kept.png"), permissions).unwrap();
    for file in ["none/picture.png", "occupied/picture.png", "folder", "kept.png"] {
        let line = folder.refused(&["--output", file]);
        assert!(line.starts_with(&format!("error: {file}: ")), "{line}");
    }
    assert_eq!(fs::read(folder.0.join("kept.png")).unwrap(), b"precious");
}

#[test]
fn a_failure_leaves_the_old_picture_and_a_success_replaces_it() {
    let folder = Folder::new("replace");
    folder.file("tracer.png", "old");
    folder.refused(&["--mesh", "missing.obj"]);
    assert_eq!(fs::read(folder.0.join("tracer.png")).unwrap(), b"old");
    let output = folder.run(&[]);
    assert!(output.status.success() && output.stderr.is_empty());
    assert!(String::from_utf8(output.stdout).unwrap().contains("Mrays/s"));
    let picture = fs::read(folder.0.join("tracer.png")).unwrap();
    assert!(picture.starts_with(b"\x89PNG"));
    assert_eq!(folder.names(), ["tracer.png"]);
}

#[test]
fn threads_packets_and_the_hierarchy_do_not_change_the_bytes() {
    let folder = Folder::new("same");
    let picture = |arguments: &[&str]| {
        assert!(folder.run(arguments).status.success());
        fs::read(folder.0.join("tracer.png")).unwrap()
    };
    let one = picture(&["--size", "48x40", "--threads", "1"]);
    assert_eq!(one, picture(&["--size", "48x40", "--threads", "2"]));
    assert_eq!(one, picture(&["--size", "48x40", "--packets"]));
    let naive = picture(&["--accel", "none"]);
    assert_eq!(naive, picture(&["--accel", "bvh2"]));
    assert_eq!(naive, picture(&["--accel", "bvh8"]));
    assert_eq!(naive, picture(&[]));
    assert_eq!(naive, picture(&["--packets"]));
    // The last packet of a row is not full.
    assert_eq!(picture(&["--size", "13x11"]), picture(&["--size", "13x11", "--packets"]));
}

#[test]
fn no_method_depends_on_threads() {
    let folder = Folder::new("methods");
    let picture = |method: &[&str], arguments: &[&str]| {
        let scene = ["--scene", "edges", "--mesh", "icosphere:1", "--size", "40x36"];
        let output = folder.run(&[&scene[..], &["--antialias"], method, arguments].concat());
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        fs::read(folder.0.join("tracer.png")).unwrap()
    };
    let methods: [&[&str]; 9] = [
        &["none"],
        &["uniform"],
        &["adaptive", "--max-level", "1"],
        &["adaptive", "--max-level", "2"],
        &["stochastic"],
        &["stochastic", "--seed", "1"],
        &["pyramid", "--max-level", "1"],
        &["cone"],
        &["cone", "--lamp-radius", "20"],
    ];
    let pictures = methods.map(|method| picture(method, &["--threads", "1"]));
    for (index, method) in methods.into_iter().enumerate() {
        assert_eq!(pictures[index], picture(method, &["--threads", "2"]), "{method:?}");
        assert!(!pictures[..index].contains(&pictures[index]), "{method:?} has no effect");
        if matches!(method[0], "none" | "uniform" | "stochastic") {
            assert_eq!(pictures[index], picture(method, &["--packets"]), "{method:?}");
        }
    }
}

#[test]
fn each_scene_and_each_fog_makes_another_picture() {
    let folder = Folder::new("scenes");
    let options: [&[&str]; 13] = [
        &["--scene", "showcase"],
        &["--scene", "mesh"],
        &["--scene", "spheres"],
        &["--scene", "shares"],
        &["--scene", "textures"],
        &["--scene", "lamps"],
        &["--scene", "edges"],
        &["--fog", "linear"],
        &["--fog", "linear", "--fog-range", "0,9.5"],
        &["--fog", "linear", "--fog-color", "1,0.5,0"],
        &["--fog", "exponential"],
        &["--fog", "exponential", "--fog-density", "0.2"],
        &["--fog", "exponential", "--fog-color", "1,0.5,0"],
    ];
    let mut pictures = Vec::new();
    for arguments in options {
        let output = folder.run(arguments);
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        let picture = fs::read(folder.0.join("tracer.png")).unwrap();
        assert!(!pictures.contains(&picture), "{arguments:?} has no effect");
        pictures.push(picture);
    }
}

/// The parts of a picture of 40 × 34 pixels, as files of these names in a folder.
const PARTS: [(&str, &str); 3] =
    [("a.png", "0,0,33,20"), ("b.png", "33,0,40,20"), ("c.png", "0,20,40,34")];

impl Folder {
    /// Renders a picture, or a part of it, by the method with a seed.
    fn render(&self, file: &str, mesh: &str, arguments: &[&str]) -> Vec<u8> {
        let scene = ["--scene", "mesh", "--mesh", mesh, "--size", "40x34"];
        let rest = ["--antialias", "stochastic", "--output", file];
        let output = self.run(&[&scene[..], &rest, arguments].concat());
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        fs::read(self.0.join(file)).unwrap()
    }

    /// Puts parts together.
    fn merge(&self, parts: &[&str]) -> Output {
        let command = [&["--output", "merged.png", "--merge"], parts].concat();
        Command::new(tracer()).args(command).current_dir(&self.0).output().unwrap()
    }
}

#[test]
fn parts_make_the_same_file_as_the_whole() {
    let folder = Folder::new("parts");
    for method in ["none", "uniform", "adaptive", "stochastic", "pyramid", "cone"] {
        let run = |arguments: &[&str]| {
            let scene = ["--scene", "edges", "--mesh", "icosphere:1"];
            let common = [&scene[..], &["--size", "40x34", "--antialias", method]].concat();
            assert!(folder.run(&[&common, arguments].concat()).status.success());
        };
        run(&["--output", "whole.png"]);
        for (file, crop) in PARTS {
            run(&["--crop", crop, "--output", file, "--threads", "1"]);
        }
        let output = folder.merge(&["c.png", "a.png", "b.png"]);
        assert!(output.status.success() && output.stderr.is_empty());
        assert_eq!(String::from_utf8(output.stdout).unwrap(), "merged.png\n");
        let file = |name| fs::read(folder.0.join(name)).unwrap();
        assert!(file("merged.png") == file("whole.png"), "{method}");
    }
}

#[test]
fn parts_that_do_not_fit_are_named_with_the_reason() {
    let folder = Folder::new("unfit");
    for (file, crop) in PARTS {
        folder.render(file, "icosphere:1", &["--crop", crop]);
    }
    let bytes = folder.render("whole.png", "icosphere:1", &[]);
    folder.file("text.png", "no picture");
    let crop = ["--crop", PARTS[1].1];
    folder.render("mesh.png", "icosphere:0", &crop);
    let others: [(&str, &[&str]); 3] = [
        ("seed.png", &["--seed", "1"]),
        ("fog.png", &["--fog", "exponential"]),
        ("kernel.png", &["--triangle", "watertight"]),
    ];
    for (file, other) in others {
        folder.render(file, "icosphere:1", &[&crop, other].concat());
    }
    folder.render("wide.png", "icosphere:1", &["--crop", "30,10,40,34"]);
    let part = fs::read(folder.0.join("c.png")).unwrap();
    folder.file("cut.png", &part[..part.len() / 2]);
    // The text is changed, and its checksum is not.
    let at = part.windows(10).position(|bytes| bytes == b"0,20,40,34").unwrap();
    folder.file("changed.png", [&part[..at], b"0,20,40,33", &part[at + 10..]].concat());
    assert!(!bytes.windows(4).any(|bytes| bytes == b"tEXt"));

    let cases: [(&[&str], &str); 13] = [
        (&["a.png", "b.png"], "the pixels 0,20,40,34 are in none of the parts"),
        (&["c.png", "a.png"], "the pixels 33,0,40,20 are in none of the parts"),
        (&["b.png", "c.png"], "the pixels 0,0,33,20 are in none of the parts"),
        (&["a.png", "b.png", "c.png", "a.png"], "a.png: the pixels 0,0,33,20 are in a.png too"),
        (&["a.png", "wide.png", "b.png"], "wide.png: the pixels 30,10,33,20 are in a.png too"),
        (&["a.png", "seed.png", "c.png"], "seed.png: of another picture than a.png: "),
        (&["a.png", "fog.png", "c.png"], "fog.png: of another picture than a.png: "),
        (&["a.png", "mesh.png", "c.png"], "mesh.png: of another picture than a.png: "),
        (&["a.png", "kernel.png", "c.png"], "kernel.png: of another picture than a.png: "),
        (&["whole.png"], "whole.png: not a part of a picture: no text 'Crop' in it"),
        (&["text.png"], "text.png: "),
        (&["a.png", "b.png", "cut.png"], "cut.png: "),
        (&["a.png", "b.png", "none.png"], "none.png: "),
    ];
    let before = folder.names();
    for (parts, reason) in cases {
        let output = folder.merge(parts);
        let said = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{parts:?}: {said}");
        assert!(said.starts_with(&format!("error: {reason}")), "{parts:?}: {said}");
        assert_eq!((said.lines().count(), folder.names()), (1, before.clone()));
    }
    // A damaged text is passed over, or the file refused: either way there is no picture.
    assert_eq!(folder.merge(&["a.png", "b.png", "changed.png"]).status.code(), Some(2));
}

#[test]
fn the_bench_makes_a_table_and_no_picture() {
    let folder = Folder::new("bench");
    let bench = ["--bench", "--mesh", "icosphere:1", "--size", "16x9"];
    let run = |more: &[&str]| {
        let arguments = [&bench[..], more].concat();
        Command::new(tracer()).args(arguments).current_dir(&folder.0).output().unwrap()
    };
    for [option, value] in [["--output", "x.png"], ["--crop", "0,0,9,9"], ["--fog", "linear"]] {
        let refused = run(&[option, value]);
        assert_eq!(refused.status.code(), Some(2));
        let said = String::from_utf8(refused.stderr).unwrap();
        assert_eq!(said, format!("error: '{option}' has no place with '--bench'\n"));
    }
    let output = run(&[]);
    assert!(output.status.success() && output.stderr.is_empty());
    let table = String::from_utf8(output.stdout).unwrap();
    let row = |name: &str| {
        let row = table.lines().find(|line| line.starts_with(name)).unwrap();
        row.split_whitespace().skip(1).map(|word| word.parse().unwrap()).collect::<Vec<f64>>()
    };
    for kind in ["primary", "lamp", "random", "shadow"] {
        let row = row(kind);
        // No part of a sphere has another in its shadow.
        let positive = if kind == "lamp" { &row[..5] } else { &row[..] };
        assert!(row.len() == 6 && positive.iter().all(|x| *x > 0.0), "{table}");
    }
    assert!(table.contains("triangles         80\n"), "{table}");
    assert!(folder.names().is_empty());
}

#[test]
fn the_comparison_makes_a_table_and_a_plot() {
    let folder = Folder::new("compare");
    let arguments =
        ["--size", "5x4", "--depth", "0", "--mesh", "icosphere:0", "--compare", "plot.svg"];
    let output = Command::new(tracer()).args(arguments).current_dir(&folder.0).output().unwrap();
    assert!(output.status.success() && output.stderr.is_empty());
    let table = String::from_utf8(output.stdout).unwrap();
    let plot = String::from_utf8(fs::read(folder.0.join("plot.svg")).unwrap()).unwrap();
    assert_eq!(folder.names(), ["plot.svg"]);
    assert!(plot.starts_with("<svg") && plot.trim_end().ends_with("</svg>"));
    for method in ["none", "uniform", "adaptive", "stochastic", "pyramid", "cone"] {
        let rows: Vec<_> = table.lines().filter(|line| line.starts_with(method)).collect();
        assert!(rows.len() >= 2, "{table}");
        for row in rows {
            let numbers: Vec<f64> =
                row.split_whitespace().rev().take(3).map(|word| word.parse().unwrap()).collect();
            assert!(numbers[..2].iter().all(|x| *x > 0.0), "{row}");
        }
        assert!(plot.contains(method), "{method}");
    }
}
