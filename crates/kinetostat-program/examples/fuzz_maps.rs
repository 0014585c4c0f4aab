//! Random programs under ridged tables of corrections for a stated time: `cargo xtask fuzz`.
//!
//! `fuzz_maps MINUTES SEED`, or `fuzz_maps case SEED` to repeat one case.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::print_stdout,
    dead_code,
    reason = "a tool for developers; modules are shared with the tests"
)]

#[path = "../tests/program/sampled/mod.rs"]
mod sampled;

use kinetostat_testing::Worst;
use std::process::ExitCode;
use std::time::{Duration, Instant};

fn main() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).collect();
    if let [first, seed] = words.as_slice()
        && first == "case"
    {
        println!(
            "{:?}",
            sampled::check(seed.parse().unwrap(), kinetostat_program::Arcs::Fit)
        );
        return ExitCode::SUCCESS;
    }
    let minutes: f64 = words.first().and_then(|w| w.parse().ok()).unwrap_or(1.0);
    let first: u64 = words.get(1).and_then(|w| w.parse().ok()).unwrap_or(1);
    let end = Instant::now() + Duration::from_secs_f64(60.0 * minutes);
    let (mut cases, mut places, mut faults, mut worst) = (0_u64, 0, 0, Worst::new());
    while Instant::now() < end {
        let arcs = match cases % 2 {
            0 => kinetostat_program::Arcs::Fit,
            _ => kinetostat_program::Arcs::Lines,
        };
        match sampled::check(first.wrapping_mul(1_000_003).wrapping_add(cases), arcs) {
            Ok(found) => {
                places += found.places;
                worst.add(found.worst.of_all(found.places));
            }
            Err(what) => {
                faults += 1;
                println!("FAULT {what}");
            }
        }
        cases += 1;
    }
    println!(
        "{cases} programs under tables, {places} places, worst {:.3} of what is allowed, {faults} faults",
        worst.measured().unwrap_or(0.0)
    );
    match faults {
        0 => ExitCode::SUCCESS,
        _ => ExitCode::FAILURE,
    }
}
