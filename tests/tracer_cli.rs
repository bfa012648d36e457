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
        let small = ["--samples=1", "--depth=2"];
        let size: &[&str] = if arguments.contains(&"--size") { &[] } else { &["--size", "16x9"] };
        Command::new(tracer())
            .args(small)
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
    let cases: [(&[&str], &str); 15] = [
        (&["--size", "0x9"], "at least one pixel"),
        (&["--size", "100000x100000"], "more than 67108864 pixels"),
        (&["--size", "wide"], "not of the form 960x540"),
        (&["--samples", "0"], "'--samples"),
        (&["--samples", "289"], "'--samples"),
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
fn the_bench_makes_a_table_and_no_picture() {
    let folder = Folder::new("bench");
    let output = folder.run(&["--bench", "--mesh", "icosphere:1"]);
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
