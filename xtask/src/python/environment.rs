//! Environments for the package, in the target directory.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use anyhow::{Context, Result, bail};

use super::interpreter::Interpreter;
use crate::root;

/// Folder of environments, wheels and locales.
pub fn folder() -> PathBuf {
    let target =
        std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| root().join("target"), PathBuf::from);
    target.join("python")
}

/// A virtual environment.
pub struct Environment {
    path: PathBuf,
    /// Version of its Python.
    pub version: String,
}

impl Environment {
    /// With all that the tests need; it is kept from run to run. `None` if pip cannot install it.
    pub fn with_test_tools(python: &Interpreter) -> Result<Option<Self>> {
        let own = Self::kept(python, "tests")?;
        // The pip that comes with an old Python knows no groups of dependencies.
        let fresh = own.pip(&["install", "--upgrade", "pip"])?;
        Ok((fresh && own.pip(&["install", "--group", "test"])?).then_some(own))
    }

    /// A fresh one with numpy alone; `None` if pip cannot install that.
    pub fn bare(python: &Interpreter) -> Result<Option<Self>> {
        let own = Self::fresh(python, "bare")?;
        Ok(own.pip(&["install", "numpy"])?.then_some(own))
    }

    /// A fresh one with nothing.
    pub fn fresh(python: &Interpreter, name: &str) -> Result<Self> {
        let path = Self::path_of(python, name);
        if path.exists() {
            std::fs::remove_dir_all(&path)
                .with_context(|| format!("cannot remove {}", path.display()))?;
        }
        Self::kept(python, name)
    }

    fn path_of(python: &Interpreter, name: &str) -> PathBuf {
        folder().join(format!("{name}-{python}"))
    }

    fn kept(python: &Interpreter, name: &str) -> Result<Self> {
        let path = Self::path_of(python, name);
        let own = Self {
            version: python.to_string(),
            path,
        };
        let works = || {
            let said = own.python().args(["-m", "pip", "--version"]).output();
            said.is_ok_and(|output| output.status.success())
        };
        if !works() {
            let made = Command::new(&python.program)
                .args(["-m", "venv", "--clear"])
                .arg(&own.path)
                .output()
                .with_context(|| format!("cannot start {}", python.program.display()))?;
            if !made.status.success() {
                bail!(
                    "venv of Python {python} failed: {}",
                    String::from_utf8_lossy(&made.stderr)
                );
            }
        }
        Ok(own)
    }

    /// Interpreter of the environment, without settings of the caller that name other packages.
    pub fn python(&self) -> Command {
        let mut command = Command::new(self.path.join("bin/python"));
        command
            .env_remove("PYTHONPATH")
            .env_remove("PYTHONHOME")
            .env("VIRTUAL_ENV", &self.path)
            .current_dir(root());
        command
    }

    /// Runs pip; false, with its last lines shown, where it fails.
    pub fn pip(&self, words: &[&str]) -> Result<bool> {
        let done = self
            .python()
            .args(["-m", "pip", "--quiet", "--disable-pip-version-check"])
            .args(words)
            .stdin(Stdio::null())
            .output()
            .context("cannot start pip")?;
        if !done.status.success() {
            let said = String::from_utf8_lossy(&done.stderr);
            let lines: Vec<&str> = said.lines().collect();
            eprintln!("{}", lines[lines.len().saturating_sub(6)..].join("\n"));
        }
        Ok(done.status.success())
    }

    /// Installs a wheel without what it depends on, in place of one that is there.
    pub fn install(&self, wheel: &Path) -> Result<()> {
        let wheel = wheel.display().to_string();
        match self.pip(&[
            "install",
            "--no-deps",
            "--no-index",
            "--force-reinstall",
            &wheel,
        ])? {
            true => Ok(()),
            false => bail!("pip of Python {} could not install {wheel}", self.version),
        }
    }

    /// Itself, with a wheel installed.
    pub fn holding(self, wheel: &Path) -> Result<Self> {
        self.install(wheel)?;
        Ok(self)
    }
}
