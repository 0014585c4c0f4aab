//! Random APT files, whole and broken, for a stated time: `cargo xtask fuzz`.
//!
//! `fuzz_apt MINUTES SEED`, or `fuzz_apt case SEED` to repeat one case.

#![allow(
    clippy::print_stdout,
    reason = "a tool for developers; a module is shared with the tests"
)]

#[path = "../tests/formats/chance.rs"]
mod chance;
mod fuzzing;
#[path = "../tests/formats/harness.rs"]
mod harness;
#[path = "../tests/formats/apt/random.rs"]
mod random;

use std::process::ExitCode;

fn main() -> ExitCode {
    fuzzing::run("APT files", random::check)
}
