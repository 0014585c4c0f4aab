//! The path of a job's program as the page shows it: errors before and after compensation, and the machine at each place.

use std::path::Path;

use kinetostat::{Mechanism, Pose, PostureRequest, Wrench};
use kinetostat_machining::{ProgramPlace, Run, Task, compensate_program};
use kinetostat_model::Model;
use nalgebra::Vector3;

use crate::files::input_files::InputFiles;
use crate::job::arguments::{ProgramArgs, WritingFlags};
use crate::job::job_file::JobFile;
use crate::job::of_model::machine_of;
use crate::job::program::read_program;
use crate::job::setting::setting;
use crate::machine::units::unit_of;
use crate::program::aim::Aim;
use crate::program::solve::{forces_of, with_task};
use crate::program::summary;
use crate::ui::failure::{Answer, Failure};
use crate::ui::progress::Progress;
use crate::view::answer::{PathAnswer, PlaceOnPath};

/// Places of a path that are shown, about.
const PLACES: usize = 1500;

/// A place of the path, and what the machine does there.
pub(super) struct ShownPlace {
    line: usize,
    path_mm: f64,
    position: Vector3<f64>,
    error_before_mm: f64,
    error_after_mm: f64,
    /// Commands of the program as it is, m or rad.
    pub(super) commands: Vec<f64>,
    /// From the machine's tool to the tip of the tool of this place.
    pub(super) tip: Pose,
    pub(super) wrench: Wrench,
}

/// A program with its places.
pub(super) struct ShownPath {
    program: String,
    text: String,
    tolerance_mm: Option<f64>,
    headline: Vec<String>,
    pub(super) places: Vec<ShownPlace>,
}

/// Reads a job, compensates its program without writing it, and keeps what is shown: model with the job's tool, and path.
pub(super) fn of_job(job: &Path) -> Answer<(Model, ShownPath)> {
    let files = InputFiles::default();
    let job = JobFile::read(&files, job)?;
    let flags = ProgramArgs::default();
    let mut setting = setting(&files, Some(&job), &flags, &WritingFlags::default())?;
    let (machine, mut model) = machine_of(&mut setting, &files, Some(&job), None, &flags)?;
    let read = read_program(&setting)?;
    let progress = Progress::new();
    let forces = forces_of(&machine, &setting, read.path(), &progress)?;
    let run = with_task(
        Aim::Compensate,
        &machine,
        &setting,
        &read,
        forces.as_ref(),
        |task| {
            let task = Task {
                places: PLACES,
                ..task.clone()
            };
            compensate_program(&task, &progress)
        },
    )?;
    progress.finish();
    let run = run.map_err(|error| setting.within(Failure::from(error)))?;
    model.mechanism = machine.mechanism.clone();
    let places = run.places.iter();
    let path = ShownPath {
        program: setting.program_name.clone(),
        text: String::from_utf8_lossy(&setting.program).into_owned(),
        tolerance_mm: Some(run.result.tolerance.allowed_mm),
        headline: summary::of_run(&run.result)
            .lines()
            .map(str::to_owned)
            .collect(),
        places: places
            .filter_map(|place| shown(place, &run, &machine.mechanism))
            .collect(),
    };
    Ok((model, path))
}

fn shown(place: &ProgramPlace, run: &Run, mechanism: &Mechanism) -> Option<ShownPlace> {
    let mut points = run.points.iter();
    let point = points.find(|p| p.move_index == place.move_index && p.share == place.share)?;
    let drives = mechanism
        .limbs()
        .iter()
        .flat_map(|limb| limb.nominal.actuators());
    let commands: Vec<f64> = (drives.zip(&point.actuator_command))
        .map(|(drive, shown)| shown / unit_of(drive.kind))
        .collect();
    let posture = mechanism
        .posture(PostureRequest::commands(&commands))
        .ok()?;
    Some(ShownPlace {
        line: place.line,
        path_mm: place.path_mm,
        position: place.programmed.translation.vector,
        error_before_mm: place.error_before_mm,
        error_after_mm: place.error_after_mm,
        tip: posture.target().inverse() * place.programmed,
        commands,
        wrench: place.wrench,
    })
}

impl ShownPath {
    pub(super) fn answer(&self) -> PathAnswer {
        let place = |p: &ShownPlace| PlaceOnPath {
            line: p.line,
            path_mm: p.path_mm,
            time_s: None,
            position_mm: (p.position * 1e3).into(),
            force_n: p.wrench.force().into(),
            error_before_mm: p.error_before_mm,
            error_after_mm: Some(p.error_after_mm),
        };
        PathAnswer {
            program: self.program.clone(),
            text: self.text.clone(),
            places: self.places.iter().map(place).collect(),
            tolerance_mm: self.tolerance_mm,
            headline: self.headline.clone(),
        }
    }
}
