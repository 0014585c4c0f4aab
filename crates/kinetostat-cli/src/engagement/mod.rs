//! `kinetostat engagement`: what the program of a job cuts, where, and with which force, torque and power.
//!
//! It takes the job's program, cutters, material, stock and spindle, and gives the removed volume, the force along the path,
//! the worst lines and what was assumed, as text, JSON, table and picture. It knows no machine.

mod answer;
mod answer_of;
pub(crate) mod arguments;
mod csv;
mod map;
mod plot;
mod text;

use kinetostat::Pose;
use kinetostat_machining::Placement;
use nalgebra::UnitQuaternion;

use crate::engagement::answer_of::answer_of;
use crate::engagement::arguments::EngagementArgs;
use crate::files::answer_files::{ClaimedFiles, Shown};
use crate::files::input_files::InputFiles;
use crate::job::arguments::{ProgramArgs, WritingFlags};
use crate::job::cut::along::stopped_or_within;
use crate::job::cut::cut_setup;
use crate::job::job_file::JobFile;
use crate::job::program::read_program;
use crate::job::setting::setting;
use crate::ui::failure::{Answer, Failure};
use crate::ui::progress::Progress;

pub(crate) fn run(args: &EngagementArgs) -> Answer<()> {
    let files = InputFiles::default();
    let job = JobFile::read(&files, &args.job)?;
    let flags = ProgramArgs {
        program: args.program.clone(),
        ..ProgramArgs::default()
    };
    let setting = setting(&files, Some(&job), &flags, &WritingFlags::default())?;
    let cut = cut_setup(&files, Some(&job), &flags, &as_programmed())?;
    let Some(cut) = cut else {
        return Err(Failure::input(format!(
            "the job file '{}' names no material: without it nothing is known of a cut; write [material] name = \"AlMg4.5Mn\" with [stock] (or [engagement]) and the cutter of the tool",
            job.path.display()
        )));
    };
    let (_, path) = read_program(&setting)?;
    let mut inputs = setting.inputs.clone();
    inputs.extend(cut.files.paths.iter().cloned());
    let claimed = ClaimedFiles::claim(&args.outputs, &inputs)?;
    let progress = Progress::new();
    let walked = cut.question.along_and_left(&path, &progress);
    let (forces, left) =
        walked.map_err(|failure| stopped_or_within(failure, &setting.program_name))?;
    progress.finish();
    let material = job.job.material.as_ref();
    let material = material.map_or("", |table| table.get_ref().name.get_ref());
    let answer = answer_of(&setting, (material, &cut), (&path, &forces), left.as_ref());
    let shown = Shown {
        text: text::answer_text(&answer),
        csv: match args.outputs.csv.is_some() {
            true => csv::of_cut(&forces, &path)?,
            false => Vec::new(),
        },
        svg: match args.outputs.plot.is_some() {
            true => plot::drawing(&answer, &cut.question.engagement, left.as_ref(), &path),
            false => String::new(),
        },
        failure: None,
    };
    claimed.finish(&shown, &answer)
}

/// The program in its own coordinates, the tool along z: a cut knows no machine.
fn as_programmed() -> Placement {
    Placement {
        base_from_part: Pose::identity(),
        tool_orientation: UnitQuaternion::identity(),
        orientation_follows: false,
        scale: 1.0,
    }
}
