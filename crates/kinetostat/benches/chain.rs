//! Stiffness and equilibrium of chains of 10 to 3000 spring coordinates.
//!
//! ```sh
//! cargo bench -p kinetostat
//! ```

#![allow(missing_docs, reason = "criterion's macro makes a function")]

use std::hint::black_box;

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use kinetostat::{Pose, Settings, solve_chain, unloaded_stiffness};

mod long;

/// Numbers of coordinates; a cantilever has the next multiple of six.
const SIZES: [usize; 6] = [10, 30, 100, 300, 1000, 3000];

fn chains(c: &mut Criterion) {
    let settings = Settings::default();
    for (name, build) in [
        (
            "cantilever",
            long::cantilever as fn(usize) -> kinetostat::Chain,
        ),
        ("arm", long::arm),
    ] {
        let mut group = c.benchmark_group(name);
        group.sample_size(20);
        for size in SIZES {
            let chain = build(size);
            let count = chain.coordinate_count();
            group.throughput(Throughput::Elements(count as u64));
            let x = chain.home_coordinates();
            group.bench_function(BenchmarkId::new("stiffness", count), |b| {
                b.iter(|| unloaded_stiffness(black_box(&chain), &Pose::identity(), &x, &[]));
            });
            let bent = long::soft_cantilever(count);
            for (label, chain, asked) in [
                ("equilibrium under a force", &chain, long::Asked::Force),
                ("equilibrium of a held end", &chain, long::Asked::Pose),
                ("equilibrium bent far", &bent, long::Asked::BentFar),
            ] {
                if asked == long::Asked::BentFar && name != "cantilever" {
                    continue;
                }
                let problem = long::problem(chain, asked);
                group.bench_function(BenchmarkId::new(label, count), |b| {
                    b.iter(|| solve_chain(black_box(&problem), &settings));
                });
            }
        }
        group.finish();
    }
}

criterion_group!(benches, chains);
criterion_main!(benches);
