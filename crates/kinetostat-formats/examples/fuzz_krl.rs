//! Random KRL programs, whole and broken, for a stated time: `cargo xtask fuzz`.
//!
//! `fuzz_krl MINUTES SEED`, or `fuzz_krl case SEED` to repeat one case.

#![allow(
    clippy::print_stdout,
    reason = "a tool for developers; a module is shared with the tests"
)]

#[path = "../tests/formats/chance.rs"]
mod chance;
mod fuzzing;
#[path = "../tests/formats/harness.rs"]
mod harness;
#[path = "../tests/formats/krl/random.rs"]
mod random;

use std::process::ExitCode;

fn main() -> ExitCode {
    fuzzing::run("KRL programs", random::check)
}
