//! Instructions that every work takes, counted by valgrind. `cargo xtask counts` runs this and compares
//! with `benches/counts.json`.
//!
//! Valgrind knows no AVX-512, so that the kernels' AVX2 is counted, on every processor that has it.

#![allow(missing_docs, reason = "gungraun's macros make functions")]

use std::hint::black_box;

use gungraun::Callgrind;
use gungraun::prelude::*;
use kinetostat::{MechanismEquilibrium, Posture, UnloadedStiffness, Wrench};
use kinetostat_bench::machines::{path, work};
use kinetostat_bench::{Results, Task, sample};
use nalgebra::Vector6;

/// Run once before: the choice of the instruction set is not counted, and the results have their memory.
fn ready(name: &str, count: usize) -> (Task, Results) {
    let task = work(name, count).expect("a work");
    let mut results = Results::default();
    task.run(count, &mut results).expect("answers");
    (task, results)
}

// So few postures that no other thread is called.
#[library_benchmark(setup = ready)]
#[bench::w1("W1", 64)]
#[bench::w2("W2", 64)]
#[bench::w3("W3", 64)]
#[bench::w3_k("W3+K", 64)]
#[bench::w4("W4", 64)]
#[bench::w5("W5", 8)]
fn together((task, mut results): (Task, Results)) -> (Task, Results) {
    black_box(&task).run(64, &mut results).expect("answers");
    (task, results)
}

#[library_benchmark(setup = ready)]
#[bench::w1("W1", 16)]
#[bench::w2("W2", 16)]
#[bench::w3("W3", 16)]
#[bench::w3_k("W3+K", 16)]
#[bench::w4("W4", 16)]
#[bench::w5("W5", 2)]
fn one_by_one((task, mut results): (Task, Results)) -> (Task, Results) {
    black_box(&task).run(1, &mut results).expect("answers");
    (task, results)
}

/// A machine at home for the general engine, and a load.
fn at_home(file: &str, force: f64, moment: f64) -> (Posture<'static>, Wrench) {
    let model = kinetostat_model::read_model(&path(file)).expect("a model");
    // It lives as long as the program.
    let mechanism = &Box::leak(Box::new(model)).mechanism;
    let home = mechanism.platforms()[mechanism.tool()].home;
    let wrench = sample::wrenches(0..1, force, moment);
    (
        mechanism.posture(&home).expect("a posture"),
        Wrench(Vector6::from_column_slice(&wrench)),
    )
}

#[library_benchmark(setup = at_home)]
#[bench::arm("arm", 0.0, 0.0)]
#[bench::hexapod("hexapod", 0.0, 0.0)]
fn general_stiffness(at: (Posture<'static>, Wrench)) -> UnloadedStiffness {
    black_box(&at.0).stiffness().expect("a stiffness")
}

#[library_benchmark(setup = at_home)]
#[bench::arm("arm", 2000.0, 300.0)]
#[bench::puu3("puu3", 300.0, 10.0)]
fn general_equilibrium(at: (Posture<'static>, Wrench)) -> MechanismEquilibrium {
    black_box(&at.0)
        .deflected_by(&at.1)
        .expect("an equilibrium")
}

library_benchmark_group!(
    name = counts,
    benchmarks = [together, one_by_one, general_stiffness, general_equilibrium]
);

main!(
    config = LibraryBenchmarkConfig::default()
        // A string instruction counts as many as it has bytes: vectors instead, on every processor.
        .env(
            "GLIBC_TUNABLES",
            "glibc.cpu.x86_rep_stosb_threshold=1000000000:glibc.cpu.x86_rep_movsb_threshold=1000000000"
        )
        .tool(Callgrind::with_args(["--cache-sim=no"]));
    library_benchmark_groups = counts
);
