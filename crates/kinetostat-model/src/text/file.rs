//! Reading a model from disk.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use crate::problem::{ModelError, Problem};

/// Longer texts are refused, bytes.
pub(crate) const MOST_BYTES: usize = 16 * 1024 * 1024;

/// The text of a file that may be a model; `file` names it in messages.
pub(crate) fn read_text(path: &Path, file: &str) -> Result<String, ModelError> {
    let refuse = |message: String, help: &str| {
        ModelError::new(vec![Problem::without_text(file, message, help.into())])
    };
    if path.is_dir() {
        return Err(refuse(
            "this is a directory, not a model file".into(),
            "name the .toml file in it",
        ));
    }
    let bytes = read(path).map_err(|e| {
        let (message, help) = match e.kind() {
            std::io::ErrorKind::NotFound => (
                "there is no such file".to_owned(),
                "check the path; the presets are listed by: kinetostat model list",
            ),
            std::io::ErrorKind::PermissionDenied => (
                "the file may not be read".to_owned(),
                "ask for the right to read it",
            ),
            _ => (format!("the file cannot be read: {e}"), "check the path"),
        };
        refuse(message, help)
    })?;
    let Some(bytes) = bytes else {
        return Err(refuse(
            "the file is larger than 16 MB, which no model file is".into(),
            "name a model file in TOML",
        ));
    };
    if bytes.starts_with(&[0xff, 0xfe]) || bytes.starts_with(&[0xfe, 0xff]) {
        return Err(refuse(
            "the file is written in UTF-16".into(),
            "save it as UTF-8",
        ));
    }
    let text = String::from_utf8(bytes).map_err(|e| {
        let at = e.utf8_error().valid_up_to();
        let before = &e.as_bytes()[..at];
        if before.contains(&0) || e.as_bytes().contains(&0) {
            return refuse(
                "this is a binary file, not a model file".into(),
                "name a model file in TOML",
            );
        }
        let line = before.iter().filter(|b| **b == b'\n').count() + 1;
        refuse(
            format!(
                "the file is not UTF-8 text: line {line} holds the byte {:#04x}",
                e.as_bytes()[at]
            ),
            "save it as UTF-8; umlauts and accents of older encodings look like this",
        )
    })?;
    if text.contains('\0') {
        return Err(refuse(
            "this is a binary file, not a model file".into(),
            "name a model file in TOML",
        ));
    }
    Ok(text)
}

/// The bytes of a file, or nothing where there are more than a model has. The size that the system
/// tells is checked first: nothing of a huge file is read.
fn read(path: &Path) -> std::io::Result<Option<Vec<u8>>> {
    let file = File::open(path)?;
    if file.metadata()?.len() > MOST_BYTES as u64 {
        return Ok(None);
    }
    let mut bytes = Vec::new();
    file.take(MOST_BYTES as u64 + 1).read_to_end(&mut bytes)?;
    Ok((bytes.len() <= MOST_BYTES).then_some(bytes))
}
