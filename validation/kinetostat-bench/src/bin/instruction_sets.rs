//! Every instruction set gives the same bits, in an optimised build: it has kernels that the build for
//! tests does not have.
//! `cargo xtask test` runs it.

use std::process::ExitCode;

use anyhow::{Result, ensure};
use kinetostat::internal::InstructionSet;
use kinetostat_bench::machines::benchmark_case;
use kinetostat_bench::{Answers, Task};

/// Cases of the benches, as many postures of each as leave the last register of eight half full.
const CASES: [&str; 6] = ["W1", "W2", "W3", "W3+K", "W4", "W5"];
const POSTURES: usize = 13;

fn main() -> ExitCode {
    match compare() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("instruction sets: {error:#}");
            ExitCode::FAILURE
        }
    }
}

fn compare() -> Result<()> {
    let sets = InstructionSet::available();
    ensure!(
        sets.contains(&InstructionSet::Widest),
        "this build has no wide kernels: it is not optimised"
    );
    for name in CASES {
        let task = benchmark_case(name, POSTURES)?;
        let one_by_one = bits(&task, InstructionSet::Single, 1)?;
        ensure!(!one_by_one.is_empty(), "{name}: no numbers");
        for &set in &sets {
            for block in [1, POSTURES] {
                ensure!(
                    bits(&task, set, block)? == one_by_one,
                    "{name}: {set:?} gives other bits in blocks of {block}"
                );
            }
        }
    }
    eprintln!("{sets:?}: the same bits, {}", CASES.join(", "));
    Ok(())
}

/// Bits of all numbers of all postures.
fn bits(task: &Task, set: InstructionSet, block: usize) -> Result<Vec<u64>> {
    let Answers {
        tool,
        coordinates,
        stiffness,
        jacobian,
        vectorised,
        ..
    } = set.during(|| task.answers(block))?;
    ensure!(
        vectorised == POSTURES,
        "the kernels left over {} postures",
        POSTURES - vectorised
    );
    let all = [tool, coordinates, stiffness, jacobian].concat();
    Ok(all.into_iter().map(f64::to_bits).collect())
}
