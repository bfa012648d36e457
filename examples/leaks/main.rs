//! What the kernels promise, as pictures: rays that slip between the triangles of a mesh, and verdicts beside a vertex.
//!
//! ```text
//! cargo run --release --example leaks -- --help
//! ```

mod kernels;
mod mesh;
mod picture;
mod verdicts;

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Parser;
use kernels::KERNELS;

/// Draws what six ray/triangle kernels do at the edges of a mesh, and beside a vertex of one triangle.
///
/// Each picture has a panel for each kernel, in the order of the tables that are printed, row by row.
#[derive(Debug, Parser)]
#[command(name = "leaks")]
struct Arguments {
    /// The folder for mesh.png and verdicts.png
    #[arg(long, value_name = "DIR", default_value = "examples/leaks")]
    output: PathBuf,
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
    match draw(&arguments.output) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::from(2)
        }
    }
}

/// Prints the tables, and writes the pictures to a folder. The error is one line.
fn draw(folder: &Path) -> Result<(), String> {
    if !folder.is_dir() {
        return Err(format!("{}: not a folder", folder.display()));
    }
    let leaks = mesh::leaks();
    println!("{:<28}{:>10}{:>10}{:>10}{:>10}", "lost", "at edges", "of", "vertices", "of");
    for (kernel, lost) in KERNELS.iter().zip(&leaks.lost) {
        println!(
            "{:<28}{:>10}{:>10}{:>10}{:>10}",
            kernel.name,
            lost.at_edges,
            leaks.rays.at_edges,
            lost.at_vertices,
            leaks.rays.at_vertices
        );
    }
    let verdicts = verdicts::verdicts();
    println!("\n{:<28}{:>14}{:>14}{:>10}", "beside a vertex", "wrong hits", "wrong misses", "of");
    for (kernel, wrong) in KERNELS.iter().zip(&verdicts.wrong) {
        println!("{:<28}{:>14}{:>14}{:>10}", kernel.name, wrong.hits, wrong.misses, verdicts.rays);
    }
    for (name, picture) in [("mesh.png", leaks.picture), ("verdicts.png", verdicts.picture)] {
        let file = folder.join(name);
        picture.write(&file).map_err(|error| format!("{}: {error}", file.display()))?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_folder_is_named() {
        let error = draw(Path::new("Cargo.toml")).expect_err("it is a file");
        assert_eq!(error, "Cargo.toml: not a folder");
        assert!(Arguments::try_parse_from(["leaks", "--outpt", "."]).is_err());
    }
}
