//! Every benchmark case on one thread: many postures in one call, and one in each call.
//!
//! ```sh
//! cargo bench -p kinetostat-bench --bench batch
//! ```

#![allow(missing_docs, reason = "criterion's macro makes a function")]

use std::hint::black_box;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use kinetostat_bench::Results;
use kinetostat_bench::machines::{CASES, benchmark_case};

/// What one thread takes at a time: no other one helps.
const POSTURES: usize = 256;

fn batch(c: &mut Criterion) {
    for name in CASES {
        let count = if name == "W5" { 8 } else { POSTURES };
        let task = benchmark_case(name, count).expect("a benchmark case");
        let mut group = c.benchmark_group(name);
        group.throughput(Throughput::Elements(count as u64));
        for (label, block) in [("together", count), ("one by one", 1)] {
            group.bench_function(label, |b| {
                let mut results = Results::default();
                b.iter(|| black_box(&task).run(block, &mut results).expect("answers"));
            });
        }
        group.finish();
    }
}

criterion_group!(benches, batch);
criterion_main!(benches);
