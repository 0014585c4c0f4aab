//! Selection of the model of a run.

use std::path::PathBuf;

use crate::job::job_file::JobFile;
use crate::ui::failure::{Answer, Failure};

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
        (None, None) => Err(Failure::input(match job {
            Some(j) => format!(
                "the job file '{}' names no model; write  model = \"orthoglide\"  at its top, or give --model MODEL",
                j.path.display()
            ),
            None => "no model is named; give a job file, or --model MODEL (a preset or a file); the presets are listed by `kinetostat model list`".to_owned(),
        })),
    }
}
