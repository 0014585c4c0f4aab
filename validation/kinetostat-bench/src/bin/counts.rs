//! Cases whose instructions `cargo xtask counts` counts by valgrind and compares with `benches/counts.json`: without
//! an argument it prints the names of the cases, with a name it runs that one.
//!
//! Valgrind knows no AVX-512, so that the kernels' AVX2 is counted, on every processor that has it.

use std::hint::black_box;
use std::process::ExitCode;

use kinetostat::{Posture, Wrench};
use kinetostat_bench::machines::{benchmark_case, path};
use kinetostat_bench::{Results, Task, sample};
use nalgebra::Vector6;

/// Cases by their names in `counts.json` and in the benches, with a number of postures for one call and
/// for one by one: so few that no other thread is called.
const CASES: [(&str, &str, usize, usize); 6] = [
    ("w1", "W1", 64, 16),
    ("w2", "W2", 64, 16),
    ("w3", "W3", 64, 16),
    ("w3_k", "W3+K", 64, 16),
    ("w4", "W4", 64, 16),
    ("w5", "W5", 8, 2),
];

/// Machines for the general engine, at home, with the sizes of a force and of a moment.
const STIFFNESS: [(&str, f64, f64); 2] = [("arm", 0.0, 0.0), ("hexapod", 0.0, 0.0)];
const EQUILIBRIUM: [(&str, f64, f64); 2] = [("arm", 2000.0, 300.0), ("puu3", 300.0, 10.0)];

fn main() -> ExitCode {
    let Some(name) = std::env::args().nth(1) else {
        names();
        return ExitCode::SUCCESS;
    };
    if counted(&name).is_none() {
        eprintln!("'{name}' is no benchmark case");
        return ExitCode::FAILURE;
    }
    ExitCode::SUCCESS
}

#[allow(clippy::print_stdout)] // this is the output that was requested
fn names() {
    for (name, ..) in CASES {
        println!("together {name}");
        println!("one_by_one {name}");
    }
    for (file, ..) in STIFFNESS {
        println!("general_stiffness {file}");
    }
    for (file, ..) in EQUILIBRIUM {
        println!("general_equilibrium {file}");
    }
}

/// Function whose instructions valgrind counts, between its call and its return.
#[inline(never)]
fn kinetostat_counted(work: &mut dyn FnMut()) {
    work();
}

fn counted(name: &str) -> Option<()> {
    let (kind, of) = name.split_once(' ')?;
    match kind {
        "together" | "one_by_one" => {
            let (_, case, all, few) = CASES.into_iter().find(|c| c.0 == of)?;
            let (count, block) = if kind == "together" {
                (all, 64)
            } else {
                (few, 1)
            };
            let (task, mut results) = ready(case, count);
            kinetostat_counted(&mut || black_box(&task).run(block, &mut results).expect("answers"));
            black_box(&results);
        }
        "general_stiffness" => {
            let (file, force, moment) = STIFFNESS.into_iter().find(|m| m.0 == of)?;
            let (posture, _) = at_home(file, force, moment);
            let mut found = None;
            kinetostat_counted(&mut || {
                found = Some(black_box(&posture).stiffness().expect("a stiffness"));
            });
            black_box(&found);
        }
        "general_equilibrium" => {
            let (file, force, moment) = EQUILIBRIUM.into_iter().find(|m| m.0 == of)?;
            let (posture, wrench) = at_home(file, force, moment);
            let mut found = None;
            kinetostat_counted(&mut || {
                let posture = black_box(&posture);
                found = Some(posture.deflected_by(&wrench).expect("an equilibrium"));
            });
            black_box(&found);
        }
        _ => return None,
    }
    Some(())
}

/// Run once before: the choice of the instruction set is not counted, and the results have their memory.
fn ready(name: &str, count: usize) -> (Task, Results) {
    let task = benchmark_case(name, count).expect("a benchmark case");
    let mut results = Results::default();
    task.run(count, &mut results).expect("answers");
    (task, results)
}

/// A machine at home for the general engine, and a load.
fn at_home(file: &str, force: f64, moment: f64) -> (Posture, Wrench) {
    let model = kinetostat_model::read_model(&path(file)).expect("a model");
    let mechanism = model.mechanism;
    let home = mechanism.platforms()[mechanism.tool()].home;
    let wrench = sample::wrenches(0..1, force, moment);
    (
        mechanism.posture(&home).expect("a posture"),
        Wrench(Vector6::from_column_slice(&wrench)),
    )
}
