//! `cargo xtask figures --builds`: what it costs to build the project and to run its tests, from a clean
//! clone. Minutes of work on two cores, so that they are measured only when they are requested.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Instant;

use anyhow::{Context, Result, ensure};

use crate::figures::{Figure, Scratch};
use crate::{cargo, root};

/// Largest time of the first command, s. It stood at 190 s before builds were measured.
const DEMO: f64 = 120.0;
/// Largest size of the program that is installed, MB.
const PROGRAM: f64 = 10.0;
/// Largest time of a build after a change in the command line, s.
const WARM: f64 = 15.0;
/// Largest processor time of the build of the core's tests with all that they need, s: half of what it took before.
const CORE_TESTS: f64 = CORE_TESTS_BEFORE / 2.0;
/// At commit fe6179b with rustc 1.95 on two cores that others used too: user and system time of
/// `cargo test -p kinetostat --tests --no-run` in a clean clone, tests inside the library included. Other work on the
/// same cores makes processor time longer, so that both are to be measured alike.
const CORE_TESTS_BEFORE: f64 = 493.0;
/// Largest processor time of the test command, minutes. It took 31 before it was measured.
const TESTS: f64 = 15.0;

/// Measures all of it. The registry cache is the user's: what is measured is the work of the compiler.
///
/// # Errors
/// A build or a test that fails.
pub fn measured(figures: &mut Vec<Figure>) -> Result<()> {
    let scratch = Scratch::new("builds")?;
    let clone = scratch.0.join("kinetostat");
    let mut git = Command::new("git");
    git.args(["clone", "--quiet"]).arg(root()).arg(&clone);
    ensure!(git.status()?.success(), "git cannot clone");
    // Downloads are no part of it.
    run(&clone, &["fetch", "--quiet", "--locked"])?;

    let used = run(&clone, &["run", "--release", "--quiet", "--", "demo"])?;
    let name = "clean clone: `cargo run --release -- demo`";
    figures.push(Figure::at_most(
        format!("{name}, time"),
        used.seconds,
        DEMO,
        "s",
    ));
    used.shown(name);

    let used = run(&clone, &["build", "--profile", "dist", "--quiet"])?;
    used.shown("build of the program that is handed out (profile dist)");
    let program = clone.join("target/dist/kinetostat");
    let bytes = fs::metadata(&program)
        .with_context(|| format!("no {}", program.display()))?
        .len();
    let name = "size of the program that is handed out (profile dist), without symbols";
    figures.push(Figure::at_most(name, bytes as f64 / 1e6, PROGRAM, "MB"));

    changed(&clone.join("crates/kinetostat-cli/src/main.rs"))?;
    let used = run(&clone, &["build", "--release", "--quiet"])?;
    let name = "build after a change in the command line (release)";
    figures.push(Figure::at_most(
        format!("{name}, time"),
        used.seconds,
        WARM,
        "s",
    ));
    used.shown(name);

    let name = "build of the core's tests from nothing";
    let used = from_nothing(
        &clone,
        &["test", "--workspace", "--test", "core", "--no-run"],
    )?;
    used.shown(name);
    if let Some(processor) = used.processor {
        let name = format!("{name}, processor time");
        figures.push(Figure::at_most(name, processor, CORE_TESTS, "s"));
    }

    let build = ["build", "--workspace", "--bin", "kinetostat", "--quiet"];
    run(&clone, &build)?;
    changed(&clone.join("crates/kinetostat-cli/src/main.rs"))?;
    let used = run(&clone, &build)?;
    let name = "build after a change in the command line (dev)";
    figures.push(Figure::at_most(
        format!("{name}, time"),
        used.seconds,
        WARM,
        "s",
    ));
    used.shown(name);

    let name = "`cargo xtask test` from nothing";
    let used = from_nothing(&clone, &["xtask", "test"])?;
    used.shown(name);
    if let Some(processor) = used.processor {
        let name = format!("{name}, processor time");
        figures.push(Figure::at_most(name, processor / 60.0, TESTS, "min"));
    }
    Ok(())
}

struct Used {
    seconds: f64,
    /// Processor time of the command and of all that it started, s, if the system reports it.
    processor: Option<f64>,
}

impl Used {
    fn shown(&self, name: &str) {
        let processor = match self.processor {
            Some(seconds) => format!(", {seconds:.0} s of processor time"),
            None => String::new(),
        };
        eprintln!("   {name}: {:.0} s{processor}", self.seconds);
    }
}

/// In a clone whose target directory is empty.
fn from_nothing(clone: &Path, words: &[&str]) -> Result<Used> {
    let target = clone.join("target");
    fs::remove_dir_all(&target).with_context(|| format!("cannot remove {}", target.display()))?;
    run(clone, words)
}

fn run(clone: &Path, words: &[&str]) -> Result<Used> {
    let before = processor_time();
    let start = Instant::now();
    let output = cargo()
        .args(words)
        .current_dir(clone)
        .env_remove("CARGO_TARGET_DIR")
        .env_remove("RUSTFLAGS")
        .stdin(Stdio::null())
        .output()
        .context("cannot start cargo")?;
    let seconds = start.elapsed().as_secs_f64();
    let words = words.join(" ");
    let said = String::from_utf8_lossy(&output.stderr);
    ensure!(
        output.status.success(),
        "cargo {words} failed in a clean clone: {said}"
    );
    let processor = before.zip(processor_time()).map(|(a, b)| b - a);
    Ok(Used { seconds, processor })
}

/// Processor time of all commands that have ended, s.
fn processor_time() -> Option<f64> {
    ended_children(&fs::read_to_string("/proc/self/stat").ok()?)
}

/// From the 16th and 17th figure of a process's line; the second, its name, may hold spaces.
fn ended_children(line: &str) -> Option<f64> {
    /// Clock ticks of every Linux that Rust runs on.
    const TICKS_PER_SECOND: f64 = 100.0;
    let (_, after_name) = line.rsplit_once(')')?;
    let figures: Vec<f64> = after_name
        .split_whitespace()
        .skip(13)
        .take(2)
        .map(|word| word.parse().ok())
        .collect::<Option<_>>()?;
    let [user, system] = figures.as_slice() else {
        return None;
    };
    Some((user + system) / TICKS_PER_SECOND)
}

/// A change that the compiler has to look at.
fn changed(file: &PathBuf) -> Result<()> {
    let text = fs::read_to_string(file).with_context(|| format!("no {}", file.display()))?;
    fs::write(file, text + "\n// Changed.\n")?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn processor_time_of_children_is_read() {
        let line = "7 (a (b) c) S 1 2 3 4 5 6 7 8 9 10 11 12 250 50 20 0 1 0 99";
        assert_eq!(ended_children(line), Some(3.0));
        assert_eq!(ended_children("7 (a) S 1"), None);
        assert_eq!(ended_children(""), None);
    }
}
