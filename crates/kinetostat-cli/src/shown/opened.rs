//! What is shown, by its file: a job with its program, a model, a preset.

use std::path::Path;

use crate::files::file_kind::FileKind;
use crate::files::input_files::InputFiles;
use crate::shown::path;
use crate::shown::session::Session;
use crate::ui::failure::Answer;

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
}
