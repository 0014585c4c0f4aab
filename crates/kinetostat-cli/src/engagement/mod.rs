//! `kinetostat engagement`: what a program cuts, where, and with which force, torque and power.
//!
//! It takes program, cutters, material, stock and spindle from options and from a job file, and gives the removed volume, the
//! force along the path, the worst lines and what was assumed, as text, JSON, table and picture. It knows no machine.

mod answer;
mod answer_of;
pub(crate) mod arguments;
mod csv;
mod cut;
mod map;
mod missing;
mod own_cut;
mod plot;
mod subject;
mod text;

use crate::engagement::answer_of::answer_of;
use crate::engagement::arguments::EngagementArgs;
use crate::engagement::cut::cut;
use crate::engagement::subject::subject;
use crate::files::answer_files::{ClaimedFiles, Shown};
use crate::files::input_files::InputFiles;
use crate::job::arguments::{ProgramArgs, WritingFlags};
use crate::job::cut::along::stopped_or_within;
use crate::job::job_file::JobFile;
use crate::job::output_paths::FLAT_PROGRAM;
use crate::job::program::read_program;
use crate::job::setting::setting;
use crate::program::flat_lines::{WithSources, listed_under};
use crate::ui::failure::Answer;
use crate::ui::progress::Progress;

pub(crate) fn run(args: &EngagementArgs) -> Answer<()> {
    let files = InputFiles::default();
    let subject = subject(args)?;
    let job = subject.job.map(|path| JobFile::read(&files, path));
    let job = job.transpose()?;
    let flags = ProgramArgs {
        program: subject.program,
        reading: args.reading.clone(),
        expansion: args.expansion.clone(),
        ..ProgramArgs::default()
    };
    let mut setting = setting(&files, job.as_ref(), &flags, &WritingFlags::default())?;
    setting.write_flat_to(args.expansion.flat_program.clone());
    let cut = cut(&files, job.as_ref(), args, &flags)?;
    let read = read_program(&setting)?;
    let path = read.path();
    let mut inputs = setting.inputs.clone();
    inputs.extend(cut.files.paths.iter().cloned());
    let mut claimed = ClaimedFiles::claim(&args.outputs, &inputs)?;
    if let Some(target) = &setting.targets.flat {
        let index = claimed.claim_also(FLAT_PROGRAM, target)?;
        claimed.fill(index, &setting.program)?;
    }
    let progress = Progress::new();
    let walked = cut.question.along_and_left(path, &progress);
    let (forces, left) = walked.map_err(|failure| stopped_or_within(failure, &setting))?;
    progress.finish();
    let answer = answer_of(&setting, &cut, (&read, &forces), left.as_ref());
    let flat = setting.flat.as_ref();
    let mut text = text::answer_text(&answer);
    text.push_str(&listed_under(&text, flat));
    let shown = Shown {
        text,
        csv: match args.outputs.csv.is_some() {
            true => csv::of_cut(&forces, path, flat)?,
            false => Vec::new(),
        },
        svg: match args.outputs.plot.is_some() {
            true => plot::drawing(&answer, &cut.question.engagement, left.as_ref(), path),
            false => String::new(),
        },
        failure: None,
    };
    claimed.finish(&shown, &WithSources(&answer, flat))
}
