//! `cargo xtask counts`: instructions that every work takes, beside a committed baseline. Times need a
//! quiet machine, counts do not.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use anyhow::{Context, Result, bail};
use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::{cargo, root, step};

/// What a count may be above its baseline, %.
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
            let Some(found) = counted()? else {
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

/// The largest growth beside the baseline, %; none where it cannot be counted.
///
/// # Errors
/// A tool that cannot be run.
pub fn worst() -> Result<Option<f64>> {
    let Some((found, baseline)) = both()? else {
        return Ok(None);
    };
    let growth = |(name, count)| percent(count, baseline.instructions.get(name).copied());
    let all = found.instructions.iter().map(growth);
    Ok(all.reduce(f64::max))
}

/// Counts of now and of the baseline.
fn both() -> Result<Option<(Counts, Counts)>> {
    let baseline =
        fs::read_to_string(file()).with_context(|| format!("cannot read {}", file().display()))?;
    let baseline: Counts = serde_json::from_str(&baseline)
        .with_context(|| format!("{} is no baseline", file().display()))?;
    if baseline.instruction_set != instruction_set() {
        skipped(&format!(
            "the baseline is for {}, this machine has {}",
            baseline.instruction_set,
            instruction_set()
        ));
        return Ok(None);
    }
    let Some(found) = counted()? else {
        skipped("valgrind is not installed");
        return Ok(None);
    };
    Ok(Some((found, baseline)))
}

fn skipped(why: &str) {
    eprintln!("SKIPPED: counts: {why}, so instructions are not compared");
}

struct Comparison {
    /// Works that take more than the slack allows, or that have no baseline.
    more: Vec<String>,
    /// Works that take less by more than that, or that are gone.
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

/// A work without a baseline is a failure: nobody would notice when it grows.
fn percent(count: &u64, before: Option<u64>) -> f64 {
    match before {
        Some(before) => 100.0 * (*count as f64 - before as f64) / before as f64,
        None => f64::INFINITY,
    }
}

/// Another compiler may be the cause.
fn taken_differently(found: &Counts, baseline: &Counts) -> String {
    let mut text = String::new();
    for (what, now, before) in [
        ("rustc", &found.rustc, &baseline.rustc),
        ("valgrind", &found.valgrind, &baseline.valgrind),
    ] {
        if now != before {
            text += &format!("This is {what} {now}, the baseline was taken with {before}. ");
        }
    }
    text
}

fn file() -> PathBuf {
    root().join("benches/counts.json")
}

/// What the kernels run on under valgrind, which knows nothing wider than AVX2.
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

/// Counts everything; none without valgrind.
fn counted() -> Result<Option<Counts>> {
    let Some(valgrind) = version(&mut Command::new("valgrind")) else {
        return Ok(None);
    };
    let rustc = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    let rustc = version(&mut Command::new(rustc)).context("cannot start rustc")?;
    let runner = runner()?;
    eprintln!("== instructions of the works, counted by valgrind");
    let output = cargo()
        .args([
            "bench",
            "--quiet",
            "-p",
            "kinetostat-bench",
            "--bench",
            "counts",
        ])
        .args(["--", "--output-format=json", "--allow-aslr=true"])
        .env("GUNGRAUN_RUNNER", runner)
        // Pairs of single numbers that the compiler packs by itself take a move that valgrind 3.19 does
        // not know. The kernels say what is packed, and are the same without.
        .env("RUSTFLAGS", "-Cno-vectorize-slp")
        .current_dir(root())
        .stderr(Stdio::inherit())
        .output()
        .context("cannot start the bench 'counts'")?;
    if !output.status.success() {
        bail!("the bench 'counts' failed ({})", output.status);
    }
    let instructions = instructions(&String::from_utf8_lossy(&output.stdout))?;
    Ok(Some(Counts {
        rustc,
        valgrind,
        instruction_set: instruction_set(),
        instructions,
    }))
}

/// From what gungraun prints: one summary per line.
fn instructions(text: &str) -> Result<BTreeMap<String, u64>> {
    let mut found = BTreeMap::new();
    for line in text.lines() {
        let summary: Value = serde_json::from_str(line)
            .with_context(|| format!("the bench 'counts' printed no summary: {line}"))?;
        let word = |key: &str| summary[key].as_str().unwrap_or_default().to_owned();
        // Beside it lies the count of an earlier run, if there was one.
        let count = &summary["profiles"][0]["data"]["total"]["metrics"]["Ir"]["values"]["new"];
        let Some(count) = count.as_u64() else {
            bail!("the bench 'counts' printed no instructions: {line}");
        };
        found.insert(format!("{} {}", word("function_name"), word("id")), count);
    }
    if found.is_empty() {
        bail!("the bench 'counts' printed nothing");
    }
    Ok(found)
}

/// The program that gungraun starts valgrind with, of the version of the library in use; built into
/// the target directory where it is not there yet.
fn runner() -> Result<PathBuf> {
    let lock = fs::read_to_string(root().join("Cargo.lock"))?;
    let version = locked(&lock, "gungraun-runner").context("gungraun is not in Cargo.lock")?;
    let target =
        std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| root().join("target"), PathBuf::from);
    let folder = target.join(format!("gungraun-runner-{version}"));
    let program = folder.join("bin").join("gungraun-runner");
    if !program.is_file() {
        step(
            "gungraun-runner into the target directory",
            cargo()
                .args(["install", "gungraun-runner", "--quiet", "--locked"])
                .args(["--version", &format!("={version}")])
                .arg("--root")
                .arg(&folder)
                .arg("--target-dir")
                .arg(folder.join("build"))
                // It starts valgrind and reads a file: building it fast is what counts.
                .env("CARGO_PROFILE_RELEASE_OPT_LEVEL", "0")
                .env("CARGO_PROFILE_RELEASE_LTO", "off")
                .env("CARGO_PROFILE_RELEASE_CODEGEN_UNITS", "16"),
        )?;
        let _ = fs::remove_dir_all(folder.join("build"));
    }
    absolute(&program)
}

fn absolute(path: &Path) -> Result<PathBuf> {
    std::path::absolute(path).with_context(|| format!("where is {}?", path.display()))
}

/// Version of a package in a lock file.
fn locked<'a>(lock: &'a str, package: &str) -> Option<&'a str> {
    let name = format!("name = \"{package}\"");
    let mut lines = lock.lines().skip_while(|line| *line != name);
    lines
        .nth(1)?
        .strip_prefix("version = \"")?
        .strip_suffix('"')
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
        let why = taken_differently(&now, &before);
        assert_eq!(why, "This is rustc 2, the baseline was taken with 1. ");
    }

    #[test]
    fn counts_are_read_from_summaries_of_a_first_and_a_later_run() {
        let line = |values: Value| {
            serde_json::json!({
                "function_name": "many", "id": "w1",
                "profiles": [{"data": {"total": {"metrics": {"Ir": {"values": values}}}}}],
            })
            .to_string()
        };
        for values in [
            serde_json::json!({"new": 7}),
            serde_json::json!({"new": 7, "old": 9}),
        ] {
            let found = instructions(&line(values)).expect("counts");
            assert_eq!(found, BTreeMap::from([("many w1".into(), 7)]));
        }
        assert!(instructions("").is_err());
        assert!(instructions(&line(Value::Null)).is_err());
    }

    #[test]
    fn the_lock_file_tells_the_version() {
        let lock = "[[package]]\nname = \"a\"\nversion = \"1.2.3\"\n";
        assert_eq!(locked(lock, "a"), Some("1.2.3"));
        assert_eq!(locked(lock, "b"), None);
    }
}
