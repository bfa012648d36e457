//! A criterion group over some kernels.

use std::hint::black_box;
use std::time::Duration;

use criterion::measurement::WallTime;
use criterion::{BenchmarkGroup, Criterion, Throughput};

use crate::data::{PAIRS, Pairs};

/// The kernels that answer one question, at one hit rate.
pub(crate) struct Kernels<'a>(BenchmarkGroup<'a, WallTime>);

impl<'a> Kernels<'a> {
    /// An empty group.
    pub(crate) fn new(criterion: &'a mut Criterion, name: &str) -> Self {
        let mut group = criterion.benchmark_group(name);
        group
            .throughput(Throughput::Elements(PAIRS as u64))
            .sample_size(50)
            .warm_up_time(Duration::from_millis(500))
            .measurement_time(Duration::from_secs(2));
        Self(group)
    }

    /// Times a kernel on all pairs. Each query is behind a `black_box`, input and answer, so that it
    /// is neither hoisted out of the loop nor vectorised across it.
    pub(crate) fn time<A, B, T>(
        &mut self,
        name: &str,
        pairs: &Pairs<A, B>,
        query: impl Fn(&A, &B) -> T,
    ) -> &mut Self {
        self.0.bench_function(name, |bencher| {
            bencher.iter(|| {
                pairs.for_each(|a, b| {
                    black_box(query(black_box(a), black_box(b)));
                });
            });
        });
        self
    }
}
