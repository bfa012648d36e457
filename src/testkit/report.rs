//! How a kernel did: counts of its faults, and one case of each.

use std::fmt::{self, Display, Formatter};

/// What a kernel did wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Fault {
    /// The shapes have a point in common, and the kernel says that they have none.
    FalseMiss,
    /// They have none, and the kernel says that they have one.
    FalseHit,
    /// The kernel hit something though the ray or the shape was none: NaN, infinite, without direction, empty.
    BadInputHit,
    /// A number of the hit is NaN.
    Nan,
    /// The t of the hit is not in the ray's range, or infinite.
    OutOfRange,
    /// It panicked.
    Panic,
    /// A ray from inside of a closed mesh met none of its triangles.
    Leak,
}

impl Display for Fault {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::FalseMiss => "false miss",
            Self::FalseHit => "false hit",
            Self::BadInputHit => "hit of bad input",
            Self::Nan => "NaN in a hit",
            Self::OutOfRange => "t out of range",
            Self::Panic => "panic",
            Self::Leak => "leak",
        })
    }
}

/// A case that a kernel got wrong. As text it is Rust: declarations of the shapes, to the last bit, ready to be pasted
/// into a regression test.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Case {
    /// The kernel's name.
    pub kernel: String,
    /// What it did wrong.
    pub fault: Fault,
    /// Whether the shapes have a point in common, exactly.
    pub touches: bool,
    /// `let` statements of the shapes, and of a mesh the triangles that the ray meets.
    pub shapes: String,
}

impl Display for Case {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        writeln!(f, "// {}: {}.", self.kernel, self.fault)?;
        write!(f, "{}let touches = {};", self.shapes, self.touches)
    }
}

/// How far computed t are from the exact ones, in ulps: the number of floats that one has to step over.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TErrors {
    /// The greatest.
    pub worst: u64,
    /// How many are 0, how many 1, from there to 2, to 4, 8 and so on.
    pub counts: [u64; 66],
}

impl Default for TErrors {
    fn default() -> Self {
        Self { worst: 0, counts: [0; 66] }
    }
}

impl TErrors {
    /// How many were measured.
    #[must_use]
    pub fn measured(&self) -> u64 {
        self.counts.iter().sum()
    }

    /// The power of two (or 0) that the given share of them, from 0 to 1, does not exceed.
    #[must_use]
    pub fn quantile(&self, share: f64) -> u64 {
        let rank = share * self.measured() as f64;
        let mut below = 0;
        let reaches = |&count: &u64| {
            below += count;
            below as f64 >= rank
        };
        let bucket = self.counts.iter().position(reaches).unwrap_or(0);
        bucket_end(bucket)
    }

    /// Counts an error that lies in a bucket.
    pub(super) fn add(&mut self, bucket: usize, error: u64) {
        self.counts[bucket] += 1;
        self.worst = self.worst.max(error);
    }
}

/// The greatest error of a bucket: 0, 1, 2, 4, … 2^63, and all.
pub(super) fn bucket_end(bucket: usize) -> u64 {
    match bucket {
        0 => 0,
        1..=64 => 1 << (bucket - 1),
        _ => u64::MAX,
    }
}

/// Rays and how many of them were lost.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Loss {
    /// Rays cast.
    pub rays: u64,
    /// Rays that no triangle stopped.
    pub lost: u64,
}

/// How rays got out of closed meshes, by what they were aimed at.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Leaks {
    /// Points of edges.
    pub at_edges: Loss,
    /// Vertices.
    pub at_vertices: Loss,
    /// Anywhere.
    pub elsewhere: Loss,
}

impl Leaks {
    /// The number of rays lost.
    #[must_use]
    pub fn lost(&self) -> u64 {
        self.at_edges.lost + self.at_vertices.lost + self.elsewhere.lost
    }
}

/// How a kernel did in a [`super::Campaign`]; [`table`] prints several.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Report {
    /// The kernel's name.
    pub kernel: String,
    /// The vector type's name.
    pub vector: &'static str,
    /// Pairs of shapes asked about.
    pub cases: u64,
    /// Wrong misses of proper shapes.
    pub false_misses: u64,
    /// Wrong hits of proper shapes.
    pub false_hits: u64,
    /// Hits of improper ones.
    pub bad_input_hits: u64,
    /// Hits with a NaN.
    pub nans: u64,
    /// Right hits with a t that is not in the ray's range, or infinite.
    pub out_of_range: u64,
    /// Panics.
    pub panics: u64,
    /// The errors of t, of one right hit in four, where there is just one t that is right.
    pub t_errors: TErrors,
    /// Rays out of closed meshes.
    pub leaks: Leaks,
    /// The first case of each fault.
    pub examples: Vec<Case>,
}

impl Report {
    /// The report of a kernel that has not been asked anything yet.
    #[must_use]
    pub fn new(kernel: &str, vector: &'static str) -> Self {
        Self {
            kernel: kernel.to_owned(),
            vector,
            cases: 0,
            false_misses: 0,
            false_hits: 0,
            bad_input_hits: 0,
            nans: 0,
            out_of_range: 0,
            panics: 0,
            t_errors: TErrors::default(),
            leaks: Leaks::default(),
            examples: Vec::new(),
        }
    }

    /// Whether there is neither a wrong verdict nor a leak, a NaN or a panic: what the grade *exact* promises.
    #[must_use]
    pub fn is_exact(&self) -> bool {
        self.is_conservative() && self.false_hits == 0
    }

    /// Whether nothing that touches was missed, no ray was lost, and the kernel is [sound](Self::is_sound): what the grade
    /// *conservative* promises.
    #[must_use]
    pub fn is_conservative(&self) -> bool {
        self.false_misses == 0 && self.is_watertight()
    }

    /// Whether no ray was lost and the kernel is [sound](Self::is_sound): what the grade *watertight* promises.
    #[must_use]
    pub fn is_watertight(&self) -> bool {
        self.leaks.lost() == 0 && self.is_sound()
    }

    /// Whether no bad input was hit, no hit had a NaN or a t out of range, and nothing panicked: what this crate promises of
    /// every kernel. (Of no cases nothing is wrong.)
    #[must_use]
    pub fn is_sound(&self) -> bool {
        self.bad_input_hits + self.nans + self.out_of_range + self.panics == 0
    }

    /// The report of both campaigns, about the same kernel.
    #[must_use]
    pub fn merged(mut self, other: Self) -> Self {
        for (count, more) in [
            (&mut self.cases, other.cases),
            (&mut self.false_misses, other.false_misses),
            (&mut self.false_hits, other.false_hits),
            (&mut self.bad_input_hits, other.bad_input_hits),
            (&mut self.nans, other.nans),
            (&mut self.out_of_range, other.out_of_range),
            (&mut self.panics, other.panics),
        ] {
            *count += more;
        }
        for (loss, more) in [
            (&mut self.leaks.at_edges, other.leaks.at_edges),
            (&mut self.leaks.at_vertices, other.leaks.at_vertices),
            (&mut self.leaks.elsewhere, other.leaks.elsewhere),
        ] {
            loss.rays += more.rays;
            loss.lost += more.lost;
        }
        self.t_errors.worst = self.t_errors.worst.max(other.t_errors.worst);
        for (count, more) in self.t_errors.counts.iter_mut().zip(other.t_errors.counts) {
            *count += more;
        }
        for case in other.examples {
            self.remember(case.fault, || case);
        }
        self
    }

    /// Keeps a case, unless there is one of this fault already.
    pub(super) fn remember(&mut self, fault: Fault, case: impl FnOnce() -> Case) {
        if self.examples.iter().all(|known| known.fault != fault) {
            self.examples.push(case());
        }
    }

    fn row(&self) -> [String; COLUMNS.len()] {
        let or_dash = |exists: bool, text: String| if exists { text } else { "–".to_owned() };
        let verdicts = |count: u64| or_dash(self.cases > 0, count.to_string());
        let loss = |loss: Loss| or_dash(loss.rays > 0, loss.lost.to_string());
        let t = &self.t_errors;
        let ulps = |ulps: u64| or_dash(t.measured() > 0, approximate(ulps));
        [
            self.kernel.clone(),
            self.vector.to_owned(),
            verdicts(self.cases),
            verdicts(self.false_misses),
            verdicts(self.false_hits),
            verdicts(self.bad_input_hits),
            self.nans.to_string(),
            verdicts(self.out_of_range),
            self.panics.to_string(),
            ulps(t.quantile(0.5)),
            ulps(t.quantile(0.99)),
            ulps(t.worst),
            loss(self.leaks.at_edges),
            loss(self.leaks.at_vertices),
            loss(self.leaks.elsewhere),
        ]
    }
}

/// A number of ulps, as a power of ten where digits would tell nothing.
fn approximate(ulps: u64) -> String {
    if ulps < 100_000 { ulps.to_string() } else { format!("{:.0e}", ulps as f64) }
}

const COLUMNS: [&str; 15] = [
    "kernel",
    "vector",
    "cases",
    "false miss",
    "false hit",
    "bad input hit",
    "NaN",
    "t out of range",
    "panic",
    "ulps of t: 50 % ≤",
    "99 % ≤",
    "worst",
    "leaks: edges",
    "vertices",
    "elsewhere",
];

/// Markdown of several reports, a row for each.
#[must_use]
pub fn table(reports: &[Report]) -> String {
    let rows: Vec<_> = reports.iter().map(Report::row).collect();
    let width = |column: usize| {
        let cells = rows.iter().map(|row| row[column].chars().count());
        cells.chain([COLUMNS[column].chars().count()]).max().unwrap_or(0)
    };
    let widths: [usize; COLUMNS.len()] = std::array::from_fn(width);
    let is_text = |column: usize| column < 2;
    let line = |cells: [&str; COLUMNS.len()]| {
        let pad = |(column, cell): (usize, &str)| {
            let width = widths[column];
            if is_text(column) { format!("{cell:<width$}") } else { format!("{cell:>width$}") }
        };
        let cells: Vec<_> = cells.into_iter().enumerate().map(pad).collect();
        format!("| {} |\n", cells.join(" | "))
    };
    let rule = (0..COLUMNS.len()).map(|column| {
        let dashes = "-".repeat(widths[column] + 1);
        format!("|{dashes}{}", if is_text(column) { '-' } else { ':' })
    });
    let head = line(COLUMNS) + &rule.collect::<String>() + "|\n";
    rows.iter().fold(head, |table, row| table + &line(row.each_ref().map(String::as_str)))
}

/// A table of one row.
impl Display for Report {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str(table(std::slice::from_ref(self)).trim_end())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_has_a_row_for_each_report_and_dashes_for_what_was_not_asked() {
        let mut verdicts = Report::new("möller_trumbore", "Vec3");
        verdicts.cases = 1000;
        verdicts.false_misses = 7;
        verdicts.t_errors.add(0, 0);
        verdicts.t_errors.add(3, 3);
        let mut leaks = Report::new("b", "DVec3");
        leaks.leaks.at_edges = Loss { rays: 20, lost: 3 };
        let expected = "\
| kernel          | vector | cases | false miss | false hit | bad input hit | NaN | t out of range | panic | ulps of t: 50 % ≤ | 99 % ≤ | worst | leaks: edges | vertices | elsewhere |
|-----------------|--------|------:|-----------:|----------:|--------------:|----:|---------------:|------:|------------------:|-------:|------:|-------------:|---------:|----------:|
| möller_trumbore | Vec3   |  1000 |          7 |         0 |             0 |   0 |              0 |     0 |                 0 |      4 |     3 |            – |        – |         – |
| b               | DVec3  |     – |          – |         – |             – |   0 |              – |     0 |                 – |      – |     – |            3 |        – |         – |
";
        assert_eq!(table(&[verdicts.clone(), leaks.clone()]), expected);
        let lines: Vec<_> = expected.lines().take(3).collect();
        assert_eq!(verdicts.to_string(), lines.join("\n"));
        assert!(verdicts.is_watertight() && !verdicts.is_conservative() && !verdicts.is_exact());
        assert!(leaks.is_sound() && !leaks.is_watertight() && !leaks.is_exact());
    }

    #[test]
    fn quantiles_are_ends_of_buckets() {
        let mut errors = TErrors::default();
        assert_eq!((errors.measured(), errors.quantile(0.5)), (0, 0));
        for (bucket, error) in [(0, 0), (1, 1), (2, 2), (65, u64::MAX)] {
            errors.add(bucket, error);
        }
        let quantiles = [0.0, 0.25, 0.5, 0.75, 1.0].map(|share| errors.quantile(share));
        assert_eq!(quantiles, [0, 0, 1, 2, u64::MAX]);
        assert_eq!((errors.worst, errors.measured()), (u64::MAX, 4));
    }
}
