//! A run along the program of a job for its places: where the machine stands at each of them. Nothing is written, and uncertain
//! numbers count as they are.

use std::path::Path;

use kinetostat::{Mechanism, Pose, PostureRequest};
use kinetostat_machining::{ProgramPlace, Run, StockAlong};
use kinetostat_model::Model;

use crate::files::input_files::InputFiles;
use crate::job::arguments::{ProgramArgs, WritingFlags};
use crate::job::job_file::JobFile;
use crate::job::machine::MachineSetup;
use crate::job::of_model::machine_of;
use crate::job::program::read_program;
use crate::job::setting::{Setting, setting};
use crate::machine::units::unit_of;
use crate::program::aim::Aim;
use crate::program::solve::solve;
use crate::ui::failure::Answer;

/// A run along the program of a job.
pub(crate) struct JobRun {
    pub(crate) job: JobFile,
    pub(crate) setting: Setting,
    pub(crate) machine: MachineSetup,
    pub(crate) model: Model,
    /// The run, with some of its places on cutting moves.
    pub(crate) run: Run,
    /// The stock as the program removes it, where the job has one.
    pub(crate) stock: Option<StockAlong>,
}

/// The machine at a place.
pub(crate) struct Standing {
    /// Commands of the program as it is, m or rad.
    pub(crate) commands: Vec<f64>,
    /// Tool of the mechanism from the tip of the tool of the place.
    pub(crate) tip: Pose,
}

impl JobRun {
    /// Runs the program of a job, with the model that is `named` in place of the job's, and keeps about so many places.
    pub(crate) fn of(job: &Path, named: Option<&str>, aim: Aim, places: usize) -> Answer<Self> {
        let files = InputFiles::default();
        let job = JobFile::read(&files, job)?;
        let flags = ProgramArgs::default();
        let mut setting = setting(&files, Some(&job), &flags, &WritingFlags::default())?;
        let (machine, model) = machine_of(&mut setting, &files, Some(&job), named, &flags)?;
        setting.places = places;
        setting.uncertain = None;
        if aim == Aim::Analyse {
            setting.chatter = None;
        }
        let run = solve(aim, &machine, &model, &setting, None)?;
        let stock = match &machine.cut {
            Some(cut) => StockAlong::of(&cut.question, read_program(&setting)?.path()),
            None => None,
        };
        Ok(Self {
            job,
            setting,
            machine,
            model,
            run,
            stock,
        })
    }

    /// The machine at a place, by its commands there; `mechanism` may have another tool than the job's.
    pub(crate) fn standing_at(
        &self,
        place: &ProgramPlace,
        mechanism: &Mechanism,
    ) -> Option<Standing> {
        Standing::at(place, &self.run, &self.machine.mechanism, mechanism)
    }
}

impl Standing {
    /// The machine at a place of a run with `of_run`, as `mechanism`, which may have another tool.
    pub(crate) fn at(
        place: &ProgramPlace,
        run: &Run,
        of_run: &Mechanism,
        mechanism: &Mechanism,
    ) -> Option<Self> {
        let point = run.points.get(place.point)?;
        let limbs = of_run.limbs().iter();
        let drives = limbs.flat_map(|limb| limb.nominal.actuators());
        // A written program commands other joints by its correction.
        let corrections = point.actuator_correction.iter().copied();
        let corrections = corrections.chain(std::iter::repeat(0.0));
        let shown = point.actuator_command.iter().zip(corrections);
        let commands: Vec<f64> = (drives.zip(shown))
            .map(|(drive, (written, correction))| (written - correction) / unit_of(drive.kind))
            .collect();
        let request = PostureRequest::commands(&commands);
        let posture = mechanism.posture(request).ok()?;
        Some(Self {
            tip: posture.target().inverse() * place.programmed,
            commands,
        })
    }
}
