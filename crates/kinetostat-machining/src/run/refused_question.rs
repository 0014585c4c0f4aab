//! Questions that a compensation refuses before anything is solved along the whole program.

use crate::checks::motion::no_motion;
use crate::checks::refused::{as_warning, of_task};
use crate::run::first_look::FirstLook;
use crate::run::preparation::{load, refuse};
use crate::task::{RunError, Task};
use crate::warning::{Warning, WarningCode};
use crate::watch::Unwatched;

/// Reasons for which a compensation refuses a question before anything is solved along the whole program, as warnings, and its
/// first error. `is_placed`: the tool stands as the task says, and not as it is still to be chosen, so that figures at places
/// count.
#[must_use]
pub fn refused_question(task: &Task<'_>, is_placed: bool) -> (Vec<Warning>, Option<RunError>) {
    let mut errors = Vec::new();
    errors.extend(refuse(of_task(task)).err());
    match no_motion(task.path()) {
        Some(reason) => errors.push(RunError::NoMotion(reason)),
        None => match FirstLook::new(task, &load(task), &Unwatched) {
            Err(error) => errors.push(error),
            Ok(looked) if is_placed => {
                errors.extend(refuse(looked.beyond(task)).err());
                errors.extend(looked.beginning_solved().err());
            }
            Ok(_) => {}
        },
    }
    let said = errors.iter().flat_map(|error| match error {
        RunError::BeyondLimits(beyond) => beyond.iter().map(as_warning).collect(),
        error => vec![Warning::new(WarningCode::Program, error.to_string())],
    });
    (said.collect(), errors.into_iter().next())
}
