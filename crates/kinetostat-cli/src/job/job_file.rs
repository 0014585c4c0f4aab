//! A job file that has been read, with its text for messages.

use std::path::{Path, PathBuf};

use kinetostat_diagnostic::ErrorCode;
use kinetostat_machining::{Warning, WarningCode};
use serde_spanned::Spanned;

use crate::files::input_files::InputFiles;
use crate::job::format::Job;
use crate::job::source::Source;
use crate::job::target_word::RobotWord;
use crate::ui::failure::{Answer, Failing, Failure};

/// A job file that has been read: its text is kept for messages.
#[derive(Clone, Debug)]
pub(crate) struct JobFile {
    pub(crate) path: PathBuf,
    pub(crate) text: String,
    pub(crate) job: Job,
    /// Keys that were left out because they are wrong, where the rest is looked at.
    pub(crate) left_out: Vec<String>,
    /// True while faults are collected: the program is not run once and written flat then.
    pub(crate) is_searched: bool,
}

impl JobFile {
    pub(crate) fn read(files: &InputFiles, path: &Path) -> Answer<Self> {
        let text = files.job(path)?;
        let name = path.display().to_string();
        let job = Job::read(Source {
            file: &name,
            text: &text,
        })?;
        Ok(Self {
            path: path.to_owned(),
            text,
            job,
            left_out: Vec::new(),
            is_searched: false,
        })
    }

    /// The language in which the compensated program is written, where it is another one.
    pub(crate) fn to(&self) -> Option<RobotWord> {
        Some(*self.job.robot.as_ref()?.get_ref().to.as_ref()?.get_ref())
    }

    /// Angles in it that were most likely written in the other unit.
    pub(crate) fn odd_angles(&self) -> Vec<Warning> {
        let file = self.path.display().to_string();
        let source = Source {
            file: &file,
            text: &self.text,
        };
        let found = kinetostat_model::odd_angles(&self.text).into_iter();
        found
            .map(|(span, message)| {
                Warning::at_line(WarningCode::OddPlacement, source.line(span), message)
                    .of_file(file.clone())
            })
            .collect()
    }

    /// True if a key is missing because it was left out.
    pub(crate) fn lacks(&self, key: &str) -> bool {
        self.left_out.iter().any(|left_out| left_out == key)
    }

    /// Directory that the job's relative paths start from.
    pub(crate) fn base(&self) -> PathBuf {
        self.path.parent().map(Path::to_owned).unwrap_or_default()
    }

    pub(crate) fn error<T>(&self, at: &Spanned<T>, message: &str, help: &str) -> Failure {
        Source {
            file: &self.path.display().to_string(),
            text: &self.text,
        }
        .error(at.span(), message, help)
    }
}

/// Model name, and the base folder of a relative path: of the command line, or of the job file.
pub(crate) fn model_named(
    job: Option<&JobFile>,
    flag_model: Option<&str>,
) -> Answer<(String, PathBuf)> {
    let table = job.and_then(|j| j.job.model.as_ref());
    match (flag_model, table) {
        (Some(named), _) => Ok((named.to_owned(), PathBuf::new())),
        (None, Some(named)) => Ok((
            named.get_ref().clone(),
            job.map(JobFile::base).unwrap_or_default(),
        )),
        (None, None) => Err(ErrorCode::Missing.failure(match job {
            Some(j) => format!(
                "the job file '{}' names no model; write  model = \"orthoglide\"  at its top, or give --model MODEL",
                j.path.display()
            ),
            None => "no model is named; give a job file, or --model MODEL (a preset or a file); the presets are listed by `kinetostat model list`".to_owned(),
        })),
    }
}
