//! `cargo xtask counts`: instructions that every benchmark case takes, beside a committed baseline. Times need a
//! quiet machine, counts do not.

use std::collections::BTreeMap;
use std::fs;
use std::num::NonZero;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::atomic::{AtomicUsize, Ordering};

use anyhow::{Context, Result, anyhow, bail};
use serde::{Deserialize, Serialize};

use crate::{cargo, root, step};

/// Maximum excess of a count over its baseline, %.
pub const SLACK: f64 = 3.0;

/// The committed counts, and with what they were taken.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
struct Counts {
    rustc: String,
    valgrind: String,
    instruction_set: String,
    instructions: BTreeMap<String, u64>,
}

/// `--renew` writes the baseline instead of comparing with it.
///
/// # Errors
/// A count above its baseline by more than [`SLACK`], or a tool that cannot be run.
pub fn run(options: &[&str]) -> Result<()> {
    match options {
        [] => check(),
        ["--renew"] => {
            let Some(found) = counted(Tools::found()?)? else {
                bail!("counts --renew needs valgrind, which is not installed");
            };
            fs::write(file(), serde_json::to_string_pretty(&found)? + "\n")?;
            eprintln!("== counts: {} renewed", file().display());
            Ok(())
        }
        [other, ..] => bail!("'{other}' is no option of counts; --renew is"),
    }
}

/// Compares with the baseline, or says why that is skipped.
///
/// # Errors
/// As [`run`].
pub fn check() -> Result<()> {
    let Some((found, baseline)) = both()? else {
        return Ok(());
    };
    let Comparison { more, less, table } = compare(&found, &baseline);
    eprint!("{table}");
    if !more.is_empty() {
        bail!(
            "{}: more than {SLACK} % above the baseline. {}If that is meant, renew it: cargo xtask counts --renew",
            more.join(", "),
            taken_differently(&found, &baseline),
        );
    }
    if !less.is_empty() {
        eprintln!(
            "better: {}. Renew the baseline, so that it stays: cargo xtask counts --renew",
            less.join(", ")
        );
    }
    Ok(())
}

/// The largest growth beside the baseline, %; `None` if it cannot be counted.
///
/// # Errors
/// A tool that cannot be run.
pub fn worst() -> Result<Option<f64>> {
    let Some((found, baseline)) = both()? else {
        return Ok(None);
    };
    let growth = |(name, count)| percent(count, baseline.instructions.get(name).copied());
    let all = found.instructions.iter().map(growth);
    // A count that is none is the worst.
    Ok(all.reduce(|a, b| if a.is_nan() || a > b { a } else { b }))
}

/// Counts of now and of the baseline; none, and said, where they would not be comparable.
fn both() -> Result<Option<(Counts, Counts)>> {
    let baseline =
        fs::read_to_string(file()).with_context(|| format!("cannot read {}", file().display()))?;
    let baseline: Counts = serde_json::from_str(&baseline)
        .with_context(|| format!("{} is no baseline", file().display()))?;
    let now = Tools::found()?;
    if let Some(why) = now.not_comparable(&baseline) {
        skipped(&why);
        return Ok(None);
    }
    Ok(counted(now)?.map(|found| (found, baseline)))
}

/// Tools with which counts are taken.
struct Tools {
    rustc: String,
    /// Version; `None` if it is not installed.
    valgrind: Option<String>,
    instruction_set: String,
}

impl Tools {
    fn found() -> Result<Self> {
        let rustc = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
        Ok(Self {
            rustc: version(&mut Command::new(rustc)).context("cannot start rustc")?,
            valgrind: version(&mut Command::new("valgrind")),
            instruction_set: instruction_set(),
        })
    }

    /// Reason for which counts taken with these cannot be compared with the baseline: another compiler makes other
    /// instructions of the same program.
    fn not_comparable(&self, baseline: &Counts) -> Option<String> {
        if self.valgrind.is_none() {
            return Some("valgrind is not installed".into());
        }
        for (what, now, before) in [
            (
                "processors",
                &self.instruction_set,
                &baseline.instruction_set,
            ),
            ("rustc", &self.rustc, &baseline.rustc),
        ] {
            if now != before {
                return Some(format!(
                    "the baseline is for {what} {before}, and here is {now}"
                ));
            }
        }
        None
    }
}

fn skipped(why: &str) {
    eprintln!("SKIPPED: counts: {why}, so instructions are not compared");
}

struct Comparison {
    /// Benchmark cases that take more than the slack allows, or that have no baseline.
    more: Vec<String>,
    /// Benchmark cases that take less by more than that, or that are gone.
    less: Vec<String>,
    table: String,
}

fn compare(found: &Counts, baseline: &Counts) -> Comparison {
    let (mut more, mut less) = (Vec::new(), Vec::new());
    let mut table = format!(
        "{:<40} {:>12} {:>12}   change\n",
        "instructions", "baseline", "now"
    );
    for (name, &count) in &found.instructions {
        let before = baseline.instructions.get(name).copied();
        let change = percent(&count, before);
        if change > SLACK {
            more.push(name.clone());
        } else if change < -SLACK {
            less.push(name.clone());
        }
        let (before, change) = match before {
            Some(before) => (before.to_string(), format!("{change:+.2} %")),
            None => ("none".into(), "new".into()),
        };
        table += &format!("{name:<40} {before:>12} {count:>12}   {change}\n");
    }
    let gone = |name: &&String| !found.instructions.contains_key(*name);
    less.extend(
        baseline
            .instructions
            .keys()
            .filter(gone)
            .map(|n| format!("{n} (gone)")),
    );
    Comparison { more, less, table }
}

/// A benchmark case without a baseline is a failure: nobody would notice when it grows.
fn percent(count: &u64, before: Option<u64>) -> f64 {
    match before {
        Some(before) => 100.0 * (*count as f64 - before as f64) / before as f64,
        None => f64::INFINITY,
    }
}

/// Another valgrind may be the cause.
fn taken_differently(found: &Counts, baseline: &Counts) -> String {
    if found.valgrind == baseline.valgrind {
        return String::new();
    }
    format!(
        "This is valgrind {}, the baseline was taken with {}. ",
        found.valgrind, baseline.valgrind
    )
}

fn file() -> PathBuf {
    root().join("benches/counts.json")
}

/// Instruction set of the kernels under valgrind, which knows nothing wider than AVX2.
fn instruction_set() -> String {
    #[cfg(target_arch = "x86_64")]
    let wide = is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma");
    #[cfg(not(target_arch = "x86_64"))]
    let wide = false;
    let suffix = if wide { " with AVX2" } else { "" };
    format!("{}{suffix}", std::env::consts::ARCH)
}

/// First line that a program prints about its version, without its name.
fn version(program: &mut Command) -> Option<String> {
    let output = program
        .arg("--version")
        .stderr(Stdio::null())
        .output()
        .ok()?;
    let text = String::from_utf8_lossy(&output.stdout);
    let line = text.lines().next()?.trim();
    let number = line.find(|c: char| c.is_ascii_digit())?;
    Some(line[number..].to_owned())
}

/// Every instruction set that this processor has gives the same bits.
///
/// # Errors
/// One that does not, or a build that fails.
pub fn instruction_sets() -> Result<()> {
    optimised(
        "every instruction set, optimised",
        "run",
        "instruction_sets",
    )
}

/// A program of the benches, built for speed.
fn optimised(title: &str, command: &str, program: &str) -> Result<()> {
    step(
        title,
        cargo()
            .args([command, "--quiet", "--release", "-p", "kinetostat-bench"])
            .args(["--bin", program])
            // Pairs of single numbers that the compiler packs by itself take a move that valgrind 3.19
            // does not know. The kernels say what is packed, and are the same without.
            .env("RUSTFLAGS", "-Cno-vectorize-slp")
            // Valgrind finds the function to count by its name.
            .env("CARGO_PROFILE_RELEASE_STRIP", "none"),
    )
}

/// Counts everything; none without valgrind.
fn counted(tools: Tools) -> Result<Option<Counts>> {
    let Some(valgrind) = tools.valgrind else {
        return Ok(None);
    };
    optimised("the benchmark cases to count", "build", "counts")?;
    let program = target().join("release").join("counts");
    let names = Command::new(&program)
        .output()
        .with_context(|| format!("cannot start {}", program.display()))?;
    let names = String::from_utf8(names.stdout).context("names of benchmark cases")?;
    eprintln!("== instructions of the benchmark cases, counted by valgrind");
    let names: Vec<&str> = names.lines().collect();
    let instructions = all_instructions_of(&program, &names)?;
    if instructions.is_empty() {
        bail!("{} names no benchmark case", program.display());
    }
    Ok(Some(Counts {
        rustc: tools.rustc,
        valgrind,
        instruction_set: tools.instruction_set,
        instructions,
    }))
}

/// Instructions of the benchmark cases, as many at once as there are cores: counts do not depend on what runs beside.
fn all_instructions_of(program: &Path, names: &[&str]) -> Result<BTreeMap<String, u64>> {
    let next = AtomicUsize::new(0);
    let some = || -> Result<Vec<(String, u64)>> {
        let taken = std::iter::from_fn(|| names.get(next.fetch_add(1, Ordering::Relaxed)));
        taken
            .map(|name| Ok(((*name).to_owned(), instructions_of(program, name)?)))
            .collect()
    };
    let cores = std::thread::available_parallelism().map_or(1, NonZero::get);
    std::thread::scope(|scope| {
        let workers: Vec<_> = (0..cores).map(|_| scope.spawn(some)).collect();
        let mut all = BTreeMap::new();
        for worker in workers {
            let counted = worker
                .join()
                .map_err(|_| anyhow!("a count was broken off"))?;
            all.extend(counted?);
        }
        Ok(all)
    })
}

/// Instructions of one benchmark case, without what is done before and after it.
fn instructions_of(program: &Path, name: &str) -> Result<u64> {
    let output = Command::new("valgrind")
        .args(["--tool=callgrind", "--cache-sim=no"])
        .args(["--callgrind-out-file=/dev/null"])
        .arg("--toggle-collect=*kinetostat_counted*")
        .arg(program)
        .arg(name)
        .current_dir(root())
        // Counts must not depend on the caller's settings.
        .env_clear()
        .env("PATH", std::env::var_os("PATH").unwrap_or_default())
        // A string instruction counts as many as it has bytes: vectors instead, on every processor.
        .env(
            "GLIBC_TUNABLES",
            "glibc.cpu.x86_rep_stosb_threshold=1000000000:glibc.cpu.x86_rep_movsb_threshold=1000000000",
        )
        .output()
        .context("cannot start valgrind")?;
    let said = String::from_utf8_lossy(&output.stderr);
    if !output.status.success() {
        bail!("'{name}' under valgrind failed ({}): {said}", output.status);
    }
    collected(&said)
        .with_context(|| format!("valgrind counted no instructions of '{name}': {said}"))
}

/// From what callgrind says at the end: `==123== Collected : 456`.
fn collected(said: &str) -> Option<u64> {
    let line = said.lines().find(|line| line.contains("Collected :"))?;
    let count = line.rsplit(':').next()?.trim().parse().ok()?;
    // A count of zero means that the function was not found.
    (count > 0).then_some(count)
}

fn target() -> PathBuf {
    std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| root().join("target"), PathBuf::from)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn counts(rustc: &str, numbers: &[(&str, u64)]) -> Counts {
        Counts {
            rustc: rustc.into(),
            valgrind: "3".into(),
            instruction_set: "x86_64 with AVX2".into(),
            instructions: numbers.iter().map(|(n, c)| ((*n).into(), *c)).collect(),
        }
    }

    #[test]
    fn three_percent_more_pass_and_a_little_more_does_not() {
        let before = counts(
            "1",
            &[("a", 100_000), ("b", 100_000), ("c", 100_000), ("e", 1)],
        );
        let now = counts(
            "2",
            &[("a", 103_000), ("b", 103_001), ("c", 96_999), ("d", 1)],
        );
        let changes = compare(&now, &before);
        assert_eq!(changes.more, ["b", "d"]);
        assert_eq!(changes.less, ["c", "e (gone)"]);
        assert_eq!(changes.table.lines().count(), 5);
        assert_eq!(taken_differently(&now, &before), "");
    }

    #[test]
    fn another_compiler_processor_or_no_valgrind_is_not_compared() {
        let baseline = counts("1", &[("a", 1)]);
        let with = |rustc: &str, valgrind: Option<&str>, instruction_set: &str| Tools {
            rustc: rustc.into(),
            valgrind: valgrind.map(Into::into),
            instruction_set: instruction_set.into(),
        };
        let why = |tools: Tools| tools.not_comparable(&baseline);
        let own = "x86_64 with AVX2";
        assert_eq!(why(with("1", Some("4"), own)), None);
        for (tools, word) in [
            (with("2", Some("3"), own), "rustc 1, and here is 2"),
            (with("1", Some("3"), "x86_64"), "and here is x86_64"),
            (with("1", None, own), "valgrind"),
        ] {
            let why = why(tools).expect("a reason");
            assert!(why.contains(word), "{why}");
        }
    }

    #[test]
    fn counts_are_read_from_what_callgrind_says() {
        let said = "==7== Events    : Ir\n==7== Collected : 209812\n==7== \n";
        assert_eq!(collected(said), Some(209_812));
        assert_eq!(collected("==7== Collected : 0\n"), None);
        assert_eq!(collected(""), None);
    }
}
