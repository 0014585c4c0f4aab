//! What is to be said of a run whatever its result: of its model and of its job file.

use kinetostat_machining::Warning;
use kinetostat_model::Model;

use crate::job::job_file::JobFile;
use crate::machine::model_warnings::{no_potential, of_model};

/// What looks wrong in the model, what cannot be assessed of it, and angles of the job file in the wrong unit.
pub(crate) fn of_run(model: &Model, job: Option<&JobFile>) -> Vec<Warning> {
    let mut warnings: Vec<Warning> = of_model(model).collect();
    warnings.extend(no_potential(&model.mechanism));
    warnings.extend(job.into_iter().flat_map(JobFile::odd_angles));
    warnings
}
