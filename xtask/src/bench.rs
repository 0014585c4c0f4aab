//! `cargo xtask bench-vs-numpy [--json]`: the benchmark cases W1 to W5 in one process with numpy.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use anyhow::{Context, Result, bail, ensure};
use serde::{Deserialize, Serialize};

use crate::{cargo, root, step};

/// Benchmark cases and how many times faster than numpy they must be.
pub const CASES: [(&str, f64); 6] = [
    ("W1", 15.0),
    ("W2", 30.0),
    ("W3", 50.0),
    ("W3+K", 25.0),
    ("W4", 10.0),
    ("W5", 200.0),
];

/// Measurement of one benchmark case.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Row {
    /// Name of the case in [`CASES`].
    pub work: String,
    /// Median time per posture, us.
    pub kinetostat_us: f64,
    /// Median time per posture, us.
    pub numpy_us: f64,
    /// Time of numpy over that of kinetostat.
    pub ratio: f64,
    /// Largest difference of a number to the largest number of its item; none is a failure.
    pub max_relative_difference: f64,
}

/// Measures and prints. With `--json` stdout holds a list and nothing else.
///
/// # Errors
/// Without Python or numpy, and where numpy and kinetostat disagree.
pub fn versus_numpy(options: &[&str]) -> Result<()> {
    match options {
        [] => {
            let status = comparison()?.status().context("cannot start Python")?;
            if !status.success() {
                bail!("the comparison with numpy failed ({status})");
            }
            eprintln!();
            step(
                "many postures",
                cargo()
                    .args(["run", "--release", "--quiet", "-p", "kinetostat-bench"])
                    .args(["--bin", "table"]),
            )?;
        }
        ["--json"] => show(&measured()?)?,
        [other, ..] => bail!("'{other}' is no option of bench-vs-numpy; --json is"),
    }
    Ok(())
}

#[allow(clippy::print_stdout)] // this is the output that was requested
fn show(rows: &[Row]) -> Result<()> {
    println!("{}", serde_json::to_string_pretty(rows)?);
    Ok(())
}

/// Measures every benchmark case.
///
/// # Errors
/// As [`versus_numpy`].
pub fn measured() -> Result<Vec<Row>> {
    let output = comparison()?
        .arg("--json")
        .stderr(Stdio::inherit())
        .output()
        .context("cannot start Python")?;
    if !output.status.success() {
        bail!("the comparison with numpy failed ({})", output.status);
    }
    rows(&String::from_utf8_lossy(&output.stdout))
}

/// The rows of a comparison: every benchmark case once, in order, with numbers that fit one another.
fn rows(text: &str) -> Result<Vec<Row>> {
    let rows: Vec<Row> = serde_json::from_str(text)
        .with_context(|| format!("the comparison printed no list of benchmark cases: {text}"))?;
    let names = rows.iter().map(|row| row.work.as_str());
    ensure!(
        names.eq(CASES.map(|(name, _)| name)),
        "the comparison did not measure every benchmark case once: {text}"
    );
    for row in &rows {
        ensure!(
            row.kinetostat_us > 0.0
                && row.numpy_us > 0.0
                && (row.ratio * row.kinetostat_us / row.numpy_us - 1.0).abs() < 1e-9,
            "times and ratio of {} do not fit",
            row.work
        );
    }
    Ok(rows)
}

/// The command that compares, with all that it needs built.
fn comparison() -> Result<Command> {
    let mut compare = Command::new(python()?);
    compare
        .arg(root().join("benches/numpy/compare.py"))
        .env("PYTHONPATH", extension()?)
        .env("PYTHONDONTWRITEBYTECODE", "1")
        .current_dir(root());
    Ok(compare)
}

fn target() -> PathBuf {
    std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| root().join("target"), PathBuf::from)
}

/// A Python that has numpy: the machine's own, else an environment in the target directory.
///
/// # Errors
/// Where there is none.
pub fn python() -> Result<PathBuf> {
    let has_numpy = |python: &Path| {
        let run = Command::new(python)
            .args(["-c", "import numpy"])
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .status();
        run.is_ok_and(|status| status.success())
    };
    let own = Path::new("python3");
    if has_numpy(own) {
        return Ok(own.into());
    }
    if Command::new(own)
        .arg("--version")
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status()
        .is_err()
    {
        bail!("there is no python3 on this machine: the comparison with numpy needs it");
    }
    let folder = target().join("bench-python");
    let inside = folder.join("bin/python3");
    if !has_numpy(&inside) {
        let quiet = |title: &str, command: &mut Command| -> Result<()> {
            let run = command.stdin(Stdio::null()).output();
            let run = run.with_context(|| format!("cannot start: {title}"))?;
            if !run.status.success() {
                let said = String::from_utf8_lossy(&run.stderr);
                let last = said.lines().last().unwrap_or_default().to_owned();
                bail!("numpy is not there and {title} failed: {last}");
            }
            Ok(())
        };
        eprintln!("== numpy into an environment of its own");
        quiet(
            "python3 -m venv",
            Command::new(own).args(["-m", "venv"]).arg(&folder),
        )?;
        quiet(
            "pip install numpy",
            Command::new(&inside)
                .args(["-m", "pip", "install", "--quiet"])
                .args(["--disable-pip-version-check", "numpy"]),
        )?;
    }
    Ok(inside)
}

/// Builds the extension module; the folder where Python finds it.
fn extension() -> Result<PathBuf> {
    let mut build = cargo();
    build
        .args(["rustc", "--release", "--quiet", "-p", "kinetostat-bench"])
        .args(["--features", "python", "--lib", "--crate-type", "cdylib"]);
    if cfg!(target_os = "macos") {
        // Python's own symbols are there once it has loaded the module.
        build.args(["--", "-Clink-arg=-undefined", "-Clink-arg=dynamic_lookup"]);
    }
    step("build", &mut build)?;
    let (prefix, from, to) = match std::env::consts::OS {
        "windows" => ("", "dll", "pyd"),
        "macos" => ("lib", "dylib", "so"),
        _ => ("lib", "so", "so"),
    };
    let built = target()
        .join("release")
        .join(format!("{prefix}kinetostat_bench.{from}"));
    let folder = target().join("bench-python-module");
    fs::create_dir_all(&folder).with_context(|| format!("cannot make {}", folder.display()))?;
    let module = folder.join(format!("kinetostat_bench.{to}"));
    // Not over the old one: a process that runs may have it loaded.
    let fresh = folder.join(format!("fresh.{}", std::process::id()));
    fs::copy(&built, &fresh)
        .and_then(|_| fs::rename(&fresh, &module))
        .with_context(|| format!("cannot copy {} to {}", built.display(), module.display()))?;
    Ok(folder)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn text(change: impl Fn(&mut serde_json::Value)) -> String {
        let row = |(name, _): (&str, f64)| {
            serde_json::json!({
                "work": name, "kinetostat_us": 0.5, "numpy_us": 10.0, "ratio": 20.0,
                "max_relative_difference": 1e-14,
            })
        };
        let mut all: serde_json::Value = CASES.map(row).to_vec().into();
        change(&mut all);
        all.to_string()
    }

    #[test]
    fn a_comparison_has_every_case_and_ratios_that_fit() {
        let good = rows(&text(|_| ())).expect("rows");
        assert_eq!(good.len(), CASES.len());
        let again = serde_json::to_string(&good).expect("text");
        assert_eq!(rows(&again).expect("rows"), good);
        let wrong: [fn(&mut serde_json::Value); 5] = [
            |all| all[2]["work"] = "W7".into(),
            |all| all[0]["ratio"] = 21.0.into(),
            |all| all[5]["max_relative_difference"] = serde_json::Value::Null,
            |all| all[5]["more"] = 1.into(),
            |all| *all = all[0].clone(),
        ];
        for change in wrong {
            assert!(rows(&text(change)).is_err());
        }
    }
}
