//! Errors of the library, reported at their place in the job.

use kinetostat_cutting::CutError;
use kinetostat_diagnostic::ErrorCode;
use serde_spanned::Spanned;

use crate::job::job_file::JobFile;
use crate::ui::failure::Failure;
use crate::ui::fault_list::with_text;

/// An error of the library where the job states what it is about; in a file of its own, it names that.
pub(crate) fn refused<T>(job: &JobFile, at: &Spanned<T>, error: &CutError) -> Failure {
    if error.file.is_some() {
        return with_text(ErrorCode::Value, error.to_string(), error, &[]);
    }
    let found = format!("{}: {}", error.quantity, error.found);
    job.error(at, &found, &error.advice())
}
