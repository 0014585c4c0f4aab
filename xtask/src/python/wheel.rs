//! `cargo xtask wheel`: the package as it is handed out.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail, ensure};

use super::environment::{Environment, folder};
use super::interpreter::ends;
use crate::{root, step};

/// Largest size of the wheel, MB.
pub const LARGEST_MB: f64 = 15.0;

/// Builds the wheel, checks it, and installs it where nothing but numpy is.
///
/// # Errors
/// What does not hold; without Python or a package index there is no wheel.
pub fn run(options: &[&str]) -> Result<()> {
    if let [other, ..] = options {
        bail!("'{other}' is no option of wheel; there are none");
    }
    let Some((oldest, newest)) = ends() else {
        bail!("the wheel needs a CPython from 3.10 with pip and venv");
    };
    let Some(tools) = Environment::with_test_tools(&oldest)? else {
        bail!("the wheel needs the package index, for maturin and twine");
    };
    let wheel = built(&tools, "wheel", &folder().join("dist"))?;
    let size = megabytes(&wheel)?;
    eprintln!("== {}: {size:.2} MB", wheel.display());
    ensure!(
        size < LARGEST_MB,
        "the wheel has {size:.2} MB, at most {LARGEST_MB} are asked for"
    );
    step(
        "twine check",
        tools
            .python()
            .args(["-m", "twine", "check", "--strict"])
            .arg(&wheel),
    )?;
    let smoke = root().join("python/tools/bare.py");
    for python in [Some(&oldest), newest.as_ref()].into_iter().flatten() {
        let Some(alone) = Environment::bare(python)? else {
            bail!("pip could not install numpy for CPython {python}");
        };
        let alone = alone.holding(&wheel)?;
        step(
            &format!("Python {python}: the wheel with numpy alone"),
            alone.python().arg(&smoke),
        )?;
    }
    let python = newest.as_ref().unwrap_or(&oldest);
    let fresh = Environment::fresh(python, "source")?;
    step(
        &format!("Python {python}: pip install ."),
        fresh.python().args([
            "-m",
            "pip",
            "--quiet",
            "--disable-pip-version-check",
            "install",
            ".",
        ]),
    )?;
    step(
        &format!("Python {python}: the package from its source"),
        fresh.python().arg(&smoke),
    )
}

/// The wheel, built by maturin with a profile of cargo into an empty folder.
///
/// # Errors
/// A build that fails, or that leaves another number of wheels than one.
pub fn built(tools: &Environment, profile: &str, into: &Path) -> Result<PathBuf> {
    if into.exists() {
        std::fs::remove_dir_all(into)
            .with_context(|| format!("cannot empty {}", into.display()))?;
    }
    let mut build = tools.python();
    build
        .args([
            "-m",
            "maturin",
            "build",
            "--quiet",
            "--profile",
            profile,
            "--out",
        ])
        .arg(into);
    // Debugging information is six times the module, and packing it takes half a minute.
    build.arg("--strip");
    if profile == "dev" {
        // The tests of the workspace have compiled everything else already.
        build.args(["--features", "features-of-tests"]);
    }
    step(&format!("the wheel, profile {profile}"), &mut build)?;
    let mut found = std::fs::read_dir(into)?
        .filter_map(|entry| Some(entry.ok()?.path()))
        .filter(|path| path.extension().is_some_and(|e| e == "whl"));
    match (found.next(), found.next()) {
        (Some(wheel), None) => Ok(wheel),
        _ => bail!(
            "maturin left no wheel, or more than one, in {}",
            into.display()
        ),
    }
}

/// Size of a file, MB.
///
/// # Errors
/// A file that cannot be read.
pub fn megabytes(file: &Path) -> Result<f64> {
    let size =
        std::fs::metadata(file).with_context(|| format!("cannot read {}", file.display()))?;
    Ok(size.len() as f64 / 1e6)
}
