//! Errors of the library, reported with the option at fault.

use kinetostat_cutting::{CutError, CutErrorKind};
use kinetostat_diagnostic::ErrorCode;

use crate::ui::failure::{Failing, Failure};
use crate::ui::fault_list::{Fault, with_text};

/// Quantities of the library and the options that give them.
const OPTIONS: [(&str, &str); 30] = [
    ("diameter", "--diameter-mm"),
    ("teeth", "--teeth"),
    ("corner radius", "--corner-radius-mm"),
    ("lead angle", "--lead-angle-deg"),
    ("helix", "--helix-deg"),
    ("run-out", "--run-out-um"),
    ("angle of the run-out", "--run-out-angle-deg"),
    ("width of cut", "--width-mm"),
    ("depth of cut", "--depth-mm"),
    ("feed per tooth", "--feed-per-tooth-mm"),
    ("feed per tooth down the axis", "--down-feed-per-tooth-mm"),
    ("process factor", "--process-factor"),
    ("wear factor", "--wear"),
    ("rake angle", "--rake-deg"),
    ("cutting speed", "--correct-speed"),
    ("rated power", "--spindle-power-w"),
    ("base speed", "--spindle-base-rpm"),
    ("largest speed", "--spindle-most-rpm"),
    ("speed of the spindle", "--rpm"),
    ("feed", "--feed-mm-per-min"),
    ("length of the edges", "--flute-length-mm"),
    ("stick-out", "--stick-out-mm"),
    ("feed per tooth allowed", "--max-chip-mm"),
    ("lips", "--lips"),
    ("point angle", "--point-angle-deg"),
    ("hole", "--hole-mm"),
    ("chisel factor", "--chisel-factor"),
    ("approach angle", "--approach-angle-deg"),
    ("feed per turn", "--feed-per-turn-mm"),
    ("spread", "--spread-percent"),
];

/// An error of the library as the command says it: with the option, or with file and line.
pub(crate) fn refused(error: &CutError) -> Failure {
    let option = OPTIONS.iter().find(|(name, _)| *name == error.quantity);
    let Some((_, option)) = option.filter(|_| error.file.is_none()) else {
        return with_text(ErrorCode::Value, error.to_string(), error, &[]);
    };
    let CutError {
        quantity,
        found,
        expected,
        ..
    } = error;
    let message = format!("{option}: {quantity} of {found}; expected {expected}");
    let mut fault = error.diagnostic();
    fault.location.name = Some((*option).to_owned());
    fault.message.clone_from(&message);
    ErrorCode::Value.failure(message).with_faults([fault])
}

/// A number of an option within bounds that hold for any machine shop.
pub(crate) fn within(
    quantity: &str,
    value: f64,
    bounds: std::ops::RangeInclusive<f64>,
    unit: &str,
) -> Result<f64, Failure> {
    if bounds.contains(&value) {
        return Ok(value);
    }
    let found = format!("{value} {unit}");
    let expected = format!("{} to {} {unit}", bounds.start(), bounds.end());
    let kind = CutErrorKind::Cut;
    Err(refused(&CutError::new(kind, quantity, found, expected)))
}
