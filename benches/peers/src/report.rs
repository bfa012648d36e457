//! The tables, in Markdown.

use std::fmt::Write;
use std::process::Command;

use crate::data::PAIRS;
use crate::timing::{Outcome, Question};

/// The processor, the compiler and its flags, as far as they can be known.
pub fn machine() -> String {
    let cpu = std::fs::read_to_string("/proc/cpuinfo")
        .ok()
        .and_then(|info| {
            let model = info.lines().find(|line| line.starts_with("model name"))?;
            Some(model.split_once(':')?.1.trim().to_owned())
        })
        .unwrap_or_else(|| "unknown processor".to_owned());
    // The one on the path is the one that built this, as a rule.
    let rustc = Command::new("rustc").arg("--version").output().map_or_else(
        |_| "unknown rustc".to_owned(),
        |output| String::from_utf8_lossy(&output.stdout).trim().to_owned(),
    );
    let features = [
        ("avx2", cfg!(target_feature = "avx2")),
        ("fma", cfg!(target_feature = "fma")),
        ("avx512f", cfg!(target_feature = "avx512f")),
    ]
    .map(|(name, on)| if on { name } else { "" })
    .join(" ");
    let flags = match features.trim() {
        "" => "the target's default features",
        features => features,
    };
    let build =
        if cfg!(debug_assertions) { " **A debug build: the numbers mean nothing.**" } else { "" };
    format!(
        "{cpu}; {rustc}; {}, {flags}.{build}\n\n{PAIRS} pairs per table, in an order of \
         hits and misses that is new each round. Times in ns per query. The ratio is taken round by round; its \
         spread is from the 10th to the 90th percentile. Clock cycles are those of the best round.\n",
        std::env::consts::ARCH
    )
}

/// The table of one question.
pub fn table(question: &Question, outcomes: &[Outcome]) -> String {
    let mut table = format!(
        "## {}\n\n{}\n\n\
         | contender | min | cycles | median | ratio | spread | hits |\n|---|--:|--:|--:|--:|--:|--:|\n",
        question.title, question.note
    );
    for (contender, outcome) in question.contenders.iter().zip(outcomes) {
        let (times, ratios) = (sorted(&outcome.times), sorted(&outcome.ratios));
        let name = if contender.is_reference {
            format!("**{}**", contender.name)
        } else {
            contender.name.to_owned()
        };
        let (hits, percent) = (outcome.hits, 100.0 * outcome.hits as f64 / PAIRS as f64);
        // Writing to a string does not fail.
        let _ = writeln!(
            table,
            "| {name} | {:.2} | {:.2} | {:.2} | {:.3} | {:.3}–{:.3} | {hits} ({percent:.1} %) |",
            quantile(&times, 0.0),
            outcome.cycles,
            quantile(&times, 0.5),
            ratio(outcome),
            quantile(&ratios, 0.1),
            quantile(&ratios, 0.9),
        );
    }
    let [_, f64s, integers] = question.stages;
    let percent = |count: usize| 100.0 * count as f64 / PAIRS as f64;
    let _ = writeln!(
        table,
        "\nThe exact kernel on Vec3A leaves {:.3} % to its second stage, {:.3} % to integers.",
        percent(f64s + integers),
        percent(integers)
    );
    table
}

/// The median of the ratios to the reference.
pub fn ratio(outcome: &Outcome) -> f64 {
    quantile(&sorted(&outcome.ratios), 0.5)
}

fn sorted(values: &[f64]) -> Vec<f64> {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted
}

/// The value below which the fraction lies; NaN of nothing.
fn quantile(sorted: &[f64], fraction: f64) -> f64 {
    let last = sorted.len().saturating_sub(1) as f64;
    let index = (last * fraction).round() as usize;
    sorted.get(index).copied().unwrap_or(f64::NAN)
}
