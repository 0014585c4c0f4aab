//! Errors of manufacture in pairs for a stated time: `cargo xtask fuzz`.
//!
//! `fuzz_errors MINUTES SEED`, or `fuzz_errors case SEED` to repeat one case.

#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a tool for developers; the module is shared with the tests"
)]

#[path = "../tests/model/error_pairs.rs"]
mod error_pairs;

use kinetostat_testing::Worst;
use std::process::ExitCode;
use std::time::{Duration, Instant};

fn main() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).collect();
    if let [first, seed] = words.as_slice()
        && first == "case"
    {
        println!("{:?}", error_pairs::check(seed.parse().unwrap()));
        return ExitCode::SUCCESS;
    }
    let minutes: f64 = words.first().and_then(|w| w.parse().ok()).unwrap_or(1.0);
    let first: u64 = words.get(1).and_then(|w| w.parse().ok()).unwrap_or(1);
    let end = Instant::now() + Duration::from_secs_f64(60.0 * minutes);
    let (mut cases, mut faults, mut worst) = (0_u64, 0, Worst::new());
    while Instant::now() < end {
        match error_pairs::check(first.wrapping_mul(1_000_003).wrapping_add(cases)) {
            Ok(off) => worst.add(off),
            Err(what) => {
                faults += 1;
                println!("FAULT {what}");
            }
        }
        cases += 1;
    }
    println!(
        "{cases} pairs of errors, worst {:.3} of what is allowed, {faults} faults",
        worst.measured().unwrap_or(0.0)
    );
    match faults {
        0 => ExitCode::SUCCESS,
        _ => ExitCode::FAILURE,
    }
}
