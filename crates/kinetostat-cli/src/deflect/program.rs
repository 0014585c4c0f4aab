//! Deflections along a program.

use std::path::Path;

use crate::deflect::arguments::DeflectArgs;
use crate::files::input_files::InputFiles;
use crate::files::outputs::{self, Existing};
use crate::job::arguments::WritingFlags;
use crate::job::free_turn::FreeTurn;
use crate::job::job_file::JobFile;
use crate::job::machine::machine_setup;
use crate::job::of_model::give_of_model;
use crate::job::setting::setting;
use crate::job::turn_arguments::FreeTurnWord;
use crate::job::{program, run_warnings};
use crate::program::aim::Aim;
use crate::program::outputs::RunOutputs;
use crate::program::{report, solve, summary};
use crate::ui::failure::Answer;

pub(crate) fn along_program(args: &DeflectArgs, is_job: bool) -> Answer<()> {
    let files = InputFiles::default();
    let job = is_job
        .then(|| JobFile::read(&files, Path::new(&args.subject)))
        .transpose()?;
    let named = (!is_job).then_some(args.subject.as_str());
    let flags = WritingFlags {
        json: args.json.as_deref(),
        ..WritingFlags::default()
    };
    // The program is analysed as it is, also where the job has it written in another language.
    let mut setting = setting(&files, job.as_ref(), &args.program, &flags)?;
    setting.write_flat_to(args.program.expansion.flat_program.clone());
    let mut chosen = setting.targets.clone();
    // The job's outputs are those of the compensation: an analysis writes what is named here.
    chosen.report.clone_from(&args.program.report);
    chosen.pdf.clone_from(&args.program.pdf);
    chosen.points.clone_from(&args.program.points);
    chosen.turn_plot = (args.program.turn.turn_plot.clone()).filter(|_| {
        // Without a turn that is chosen there is nothing to draw.
        setting.free_turn != FreeTurnWord::AsStated
    });
    chosen.json = args.json.clone().filter(|p| p != Path::new("-"));
    let existing = Existing::forced(args.program.force_overwrite);
    let model_of_job = (job.as_ref(), named);
    give_of_model(&mut setting, &files, model_of_job, &args.program)?;
    let frames = setting.robot_frames()?;
    let (machine, model) = machine_setup(
        &files,
        job.as_ref(),
        named,
        &args.program,
        (frames.as_ref(), &mut setting.inputs),
    )?;
    setting.turned_by(machine.rotary.clone());
    program::read_program(&setting)?;
    let mut outputs = RunOutputs::claim(Aim::Analyse, &chosen, existing, &setting.inputs)?;
    let turn = solve::turn(&machine, &setting)?;
    let mut run = solve::turned(
        Aim::Analyse,
        (&machine, &model),
        (&setting, turn.as_ref()),
        args.program.threads,
    )?;
    if let Some(turn) = &turn {
        turn.put_into(&mut run.result.run_inputs);
    }
    run.result
        .warnings
        .extend(run_warnings::of_run(&model, job.as_ref()));
    outputs.list(args.program.all_points, &model);
    outputs.fill(&run, &setting, turn.as_ref())?;
    let note = outputs.note(&run);
    let paths = outputs.files.commit()?;
    let said = turn.as_ref().map_or_else(String::new, FreeTurn::said);
    let text = format!(
        "{}{said}{}{note}",
        summary::of_run(&run.result),
        outputs::written(&paths)
    );
    let to_screen = args.json.as_deref() == Some(Path::new("-"));
    report::print_run(&text, to_screen.then_some(&run.result))
}
