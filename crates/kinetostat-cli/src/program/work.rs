//! Where a machine works along the program of a job: postures and loads at some of its places.

use std::path::Path;

use kinetostat::{Mechanism, PostureRequest};
use kinetostat_diagnostic::ErrorCode;
use kinetostat_identification::{Observation, Reading, TestLoad};
use kinetostat_machining::{ProgramPlace, Run, Task, WeightCorrection, analyse};
use kinetostat_model::Model;
use nalgebra::Vector3;

use crate::files::input_files::InputFiles;
use crate::job::arguments::{ProgramArgs, WritingFlags};
use crate::job::job_file::JobFile;
use crate::job::machine::MachineSetup;
use crate::job::of_model::machine_of;
use crate::job::program::read_program;
use crate::job::setting::setting;
use crate::machine::units::unit_of;
use crate::program::aim::Aim;
use crate::program::solve::{forces_of, with_task};
use crate::ui::failure::{Answer, Failing};
use crate::ui::progress::Progress;

/// About how many places of a program are looked at.
const PLACES: usize = 60;

/// A place on a cutting move, and what the machine does there.
pub(crate) struct WorkPlace {
    /// Length of the path up to here, mm.
    pub(crate) path_mm: f64,
    /// Commands and load; the readings are places of the tool's tip, or its displacement by the load where weights do not count.
    pub(crate) observation: Observation,
}

/// Places along the program of a job, with `model` (as `named`) in place of the job's.
pub(crate) fn work_of_job(job: &Path, named: &str, model: &Model) -> Answer<Vec<WorkPlace>> {
    let files = InputFiles::default();
    let job = JobFile::read(&files, job)?;
    let flags = ProgramArgs::default();
    let mut setting = setting(&files, Some(&job), &flags, &WritingFlags::default())?;
    let (machine, _) = machine_of(&mut setting, &files, Some(&job), Some(named), &flags)?;
    let read = read_program(&setting)?;
    let progress = Progress::new();
    let forces = forces_of(&machine, &setting, read.path(), &progress)?;
    let forces = forces.as_ref();
    let run = with_task(Aim::Analyse, &machine, &setting, &read, forces, |task| {
        let task = Task {
            places: PLACES,
            ..task.clone()
        };
        analyse(&task, &progress)
    })?;
    progress.finish();
    let run = run.map_err(|error| setting.within(error.into()))?;
    let loaded = run.places.iter().filter(|p| p.wrench.0.norm() > 0.0);
    let work: Vec<WorkPlace> = loaded
        .filter_map(|place| work_at(place, &run, &machine, &model.mechanism))
        .collect();
    match work.is_empty() {
        true => Err(setting.within(ErrorCode::ProgramUnsuited.failure(
            "the program has no cutting move under a load: nothing is known of where the machine works",
        ))),
        false => Ok(work),
    }
}

/// A place of a run as an observation of the model, whose tool may be another than the job's.
fn work_at(
    place: &ProgramPlace,
    run: &Run,
    machine: &MachineSetup,
    model: &Mechanism,
) -> Option<WorkPlace> {
    let mut points = run.points.iter();
    let point = points.find(|p| p.move_index == place.move_index && p.share == place.share)?;
    let limbs = machine.mechanism.limbs().iter();
    let drives = limbs.flat_map(|limb| limb.nominal.actuators());
    let commands: Vec<f64> = (drives.zip(&point.actuator_command))
        .map(|(drive, shown)| shown / unit_of(drive.kind))
        .collect();
    let posture = model.posture(PostureRequest::commands(&commands)).ok()?;
    let tip = posture.target().inverse() * place.programmed;
    let at = tip.translation.vector;
    Some(WorkPlace {
        path_mm: place.path_mm,
        observation: Observation {
            posture: format!("line {}", place.line),
            commands,
            load: TestLoad {
                force: place.wrench.0.fixed_rows::<3>(0).into_owned(),
                moment: place.wrench.0.fixed_rows::<3>(3).into_owned(),
                at: at.into(),
            },
            branch: None,
            // The tool belongs where it is programmed if all of the machine's own error counts.
            readings: match machine.weight {
                WeightCorrection::All => {
                    Reading::place(at, &place.programmed.translation.vector, 1.0).into()
                }
                _ => Reading::displacement(at, &Vector3::zeros(), 1.0).into(),
            },
        },
    })
}
