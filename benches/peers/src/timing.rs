//! Contenders, and the race between them.

use std::hint::black_box;
use std::time::Instant;

use crate::data::{PAIRS, Pairs};

/// What a table is about, and who takes part.
pub struct Question {
    /// The heading.
    pub title: String,
    /// What is compared, in a sentence or two.
    pub note: &'static str,
    /// One of them is the reference.
    pub contenders: Vec<Contender>,
    /// How many of the queries each stage of the exact kernel decides: floats, `f64`, integers.
    pub stages: [usize; 3],
}

/// Counts the queries by the stage that decides them.
pub fn stages<A, B>(pairs: &Pairs<A, B>, stage: impl Fn(&A, &B) -> usize) -> [usize; 3] {
    let mut counts = [0; 3];
    pairs.for_each(|a, b| counts[stage(a, b)] += 1);
    counts
}

/// A kernel with its queries.
pub struct Contender {
    /// Library, function, type.
    pub name: &'static str,
    /// Whether the others are compared with this one.
    pub is_reference: bool,
    /// Asks all queries, and counts the hits.
    pass: Box<dyn Fn() -> usize>,
}

impl Contender {
    /// A contender that asks `query` about all `pairs`.
    ///
    /// Each query is behind a `black_box`, which takes its input by reference and its whole answer:
    /// nothing is hoisted out of the loop, vectorised across it, or left out of the answer.
    pub fn new<A: 'static, B: 'static, T>(
        name: &'static str,
        pairs: Pairs<A, B>,
        query: impl Fn(&A, &B) -> T + 'static,
        is_hit: impl Fn(&T) -> bool + 'static,
    ) -> Self {
        let pass = move || {
            let mut hits = 0;
            pairs.for_each(|a, b| {
                let answer = black_box(query(black_box(a), black_box(b)));
                hits += usize::from(is_hit(&answer));
            });
            hits
        };
        Self { name, is_reference: false, pass: Box::new(pass) }
    }

    /// A contender with a loop of its own over as many queries, [`ask_packs`] in most cases, which counts the hits.
    pub fn with_pass(name: &'static str, pass: impl Fn() -> usize + 'static) -> Self {
        Self { name, is_reference: false, pass: Box::new(pass) }
    }

    /// The same contender, as the one with which the others are compared.
    pub fn reference(mut self) -> Self {
        self.is_reference = true;
        self
    }
}

/// Asks `query` about all packs in each round, and writes the answers down as a caller would: to be called where the processor's level
/// is known. As in a traversal the ray is a local variable for all of its packs.
#[inline(always)]
pub fn ask_packs<A: Copy, P, T: Copy>(
    packs: &[(A, Vec<P>)],
    rounds: usize,
    query: impl Fn(&A, &P) -> T,
    hits: impl Fn(&T) -> u32,
) -> usize {
    let Some((a, [pack, ..])) = packs.first().map(|(a, packs)| (a, packs.as_slice())) else {
        return 0;
    };
    let mut answers = vec![query(a, pack); packs[0].1.len()];
    let mut count = 0;
    for (a, packs) in (0..rounds).flat_map(|_| packs) {
        let a = *black_box(a);
        for (pack, answer) in black_box(packs).iter().zip(&mut answers) {
            *answer = query(&a, pack);
        }
        count += black_box(&answers).iter().map(&hits).sum::<u32>() as usize;
    }
    count
}

/// Nanoseconds of a clock cycle, if a multiplication of 64-bit integers takes three, as it does on the x86-64 processors
/// since 2008: the best of many short chains.
fn cycle() -> f64 {
    const LENGTH: u32 = 10_000;
    let chain = || {
        let start = Instant::now();
        let mut x = black_box(3_u64);
        for _ in 0..LENGTH {
            x = x.wrapping_mul(x);
        }
        black_box(x);
        start.elapsed().as_secs_f64() * 1e9 / f64::from(3 * LENGTH)
    };
    (0..20).map(|_| chain()).fold(f64::INFINITY, f64::min)
}

/// How a contender did.
pub struct Outcome {
    /// How many queries it answered with a hit.
    pub hits: usize,
    /// Nanoseconds per query in each round.
    pub times: Vec<f64>,
    /// Its time over the reference's in each round.
    pub ratios: Vec<f64>,
    /// Clock cycles per query in its best round.
    pub cycles: f64,
}

/// Lets the contenders run in turns; the outcomes are in their order.
pub fn race(contenders: &[Contender], rounds: usize) -> Vec<Outcome> {
    let mut random = fastrand::Rng::with_seed(2);
    let mut order: Vec<usize> = (0..contenders.len()).collect();
    // The first pass warms up, and is not timed.
    let hits: Vec<usize> = contenders.iter().map(|c| (c.pass)()).collect();
    let mut times = vec![Vec::with_capacity(rounds); contenders.len()];
    let mut shortest_cycle = f64::INFINITY;
    for _ in 0..rounds {
        shortest_cycle = shortest_cycle.min(cycle());
        random.shuffle(&mut order);
        for &i in &order {
            let start = Instant::now();
            black_box((contenders[i].pass)());
            times[i].push(start.elapsed().as_secs_f64() * 1e9 / PAIRS as f64);
        }
    }
    let reference =
        contenders.iter().position(|c| c.is_reference).map_or_else(Vec::new, |i| times[i].clone());
    hits.into_iter()
        .zip(times)
        .map(|(hits, times)| Outcome {
            hits,
            ratios: times.iter().zip(&reference).map(|(a, b)| a / b).collect(),
            cycles: times.iter().copied().fold(f64::INFINITY, f64::min) / shortest_cycle,
            times,
        })
        .collect()
}
