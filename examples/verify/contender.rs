//! Kernels that run a campaign, what each promises, and the run of them all.

use std::time::Duration;

use indicatif::{ProgressBar, ProgressStyle};
use isect::testkit::{Campaign, Report, table};
use rayon::prelude::*;

/// What a kernel promises.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Promise {
    /// The verdict of exact arithmetic.
    Exact,
    /// And a t within an ulp.
    Refined,
    /// Nothing that touches is missed.
    Conservative,
    /// No ray gets out of a closed mesh.
    Watertight,
    /// No hit of bad input, no NaN, no panic.
    Sound,
    /// Another library's: only reported.
    Unknown,
}

impl Promise {
    fn is_kept(self, report: &Report) -> bool {
        match self {
            Self::Exact => report.is_exact(),
            Self::Refined => report.is_exact() && report.t_errors.worst <= 1,
            Self::Conservative => report.is_conservative(),
            Self::Watertight => report.is_watertight(),
            Self::Sound => report.is_sound(),
            Self::Unknown => true,
        }
    }
}

/// A kernel that can be run over the cases of a campaign.
pub(crate) struct Contender {
    pub(crate) name: String,
    promise: Promise,
    run: Box<Run>,
}

/// Runs a campaign, under a name.
type Run = dyn Fn(Campaign, &str) -> Report + Sync;

impl Contender {
    pub(crate) fn new(
        name: &str,
        promise: Promise,
        run: impl Fn(Campaign, &str) -> Report + Sync + 'static,
    ) -> Self {
        Self { name: name.to_owned(), promise, run: Box::new(run) }
    }
}

/// Into how many parts a campaign is split: always so many, so that the cases do not depend on the machine.
const PARTS: u32 = 16;

/// The contenders' reports, in their order.
pub(crate) fn run(contenders: &[Contender], campaign: Campaign) -> Vec<Report> {
    let parts: Vec<Campaign> = campaign.parts(PARTS).collect();
    let style = ProgressStyle::with_template("{bar:40} {pos}/{len} {elapsed} {msg}");
    let bar = ProgressBar::new((contenders.len() * parts.len()) as u64)
        .with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
    bar.enable_steady_tick(Duration::from_millis(200));
    // A panic is a fault to be counted, not one to be told of.
    let hook = std::panic::take_hook();
    std::panic::set_hook(Box::new(|_| ()));
    let reports = contenders
        .par_iter()
        .map(|contender| {
            let reports: Vec<Report> = parts
                .par_iter()
                .map(|part| {
                    let report = (contender.run)(*part, &contender.name);
                    bar.set_message(contender.name.clone());
                    bar.inc(1);
                    report
                })
                .collect();
            let merged = reports.into_iter().reduce(Report::merged);
            merged.unwrap_or_else(|| Report::new(&contender.name, ""))
        })
        .collect();
    std::panic::set_hook(hook);
    bar.finish_and_clear();
    reports
}

/// Prints the table, a case of each fault of those that break their promise (or of all), and says whether none does.
pub(crate) fn print(contenders: &[Contender], reports: &[Report], with_examples: bool) -> bool {
    println!("{}", table(reports));
    let mut broken = Vec::new();
    for (contender, report) in contenders.iter().zip(reports) {
        let is_kept = contender.promise.is_kept(report);
        if with_examples || !is_kept {
            report.examples.iter().for_each(|case| println!("{case}\n"));
        }
        if !is_kept {
            broken.push(format!("{}, {}: {:?}", report.kernel, report.vector, contender.promise));
        }
    }
    if broken.is_empty() {
        println!("Every promise is kept.");
    } else {
        println!("Broken promises:\n{}", broken.join("\n"));
    }
    broken.is_empty()
}
