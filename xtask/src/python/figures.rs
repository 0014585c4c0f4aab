//! Figures of the Python package: its wheel, its import, what a call costs beside Rust, a large map, and many machines.

use std::path::PathBuf;
use std::process::Command;

use anyhow::{Context, Result, bail};

use super::environment::{Environment, folder};
use super::interpreter::ends;
use super::wheel;
use crate::figures::{Figure, tables, take_printed};
use crate::{cargo, root, step};

/// Measures them; says why where Python or the package index is missing.
///
/// # Errors
/// A build or a script that fails.
pub fn measured(figures: &mut Vec<Figure>) -> Result<()> {
    let Some((oldest, newest)) = ends() else {
        return left_out("there is no CPython from 3.10 with pip and venv");
    };
    let Some(tools) = Environment::with_test_tools(&oldest)? else {
        return left_out("the package index cannot be reached");
    };
    let file = wheel::built(&tools, "wheel", &folder().join("dist"))?;
    let size = wheel::megabytes(&file)?;
    figures.push(Figure::at_most(
        "Python: size of the wheel",
        size,
        wheel::LARGEST_MB,
        "MB",
    ));
    let Some(alone) = Environment::bare(newest.as_ref().unwrap_or(&oldest))? else {
        return left_out("pip could not install numpy");
    };
    let alone = alone.holding(&file)?;
    // Both calls use the machine code of the wheel's own package: another build alone changes a call of 180 us by a few
    // microseconds.
    step(
        "the same calls in Rust",
        cargo().args([
            "build",
            "--profile",
            "wheel",
            "--quiet",
            "-p",
            "kinetostat-python",
            "--example",
            "python_calls",
        ]),
    )?;
    let program = folder()
        .with_file_name("wheel")
        .join("examples/python_calls");
    script(figures, alone.python(), "overhead.py", &[program])?;
    let tools = tools.holding(&file)?;
    script(figures, tools.python(), "maps.py", &[])?;
    script(figures, tools.python(), "interrupted.py", &[])?;
    let machines = ["--example", "machines_per_second", "--", "20000", "100"];
    tables(figures, &[&["kinetostat-analysis"][..], &machines].concat())
}

/// A script of `benches/python` that prints figures, and what else it says on stderr.
fn script(
    figures: &mut Vec<Figure>,
    mut python: Command,
    name: &str,
    words: &[PathBuf],
) -> Result<()> {
    let output = python
        .arg(root().join("benches/python").join(name))
        .args(words)
        .output()
        .context("cannot start Python")?;
    let text = String::from_utf8_lossy(&output.stdout);
    if !output.status.success() {
        bail!(
            "benches/python/{name} failed: {}",
            String::from_utf8_lossy(&output.stderr)
        );
    }
    take_printed(figures, &text)
}

fn left_out(why: &str) -> Result<()> {
    eprintln!("skipped: {why}, so the Python package is not measured");
    Ok(())
}
