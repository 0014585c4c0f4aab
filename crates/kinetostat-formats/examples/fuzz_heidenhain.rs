//! Random Heidenhain programs, whole and broken, for a stated time: `cargo xtask fuzz`.
//!
//! `fuzz_heidenhain MINUTES SEED`, or `fuzz_heidenhain case SEED` to repeat one case.

#![allow(
    clippy::print_stdout,
    reason = "a tool for developers; a module is shared with the tests"
)]

#[path = "../tests/formats/harness.rs"]
mod harness;
#[path = "../tests/formats/heidenhain/random.rs"]
mod random;

use std::process::ExitCode;
use std::time::{Duration, Instant};

fn main() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let number = |index: usize| words.get(index).and_then(|word| word.parse::<f64>().ok());
    if words.first().is_some_and(|word| word == "case") {
        let seed = words.get(1).and_then(|word| word.parse().ok());
        println!("{:?}", random::check(seed.unwrap_or(1)));
        return ExitCode::SUCCESS;
    }
    let end = Instant::now() + Duration::from_secs_f64(60.0 * number(0).unwrap_or(1.0));
    let first = number(1).unwrap_or(1.0) as u64;
    let (mut cases, mut read, mut failed) = (0_u64, 0, 0);
    while Instant::now() < end {
        match random::check(first.wrapping_mul(1_000_003).wrapping_add(cases)) {
            Ok(taken) => read += usize::from(taken),
            Err(what) => {
                failed += 1;
                println!("FAULT {what}");
            }
        }
        cases += 1;
    }
    println!("{cases} Heidenhain programs, {read} read, {failed} faults");
    match failed {
        0 => ExitCode::SUCCESS,
        _ => ExitCode::FAILURE,
    }
}
