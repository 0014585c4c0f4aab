//! The Python package: built, tested and checked on the oldest and the newest CPython at hand, and its wheel.

use std::collections::BTreeMap;
use std::env;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use anyhow::{Context, Result, bail, ensure};

use crate::{cargo, root, step};

/// The oldest CPython that the package runs on: minor version of 3.
const OLDEST: u32 = 10;

/// What the tests need on every CPython.
const FEW: &[&str] = &["numpy", "pytest", "hypothesis"];

/// A CPython that is here.
#[derive(Clone, Debug)]
pub struct Interpreter {
    pub minor: u32,
    pub program: PathBuf,
}

/// The oldest and the newest CPython at hand that the package can run on: one, two, or none.
pub fn interpreters() -> Vec<Interpreter> {
    let mut found = BTreeMap::new();
    for program in candidates() {
        if let Some(minor) = minor_of(&program).filter(|&minor| minor >= OLDEST) {
            found.entry(minor).or_insert(program);
        }
    }
    let mut all: Vec<Interpreter> = (found.into_iter())
        .map(|(minor, program)| Interpreter { minor, program })
        .collect();
    if all.len() > 2 {
        all.drain(1..all.len() - 1);
    }
    all
}

/// Programs by their names on the path, and those of pyenv.
fn candidates() -> Vec<PathBuf> {
    let named = std::iter::once("python3".to_owned())
        .chain((OLDEST..OLDEST + 12).map(|minor| format!("python3.{minor}")));
    let path = env::var_os("PATH").unwrap_or_default();
    let folders: Vec<PathBuf> = env::split_paths(&path).collect();
    let mut all: Vec<PathBuf> = named
        .flat_map(|name| folders.iter().map(move |folder| folder.join(&name)))
        .filter(|program| program.is_file())
        .collect();
    let pyenv = env::var_os("PYENV_ROOT").map(PathBuf::from);
    let pyenv = pyenv.or_else(|| env::home_dir().map(|home| home.join(".pyenv")));
    if let Some(versions) = pyenv.and_then(|root| fs::read_dir(root.join("versions")).ok()) {
        let each = versions.flatten().map(|v| v.path().join("bin/python3"));
        all.extend(each.filter(|program| program.is_file()));
    }
    all
}

fn minor_of(program: &Path) -> Option<u32> {
    let asked = "import sys, venv; print(sys.implementation.name, *sys.version_info[:2])";
    let output = Command::new(program).args(["-c", asked]).output().ok()?;
    let said = String::from_utf8(output.stdout).ok()?;
    said.trim().strip_prefix("cpython 3 ")?.parse().ok()
}

/// A virtual environment of the tests; false where its packages cannot be had.
struct Environment {
    python: PathBuf,
    minor: u32,
}

impl Environment {
    fn new(interpreter: &Interpreter, folder: &Path) -> Result<Self> {
        let python = folder.join("bin/python");
        if !python.is_file() {
            let mut make = Command::new(&interpreter.program);
            make.args(["-m", "venv"]).arg(folder);
            step("virtual environment", &mut make)?;
        }
        let minor = interpreter.minor;
        Ok(Self { python, minor })
    }

    fn python(&self) -> Command {
        let mut command = Command::new(&self.python);
        command.env_remove("PYTHONHOME").env_remove("PYTHONPATH");
        command
    }

    /// Installs packages; false where there is no index to take them from.
    fn has(&self, packages: &[&str]) -> Result<bool> {
        let mut pip = self.python();
        pip.args([
            "-m",
            "pip",
            "install",
            "--quiet",
            "--disable-pip-version-check",
        ]);
        Ok(pip.args(packages).current_dir(root()).status()?.success())
    }
}

fn target() -> PathBuf {
    env::var_os("CARGO_TARGET_DIR").map_or_else(|| root().join("target"), PathBuf::from)
}

/// Name of the extension module's file on this system, as cargo builds it and as Python loads it.
fn module() -> (&'static str, &'static str) {
    match env::consts::OS {
        "windows" => ("_core.dll", "_core.pyd"),
        "macos" => ("lib_core.dylib", "_core.abi3.so"),
        _ => ("lib_core.so", "_core.abi3.so"),
    }
}

/// The package beside its module, as an installation lays them; gives the folder for `PYTHONPATH`.
fn laid_out(folder: &Path) -> Result<PathBuf> {
    step(
        "the extension module of Python",
        cargo().args(["build", "--quiet", "-p", "kinetostat-python"]),
    )?;
    let site = folder.join("site");
    if site.exists() {
        fs::remove_dir_all(&site)?;
    }
    copied(&root().join("python/kinetostat"), &site.join("kinetostat"))?;
    let (built, loaded) = module();
    let built = target().join("debug").join(built);
    fs::copy(&built, site.join("kinetostat").join(loaded))
        .with_context(|| format!("{} is not there", built.display()))?;
    Ok(site)
}

/// Sources of a package: what was built by hand or is left by an interpreter stays behind.
fn copied(from: &Path, to: &Path) -> Result<()> {
    fs::create_dir_all(to)?;
    for entry in fs::read_dir(from)? {
        let path = entry?.path();
        let Some(name) = path.file_name() else {
            continue;
        };
        if path.is_dir() && name != "__pycache__" {
            copied(&path, &to.join(name))?;
        } else if path
            .extension()
            .is_some_and(|e| e == "py" || e == "pyi" || e == "typed")
            || name == "py.typed"
        {
            fs::copy(&path, to.join(name))?;
        }
    }
    Ok(())
}

/// Builds the package and tests it.
///
/// # Errors
/// What fails. Without a CPython, or without an index of packages, it says what is skipped.
pub fn test() -> Result<()> {
    let found = interpreters();
    let (Some(oldest), Some(newest)) = (found.first(), found.last()) else {
        eprintln!(
            "SKIPPED: no CPython 3.{OLDEST} or later is here, the Python package is not tested"
        );
        return Ok(());
    };
    let folder = target().join("python");
    let site = laid_out(&folder)?;
    for interpreter in &found {
        let name = format!("3.{}", interpreter.minor);
        let environment = Environment::new(interpreter, &folder.join(&name))?;
        if !environment.has(&["numpy"])? {
            eprintln!(
                "SKIPPED: pip cannot install numpy for CPython {name}, the package is not tested on it"
            );
            continue;
        }
        bare(&environment, &site)?;
        // The whole of it on the newest; on the oldest what needs only numpy.
        let all = interpreter.minor == newest.minor;
        if !environment.has(FEW)? {
            eprintln!(
                "SKIPPED: pip cannot install pytest for CPython {name}, the package is not tested on it"
            );
            continue;
        }
        if all && !environment.has(&extras()?.iter().map(String::as_str).collect::<Vec<_>>())? {
            eprintln!(
                "SKIPPED: pip cannot install the package's extras for CPython {name}; tests that need them skip themselves"
            );
        }
        pytest(&environment, &site, "C.UTF-8", &[])?;
        if all {
            checks(&environment, &site)?;
        }
    }
    let environment = Environment::new(oldest, &folder.join(format!("3.{}", oldest.minor)))?;
    comma(&environment, &site)
}

/// Packages of the extra `test` in pyproject.toml.
fn extras() -> Result<Vec<String>> {
    let text = fs::read_to_string(root().join("pyproject.toml"))?;
    let list = text
        .split_once("\ntest = [")
        .and_then(|(_, rest)| rest.split_once("]\n"))
        .context("pyproject.toml has no extra `test = [...]`")?
        .0;
    let each = list.split('"').skip(1).step_by(2);
    Ok(each.map(ToOwned::to_owned).collect())
}

/// With numpy alone: it is imported, computes, and loads nothing that draws.
fn bare(environment: &Environment, site: &Path) -> Result<()> {
    let script = "
import sys, time
import numpy
start = time.perf_counter()
import kinetostat
seconds = time.perf_counter() - start
drawing = [name for name in ('matplotlib', 'pyvista', 'vtk', 'sympy', 'xarray', 'scipy', 'pandas') if name in sys.modules]
assert not drawing, f'the import loads {drawing}'
matrix = kinetostat.Machine.preset('orthoglide').posture(position=[0, 0, 0]).stiffness().matrix
assert matrix.shape == (6, 6) and numpy.isfinite(matrix).all()
print(f'import of kinetostat beside numpy on CPython {sys.version.split()[0]}: {seconds:.3f} s')
";
    let mut python = environment.python();
    python.args(["-c", script]).env("PYTHONPATH", site);
    step(
        &format!("Python 3.{} with numpy alone", environment.minor),
        &mut python,
    )
}

fn pytest(environment: &Environment, site: &Path, locale: &str, more: &[&str]) -> Result<()> {
    // Without a display, and with the arguments of pyproject.toml.
    let mut python = environment.python();
    python
        .args(["-m", "pytest", "-p", "no:cacheprovider", "python/tests"])
        .args(more)
        .env("PYTHONPATH", site)
        .env("PYTHONDONTWRITEBYTECODE", "1")
        .env("LC_ALL", locale)
        .env_remove("DISPLAY");
    if more.is_empty() {
        python.arg("--doctest-modules").arg(site.join("kinetostat"));
    }
    step(
        &format!("Python 3.{}, locale {locale}", environment.minor),
        &mut python,
    )
}

/// Types, stubs, style, and the functions that are made from the command line's table.
fn checks(environment: &Environment, site: &Path) -> Result<()> {
    let mut types = environment.python();
    types.args(["-m", "mypy", "--no-incremental", "python/kinetostat"]);
    step("types of the Python package", &mut types)?;
    let mut stubs = environment.python();
    stubs
        .args(["-m", "mypy.stubtest", "kinetostat._core"])
        .args(["--allowlist", "python/tools/stubtest_allowed.txt"])
        .env("PYTHONPATH", site)
        .env("MYPYPATH", site);
    step("stubs beside the extension module", &mut stubs)?;
    for words in [
        &["-m", "ruff", "check", "--no-cache", "python"][..],
        &["-m", "ruff", "format", "--no-cache", "--check", "python"],
    ] {
        step(
            "style of the Python package",
            environment.python().args(words),
        )?;
    }
    let mut made = environment.python();
    made.args(["python/tools/make_commands.py", "--check"])
        .env("PYTHONPATH", site);
    step("functions of the commands", &mut made)
}

/// Numbers are read and written alike where the decimal point is a comma.
fn comma(environment: &Environment, site: &Path) -> Result<()> {
    let listed = Command::new("locale")
        .arg("-a")
        .stderr(Stdio::null())
        .output();
    let listed = listed.map(|o| String::from_utf8_lossy(&o.stdout).into_owned());
    let listed = listed.unwrap_or_default();
    let name = (listed.lines()).find(|name| name.starts_with("de_") || name.starts_with("fr_"));
    let Some(name) = name else {
        eprintln!(
            "SKIPPED: no locale with a decimal comma is installed (de_DE.UTF-8), its run of the Python tests is left out"
        );
        return Ok(());
    };
    if environment
        .python()
        .args(["-c", "import pytest"])
        .stderr(Stdio::null())
        .status()?
        .success()
    {
        pytest(environment, site, name, &["-k", "not slow"])?;
    }
    Ok(())
}

/// `cargo xtask wheel`: the wheel that is handed out, checked as an index checks it and installed beside numpy alone.
///
/// # Errors
/// What fails; a wheel above 15 MB does.
pub fn wheel() -> Result<()> {
    let found = interpreters();
    let newest = found.last().context("no CPython is here")?;
    let folder = target().join("python");
    let tools = Environment::new(newest, &folder.join("wheel-tools"))?;
    ensure!(
        tools.has(&["maturin>=1.9.4,<2", "twine"])?,
        "pip cannot install maturin and twine"
    );
    let out = folder.join("wheels");
    if out.exists() {
        fs::remove_dir_all(&out)?;
    }
    let mut build = tools.python();
    build
        .args(["-m", "maturin", "build", "--quiet", "--out"])
        .arg(&out);
    step("the wheel", build.arg("--interpreter").arg(&tools.python))?;
    let mut wheels = fs::read_dir(&out)?.flatten().map(|e| e.path());
    let wheel = wheels
        .find(|p| p.extension().is_some_and(|e| e == "whl"))
        .context("maturin made no wheel")?;
    let bytes = fs::metadata(&wheel)?.len();
    let name = wheel.file_name().unwrap_or_default().to_string_lossy();
    eprintln!("== {name}: {:.2} MB", bytes as f64 / 1e6);
    ensure!(
        bytes < 15_000_000,
        "{name} has {bytes} bytes, 15 MB are allowed"
    );
    ensure!(
        name.contains("abi3"),
        "{name} is not for all CPythons (abi3)"
    );
    let mut twine = tools.python();
    twine.args(["-m", "twine", "check", "--strict"]).arg(&wheel);
    step("the wheel's description", &mut twine)?;
    for interpreter in &found {
        let fresh = folder.join(format!("wheel-3.{}", interpreter.minor));
        if fresh.exists() {
            fs::remove_dir_all(&fresh)?;
        }
        let environment = Environment::new(interpreter, &fresh)?;
        let path = wheel.to_string_lossy();
        if !environment.has(&[&path])? {
            bail!(
                "pip cannot install {name} on CPython 3.{}",
                interpreter.minor
            );
        }
        let script = "
import importlib.metadata as m, kinetostat as ks
print('installed:', ', '.join(sorted(d.name for d in m.distributions() if d.name not in ('pip', 'setuptools'))))
print(ks.Machine.preset('orthoglide').posture(position=[0, 0, 0]).deflected_by(ks.wrench([100, -20, -30])).displacement)
";
        let mut python = environment.python();
        // Not in the tree: what is tried is what was installed.
        python.args(["-c", script]);
        let status = python.current_dir(&fresh).status()?;
        ensure!(
            status.success(),
            "the wheel does not run on CPython 3.{}",
            interpreter.minor
        );
        let program = fresh.join("bin/kinetostat");
        let status = Command::new(&program).args(["--version"]).status();
        ensure!(status?.success(), "{} does not run", program.display());
    }
    Ok(())
}
