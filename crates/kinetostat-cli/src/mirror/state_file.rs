//! The file of the state: what `mirror` has written, and nothing else.
//!
//! Its first line is a digest of all others. A number that was changed by hand would be taken for a correction that the machine
//! was given, and every trial after it would mirror the difference.

use std::path::Path;

use kinetostat_mirror::MirrorState;
use serde::Deserialize;

use crate::files::hash::sha256;
use crate::files::input_files::InputFiles;
use crate::ui::failure::{Answer, Failure};

/// Name of the digest in the file.
const DIGEST: &str = "content_sha256";

/// A state with the digest that it was written with, if any: states of earlier versions have none.
#[derive(Deserialize)]
struct Digest {
    content_sha256: Option<String>,
}

pub(crate) fn read_state(files: &InputFiles, path: &Path) -> Answer<MirrorState> {
    let text = files.state(path)?;
    let of_file = |error: toml::de::Error| {
        let before = error.span().map_or(0, |span| span.start);
        let line = 1 + text.as_bytes()[..before]
            .iter()
            .filter(|b| **b == b'\n')
            .count();
        Failure::input(format!(
            "'{}', line {line}: this is no state of trials: {}; name the file that an earlier run wrote with --state",
            path.display(),
            error.message()
        ))
    };
    let digest: Digest = toml::from_str(&text).map_err(of_file)?;
    let state = toml::from_str(&text).map_err(of_file)?;
    match digest.content_sha256 {
        Some(written) if written != digest_of(&text) => Err(Failure::input(format!(
            "'{}': the file was changed after it was written ({DIGEST} is not that of its content), and corrections would no longer be those of the programs that were run; take a copy of it as it was, or begin with a new state (another --state, and the program without a correction as trial 1)",
            path.display()
        ))),
        _ => Ok(state),
    }
}

/// Digest of all lines but its own, whatever ends them: tools that copy a text change that.
fn digest_of(text: &str) -> String {
    let content = text.lines().filter(|line| !line.starts_with(DIGEST));
    let content: Vec<&str> = content.collect();
    sha256(content.join("\n").as_bytes())
}

pub(crate) fn state_text(state: &MirrorState) -> Answer<String> {
    let content = toml::to_string(state)
        .map_err(|error| Failure::input(format!("the state cannot be written: {error}")))?;
    Ok(format!("{DIGEST} = \"{}\"\n{content}", digest_of(&content)))
}
