//! Resolution of lengths of the control.

use crate::text::number::short;

/// Decimals of a length in a unit of so many mm: 4 in mm, 5 in inches. The control takes no more.
pub(crate) fn decimals(unit_mm: f64) -> usize {
    match unit_mm == 1.0 {
        true => 4,
        false => 5,
    }
}

/// A length with its sign, as finely as the control resolves it.
pub(crate) fn length(value: f64, unit_mm: f64) -> String {
    let text = short(value, decimals(unit_mm));
    match text.starts_with('-') {
        true => text,
        false => format!("+{text}"),
    }
}
