//! Runs every kernel of this crate, and those of obvhs, over hard cases, and holds them to what they promise.
//!
//! ```text
//! cargo run --release --example verify -- --help
//! ```

mod contender;
mod kernels;

use std::process::ExitCode;

use clap::Parser;
use isect::glam::{DVec3, Vec3, Vec3A};
use isect::testkit::Campaign;

/// Asks every kernel about hard cases and compares the answers with exact arithmetic.
///
/// The exit code is 1 if a kernel breaks its promise: an exact one with any wrong verdict, a conservative one that misses,
/// a watertight one that leaks, any with a NaN in a hit, a t out of range, a hit of bad input, a panic. The wrong verdicts of the fast kernels
/// and of other libraries are only reported.
#[derive(Debug, Parser)]
#[command(name = "verify")]
struct Arguments {
    /// Cases per kernel and vector type, and rays out of closed meshes
    #[arg(long, value_name = "N", default_value_t = 100_000, value_parser = clap::value_parser!(u64).range(1..))]
    cases: u64,
    /// Seed of the cases
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
    /// Only kernels whose name contains this
    #[arg(long, value_name = "NAME", default_value = "")]
    kernel: String,
    /// Prints a case of each fault, in Rust, also where nothing was promised
    #[arg(long)]
    examples: bool,
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
    let mut contenders = kernels::of_isect::<Vec3>();
    contenders.extend(kernels::of_isect::<Vec3A>());
    contenders.extend(kernels::of_isect::<DVec3>());
    contenders.extend(kernels::of_obvhs());
    contenders.retain(|contender| contender.name.contains(&arguments.kernel));
    if contenders.is_empty() {
        eprintln!("verify: no kernel has a name with {:?}", arguments.kernel);
        return ExitCode::from(2);
    }
    let reports = contender::run(&contenders, Campaign::new(arguments.cases, arguments.seed));
    if contender::print(&contenders, &reports, arguments.examples) {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    }
}
