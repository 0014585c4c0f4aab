//! The Python package: its tests as a step of `cargo xtask test`, and `cargo xtask wheel`.
//!
//! Everything that pip installs lies in the target directory (`python/`); nothing of the system's Python is touched.

mod environment;
mod figures;
mod interpreter;
mod wheel;

pub use figures::measured;
pub use wheel::run as wheel;

use std::path::Path;
use std::process::Command;

use anyhow::{Context, Result};

use crate::{root, step};
use environment::{Environment, folder};
use interpreter::{Interpreter, ends};

/// Environments for the tests of the package on the oldest and the newest CPython at hand.
pub struct Prepared {
    oldest: Interpreter,
    tools: Environment,
    /// The newest where it is another one, with its environment where pip could make one.
    newest: Option<(Interpreter, Option<Environment>)>,
}

/// Makes environments; none, and it is said, where Python or the package index is missing.
///
/// # Errors
/// An environment that cannot be made.
pub fn prepare() -> Result<Option<Prepared>> {
    let Some((oldest, newest)) = ends() else {
        skipped("there is no CPython from 3.10 with pip and venv on this machine");
        return Ok(None);
    };
    let Some(tools) = Environment::with_test_tools(&oldest)? else {
        skipped("the package index cannot be reached: pip could not install what the tests need");
        return Ok(None);
    };
    let newest = match newest {
        Some(python) => {
            let own = Environment::with_test_tools(&python)?;
            if own.is_none() {
                skipped(&format!(
                    "pip could not install the tests' tools for CPython {python}"
                ));
            }
            Some((python, own))
        }
        None => None,
    };
    Ok(Some(Prepared {
        oldest,
        tools,
        newest,
    }))
}

/// Tests of the package.
///
/// # Errors
/// A test that fails.
pub fn check(prepared: Option<Prepared>) -> Result<()> {
    let Some(Prepared {
        oldest,
        tools,
        newest,
    }) = prepared
    else {
        return Ok(());
    };
    let wheel = wheel::built(&tools, "dev", &folder().join("wheels"))?;
    static_checks(&tools, &wheel)?;
    let others = newest.as_ref().map(|(python, _)| python);
    for python in [Some(&oldest), others].into_iter().flatten() {
        bare(python, &wheel)?;
    }
    let plain: &[(&str, &str)] = &[];
    tests(&tools, "in the plain locale", plain)?;
    let last = match newest.and_then(|(_, own)| own) {
        Some(last) => last.holding(&wheel)?,
        None => tools,
    };
    let comma = comma_locale()?;
    let comma: Vec<(&str, &str)> = comma
        .iter()
        .map(|(k, v)| (k.as_str(), v.as_str()))
        .collect();
    let title = match comma.is_empty() {
        true => "without a display",
        false => "under a comma-decimal locale, without a display",
    };
    tests(&last, title, &comma)
}

/// The package imports and answers with numpy alone.
fn bare(python: &Interpreter, wheel: &Path) -> Result<()> {
    let Some(alone) = Environment::bare(python)? else {
        skipped(&format!("pip could not install numpy for CPython {python}"));
        return Ok(());
    };
    let alone = alone.holding(wheel)?;
    step(
        &format!("Python {python}: the package with numpy alone"),
        alone.python().arg(root().join("python/tools/bare.py")),
    )
}

/// Format, lints, types, stubs, and functions of all commands: the same on every Python.
fn static_checks(tools: &Environment, wheel: &Path) -> Result<()> {
    tools.install(wheel)?;
    let checks: [(&str, &[&str]); 5] = [
        ("ruff", &["-m", "ruff", "check", "python", "benches/python"]),
        (
            "ruff format",
            &[
                "-m",
                "ruff",
                "format",
                "--check",
                "python",
                "benches/python",
            ],
        ),
        (
            "mypy --strict",
            &["-m", "mypy", "--strict", "python/kinetostat"],
        ),
        (
            "stubtest of the package",
            &[
                "-m",
                "mypy.stubtest",
                "--mypy-config-file",
                "pyproject.toml",
                "--allowlist",
                "python/tools/stubtest-allowed.txt",
                "--ignore-unused-allowlist",
                "kinetostat",
            ],
        ),
        (
            "commands of the package",
            &["python/tools/make_commands.py", "--check"],
        ),
    ];
    for (title, words) in checks {
        step(
            &format!("Python {}: {title}", tools.version),
            tools.python().args(words),
        )?;
    }
    Ok(())
}

/// pytest and doctests; their closing lines are shown.
fn tests(environment: &Environment, title: &str, settings: &[(&str, &str)]) -> Result<()> {
    let with = |words: &[&str]| {
        let mut run = environment.python();
        // A process on every core, each with whole files: what a file prepares is prepared once.
        run.args(["-m", "pytest", "-n", "auto", "--dist", "loadfile"])
            .args(words)
            .env_remove("MPLBACKEND");
        if title.contains("display") {
            run.env_remove("DISPLAY").env_remove("WAYLAND_DISPLAY");
        }
        run.envs(settings.iter().copied());
        run
    };
    let version = &environment.version;
    step(
        &format!("Python {version}: tests {title}"),
        &mut with(&["python/tests"]),
    )?;
    step(
        &format!("Python {version}: examples of the documentation {title}"),
        &mut with(&["--doctest-modules", "--pyargs", "kinetostat"]),
    )
}

/// Settings for a locale that writes a comma before decimals, made where the system has none; empty, and said, where neither is there.
fn comma_locale() -> Result<Vec<(String, String)>> {
    const NAME: &str = "de_DE.UTF-8";
    let set = |extra: Option<String>| {
        let mut all = vec![("LC_ALL".to_owned(), NAME.to_owned())];
        all.extend(extra.map(|path| ("LOCPATH".to_owned(), path)));
        all
    };
    let listed = Command::new("locale").arg("-a").output();
    let there = listed.is_ok_and(|o| String::from_utf8_lossy(&o.stdout).contains("de_DE.utf8"));
    if there {
        return Ok(set(None));
    }
    let own = folder().join("locale");
    std::fs::create_dir_all(&own).with_context(|| format!("cannot make {}", own.display()))?;
    let made = Command::new("localedef")
        .args(["-i", "de_DE", "-f", "UTF-8"])
        .arg(own.join(NAME))
        .output();
    if made.is_ok() && own.join(NAME).join("LC_NUMERIC").is_file() {
        return Ok(set(Some(own.display().to_string())));
    }
    skipped("there is no locale with a decimal comma, and localedef could not make one");
    Ok(Vec::new())
}

fn skipped(why: &str) {
    eprintln!("SKIPPED: Python: {why}");
}
