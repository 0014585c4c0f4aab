//! `cargo xtask book`: the book as pages that need no network.

use std::path::PathBuf;

use anyhow::{Result, bail};

use crate::{cargo, root, step};

/// Builds the book into `book/book`; `--open` shows it.
///
/// # Errors
/// A formula that cannot be read, a page that refers to the network, or a word that is no option.
pub fn run(options: &[&str]) -> Result<()> {
    let open = match options {
        [] => false,
        ["--open"] => true,
        [other, ..] => bail!("'{other}' is no option of book; --open is"),
    };
    tool("book", "run")?;
    if open {
        let page = root().join("book/book/index.html");
        let program = match std::env::consts::OS {
            "macos" => "open",
            "windows" => "explorer",
            _ => "xdg-open",
        };
        step("open", std::process::Command::new(program).arg(page))?;
    }
    Ok(())
}

/// The book builds, and its tool's own tests pass.
///
/// # Errors
/// What does not.
pub fn check() -> Result<()> {
    tool("tests of the book's tool", "test")?;
    tool("book", "run")
}

/// The tool is a workspace of its own, so that nobody compiles mdBook to mill.
fn tool(title: &str, command: &str) -> Result<()> {
    let target =
        std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| root().join("target"), PathBuf::from);
    step(
        title,
        cargo()
            .args([command, "--quiet", "--locked"])
            .args(["--manifest-path", "book/tool/Cargo.toml"])
            .arg("--target-dir")
            .arg(target.join("book-tool")),
    )
}
