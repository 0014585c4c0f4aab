//! `kinetostat chatter`: the lines of a program that chatter, with the spindle speed and the depth that do not.
//!
//! It takes the job of a run whose forces are computed from the cut, and damping; it gives the limit of depth along the
//! program, stretches that chatter, and what would not, as text, JSON, table and picture.

mod answer;
pub(crate) mod arguments;
mod plot;
mod text;

use kinetostat_analysis::vibration::program::{ChatterQuestion, ProgramChatterError};

use crate::chatter::answer::ChatterAnswer;
use crate::chatter::arguments::ChatterArgs;
use crate::files::answer_files::{ClaimedFiles, Shown};
use crate::files::input_files::InputFiles;
use crate::job::arguments::{ProgramArgs, WritingFlags};
use crate::job::cut::along::{stopped_or_within, warnings};
use crate::job::job_file::JobFile;
use crate::job::machine::machine_setup;
use crate::job::of_model::give_of_model;
use crate::job::program::read_program;
use crate::job::setting::{Setting, setting};
use crate::program::aim::Aim;
use crate::program::flat_lines::of_warnings;
use crate::program::solve::{forces_of, with_task};
use crate::ui::failure::{Answer, Code, Failure};
use crate::ui::progress::Progress;
use crate::ui::threads::in_threads;
use crate::vibration::stability::damped;
use crate::vibration::{damping::words, subject};

pub(crate) fn run(args: &ChatterArgs) -> Answer<()> {
    refuse_senseless(args)?;
    let files = InputFiles::default();
    let job = JobFile::read(&files, &args.job)?;
    let flags = ProgramArgs {
        program: args.program.clone(),
        ..ProgramArgs::default()
    };
    let mut setting = setting(&files, Some(&job), &flags, &WritingFlags::default())?;
    let model_named = args.model.as_deref();
    let named = (Some(&job), model_named);
    give_of_model(&mut setting, &files, named, &flags)?;
    let frames = setting.robot_frames()?;
    let with = (frames.as_ref(), &mut setting.inputs);
    let (machine, model) = machine_setup(&files, Some(&job), model_named, &flags, with)?;
    let damping = damped(&args.damping, &model.damping(), "chatter needs")?;
    setting.turned_by(machine.rotary.clone());
    let claimed = ClaimedFiles::claim(&args.outputs, &setting.inputs)?;
    let read = read_program(&setting)?;
    let Some(cut) = &machine.cut else {
        return Err(Failure::input(
            "the job says nothing of the cut: [material], a cutter of the tool, and [stock] or [engagement] are needed",
        )
        .within(&args.job.display().to_string()));
    };
    if machine.placement.orientation_follows {
        return Err(Failure::input(
            "the tool of this machine turns as it moves: chatter along a program is for machines that hold their tool as the program says",
        ));
    }
    let progress = Progress::new();
    let forces = forces_of(&machine, &setting, read.path(), &progress)?;
    let Some(forces) = &forces else {
        return Err(Failure::input("the job has no forces of the cut"));
    };
    let found = with_task(
        Aim::Analyse,
        &machine,
        &setting,
        &read,
        Some(forces),
        |task| {
            let question = ChatterQuestion {
                task,
                forces,
                cut: &cut.question,
                damping: &damping,
                modes_up_to_hz: args.modes_up_to_hz,
                every_mm: args.every_mm,
                most: args.most_places,
            };
            in_threads(args.threads, || question.along(&progress))
        },
    )??;
    let found = found.map_err(|error| refused(error, &setting))?;
    progress.finish();
    let flat = setting.flat.as_ref();
    let mut said = warnings(Some(forces));
    said.extend(setting.of_expansion());
    let answer = ChatterAnswer::new(
        (&found, flat),
        &setting.program_name,
        (&machine.run_inputs.model, &cut.material, words(&damping)),
        of_warnings(said, flat),
    );
    let shown = Shown {
        text: text::answer_text(&answer),
        csv: text::table(&answer)?,
        svg: match args.outputs.plot.is_some() {
            true => plot::drawing(&answer),
            false => String::new(),
        },
        failure: None,
    };
    claimed.finish(&shown, &answer)
}

fn refuse_senseless(args: &ChatterArgs) -> Answer<()> {
    let positive = [
        ("--every-mm", args.every_mm, "mm"),
        ("--modes-up-to-hz", args.modes_up_to_hz, "Hz"),
    ];
    let senseless = |(_, value, _): &(&str, f64, &str)| value.is_nan() || *value <= 0.0;
    if let Some((name, value, unit)) = positive.into_iter().find(senseless) {
        return Err(Failure::input(format!(
            "{name} is {value}; a number above 0 is needed, {unit}"
        )));
    }
    match args.most_places {
        1..=1_000_000 => Ok(()),
        n => Err(Failure::input(format!(
            "--most-places is {n}; a number from 1 to 1000000 is needed"
        ))),
    }
}

/// Why there is no answer, with the line of the program.
fn refused(error: ProgramChatterError, setting: &Setting) -> Failure {
    match error {
        ProgramChatterError::Machine { line, error } => {
            let mut failure = subject::refused(error);
            failure.plain = format!("line {line}: {}", failure.plain);
            failure.styled = None;
            setting.within(failure)
        }
        ProgramChatterError::Tool(failure) => stopped_or_within(failure, setting),
        ProgramChatterError::Cancelled => Failure::new(Code::Stopped, error),
        other => setting.within(Failure::input(other)),
    }
}
