//! Tasks of the project: `cargo xtask test`, `cargo xtask book`, `cargo xtask figures [--json]`.

mod bench;
mod book;
mod builds;
mod counts;
mod cutting;
mod figures;
mod fuzz;
mod long;
mod programs;
mod python;
mod test;
mod viewer;

use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};
use std::time::Instant;

use anyhow::{Context, Result, bail};

const HELP: &str = "\
Tasks of the project

  cargo xtask test              format, lints, tests, documentation, book, instruction counts,
                                the Python package: what CI runs
  cargo xtask test --quick      format, lints, tests of all crates but the core and the command line
  cargo xtask test --python     the Python package alone
  cargo xtask wheel             the Python package as it is handed out, in target/python/dist
  cargo xtask viewer            the page of `kinetostat view` from its sources; --check compares it with the
                                one in the repository, and tries it in Chromium; needs Node
  cargo xtask book              the book as pages in book/book; with --open it is shown
  cargo xtask figures           every number that the issues ask for, measured now
  cargo xtask figures --json    the same as a list of {name, measured, asked, unit, holds}
  cargo xtask figures --quick   without the ones that build from an empty registry cache
  cargo xtask figures --cutting those of cutting forces and of the stock alone
  cargo xtask figures --long    those of long programs alone: rates, memory, the table of points
  cargo xtask figures --programs those of programs of robots and machines alone
  cargo xtask figures --python  those of the Python package alone
  cargo xtask figures --builds  those of builds and tests from a clean clone alone: about half an hour
  cargo xtask fuzz [--minutes M] [--seed N]   random chains through every question; --case N
                                repeats one
  cargo xtask long [--blocks N] [--kills K]   programs of millions of blocks: memory, growth, kills
  cargo xtask bench-vs-numpy    speed beside vectorised numpy, in one process; needs python3
  cargo xtask bench-vs-numpy --json   the same as a list of {work, kinetostat_us, numpy_us, ratio,
                                max_relative_difference}
  cargo xtask counts            instructions of every benchmark case beside their baseline; needs valgrind
  cargo xtask counts --renew    takes what is counted now as the baseline";

fn main() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    let done = match words.as_slice() {
        ["test"] => test::run(),
        ["test", "--quick"] => test::quick(),
        ["test", "--python"] => python::prepare().and_then(python::check),
        ["viewer", options @ ..] => viewer::run(options),
        ["book", options @ ..] => book::run(options),
        ["figures", options @ ..] => figures::run(options),
        ["fuzz", options @ ..] => fuzz::run(options),
        ["long", options @ ..] => long::run(options),
        ["wheel", options @ ..] => python::wheel(options),
        ["counts", options @ ..] => counts::run(options),
        ["bench-vs-numpy", options @ ..] => bench::versus_numpy(options),
        _ => {
            eprintln!("{HELP}");
            return ExitCode::FAILURE;
        }
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("xtask: {error:#}");
            ExitCode::FAILURE
        }
    }
}

/// Root of the workspace.
fn root() -> PathBuf {
    let own = Path::new(env!("CARGO_MANIFEST_DIR"));
    own.parent().unwrap_or(own).to_path_buf()
}

/// Runs a command at the root; its output is shown, failure is an error.
fn step(title: &str, command: &mut Command) -> Result<()> {
    eprintln!("== {title}");
    let start = Instant::now();
    let status = command
        .current_dir(root())
        .status()
        .with_context(|| format!("{title}: cannot start {command:?}"))?;
    if !status.success() {
        bail!("{title} failed ({status})");
    }
    eprintln!("== {title}: {:.0} s", start.elapsed().as_secs_f64());
    Ok(())
}

/// The cargo that runs this task.
fn cargo() -> Command {
    Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()))
}
