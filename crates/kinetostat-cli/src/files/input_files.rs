//! Files that a command reads, with words for everything that can be wrong with them. The demo
//! reads its own files from memory before they are on disk.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{ErrorKind, Read};
use std::path::{Path, PathBuf};

use kinetostat_diagnostic::ErrorCode;
use kinetostat_model::{Model, preset_text, read_model};

use crate::files::file_kind::{FileKind, beginning, is_xml, refuse_other_kind};
use crate::files::standard_input;
use crate::ui::failure::{Answer, Failing};

/// Largest program or map that is read, bytes.
const MOST_BYTES: u64 = 512 << 20;

/// Largest file of settings, bytes: a job, a template, uncertainties, materials, tools. A table of TOML takes some thirty times its
/// length in memory.
const MOST_SETTINGS_BYTES: u64 = 1 << 20;

/// Largest state of trials, bytes; a state has seven numbers for each of its stations.
pub(crate) const MOST_STATE_BYTES: u64 = 16 << 20;

/// Largest model that is read from standard input, bytes: as of a file.
const MOST_MODEL_BYTES: u64 = 16 << 20;

/// Files on disk, and some that are not there yet.
#[derive(Clone, Debug, Default)]
pub(crate) struct InputFiles {
    memory: BTreeMap<PathBuf, Vec<u8>>,
}

impl InputFiles {
    /// Puts a file in front of the disk.
    pub(crate) fn insert(&mut self, path: PathBuf, bytes: impl Into<Vec<u8>>) {
        self.memory.insert(path, bytes.into());
    }

    /// The bytes of a file; `what` names its part in the question.
    pub(crate) fn bytes(&self, what: &str, path: &Path) -> Answer<Vec<u8>> {
        let bytes = self.at_most(what, path, MOST_BYTES)?;
        if what == "program" && may_be_other_kind(path, &bytes) {
            refuse_other_kind(path, &bytes, FileKind::Program)?;
        }
        Ok(bytes)
    }

    fn at_most(&self, what: &str, path: &Path, most: u64) -> Answer<Vec<u8>> {
        match self.memory.get(path) {
            Some(bytes) => Ok(bytes.clone()),
            None => read(what, path, most),
        }
    }

    /// A file of text; `what` names its part in the question.
    pub(crate) fn text(&self, what: &str, path: &Path) -> Answer<String> {
        text_in(what, path, self.bytes(what, path)?)
    }

    /// The text of a file that a person writes: at most 1 MB.
    pub(crate) fn settings(&self, what: &str, path: &Path) -> Answer<String> {
        text_in(what, path, self.at_most(what, path, MOST_SETTINGS_BYTES)?)
    }

    /// The text of a state of trials.
    pub(crate) fn state(&self, path: &Path) -> Answer<String> {
        text_in(
            "state",
            path,
            self.at_most("state", path, MOST_STATE_BYTES)?,
        )
    }

    /// A job file's text.
    pub(crate) fn job(&self, path: &Path) -> Answer<String> {
        let bytes = self.at_most("job file", path, MOST_SETTINGS_BYTES)?;
        refuse_other_kind(path, &bytes, FileKind::Job)?;
        let text = text_in("job file", path, bytes)?;
        if text.trim().is_empty() {
            return Err(ErrorCode::JobFile.failure(format!(
                "the job file '{}' is empty; start from the one that `kinetostat demo` writes",
                path.display()
            )));
        }
        Ok(text)
    }

    /// A model by the name of a preset or the path of a file. `base` is the directory that relative
    /// paths start from.
    pub(crate) fn model(&self, named: &str, base: &Path) -> Answer<(Model, Option<PathBuf>)> {
        if preset_text(named).is_some() {
            return Ok((Model::preset(named)?, None));
        }
        let path = base.join(named);
        if let Some(bytes) = self.memory.get(&path) {
            let text = String::from_utf8_lossy(bytes).into_owned();
            return Ok((Model::from_toml(&text, named)?, Some(path)));
        }
        if standard_input::is(&path) {
            let bytes = self.at_most("model", &path, MOST_MODEL_BYTES)?;
            refuse_other_kind(&path, &bytes, FileKind::Model)?;
            let text = text_in("model", &path, bytes)?;
            return Ok((Model::from_toml(&text, named)?, Some(path)));
        }
        let like_a_path = named.contains(['/', '\\', '.']) || path.exists();
        if like_a_path {
            let first = beginning(&path).unwrap_or_default();
            refuse_other_kind(&path, &first, FileKind::Model)?;
            return Ok((read_model(&path)?, Some(path)));
        }
        Ok((Model::preset(named)?, None))
    }
}

/// Memory that a line of a program takes while it is followed and written again, bytes: measured on lines of one motion.
const BYTES_OF_A_LINE: usize = 1000;

/// Refuses a program whose moves would not fit into memory: an allocation that fails later ends the process without a word.
pub(crate) fn refuse_beyond_memory(path: &Path, bytes: usize, lines: usize) -> Answer<()> {
    let needed = BYTES_OF_A_LINE
        .saturating_mul(lines)
        .saturating_add(2 * bytes);
    // The address space is asked for and given back; no page of it is touched.
    Vec::<u8>::new().try_reserve_exact(needed).map_err(|_| {
        ErrorCode::Memory.failure(format!(
            "the program '{}' has {lines} lines ({:.0} MB) and needs about {:.1} GB of memory, more than the system gives; divide it, or raise the limit of memory (ulimit -v)",
            path.display(),
            bytes as f64 * 1e-6,
            needed as f64 * 1e-9
        ))
    })
}

/// True of a program that may be a job, a model or a description of a robot instead. Any text is a program otherwise.
fn may_be_other_kind(path: &Path, bytes: &[u8]) -> bool {
    let ending = path.extension();
    let is_toml = ending.is_some_and(|ending| ending.eq_ignore_ascii_case("toml"));
    is_toml || standard_input::is(path) || is_xml(bytes)
}

/// Bytes that are text.
pub(crate) fn text_in(what: &str, path: &Path, bytes: Vec<u8>) -> Answer<String> {
    let refuse = |message: &str| {
        ErrorCode::FileNotRead.failure(format!("the {what} '{}' {message}", path.display()))
    };
    if bytes.starts_with(&[0xff, 0xfe]) || bytes.starts_with(&[0xfe, 0xff]) {
        return Err(refuse("is written in UTF-16; save it as UTF-8"));
    }
    if bytes.contains(&0) {
        return Err(refuse("is a binary file; name a file of text"));
    }
    let text = String::from_utf8(bytes).map_err(|error| {
        let before = &error.as_bytes()[..error.utf8_error().valid_up_to()];
        let line = 1 + before.iter().filter(|byte| **byte == b'\n').count();
        refuse(&format!(
            "is not UTF-8 text at line {line}; save it as UTF-8"
        ))
    })?;
    Ok(text.strip_prefix('\u{feff}').unwrap_or(&text).to_owned())
}

fn read(what: &str, path: &Path, most: u64) -> Answer<Vec<u8>> {
    let refuse = |message: &str| {
        ErrorCode::FileNotRead.failure(format!("the {what} '{}' {message}", path.display()))
    };
    let too_large = || {
        let most = most >> 20;
        refuse(&format!("is larger than {most} MB, which no {what} is"))
    };
    if standard_input::is(path) {
        let bytes = standard_input::beginning(most + 1)
            .map_err(|error| refuse(&format!("cannot be read: {error}")))?;
        return match bytes.len() as u64 > most {
            true => Err(too_large()),
            false => Ok(bytes),
        };
    }
    if path.is_dir() {
        return Err(refuse("is a directory; name a file in it"));
    }
    let file = File::open(path).map_err(|error| match error.kind() {
        ErrorKind::NotFound => refuse("does not exist; check the path"),
        ErrorKind::PermissionDenied => refuse("may not be read; ask for the right to read it"),
        ErrorKind::NotADirectory => {
            refuse("cannot be read: a part of the path is a file, not a directory")
        }
        _ => refuse(&format!("cannot be read: {error}")),
    })?;
    // The size that the system tells is checked first: nothing of a huge file is read.
    let told = file.metadata().map_or(0, |about| about.len());
    let mut bytes = Vec::new();
    if told <= most {
        file.take(most + 1)
            .read_to_end(&mut bytes)
            .map_err(|error| refuse(&format!("cannot be read: {error}")))?;
    }
    if told.max(bytes.len() as u64) > most {
        return Err(too_large());
    }
    Ok(bytes)
}
