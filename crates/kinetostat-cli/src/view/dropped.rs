//! Files that are dropped onto the page.

use std::path::Path;

use kinetostat_diagnostic::ErrorCode;
use schemars::JsonSchema;
use serde::Deserialize;

use crate::files::file_kind::FileKind;
use crate::shown::session::Session;
use crate::ui::failure::{Answer, Failing};

/// Files that are opened together, and letters of their names.
const MOST_FILES: usize = 200;
const MOST_LETTERS: usize = 200;

/// Files that were dropped onto the page.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct OpenRequest {
    pub(super) files: Vec<DroppedFile>,
}

/// A file of text.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct DroppedFile {
    name: String,
    text: String,
}

/// The job of files that came together without a folder, or else the model. They are laid into a folder for as long as they are read,
/// since a job and a program look for others beside themselves.
pub(super) fn session_of(files: &[DroppedFile]) -> Answer<Session> {
    let folder = tempfile::tempdir().map_err(|error| ErrorCode::Output.failure(error))?;
    if files.len() > MOST_FILES {
        return Err(ErrorCode::Value.failure(format!("at most {MOST_FILES} files at once")));
    }
    let mut subjects = [None, None];
    for file in files {
        let path = Path::new(&file.name);
        let is_plain = path.file_name().is_some_and(|own| own == path.as_os_str());
        if !is_plain || file.name.len() > MOST_LETTERS {
            return Err(
                ErrorCode::Value.failure(format!("'{}' is no name of a file alone", file.name))
            );
        }
        std::fs::write(folder.path().join(path), &file.text)
            .map_err(|error| ErrorCode::Output.failure(error))?;
        match FileKind::of(path, file.text.as_bytes()) {
            Some(FileKind::Job) => subjects[0] = Some(&file.name),
            Some(FileKind::Model) => subjects[1] = Some(&file.name),
            _ => (),
        }
    }
    let Some(name) = subjects.into_iter().flatten().next() else {
        return Err(ErrorCode::Missing.failure(
                "none of these files is a job or a model: a program alone says neither machine nor place; drop its job file, its model and the program together, or begin with `kinetostat start`",
            ));
    };
    // Messages name the files as they are called where they come from.
    let at = format!("{}/", folder.path().display());
    let mut session = Session::open(&format!("{at}{name}")).map_err(|mut failure| {
        failure.plain = failure.plain.replace(&at, "");
        failure
    })?;
    session.named.clone_from(name);
    session.path = None;
    Ok(session)
}
