//! Contenders, and the race between them.

use std::hint::black_box;
use std::mem;
use std::time::{Duration, Instant};

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
    pass: Pass,
}

/// Asks all queries in a new order, and says how many are hits and how long the asking took: of an order that comes again and
/// again the processor learns every branch, which flatters kernels that branch.
type Pass = Box<dyn FnMut(&mut fastrand::Rng) -> (usize, Duration)>;

fn timed(ask: impl FnOnce() -> usize) -> (usize, Duration) {
    let start = Instant::now();
    let hits = black_box(ask());
    (hits, start.elapsed())
}

/// Packs for each of the rays, or whatever asks.
pub type Packs<A, P> = Vec<(A, Vec<P>)>;

impl Contender {
    /// A contender that asks `query` about all `pairs`.
    ///
    /// Each query is behind a `black_box`, which takes its input by reference and its whole answer:
    /// nothing is hoisted out of the loop, vectorised across it, or left out of the answer.
    pub fn new<A: 'static, B: 'static, T>(
        name: &'static str,
        mut pairs: Pairs<A, B>,
        query: impl Fn(&A, &B) -> T + 'static,
        is_hit: impl Fn(&T) -> bool + 'static,
    ) -> Self {
        let pass = move |random: &mut fastrand::Rng| {
            pairs.shuffle(random);
            timed(|| {
                let mut hits = 0;
                pairs.for_each(|a, b| {
                    let answer = black_box(query(black_box(a), black_box(b)));
                    hits += usize::from(is_hit(&answer));
                });
                hits
            })
        };
        Self { name, is_reference: false, pass: Box::new(pass) }
    }

    /// A contender with a loop of its own over as many queries, [`ask_packs`] in most cases, which counts the hits.
    pub fn of_packs<A: 'static, P: 'static>(
        name: &'static str,
        mut packs: Packs<A, P>,
        ask: impl Fn(&[(A, Vec<P>)]) -> usize + 'static,
    ) -> Self {
        let pass = move |random: &mut fastrand::Rng| {
            // The contents change places, and the memory that they lie in is gone through in order, as for pairs.
            for i in (1..packs.len()).rev() {
                if let (rest, [last, ..]) = packs.split_at_mut(i)
                    && let Some(other) = rest.get_mut(random.usize(..=i))
                {
                    mem::swap(&mut last.0, &mut other.0);
                    last.1.swap_with_slice(&mut other.1);
                }
            }
            for (_, some) in &mut packs {
                random.shuffle(some);
            }
            timed(|| ask(&packs))
        };
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
pub fn race(contenders: &mut [Contender], rounds: usize) -> Vec<Outcome> {
    let mut random = fastrand::Rng::with_seed(2);
    let mut order: Vec<usize> = (0..contenders.len()).collect();
    // The first pass warms up, and is not timed.
    let hits: Vec<usize> = contenders.iter_mut().map(|c| (c.pass)(&mut random).0).collect();
    let mut times = vec![Vec::with_capacity(rounds); contenders.len()];
    let mut shortest_cycle = f64::INFINITY;
    for _ in 0..rounds {
        shortest_cycle = shortest_cycle.min(cycle());
        random.shuffle(&mut order);
        for &i in &order {
            let (_, time) = (contenders[i].pass)(&mut random);
            times[i].push(time.as_secs_f64() * 1e9 / PAIRS as f64);
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
