//! The program of the next trial.

use kinetostat_machining::{FieldCorrection, RunError, correct_by_field, with_model_field};
use kinetostat_mirror::{MirrorField, SumOfFields};

use crate::job::machine::MachineSetup;
use crate::job::program::ReadProgram;
use crate::job::setting::Setting;
use crate::program::aim::Aim;
use crate::program::solve::{forces_of, with_task};
use crate::ui::failure::{Answer, Failure};
use crate::ui::progress::Progress;

/// The program with its correction, on top of a model's where there is one.
pub(crate) fn written(
    machine: Option<&MachineSetup>,
    setting: &Setting,
    read: &ReadProgram<'_>,
    field: &MirrorField<'_>,
) -> Answer<FieldCorrection> {
    let progress = Progress::new();
    let refuse = |error: RunError| setting.within(Failure::from(error));
    let Some(machine) = machine else {
        let mut writing = setting.writing.clone();
        if let Some(header) = &mut writing.header {
            *header = vec![
                format!("version {}", env!("CARGO_PKG_VERSION")),
                "corrections from measured points".to_owned(),
            ];
        }
        let made = read.with(|program| correct_by_field(program, field, &writing, &progress));
        progress.finish();
        return made.map_err(|error| refuse(RunError::Write(error)));
    };
    let forces = forces_of(machine, setting, read.path(), &progress)?;
    let made = with_task(
        Aim::Compensate,
        machine,
        setting,
        read,
        forces.as_ref(),
        |task| {
            with_model_field(task, &progress, |model| {
                let both = SumOfFields {
                    model,
                    mirror: field,
                };
                correct_by_field(task.program, &both, &task.writing, &progress)
            })
        },
    )?;
    progress.finish();
    made.map_err(refuse)?
        .map_err(|error| refuse(RunError::Write(error)))
}
