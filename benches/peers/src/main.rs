//! Times isect and its peers (obvhs, parry3d, the bvh crate) on the same queries, in the same
//! process, and prints a table per question.
//!
//! Absolute times drift with the machine's clock and its other work. So the contenders take turns,
//! in a new random order in each round, and what counts is the ratio of a contender's time to the
//! reference's in the same round.
//!
//! With `--verify` it runs them over the testkit's hard cases instead, and prints their faults.

mod chart;
#[path = "../../../examples/verify/contender.rs"]
mod contender;
#[path = "../../data/mod.rs"]
mod data;
#[path = "../../../examples/verify/kernels.rs"]
mod kernels;
mod packs;
mod peer;
mod ray_box;
mod ray_triangle;
mod report;
mod timing;
mod triangle_box;
mod verify;

use std::fs;
use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;
use isect::testkit::Campaign;

/// Times isect and its peers on the same queries.
#[derive(Parser)]
struct Options {
    /// A few rounds only, to see that it runs: the numbers mean little.
    #[arg(long)]
    quick: bool,
    /// How often each contender runs over all pairs, per table.
    #[arg(long, default_value_t = 301)]
    rounds: usize,
    /// Only contenders whose name contains this (and the reference).
    #[arg(long, default_value = "")]
    filter: String,
    /// Only questions whose title contains this, or one of several.
    #[arg(long)]
    question: Vec<String>,
    /// Also draws the ratios of these questions.
    #[arg(long, value_name = "FILE.svg")]
    chart: Option<PathBuf>,
    /// Compares answers with exact arithmetic, in place of times with each other.
    #[arg(long)]
    verify: bool,
    /// With --verify: cases for each contender.
    #[arg(long, default_value_t = 100_000)]
    cases: u64,
    /// With --verify: the seed of the cases.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// With --verify: prints a case of each fault, in Rust, also where nothing was promised.
    #[arg(long)]
    examples: bool,
}

fn main() -> ExitCode {
    let options = Options::parse();
    if options.verify {
        let campaign = Campaign::new(options.cases, options.seed);
        return verify::run(&options.filter, campaign, options.examples);
    }
    let rounds = if options.quick { 3 } else { options.rounds };
    println!("{}", report::machine());
    let questions = ray_triangle::questions()
        .chain(ray_box::questions())
        .chain(triangle_box::questions())
        .chain(packs::triangle_questions())
        .chain(packs::box_questions());
    let is_asked = |title: &str| {
        options.question.is_empty() || options.question.iter().any(|part| title.contains(part))
    };
    let mut groups = Vec::new();
    for mut question in questions.filter(|q| is_asked(&q.title)) {
        question.contenders.retain(|c| c.is_reference || c.name.contains(&options.filter));
        let results = timing::race(&mut question.contenders, rounds);
        println!("{}", report::table(&question, &results));
        groups.push(chart::Group::new(&question, &results));
    }
    let Some(file) = options.chart else { return ExitCode::SUCCESS };
    match chart::draw(&groups).and_then(|svg| Ok(fs::write(&file, svg)?)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {}: {error}", file.display());
            ExitCode::from(2)
        }
    }
}
