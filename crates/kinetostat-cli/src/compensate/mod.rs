//! `kinetostat compensate`: a program that cuts where it should.
//!
//! It takes a job, or a table of corrections, and writes the compensated program with its report, result and
//! points. The run itself is in the crate `kinetostat-machining`: `run/compensate.rs` goes through its stages, and a
//! point that the machine cannot reach is refused where the corrections are found, in `field.rs` (`cause_and_advice`
//! says it; the core's `machine/inverse` finds it).

pub(crate) mod arguments;
mod copy;
mod correction_table;
mod long;

use std::path::{Path, PathBuf};

use kinetostat_diagnostic::ErrorCode;
use kinetostat_machining::{RunResult, merged};

use crate::compensate::arguments::CompensateArgs;
use crate::compensate::copy::{copy, rotary_of_copy};
use crate::convert::for_run::{Source, in_other_language, machine_of_made};
use crate::convert::targets::Named;
use crate::files::input_files::InputFiles;
use crate::files::outputs::{self, Existing};
use crate::job::all_faults::{RunQuery, with_all_others};
use crate::job::arguments::WritingFlags;
use crate::job::feature_lines::refuse_lines_beyond;
use crate::job::file_endings::refuse_other_endings;
use crate::job::free_turn::FreeTurn;
use crate::job::job_file::JobFile;
use crate::job::limits::{OF_CORRECTIONS, refuse_limits_but};
use crate::job::of_model::machine_of;
use crate::job::setting::{Setting, program_path, setting};
use crate::job::target_word::RobotWord;
use crate::job::turn_arguments::FreeTurnWord;
use crate::job::{program, run_warnings};
use crate::long::which::{holding, say_as_a_whole};
use crate::program::aim::Aim;
use crate::program::features::refuse_missed_features;
use crate::program::outputs::RunOutputs;
use crate::program::{report, solve, summary};
use crate::shown::in_report;
use crate::ui::failure::{Answer, Failing, Failure};
use crate::ui::given::Given;
use crate::ui::result_form::ResultForm;

/// Results that the command gives as JSON.
pub(crate) const RESULTS: &[ResultForm] = &[
    ResultForm::of::<RunResult>("a program corrected by a model"),
    ResultForm::of::<correction_table::MapResult<'static>>("a program corrected from a table"),
];

pub(crate) fn run(mut args: CompensateArgs, given: &Given) -> Answer<()> {
    job_after_json(&mut args);
    let files = InputFiles::default();
    refuse_unused(&files, &args, given)?;
    compensate(&files, &args).map_err(|failure| {
        let mut program = args.run.program.clone();
        let job = args.run.job.as_deref();
        let job = job.and_then(|path| JobFile::read(&files, path).ok());
        program.robot.converted = target(job.as_ref(), &args).is_some();
        program.robot.template.clone_from(&args.template);
        let query = RunQuery {
            // A table and a copy need no machine: not all of the job is read for them.
            job: args
                .run
                .job
                .as_deref()
                .filter(|_| args.map.is_none() && !args.no_compensation),
            model: args.run.model.as_deref(),
            program: &program,
            writing: writing(&args),
        };
        with_all_others(&files, &query, failure)
    })
}

/// Refuses options that have no effect: on a table of corrections, on a copy, and without another language.
fn refuse_unused(files: &InputFiles, args: &CompensateArgs, given: &Given) -> Answer<()> {
    let job = args.run.job.as_deref();
    let job = job.and_then(|path| JobFile::read(files, path).ok());
    if args.no_compensation {
        given.refuse_but(
            &OF_A_COPY,
            "is for a correction, and --no-compensation writes none: leave it out",
        )?;
    }
    if args.map.is_some() {
        given.refuse(
            &UNUSED_BY_A_TABLE,
            "is for a run with a model, and --map corrects from a table: leave it out",
        )?;
        let why = "a table of corrections says nothing of loads, tools and places";
        refuse_limits_but(&OF_CORRECTIONS, &args.run.program.limits, why)?;
    }
    if target(job.as_ref(), args).is_none() {
        given.refuse(
            &["--template"],
            "is for a program that is written in another language: add --to krl, rapid or ls",
        )?;
    }
    Ok(())
}

/// Options that a table of corrections has no use for.
const UNUSED_BY_A_TABLE: [&str; 13] = [
    "--correct",
    "--free-turn",
    "--stiff-turn",
    "--turn-plot",
    "--weight",
    "--touch-off",
    "--uncertain",
    "--machines",
    "--vtk",
    "--all-points",
    "--restart",
    "--threads",
    "--load-at-corners",
];

/// Options of a copy: how the program is read and written flat.
const OF_A_COPY: [&str; 23] = [
    // Options without effect there, as for all that is run as a whole.
    "--part-lines",
    "--no-compensation",
    "--program",
    "--model",
    "--out",
    "--force-overwrite",
    "--units",
    "--arc-tolerance",
    "--work-offset",
    "--block-delete",
    "--axes-stand-still",
    "--tool-centre-point",
    "--start-position-mm",
    "--machine-zero-mm",
    "--g28-mm",
    "--g30-mm",
    "--expand",
    "--subprograms",
    "--tool-diameter-mm",
    "--parameter",
    "--dialect",
    "--no-comments",
    "--flat-program",
];

fn compensate(files: &InputFiles, args: &CompensateArgs) -> Answer<()> {
    let job = args.run.job.as_deref();
    let job = job.map(|path| JobFile::read(files, path)).transpose()?;
    let whole = holding(&[
        (
            args.map.is_some(),
            "its corrections are those of a table (--map)",
        ),
        (
            args.no_compensation,
            "it is written without a correction (--no-compensation)",
        ),
        (
            target(job.as_ref(), args).is_some(),
            "it is written in another language (--to)",
        ),
    ]);
    if whole.is_empty() {
        if long::compensate(files, job.as_ref(), args, &writing(args))? {
            return Ok(());
        }
    } else if let Ok(path) = program_path(job.as_ref(), &args.run.program) {
        say_as_a_whole(&path, &args.run.program, &whole);
    }
    compensate_whole(files, args)
}

fn compensate_whole(files: &InputFiles, args: &CompensateArgs) -> Answer<()> {
    let job = args
        .run
        .job
        .as_deref()
        .map(|path| JobFile::read(files, path))
        .transpose()?;
    let job = job.as_ref();
    let to = target(job, args);
    let mut flags = args.run.program.clone();
    flags.robot.converted = to.is_some();
    flags.robot.template.clone_from(&args.template);
    let flags = &flags;
    let mut setting = setting(files, job, flags, &writing(args))?;
    let existing = Existing::forced(flags.force_overwrite);
    if to.is_none() {
        refuse_other_endings(&setting)?;
    }
    let names_model = job.is_some_and(|j| j.job.model.is_some());
    if args.no_compensation {
        if args.run.model.is_some() || names_model {
            let named = args.run.model.as_deref();
            setting.turned_by(rotary_of_copy(files, job, named, flags));
        }
        return copy(&setting, existing);
    }
    let to_screen = args.run.json.as_deref() == Some(Path::new("-"));
    if let Some(map) = &args.map {
        if names_model {
            return Err(ErrorCode::Conflict.failure("--map corrects from a table, and the job names a model, whose corrections would be left out: leave --map out, or give the table a job without model, placement and load (or --program alone)",
            ));
        }
        // A table of corrections knows no tools: a second one is warned of.
        setting.reading.tools = None;
        return correction_table::from_map(files, map, &setting, existing, to_screen);
    }
    refuse_lines_beyond(job, &setting)?;
    let model_named = args.run.model.as_deref();
    let (mut machine, model) = machine_of(&mut setting, files, job, model_named, flags)?;
    // A program that cannot be read is reported before outputs are looked at.
    program::read_program(&setting)?;
    let (mut turn, mut findings) = (None, Vec::new());
    match to {
        Some(word) => {
            let named = Named {
                out: args.out.as_deref(),
                flat: flags.expansion.flat_program.as_deref(),
            };
            let source = Source {
                setting,
                model: &model,
                machine: &machine,
            };
            let found = in_other_language(files, job, flags, source, word, named)?;
            setting = found.setting;
            (turn, findings) = (found.turn, found.findings);
            machine = machine_of_made(files, job, model_named, flags, &mut setting)?;
        }
        None => refuse_turn_without_words(&setting)?,
    }
    let mut outputs =
        RunOutputs::claim(Aim::Compensate, &setting.targets, existing, &setting.inputs)?;
    let mut run = solve::solve(Aim::Compensate, &machine, &model, &setting, flags.threads)
        .map_err(|failure| with_turn_hint(failure, (&setting, to)))?;
    run.result.warnings.extend(findings);
    run.result
        .warnings
        .extend(run_warnings::of_run(&model, job, flags));
    run.result.warnings = merged(run.result.warnings);
    outputs.list(flags.all_points, &model);
    if let Some(turn) = &turn {
        turn.put_into(&mut run.result.run_inputs);
    }
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
    report::print_run(&text, to_screen.then_some(&run.result))?;
    report::refuse_missed_tolerance(&run.result.tolerance, &setting)?;
    refuse_missed_features(&run.result.features, &setting)?;
    report::refuse_doubtful(&run.result, &setting)
}

/// Adds a hint on the turn of the tool if the arm cannot follow a program of positions that is written for a robot.
fn with_turn_hint(mut failure: Failure, (setting, to): (&Setting, Option<RobotWord>)) -> Failure {
    let Some(way_out) = &failure.way_out else {
        return failure;
    };
    if to.is_some() && setting.free_turn == FreeTurnWord::AsStated {
        failure.plain.push_str(match way_out.turn_about_tool_axis_deg {
            None => {
                ". That is of a turn that stays the same along the program: --free-turn (free_turn = \"choose\" under [robot]) looks for one that changes along it, of a round tool"
            }
            Some(_) => {
                ". --free-turn (free_turn = \"choose\" under [robot]) chooses the turn of a round tool along the path"
            }
        });
        failure.styled = None;
    }
    failure
}

/// The language in which the program is written, where it is another one.
fn target(job: Option<&JobFile>, args: &CompensateArgs) -> Option<RobotWord> {
    let in_job = job.and_then(JobFile::to);
    let runs = args.map.is_none() && !args.no_compensation;
    args.to.or(in_job.filter(|_| runs))
}

/// G-code and APT say where the tool goes, not how it is turned; programs of robots say both, and keep how it is turned.
fn refuse_turn_without_words(setting: &Setting) -> Answer<()> {
    match setting.free_turn {
        FreeTurnWord::AsStated => Ok(()),
        _ if states_turn(setting) => Err(setting.within(ErrorCode::ProgramUnsuited.failure("the program states how the tool is turned about its own axis, and a corrected one keeps that: write it as a new program, with --to krl, rapid or ls (to = \"krl\" under [robot]); `kinetostat deflect --free-turn` shows what the turn is worth",
        ))),
        FreeTurnWord::Choose | FreeTurnWord::Stiff => Err(setting.within(ErrorCode::ProgramUnsuited.failure("this language has no words for the turn of a tool about its own axis, so that what is chosen could not be written: write the program for the robot, with --to krl, rapid or ls (to = \"krl\" under [robot]); `kinetostat deflect --free-turn` shows what the turn is worth",
        ))),
    }
}

/// True if the language of the program states the turn of the tool about its own axis.
fn states_turn(setting: &Setting) -> bool {
    let language = setting.robot.as_ref().map(|robot| robot.language);
    language.is_some_and(|language| language.states_turn())
}

fn writing(args: &CompensateArgs) -> WritingFlags<'_> {
    WritingFlags {
        tolerance_um: args.tolerance_um,
        of_all: true,
        arcs: args.arcs,
        min_block_mm: args.min_block_mm,
        decimals: args.decimals,
        max_blocks_per_second: args.max_blocks_per_second,
        max_feed_factor: args.max_feed_factor,
        backward_step_um: args.backward_step_um,
        no_header: args.no_header,
        again: args.again,
        out: args.out.as_deref(),
        json: args.run.json.as_deref(),
    }
}

/// `--json job.toml` means the job: the file of `--json` may be left out, and nobody calls a result
/// `.toml`.
fn job_after_json(args: &mut CompensateArgs) {
    let taken = args
        .run
        .json
        .as_ref()
        .is_some_and(|p| p.extension().is_some_and(|e| e == "toml"));
    if taken && args.run.job.is_none() {
        args.run.job = args.run.json.replace(PathBuf::from("-"));
    }
}
