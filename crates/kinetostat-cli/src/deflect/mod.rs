//! `kinetostat deflect`: how far the tool is off, at one place or along a program.
//!
//! It takes a model with a place and a load, or a job, and gives displacements, forces of actuators and limbs, and
//! stability.

mod answer;
pub(crate) mod arguments;
mod place;
mod text;

use std::path::Path;

use kinetostat_diagnostic::ErrorCode;
use kinetostat_machining::RunResult;
use kinetostat_model::Model;

use crate::convert::for_run::refuse_unconvertible;
use crate::deflect::arguments::DeflectArgs;
use crate::deflect::place::at_place;
use crate::files::file_kind::FileKind;
use crate::files::input_files::InputFiles;
use crate::files::outputs::{self, Existing};
use crate::job::all_faults::{RunQuery, with_all_others};
use crate::job::arguments::WritingFlags;
use crate::job::feature_lines::refuse_lines_beyond;
use crate::job::free_turn::FreeTurn;
use crate::job::job_file::JobFile;
use crate::job::machine::MachineSetup;
use crate::job::of_model::machine_of;
use crate::job::output_paths::{OutputPaths, refuse_unused};
use crate::job::setting::{Setting, program_path, setting};
use crate::job::turn_arguments::FreeTurnWord;
use crate::job::{program, run_warnings};
use crate::long::put_in_place::claim;
use crate::long::run::{LongRun, survey};
use crate::long::which::{
    only_as_a_whole, part_length, say_as_a_whole, whole_by_setting, with_first_lines,
};
use crate::program::aim::Aim;
use crate::program::outputs::RunOutputs;
use crate::program::{report, solve, summary};
use crate::shown::in_report;
use crate::ui::failure::{Answer, Failing};
use crate::ui::given::Given;
use crate::ui::result_form::ResultForm;

/// Results that the command gives as JSON.
pub(crate) const RESULTS: &[ResultForm] = &[
    ResultForm::of::<answer::Deflection>("deflection at one place"),
    ResultForm::of::<RunResult>("deflection along a program"),
];

pub(crate) fn run(args: DeflectArgs, given: &Given) -> Answer<()> {
    let subject = Path::new(&args.subject);
    let is_job = !args.place.given() && FileKind::of_file(subject) == Some(FileKind::Job);
    if is_job || args.program.program.is_some() {
        if args.place.given() {
            return Err(ErrorCode::Conflict.failure("--at, --joints and --controller ask for one place, --program for all of a program: keep one of them",
            ));
        }
        given.refuse(
            &["--load-at-corners", "--chord-tolerance-um"],
            "is about a program that is written, and deflect writes none: leave it out, or give it to compensate",
        )?;
        return along_program(&args, is_job).map_err(|failure| {
            let query = RunQuery {
                job: is_job.then_some(subject),
                model: None,
                program: &args.program,
                writing: WritingFlags::default(),
            };
            with_all_others(&InputFiles::default(), &query, failure)
        });
    }
    at_place(&args, given)
}

fn along_program(args: &DeflectArgs, is_job: bool) -> Answer<()> {
    let files = InputFiles::default();
    let job = is_job
        .then(|| JobFile::read(&files, Path::new(&args.subject)))
        .transpose()?;
    // The first lines of a long program identify it.
    let path = program_path(job.as_ref(), &args.program)?;
    if let Some(first) = with_first_lines(&files, &path, &args.program)
        && run_along(args, &first, job.as_ref(), is_job, true)?
    {
        return Ok(());
    }
    run_along(args, &files, job.as_ref(), is_job, false).map(drop)
}

/// The deflections along a program; in parts, whether it can be run so.
fn run_along(
    args: &DeflectArgs,
    files: &InputFiles,
    job: Option<&JobFile>,
    is_job: bool,
    in_parts: bool,
) -> Answer<bool> {
    let named = (!is_job).then_some(args.subject.as_str());
    let flags = WritingFlags {
        json: args.json.as_deref(),
        ..WritingFlags::default()
    };
    // The program is analysed as it is, also where the job has it written in another language.
    let mut setting = match setting(files, job, &args.program, &flags) {
        // Faults and other languages are reported by the run as a whole.
        Err(_) if in_parts => return Ok(false),
        found => found?,
    };
    let whole = whole_by_setting(&setting);
    if in_parts && !whole.is_empty() {
        say_as_a_whole(&setting.program_path, &args.program, &whole);
        return Ok(false);
    }
    setting.write_flat_to(args.program.expansion.flat_program.clone());
    let mut chosen = setting.targets.clone();
    // The job's outputs are those of the compensation: an analysis writes what is named here.
    chosen.report.clone_from(&args.program.report);
    chosen.pdf.clone_from(&args.program.pdf);
    chosen.points.clone_from(&args.program.points);
    chosen.turn_plot = (args.program.turn.turn_plot.clone()).filter(|_| {
        // The plot shows a chosen turn, so it needs one.
        setting.free_turn != FreeTurnWord::AsStated
    });
    chosen.json = args.json.clone().filter(|p| p != Path::new("-"));
    refuse_unused(&args.program, &chosen)?;
    let existing = Existing::forced(args.program.force_overwrite);
    let (machine, model) = machine_of(&mut setting, files, job, named, &args.program)?;
    if in_parts {
        chosen.program = None;
        let whole = only_as_a_whole(&setting, &machine, &chosen);
        if !whole.is_empty() {
            say_as_a_whole(&setting.program_path, &args.program, &whole);
            return Ok(false);
        }
        return part_by_part(args, &machine, &model, setting, job, existing, chosen);
    }
    refuse_lines_beyond(job, &setting)?;
    program::read_program(&setting)?;
    refuse_unconvertible(files, job, &args.program, &model, &machine)?;
    let mut outputs = RunOutputs::claim(Aim::Analyse, &chosen, existing, &setting.inputs)?;
    let turn = solve::turn(&machine, &setting)?;
    let mut run = solve::turned(
        Aim::Analyse,
        &machine,
        &model,
        &setting,
        turn.as_ref(),
        args.program.threads,
    )?;
    if let Some(turn) = &turn {
        turn.put_into(&mut run.result.run_inputs);
    }
    run.result
        .warnings
        .extend(run_warnings::of_run(&model, job, &args.program));
    outputs.list(args.program.all_points, &model);
    let shown = in_report::of_run(&outputs, &setting, &machine, &model, &run)?;
    outputs.fill(&run, &setting, turn.as_ref(), shown.as_ref())?;
    let note = outputs.note(&run);
    let paths = outputs.files.commit()?;
    let said = turn.as_ref().map_or_else(String::new, FreeTurn::said);
    let text = format!(
        "{}{said}{}{note}",
        summary::of_run(&run.result),
        outputs::written(&paths)
    );
    let to_screen = args.json.as_deref() == Some(Path::new("-"));
    report::print_run(&text, to_screen.then_some(&run.result)).map(|()| true)
}

/// The deflections along a long program, and whether it can be read in parts, of which the setting has the first lines.
fn part_by_part(
    args: &DeflectArgs,
    machine: &MachineSetup,
    model: &Model,
    mut setting: Setting,
    job: Option<&JobFile>,
    existing: Existing,
    targets: OutputPaths,
) -> Answer<bool> {
    let mut outputs = claim(Aim::Analyse, &targets, existing, &setting.inputs)?;
    outputs.list(args.program.all_points, model);
    let length = part_length(&args.program, model);
    let Some(whole) = survey(&mut setting, Aim::Analyse, length)? else {
        return Ok(false);
    };
    refuse_lines_beyond(job, &setting)?;
    let run = LongRun {
        aim: Aim::Analyse,
        machine,
        model,
        setting: &setting,
        survey: &whole,
        flags: &args.program,
        targets: &targets,
    };
    let (mut run, done) = run.run(&mut outputs)?;
    let found = run_warnings::of_run(model, job, &args.program);
    run.result.warnings.extend(found);
    done.fill(&mut outputs, &run.result.run_inputs, &targets)?;
    done.or_kept(outputs.fill_result(&run, &setting))?;
    let paths = done.commit(outputs.files)?;
    done.remove();
    let text = summary::of_run(&run.result) + &outputs::written(&paths);
    let to_screen = args.json.as_deref() == Some(Path::new("-"));
    report::print_run(&text, to_screen.then_some(&run.result))?;
    Ok(true)
}
