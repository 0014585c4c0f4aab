//! The CPythons of this machine.

use std::collections::BTreeMap;
use std::fmt;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// The first that the package supports.
const OLDEST: (u32, u32) = (3, 10);

/// Names beyond this are not tried.
const NEWEST_NAME: u32 = 20;

/// A CPython.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Interpreter {
    pub program: PathBuf,
    pub version: (u32, u32),
}

impl fmt::Display for Interpreter {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}.{}", self.version.0, self.version.1)
    }
}

/// The oldest that the package supports, and the newest where it is another one.
pub fn ends() -> Option<(Interpreter, Option<Interpreter>)> {
    let mut found = BTreeMap::new();
    for program in candidates() {
        if let Some(python) = asked(&program) {
            found.entry(python.version).or_insert(python);
        }
    }
    let oldest = found.pop_first()?.1;
    Some((oldest, found.pop_last().map(|(_, python)| python)))
}

/// Names on the path first, then versions that pyenv keeps.
fn candidates() -> Vec<PathBuf> {
    let mut all = vec![PathBuf::from("python3")];
    all.extend((OLDEST.1..=NEWEST_NAME).map(|minor| PathBuf::from(format!("python3.{minor}"))));
    let pyenv = std::env::var_os("PYENV_ROOT")
        .map(PathBuf::from)
        .or_else(|| Some(PathBuf::from(std::env::var_os("HOME")?).join(".pyenv")));
    let versions = pyenv.and_then(|root| std::fs::read_dir(root.join("versions")).ok());
    all.extend(
        versions
            .into_iter()
            .flatten()
            .flatten()
            .map(|entry| entry.path().join("bin/python3")),
    );
    all
}

/// Description that a program gives of itself; `None` if it is no CPython of a supported version that can make
/// environments.
fn asked(program: &Path) -> Option<Interpreter> {
    const QUESTION: &str = "import sys, platform, venv, ensurepip; \
        print(platform.python_implementation(), sys.version_info.releaselevel, *sys.version_info[:2], sys.executable)";
    let answer = Command::new(program)
        .args(["-c", QUESTION])
        .stderr(Stdio::null())
        .stdin(Stdio::null())
        .output()
        .ok()?;
    answer.status.success().then_some(())?;
    read(&String::from_utf8_lossy(&answer.stdout))
}

fn read(answer: &str) -> Option<Interpreter> {
    let mut words = answer.trim().splitn(5, ' ');
    let mut next = || words.next();
    (next()? == "CPython" && next()? == "final").then_some(())?;
    let version = (next()?.parse().ok()?, next()?.parse().ok()?);
    let program = PathBuf::from(next()?);
    (version >= OLDEST).then_some(Interpreter { program, version })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_released_cpythons_that_the_package_supports_count() {
        let python = read("CPython final 3 10 /opt/my python/bin/python3\n").expect("one");
        assert_eq!(python.version, (3, 10));
        assert_eq!(python.program, PathBuf::from("/opt/my python/bin/python3"));
        assert_eq!(python.to_string(), "3.10");
        for other in [
            "CPython final 3 9 /p",
            "PyPy final 3 10 /p",
            "CPython alpha 3 15 /p",
            "",
            "3.10",
        ] {
            assert_eq!(read(other), None, "{other}");
        }
    }
}
