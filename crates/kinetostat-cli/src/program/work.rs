//! Where a machine works along the program of a job: postures and loads at some of its places.

use std::path::Path;

use kinetostat::Mechanism;
use kinetostat_diagnostic::ErrorCode;
use kinetostat_identification::{Observation, Reading, TestLoad};
use kinetostat_machining::{ProgramPlace, WeightCorrection};
use kinetostat_model::Model;
use nalgebra::Vector3;

use crate::program::aim::Aim;
use crate::program::places::JobRun;
use crate::ui::failure::{Answer, Failing};

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
    let of_job = JobRun::of(job, Some(named), Aim::Analyse, PLACES)?;
    let places = of_job.run.places.iter();
    let work: Vec<WorkPlace> = places
        .filter(|place| place.wrench.0.norm() > 0.0)
        .filter_map(|place| work_at(place, &of_job, &model.mechanism))
        .collect();
    match work.is_empty() {
        true => Err(of_job.setting.within(ErrorCode::ProgramUnsuited.failure(
            "the program has no cutting move under a load: nothing is known of where the machine works",
        ))),
        false => Ok(work),
    }
}

/// A place of a run as an observation of the model, whose tool may be another than the job's.
fn work_at(place: &ProgramPlace, of_job: &JobRun, model: &Mechanism) -> Option<WorkPlace> {
    let standing = of_job.standing_at(place, model)?;
    let at = standing.tip.translation.vector;
    Some(WorkPlace {
        path_mm: place.path_mm,
        observation: Observation {
            posture: format!("line {}", place.line),
            commands: standing.commands,
            load: TestLoad {
                force: place.wrench.force(),
                moment: place.wrench.moment(),
                at: at.into(),
            },
            branch: None,
            // The tool belongs where it is programmed if all of the machine's own error counts.
            readings: match of_job.machine.weight {
                WeightCorrection::All => {
                    Reading::place(at, &place.programmed.translation.vector, 1.0).into()
                }
                _ => Reading::displacement(at, &Vector3::zeros(), 1.0).into(),
            },
        },
    })
}
