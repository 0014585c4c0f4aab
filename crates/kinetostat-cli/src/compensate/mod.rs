//! `kinetostat compensate`: a program that cuts where it should.
//!
//! It takes a job, or a table of corrections, and writes the compensated program with its report, result and
//! points. The run itself is in the crate `kinetostat-machining`: `run/compensate.rs` goes through its stages, and a
//! point that the machine cannot reach is refused where the corrections are found, in `field.rs` (`cause_and_advice`
//! says it; the core's `machine/inverse` finds it).

pub(crate) mod arguments;
mod correction_table;

use std::path::{Path, PathBuf};

use kinetostat_machining::number::counted;
use kinetostat_program::{Program, interpret};

use crate::compensate::arguments::CompensateArgs;
use crate::files::input_files::InputFiles;
use crate::files::outputs::{self, Existing, Outputs};
use crate::job::all_faults::{RunQuery, with_all_others};
use crate::job::arguments::WritingFlags;
use crate::job::job_file::JobFile;
use crate::job::machine::machine_setup;
use crate::job::robot::joint_arm::give_arm;
use crate::job::setting::{Setting, setting};
use crate::job::{program, run_warnings};
use crate::program::aim::Aim;
use crate::program::outputs::RunOutputs;
use crate::program::{report, solve, summary};
use crate::ui::failure::{Answer, Failure};
use crate::ui::layout::wrapped;
use crate::ui::screen::{self, Stream};

pub(crate) fn run(mut args: CompensateArgs) -> Answer<()> {
    job_after_json(&mut args);
    let files = InputFiles::default();
    compensate(&files, &args).map_err(|failure| {
        let query = RunQuery {
            // A table and a copy need no machine: not all of the job is read for them.
            job: args
                .run
                .job
                .as_deref()
                .filter(|_| args.map.is_none() && !args.no_compensation),
            model: args.run.model.as_deref(),
            program: &args.run.program,
            writing: flags(&args),
        };
        with_all_others(&files, &query, failure)
    })
}

fn compensate(files: &InputFiles, args: &CompensateArgs) -> Answer<()> {
    let job = args
        .run
        .job
        .as_deref()
        .map(|path| JobFile::read(files, path))
        .transpose()?;
    let mut setting = setting(files, job.as_ref(), &args.run.program, &flags(args))?;
    let existing = Existing::forced(args.run.program.force_overwrite);
    if args.no_compensation {
        return copy(&setting, existing);
    }
    let to_screen = args.run.json.as_deref() == Some(Path::new("-"));
    if let Some(map) = &args.map {
        // A table of corrections knows no tools: a second one is warned of.
        setting.reading.tools = None;
        return correction_table::from_map(files, map, &setting, existing, to_screen);
    }
    give_arm(
        setting.robot.as_mut(),
        files,
        (job.as_ref(), args.run.model.as_deref()),
        &args.run.program,
    )?;
    let frames = setting.robot_frames()?;
    let (machine, model) = machine_setup(
        files,
        job.as_ref(),
        args.run.model.as_deref(),
        &args.run.program,
        (frames.as_ref(), &mut setting.inputs),
    )?;
    setting.turned_by(machine.rotary.clone());
    // A program that cannot be read is reported before outputs are looked at.
    program::read_program(&setting)?;
    let mut outputs =
        RunOutputs::claim(Aim::Compensate, &setting.targets, existing, &setting.inputs)?;
    let mut run = solve::solve(
        Aim::Compensate,
        (&machine, &model),
        &setting,
        args.run.program.threads,
    )?;
    run.result
        .warnings
        .extend(run_warnings::of_run(&model, job.as_ref()));
    outputs.list(args.run.program.all_points, &model);
    outputs.fill(&run, &setting)?;
    let note = outputs.note(&run);
    let paths = outputs.files.commit()?;
    let text = format!(
        "{}{}{note}",
        summary::of_run(&run.result),
        outputs::written(&paths)
    );
    report::print_run(&text, to_screen.then_some(&run.result))?;
    report::refuse_missed_tolerance(&run.result.tolerance, &setting)
}

fn flags(args: &CompensateArgs) -> WritingFlags<'_> {
    WritingFlags {
        tolerance_um: args.tolerance_um,
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

/// The program as it was read.
fn copy(setting: &Setting, existing: Existing) -> Answer<()> {
    if setting.robot.is_some() {
        return Err(Failure::input(
            "--no-compensation writes a program in G-code as it was read; a program of a robot would be its own copy: leave it where it is",
        ));
    }
    let refuse = |error| setting.within(Failure::input(error));
    let program = Program::read(setting.program.clone()).map_err(refuse)?;
    let mut outputs = Outputs::new(existing, setting.inputs.clone());
    let mut text = wrapped(
        &format!(
            "{}: {} in {}, {}.",
            setting.program_name,
            counted(program.block_count(), "block"),
            counted(program.line_count(), "line"),
            match setting.flat {
                Some(_) => "run once and written flat, without a correction",
                None => "written as read, byte for byte",
            }
        ),
        0,
    );
    if let Err(error) = interpret(&program, &setting.reading) {
        text.push_str(&wrapped(
            &format!("It could not be compensated as it is: {error}."),
            0,
        ));
    }
    if let Some(target) = &setting.targets.program {
        let index = outputs.claim("program", target)?;
        outputs.fill(index, program.bytes())?;
    }
    let paths = outputs.commit()?;
    text.push_str(&outputs::written(&paths));
    screen::print(Stream::Out, &text)
}
