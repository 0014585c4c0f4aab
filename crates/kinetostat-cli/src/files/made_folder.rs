//! A folder that is made for the files of a command.

use std::path::Path;

use kinetostat_diagnostic::ErrorCode;

use crate::ui::failure::{Answer, Failing};
use crate::ui::system_error::description;

/// Works in a folder that is made if it is missing, and removed if the work fails and leaves nothing in it.
pub(crate) fn in_folder<R>(path: &Path, work: impl FnOnce() -> Answer<R>) -> Answer<R> {
    let is_made = made(path)?;
    let result = work();
    if result.is_err() && is_made {
        // Only an empty folder is removed.
        let _ = std::fs::remove_dir(path);
    }
    result
}

/// Makes the folder if it is missing; true if it was made.
fn made(path: &Path) -> Answer<bool> {
    if path.is_dir() {
        return Ok(false);
    }
    match std::fs::create_dir(path) {
        Ok(()) => Ok(true),
        Err(error) => {
            let reason = match error.kind() {
                std::io::ErrorKind::AlreadyExists => "a file has that name".to_owned(),
                std::io::ErrorKind::NotFound => {
                    "the directory above it does not exist; create it first".to_owned()
                }
                _ => description(&error),
            };
            Err(ErrorCode::Output.failure(format!(
                "the directory '{}' cannot be made: {reason}; choose another with --out",
                path.display()
            )))
        }
    }
}
