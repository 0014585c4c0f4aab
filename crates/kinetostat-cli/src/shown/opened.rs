//! What is shown, by its file: a job with its program, a model, a preset.

use std::path::Path;

use kinetostat_diagnostic::ErrorCode;

use crate::files::file_kind::FileKind;
use crate::files::input_files::InputFiles;
use crate::shown::answer::DroppedFile;
use crate::shown::path;
use crate::shown::session::Session;
use crate::ui::failure::{Answer, Failing};

/// Files that are opened together, and letters of their names.
const MOST_FILES: usize = 200;
const MOST_LETTERS: usize = 200;

impl Session {
    /// A preset, or what a file says that it is.
    pub(crate) fn open(named: &str) -> Answer<Self> {
        let path = Path::new(named);
        let session = match FileKind::of_file(path) {
            Some(FileKind::Job) => Self::of_job(path)?,
            _ => {
                let (model, path) = InputFiles::default().model(named, Path::new(""))?;
                Self {
                    named: named.to_owned(),
                    path,
                    model,
                    program: None,
                }
            }
        };
        session.model.require_stiffness()?;
        Ok(session)
    }

    /// The machine of a job along its program, which is compensated and not written.
    pub(crate) fn of_job(job: &Path) -> Answer<Self> {
        let (model, program) = path::of_job(job)?;
        Ok(Self {
            named: job.display().to_string(),
            path: Some(job.to_owned()),
            model,
            program: Some(program),
        })
    }

    /// Of files that came together without a folder, the job, or else the model. They are laid into a folder for as long as they are
    /// read, since a job and a program look for others beside themselves.
    pub(crate) fn of_dropped(files: &[DroppedFile]) -> Answer<Self> {
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
        let mut session = Self::open(&format!("{at}{name}")).map_err(|mut failure| {
            failure.plain = failure.plain.replace(&at, "");
            failure
        })?;
        session.named.clone_from(name);
        session.path = None;
        Ok(session)
    }
}
