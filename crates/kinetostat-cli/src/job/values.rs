//! Numbers of an option or of the job file, and which of them are allowed.

use kinetostat_diagnostic::ErrorCode;
use serde_spanned::Spanned;

use crate::job::job_file::JobFile;
use crate::ui::failure::{Answer, Failing};

/// Allowed values, for a value that is not allowed.
pub(crate) struct NotAllowed(pub(crate) &'static str);

/// The value of an option, or else of the job file, if it is allowed; a refusal shows where it was
/// given.
pub(crate) fn chosen<T: Copy + std::fmt::Display, U>(
    job: Option<&JobFile>,
    flag: &str,
    given: Option<T>,
    written: Option<&Spanned<T>>,
    allowed: impl Fn(T) -> Result<U, NotAllowed>,
) -> Answer<Option<U>> {
    if let Some(value) = given {
        return allowed(value).map(Some).map_err(|NotAllowed(reason)| {
            ErrorCode::Value.failure(format!("{flag} is {value}: {reason}"))
        });
    }
    match (job, written) {
        (Some(j), Some(value)) => {
            allowed(*value.get_ref())
                .map(Some)
                .map_err(|NotAllowed(reason)| {
                    j.error(
                        value,
                        &format!("the value {} is not allowed here", value.get_ref()),
                        reason,
                    )
                })
        }
        _ => Ok(None),
    }
}

pub(crate) fn above_zero(value: f64) -> Result<f64, NotAllowed> {
    if value.is_finite() && value > 0.0 {
        Ok(value)
    } else {
        Err(NotAllowed("a number above zero is needed"))
    }
}

/// Programs are drawn larger or smaller, in inches for millimetres at most (25.4), or in metres (1000).
pub(crate) fn scale_of_program(value: f64) -> Result<f64, NotAllowed> {
    match (1e-3..=1e3).contains(&value) {
        true => Ok(value),
        false => Err(NotAllowed(
            "a number from 0.001 to 1000 is needed: the machine's length for one of the program",
        )),
    }
}

/// Checks the difference of the radii at both ends of an arc: controllers allow 0.001 to 0.1 mm by default, rarely
/// more than 1 mm. A centre that is farther off is another arc, and would be cut as it stands.
pub(crate) fn arc_tolerance(value: f64) -> Result<f64, NotAllowed> {
    match (1e-6..=ARC_TOLERANCE_MM).contains(&value) {
        true => Ok(value),
        false => Err(NotAllowed(
            "0.000001 to 2 mm are allowed: controllers take arcs whose radii at both ends differ by 0.001 to 0.1 mm, and refuse others",
        )),
    }
}

/// Limit above what any controller allows, and below what a wrong centre word makes.
const ARC_TOLERANCE_MM: f64 = 2.0;

pub(crate) fn micrometres(value: f64) -> Result<f64, NotAllowed> {
    if (1e-3..=1e4).contains(&value) {
        Ok(1e-3 * value)
    } else {
        Err(NotAllowed("a tolerance is 0.001 to 10000 micrometres"))
    }
}
