//! Numbers of a flat program.

/// A number as a controller reads it, with all its digits; what is left of zero after the arithmetic is zero.
pub(crate) fn number(value: f64) -> String {
    match value.abs() < NOTHING {
        true => "0".to_owned(),
        false => format!("{value}"),
    }
}

/// Smallest size that a program means.
const NOTHING: f64 = 1e-12;
