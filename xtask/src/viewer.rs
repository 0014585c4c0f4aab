//! `cargo xtask viewer`: the page of `kinetostat view`, built from its sources and tried in a browser.

use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, bail};

use crate::{cargo, root, step};

/// Version with which the server was tried.
const SCHEMATHESIS: &str = "schemathesis==4.32.5";

/// Builds the page into the repository; `--check` builds it and compares the bytes, then tries it in Chromium.
///
/// # Errors
/// No Node, sources that do not compile, a page that is another one than that of the repository, or one that does not work.
pub fn run(options: &[&str]) -> Result<()> {
    let check = match options {
        [] => false,
        ["--check"] => true,
        [other, ..] => bail!("'{other}' is no option of viewer; --check is"),
    };
    let crate_ = root().join("crates/kinetostat-view");
    let (sources, page) = (crate_.join("page"), crate_.join("bundle/index.html"));
    let before = std::fs::read(&page).with_context(|| page.display().to_string())?;
    step(
        "packages of the page",
        npm(&sources).args(["ci", "--no-audit", "--no-fund"]),
    )?;
    step("page of the view", npm(&sources).args(["run", "build"]))?;
    if !check {
        return Ok(());
    }
    if std::fs::read(&page)? != before {
        bail!(
            "bundle/index.html is not what its sources make: commit it after `cargo xtask viewer`"
        );
    }
    step(
        "command for the page",
        cargo().args(["build", "--workspace", "--quiet", "--bins"]),
    )?;
    let target =
        std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| root().join("target"), Into::into);
    let mut test = npm(&sources);
    test.arg("test")
        .env("KINETOSTAT", target.join("debug/kinetostat"));
    if let Some(schemathesis) = schemathesis(&target)? {
        test.env("SCHEMATHESIS", schemathesis);
    }
    step("page in a browser", &mut test)
}

/// The program that sends requests of every kind, in an environment of its own; none where Python cannot install it.
fn schemathesis(target: &Path) -> Result<Option<PathBuf>> {
    let own = target.join("python/schemathesis");
    let found = own.join("bin/schemathesis");
    if !found.is_file() {
        let mut python = Command::new("python3");
        python.args(["-m", "venv"]).arg(&own);
        let mut pip = Command::new(own.join("bin/pip"));
        pip.args(["install", "--quiet", SCHEMATHESIS]);
        let installed = [&mut python, &mut pip]
            .into_iter()
            .all(|command| command.status().is_ok_and(|status| status.success()));
        if !installed {
            eprintln!("SKIPPED: requests of every kind, schemathesis could not be installed");
            return Ok(None);
        }
    }
    Ok(Some(found))
}

fn npm(folder: &Path) -> Command {
    let mut command = Command::new("npm");
    // Steps run from the root.
    command.arg("--prefix").arg(folder);
    command
}
