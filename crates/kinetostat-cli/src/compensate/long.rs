//! A long program, compensated in parts.

use std::path::Path;

use crate::compensate::arguments::CompensateArgs;
use crate::files::input_files::InputFiles;
use crate::files::outputs::{self, Existing};
use crate::job::arguments::WritingFlags;
use crate::job::feature_lines::refuse_lines_beyond;
use crate::job::job_file::JobFile;
use crate::job::machine::machine_setup;
use crate::job::of_model::give_of_model;
use crate::job::run_warnings;
use crate::job::setting::{program_path, setting};
use crate::long::put_in_place::claim;
use crate::long::run::{LongRun, survey};
use crate::long::which::{
    only_as_a_whole, part_length, say_as_a_whole, whole_by_setting, with_first_lines,
};
use crate::program::aim::Aim;
use crate::program::features::refuse_missed_features;
use crate::program::{report, summary};
use crate::ui::failure::Answer;

/// Compensates a program that is long and can be run in parts; whether it is.
pub(crate) fn compensate(
    files: &InputFiles,
    job: Option<&JobFile>,
    args: &CompensateArgs,
    writing: &WritingFlags<'_>,
) -> Answer<bool> {
    let flags = &args.run.program;
    let path = program_path(job, flags)?;
    let first = with_first_lines(files, &path, flags);
    let Some(files) = &first else {
        return Ok(false);
    };
    // Faults and other languages are reported by the run as a whole.
    let Ok(mut setting) = setting(files, job, flags, writing) else {
        return Ok(false);
    };
    let model_named = args.run.model.as_deref();
    let whole = whole_by_setting(&setting);
    if !whole.is_empty() {
        say_as_a_whole(&path, flags, &whole);
        return Ok(false);
    }
    give_of_model(&mut setting, files, job, model_named, flags)?;
    let (machine, model) =
        machine_setup(files, job, model_named, flags, None, &mut setting.inputs)?;
    setting.turned_by(machine.rotary.clone());
    let targets = setting.targets.clone();
    let whole = only_as_a_whole(&setting, &machine, &targets);
    if !whole.is_empty() {
        say_as_a_whole(&path, flags, &whole);
        return Ok(false);
    }
    let existing = Existing::forced(flags.force_overwrite);
    let mut outputs = claim(Aim::Compensate, &targets, existing, &setting.inputs)?;
    outputs.list(flags.all_points, &model);
    let to_screen = args.run.json.as_deref() == Some(Path::new("-"));
    let length = part_length(flags, &model);
    let Some(found) = survey(&mut setting, Aim::Compensate, length)? else {
        return Ok(false);
    };
    refuse_lines_beyond(job, &setting)?;
    let run = LongRun {
        aim: Aim::Compensate,
        machine: &machine,
        model: &model,
        setting: &setting,
        survey: &found,
        flags,
        targets: &targets,
    };
    let (mut run, done) = run.run(&mut outputs)?;
    run.result
        .warnings
        .extend(run_warnings::of_run(&model, job, flags));
    done.fill(&mut outputs, &run.result.run_inputs, &targets)?;
    done.or_kept(outputs.fill_result(&run, &setting))?;
    let paths = done.commit(outputs.files)?;
    done.remove();
    let text = format!(
        "{}{}",
        summary::of_run(&run.result),
        outputs::written(&paths)
    );
    report::print_run(&text, to_screen.then_some(&run.result))?;
    report::refuse_missed_tolerance(&run.result.tolerance, &setting)?;
    refuse_missed_features(&run.result.features, &setting)?;
    report::refuse_doubtful(&run.result, &setting)?;
    Ok(true)
}
