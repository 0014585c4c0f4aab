//! `kinetostat deflect`: how far the tool is off, at one place or along a program.
//!
//! It takes a model with a place and a load, or a job, and gives displacements, forces of actuators and limbs, and
//! stability.

mod answer;
pub(crate) mod arguments;
mod place;
mod program;
mod text;

use std::path::Path;

use crate::deflect::arguments::DeflectArgs;
use crate::deflect::place::at_place;
use crate::deflect::program::along_program;
use crate::files::file_kind::FileKind;
use crate::files::input_files::InputFiles;
use crate::job::all_faults::{RunQuery, with_all_others};
use crate::job::arguments::WritingFlags;
use crate::ui::failure::{Answer, Failure};
use crate::ui::given::Given;

pub(crate) fn run(args: DeflectArgs, given: &Given) -> Answer<()> {
    let subject = Path::new(&args.subject);
    let is_job = !args.place.given() && FileKind::of_file(subject) == Some(FileKind::Job);
    if is_job || args.program.program.is_some() {
        if args.place.given() {
            return Err(Failure::input(
                "--at, --joints and --controller ask for one place, --program for all of a program: keep one of them",
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
