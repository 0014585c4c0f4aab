//! Warnings about a run whatever its result: about its model and its job file.

use kinetostat_machining::{Warning, WarningCode};
use kinetostat_model::{Model, odd_angles};

use crate::job::arguments::ProgramArgs;
use crate::job::job_file::JobFile;
use crate::machine::model_warnings::{no_potential, of_model};

/// Warnings about faults of the model, effects that are not assessed, and angles in the wrong unit.
pub(crate) fn of_run(model: &Model, job: Option<&JobFile>, flags: &ProgramArgs) -> Vec<Warning> {
    let mut warnings: Vec<Warning> = of_model(model).collect();
    warnings.extend(no_potential(&model.mechanism));
    warnings.extend(job.into_iter().flat_map(JobFile::odd_angles));
    for text in [&flags.part_orientation, &flags.tool_orientation] {
        let of_option = text.as_deref().and_then(|text| text.split_once('='));
        let as_in_job = of_option.map(|(name, numbers)| format!("{name} = [{numbers}]"));
        let found = odd_angles(&as_in_job.unwrap_or_default()).into_iter();
        warnings.extend(found.map(|(_, said)| Warning::new(WarningCode::OddPlacement, said)));
    }
    warnings
}
