//! Numbers as they are written.

use crate::heidenhain::digits::decimals;

/// A number with at most so many decimals.
pub(crate) fn trimmed(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    let text = match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.'),
        false => &text,
    };
    match text {
        "-0" => "0".to_owned(),
        text => text.to_owned(),
    }
}

/// A length with its sign, as finely as the control resolves it.
pub(crate) fn length(value: f64, unit_mm: f64) -> String {
    let text = trimmed(value, decimals(unit_mm));
    match text.starts_with('-') {
        true => text,
        false => format!("+{text}"),
    }
}
