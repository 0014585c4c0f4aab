//! Common types of the options of several commands: numbers, vectors, and the exit codes of their help.

use kinetostat_diagnostic::ErrorCode;
use nalgebra::Vector3;

use crate::ui::failure::{Answer, Failing};

pub(crate) const EXIT_CODES: &str = "\
Exit codes:
  0    answered
  1    wrong input: a file, a number or an option; the message says which
  2    no answer: not converged, or a point that cannot be reached
  3    compensated and written, but the tolerance is missed; the line is said
  130  stopped with Ctrl-C; nothing was written";

/// Fault of an option's number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub(crate) enum NumberFault {
    #[error("a finite number is needed")]
    NotFinite,
    #[error(
        "a number is needed, with a decimal point and not a comma, and a space before the next"
    )]
    Comma,
    #[error("a number is needed, as in 12.5; the unit is in the option's name")]
    NoNumber,
    #[error("a whole number is needed, as in 2")]
    NotWhole,
    #[error("a whole number from 3 to 8 is needed")]
    NotSmall,
}

/// A finite number with a decimal point.
pub(crate) fn number(text: &str) -> Result<f64, NumberFault> {
    match text.trim().parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        Ok(_) => Err(NumberFault::NotFinite),
        Err(_) if text.contains(',') => Err(NumberFault::Comma),
        Err(_) => Err(NumberFault::NoNumber),
    }
}

pub(crate) fn whole(text: &str) -> Result<usize, NumberFault> {
    text.trim().parse().map_err(|_| NumberFault::NotWhole)
}

pub(crate) fn small(text: &str) -> Result<u8, NumberFault> {
    text.trim().parse().map_err(|_| NumberFault::NotSmall)
}

pub(crate) fn finite(name: &str, values: &[f64]) -> Answer<()> {
    match values.iter().find(|v| !v.is_finite()) {
        Some(v) => {
            Err(ErrorCode::Value.failure(format!("{name} holds {v}: finite numbers are needed")))
        }
        None => Ok(()),
    }
}

/// Three numbers of an option.
pub(crate) fn vector(name: &str, values: &[f64]) -> Answer<Vector3<f64>> {
    finite(name, values)?;
    match values {
        [x, y, z] => Ok(Vector3::new(*x, *y, *z)),
        _ => Err(ErrorCode::Value.failure(format!("{name} needs three numbers"))),
    }
}
