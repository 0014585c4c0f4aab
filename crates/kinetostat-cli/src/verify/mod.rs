//! `kinetostat verify`: any program of a part, solved against the one that it was made from.
//!
//! It takes both programs and the machine of a job and gives the error along the second, a verdict, and a table of points.

mod aligned;
mod answer;
pub(crate) mod arguments;
mod block_marks;
mod compared;
mod ending;
mod faults;
mod marks;
mod on_paper;
mod other_language;
mod other_word;
mod program_marks;
mod solved;
mod text;
mod tilted;
mod written;

use std::path::Path;

use kinetostat_diagnostic::ErrorCode;

use crate::files::input_files::InputFiles;
use crate::files::outputs;
use crate::job::arguments::{ProgramArgs, WritingFlags};
use crate::job::feature_lines::refuse_lines_beyond;
use crate::job::job_file::JobFile;
use crate::job::machine::machine_setup;
use crate::job::of_model::give_of_model;
use crate::job::program::read_program;
use crate::job::run_warnings;
use crate::job::setting::{Setting, program_path, setting};
use crate::long::which::say_as_a_whole;
use crate::program::features::put_features;
use crate::program::report::refuse_doubtful;
use crate::ui::failure::{Answer, Failing};
use crate::ui::json;
use crate::ui::language::LanguageWord;
use crate::ui::result_form::ResultForm;
use crate::verify::answer::VerifyAnswer;
use crate::verify::arguments::VerifyArgs;
use crate::verify::other_language::{fitting, language, read_as_made, template};
use crate::verify::solved::{Solved, solved};
use crate::verify::tilted::Tilted;
use crate::verify::written::ClaimedFiles;

/// Results that the command gives as JSON.
pub(crate) const RESULTS: &[ResultForm] = &[ResultForm::of::<VerifyAnswer>(
    "a compensated program verified",
)];

pub(crate) fn run(args: &VerifyArgs) -> Answer<()> {
    let files = InputFiles::default();
    let job = args.job.as_deref().map(|path| JobFile::read(&files, path));
    let job = job.transpose()?;
    let model_named = args.model.as_deref();
    refuse_what_says_nothing(&args.original)?;
    let flags = WritingFlags {
        tolerance_um: args.tolerance_um,
        decimals: args.decimals,
        ..WritingFlags::default()
    };
    let of_original = program_path(job.as_ref(), &args.original)?;
    let is_gcode = |path: &Path| language(&files, path).is_none();
    let gcode = [is_gcode(&of_original), is_gcode(&args.verified)];
    let in_two_languages = gcode[0] != gcode[1];
    let [
        (job_of_original, of_original),
        (job_of_verified, mut of_verified),
    ] = match in_two_languages {
        true => gcode.map(|is_gcode| fitting(job.as_ref(), &args.original, is_gcode)),
        false => [0, 1].map(|_| (job.clone(), args.original.clone())),
    };
    let job = job_of_original;
    let mut original = asked(&files, job.as_ref(), &of_original, &flags, model_named)?;
    refuse_lines_beyond(job.as_ref(), &original)?;
    of_verified.program = Some(args.verified.clone());
    let named = job_of_verified.as_ref();
    let mut verified = asked(&files, named, &of_verified, &flags, model_named)?;
    for path in [&original.program_path, &verified.program_path] {
        let why = "each place of it is found on the other program (verify)";
        say_as_a_whole(path, &args.original, &[why]);
    }
    let frames = original.robot_frames()?;
    let inputs = &mut original.inputs;
    let (machine, model) = machine_setup(
        &files,
        job.as_ref(),
        model_named,
        &of_original,
        frames.as_ref(),
        inputs,
    )?;
    original.turned_by(machine.rotary.clone());
    verified.turned_by(machine.rotary.clone());
    let template = match in_two_languages && gcode[0] {
        true => template(&files, job.as_ref(), &machine)?,
        false => None,
    };
    if let Some(template) = &template {
        let read = read_program(&original)?;
        read_as_made(&mut verified, &of_verified, template, &read)?;
    }

    let inputs = original.inputs.iter().chain(&verified.inputs);
    let claimed = ClaimedFiles::of(args, inputs.cloned().collect())?;

    let Solved {
        mut found,
        uncut,
        other_words,
        corrected,
        rounding_mm,
        forces_from_cut,
    } = solved(
        &machine,
        &original,
        &verified,
        template.as_ref(),
        args.original.threads,
    )?;
    let own_bound = found.run.result.allowed_mm() + rounding_mm;
    let allowed_mm = args.tolerance_um.map_or(own_bound, |um| 1e-3 * um);
    put_features(&mut found.run, &original, allowed_mm, &uncut);
    found
        .run
        .result
        .warnings
        .extend(run_warnings::of_run(&model, job.as_ref(), &of_original));
    let mut answer = VerifyAnswer::of(
        &found,
        &verified,
        &original,
        allowed_mm,
        forces_from_cut,
        other_words,
        Tilted::of(
            &found.run.points,
            corrected,
            found.matched.turned.as_ref(),
            allowed_mm,
            original.writing.turn_lever_mm,
        ),
    );
    let assessed = answer.as_run(&found);
    answer.assessment = assessed.assessment.clone();
    let controller = model.controller.clone();
    let language = LanguageWord::language(original.targets.language);
    let paths = claimed.write(args, &found, &answer, controller, language)?;
    let to_screen = args.json.as_deref() == Some(Path::new("-"));
    let text = text::answer_text(&answer, &assessed);
    let text = format!("{text}{}", outputs::written(&paths));
    json::print_answer(&text, &answer, to_screen)?;
    match answer.held {
        true => refuse_doubtful(&assessed, &verified),
        false => {
            let faults = answer.faults().join("\n");
            Err(ErrorCode::ToleranceMissed
                .failure(faults)
                .within(&verified.program_name))
        }
    }
}

/// Options of other commands along a program that mean nothing here.
fn refuse_what_says_nothing(given: &ProgramArgs) -> Answer<()> {
    let turn = &given.turn;
    let what = if given.report.is_some() {
        "--report: its answer comes as text, as JSON (--json FILE), as PDF (--pdf FILE) and as a table of points (--points FILE)"
    } else if turn.free_turn || turn.stiff_turn || turn.turn_plot.is_some() {
        "--free-turn, --stiff-turn and --turn-plot: the tool is turned as the program says"
    } else if given.uncertain.uncertain.is_some() || given.uncertain.machines.is_some() {
        "--uncertain and --machines: one machine is solved, as the model says"
    } else if given.restart {
        "--restart: it begins anew each time"
    } else {
        return Ok(());
    };
    Err(ErrorCode::Unused.failure(format!("verify has no use for {what}")))
}

/// A program and how it is read.
fn asked(
    files: &InputFiles,
    job: Option<&JobFile>,
    program: &ProgramArgs,
    writing: &WritingFlags<'_>,
    model_named: Option<&str>,
) -> Answer<Setting> {
    let mut setting = setting(files, job, program, writing)?;
    give_of_model(&mut setting, files, job, model_named, program)?;
    Ok(setting)
}
