//! `cargo xtask test`: format, lints, tests, documentation, the book, instruction sets and counts, the
//! Python package.

use anyhow::{Result, anyhow};

use crate::{book, cargo, counts, python, step};

/// The random cases of the property tests are the same in every run, so that a commit passes or fails by itself;
/// `cargo test` takes new ones each time, and `PROPTEST_CASES=20000` many more.
const RANDOM_SEED: (&str, &str) = ("PROPTEST_RNG_SEED", "20261126");

/// Format, lints, and the tests of all crates but those that take minutes: the core's and the command line's.
pub fn quick() -> Result<()> {
    format_and_lints()?;
    step(
        "tests without those of the core and the command line",
        cargo()
            .args(["test", "--workspace", "--no-fail-fast", "--tests"])
            .args(["--exclude", "kinetostat", "--exclude", "kinetostat-cli"])
            .env(RANDOM_SEED.0, RANDOM_SEED.1),
    )
}

fn format_and_lints() -> Result<()> {
    step("format", cargo().args(["fmt", "--all", "--check"]))?;
    step(
        "lints",
        cargo().args([
            "clippy",
            "--workspace",
            "--all-targets",
            "--quiet",
            "--",
            "-D",
            "warnings",
        ]),
    )
}

/// Runs the checks of CI, which the README promises.
pub fn run() -> Result<()> {
    // pip waits for the network, and unpacks on one core.
    let python = std::thread::spawn(python::prepare);
    format_and_lints()?;
    step(
        "the core without its features",
        cargo().args([
            "check",
            "--quiet",
            "-p",
            "kinetostat",
            "--no-default-features",
        ]),
    )?;
    step(
        "documentation",
        cargo()
            .args(["doc", "--workspace", "--no-deps", "--quiet"])
            .env("RUSTDOCFLAGS", "-D warnings"),
    )?;
    // Examples are built by the lints.
    step(
        "tests",
        cargo()
            .args(["test", "--workspace", "--no-fail-fast", "--tests"])
            .env(RANDOM_SEED.0, RANDOM_SEED.1),
    )?;
    step(
        "examples in the documentation",
        cargo().args(["test", "--workspace", "--no-fail-fast", "--doc"]),
    )?;
    book::check()?;
    counts::instruction_sets()?;
    counts::check()?;
    let python = python.join().map_err(|_| anyhow!("pip was broken off"))??;
    python::check(python)?;
    eprintln!("== all passed");
    Ok(())
}
