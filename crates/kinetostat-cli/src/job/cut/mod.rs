//! Cutting forces in a job file: `[material]`, `[stock]`, `[engagement]`, `[spindle]` and the `cutter` of a tool; `[measured]`.
//!
//! Takes the tables; gives the question for [`kinetostat_machining::CutQuestion`] and what was assumed, in words.

pub(crate) mod along;
mod cutters;
mod engagement;
mod files_of_cut;
mod material;
mod measured;
mod question;
mod stock;
mod twice;

use kinetostat_cutting::CutError;
use serde_spanned::Spanned;

use crate::job::job_file::JobFile;
use crate::ui::failure::Failure;

pub(crate) use files_of_cut::FilesOfCut;
pub(crate) use measured::{MeasuredSetup, measured_setup};
pub(crate) use question::{CutSetup, cut_setup};

/// An error of the library where the job states what it is about; in a file of its own, it names that.
fn refused<T>(job: &JobFile, at: &Spanned<T>, error: &CutError) -> Failure {
    if error.file.is_some() {
        return Failure::input(error);
    }
    let help = match error.expected.starts_with("did you mean") {
        true => error.expected.clone(),
        false => format!("expected {}", error.expected),
    };
    job.error(at, &format!("{}: {}", error.quantity, error.found), &help)
}
