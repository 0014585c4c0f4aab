//! The path of a job's program as the page shows it: errors before and after compensation, and the machine at each place.

use std::path::Path;

use kinetostat::Wrench;
use kinetostat_machining::ProgramPlace;
use kinetostat_model::Model;

use crate::program::aim::Aim;
use crate::program::places::{JobRun, Standing};
use crate::program::summary;
use crate::ui::failure::Answer;
use crate::view::answer::{PathAnswer, PlaceOnPath};

/// Places of a path that are shown, about.
const PLACES: usize = 1500;

/// The machine at a place of the path, under the load there.
pub(super) struct AtPlace {
    pub(super) standing: Standing,
    pub(super) wrench: Wrench,
}

/// A program with its places.
pub(super) struct ShownPath {
    pub(super) answer: PathAnswer,
    /// One for each place of the answer.
    pub(super) places: Vec<AtPlace>,
}

/// Reads a job, compensates its program without writing it, and keeps what is shown: model with the job's tool, and path.
pub(super) fn of_job(job: &Path) -> Answer<(Model, ShownPath)> {
    let mut of_job = JobRun::of(job, None, Aim::Compensate, PLACES)?;
    let mechanism = of_job.machine.mechanism.clone();
    let shown = |place: &ProgramPlace| {
        let at = AtPlace {
            standing: of_job.standing_at(place, &mechanism)?,
            wrench: place.wrench,
        };
        Some((at, place_on_path(place)))
    };
    let (places, on_path): (Vec<_>, Vec<_>) = of_job.run.places.iter().filter_map(shown).unzip();
    of_job.model.mechanism = mechanism;
    let (setting, result) = (&of_job.setting, &of_job.run.result);
    let answer = PathAnswer {
        program: setting.program_name.clone(),
        text: String::from_utf8_lossy(&setting.program).into_owned(),
        places: on_path,
        tolerance_mm: result.tolerance.allowed_mm,
        headline: summary::of_run(result).lines().map(str::to_owned).collect(),
    };
    Ok((of_job.model, ShownPath { answer, places }))
}

fn place_on_path(place: &ProgramPlace) -> PlaceOnPath {
    PlaceOnPath {
        line: place.line,
        path_mm: place.path_mm,
        position_mm: (place.programmed.translation.vector * 1e3).into(),
        force_n: place.wrench.force().into(),
        error_before_mm: place.error_before_mm,
        error_after_mm: place.error_after_mm,
    }
}
