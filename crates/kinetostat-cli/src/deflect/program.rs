//! Deflections along a program.

use std::path::Path;

use crate::deflect::arguments::DeflectArgs;
use crate::files::input::Files;
use crate::files::output::{self, Existing};
use crate::job::arguments::WritingFlags;
use crate::job::job_file::JobFile;
use crate::job::machine::machine;
use crate::job::program;
use crate::job::setting::setting;
use crate::machine::model_warnings::{no_potential, of_model, with_smells};
use crate::program::aim::Aim;
use crate::program::outputs::Files as Targets;
use crate::program::report::tell;
use crate::program::{solve, summary};
use crate::ui::failure::Answer;

pub(crate) fn along_program(args: &DeflectArgs, is_job: bool) -> Answer<()> {
    let files = Files::default();
    let job = is_job
        .then(|| JobFile::read(&files, Path::new(&args.subject)))
        .transpose()?;
    let named = (!is_job).then_some(args.subject.as_str());
    let flags = WritingFlags {
        json: args.json.as_deref(),
        ..WritingFlags::default()
    };
    let mut setting = setting(&files, job.as_ref(), &args.program, &flags)?;
    let mut chosen = setting.targets.clone();
    // The job's outputs are those of the compensation: an analysis writes what is named here.
    chosen.report.clone_from(&args.program.report);
    chosen.points.clone_from(&args.program.points);
    chosen.json = args.json.clone().filter(|p| p != Path::new("-"));
    let existing = Existing::forced(args.program.force_overwrite);
    let (machine, model) = machine(
        &files,
        job.as_ref(),
        named,
        &args.program,
        &mut setting.inputs,
    )?;
    program::read_program(&setting)?;
    let mut targets = Targets::claim(Aim::Analyse, &chosen, existing, &setting.inputs)?;
    let mut run = solve::solve(Aim::Analyse, &machine, &setting, args.program.threads)
        .map_err(|failure| with_smells(failure, &model))?;
    run.result.warnings.extend(of_model(&model));
    run.result.warnings.extend(no_potential(&model.mechanism));
    let odd = job.iter().flat_map(|job| job.odd_angles());
    run.result.warnings.extend(odd);
    targets.list(args.program.all_points, &model);
    targets.fill(&run)?;
    let note = targets.note(&run);
    let paths = targets.outputs.commit()?;
    let text = format!(
        "{}{}{note}",
        summary::of_run(&run.result),
        output::written(&paths)
    );
    let to_screen = args.json.as_deref() == Some(Path::new("-"));
    tell(&text, to_screen.then_some(&run.result))
}
