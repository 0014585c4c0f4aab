//! Figures of a curve as they are shown.

use crate::ui::numbers::number;

/// A number of a column whose largest is `size`.
pub(crate) fn value(x: f64, size: f64) -> String {
    if x.abs() < 1e-11 * size {
        return "0".into();
    }
    number(x, 7)
}

/// Formats a number for sentences.
pub(crate) fn short(x: f64) -> String {
    if x.abs() < 1e-12 {
        return "0".into();
    }
    number(x, 6)
}
