//! Random RAPID programs, whole and broken, for a stated time: `cargo xtask fuzz`.
//!
//! `fuzz_rapid MINUTES SEED`, or `fuzz_rapid case SEED` to repeat one case.

#![allow(
    clippy::print_stdout,
    reason = "a tool for developers; a module is shared with the tests"
)]

#[path = "../tests/formats/chance.rs"]
mod chance;
mod fuzzing;
#[path = "../tests/formats/harness.rs"]
mod harness;
#[path = "../tests/formats/rapid/random.rs"]
mod random;

use std::process::ExitCode;

fn main() -> ExitCode {
    fuzzing::run("RAPID programs", random::check)
}
