//! `kinetostat chatter`: the lines of a program that chatter, with the spindle speed and the depth that do not.
//!
//! It takes the job of a run whose forces are computed from the cut, and damping; it gives the limit of depth along the
//! program, stretches that chatter, and what would not, as text, JSON, table and picture.

mod answer;
pub(crate) mod arguments;
mod text;

use kinetostat_diagnostic::ErrorCode;
use kinetostat_machining::marked_as_compensated;
use kinetostat_report::chatter_svg;

use crate::chatter::answer::ChatterAnswer;
use crate::chatter::arguments::ChatterArgs;
use crate::convert::for_run::refuse_unconvertible;
use crate::files::answer_files::{ClaimedFiles, Shown};
use crate::files::input_files::InputFiles;
use crate::job::arguments::{ProgramArgs, WritingFlags};
use crate::job::chatter::{ChatterFlags, ChatterSetting};
use crate::job::cut::along::warnings;
use crate::job::job_file::JobFile;
use crate::job::of_model::machine_of;
use crate::job::program::read_program;
use crate::job::setting::setting;
use crate::program::aim::Aim;
use crate::program::chatter::{Judging, refused};
use crate::program::flat_lines::of_warnings;
use crate::program::solve::{forces_of, with_task};
use crate::ui::failure::{Answer, Failing};
use crate::ui::progress::{AsOne, Progress};
use crate::ui::result_form::ResultForm;
use crate::ui::threads::in_threads;
use crate::vibration::damping::words;
use crate::vibration::stability::implausible;

/// Shares of the forces of the cut and of their stability in the work.
const SHARES: [f64; 2] = [0.15, 0.85];

/// Results that the command gives as JSON.
pub(crate) const RESULTS: &[ResultForm] =
    &[ResultForm::of::<ChatterAnswer>("chatter along a program")];

pub(crate) fn run(args: &ChatterArgs) -> Answer<()> {
    let files = InputFiles::default();
    let job = JobFile::read(&files, &args.job)?;
    let flags = ProgramArgs {
        program: args.program.clone(),
        ..ProgramArgs::default()
    };
    let mut setting = setting(&files, Some(&job), &flags, &WritingFlags::default())?;
    let model_named = args.model.as_deref();
    let (machine, model) = machine_of(&mut setting, &files, Some(&job), model_named, &flags)?;
    let asked = ChatterFlags {
        modes_up_to_hz: args.modes_up_to_hz,
        every_mm: args.every_mm,
        most_places: args.most_places,
    };
    let asked = ChatterSetting::of(Some(&job), asked)?;
    let judging = Judging::of(&machine, &model, &args.damping, &asked)
        .map_err(|failure| failure.within(&args.job.display().to_string()))?;
    setting.turned_by(machine.rotary.clone());
    let claimed = ClaimedFiles::claim(&args.outputs, &setting.inputs)?;
    let read = read_program(&setting)?;
    refuse_unconvertible(&files, Some(&job), &flags, &model, &machine)?;
    let progress = Progress::with_lines();
    let as_one = AsOne::new(&progress, "chatter, %", &SHARES);
    let forces = forces_of(&machine, &setting, read.path(), &as_one)?;
    let Some(forces) = &forces else {
        return Err(ErrorCode::Missing.failure("the job has no forces of the cut"));
    };
    let found = with_task(
        Aim::Analyse,
        &machine,
        &setting,
        &read,
        Some(forces),
        |task| in_threads(args.threads, || judging.along(task, forces, &as_one)),
    )??;
    let found = found.map_err(|error| refused(error, &setting))?;
    progress.finish();
    let flat = setting.flat.as_ref();
    let mut said = warnings(Some(forces));
    said.extend(read.with(marked_as_compensated));
    said.extend(setting.of_expansion());
    said.extend(implausible(&judging.damping));
    said.extend(judging.points.clone());
    let damping = words(&judging.damping);
    let result = found.result(damping.clone());
    let answer = ChatterAnswer::new(
        &found,
        flat,
        &setting.program_name,
        &machine,
        damping,
        of_warnings(said, flat),
        &asked,
    );
    let shown = Shown {
        text: text::answer_text(&answer, &result),
        csv: text::table(&answer)?,
        svg: match args.outputs.plot.is_some() {
            true => chatter_svg(&answer.program, &result),
            false => String::new(),
        },
        failure: None,
    };
    claimed.finish(&shown, &answer)
}
