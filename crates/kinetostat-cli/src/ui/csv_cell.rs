//! Cells of tables: digits that mean something, and text that no spreadsheet takes for a formula.

use kinetostat_machining::number::{Rounding, fixed_and_short, significant, without_zeros};

/// Formats with at most so many decimals, without zeros at the end.
pub(crate) fn decimals(value: f64, most: usize) -> String {
    if !value.is_finite() {
        return String::new();
    }
    fixed_and_short(value, most)
}

pub(crate) fn digits(value: f64, count: usize) -> String {
    if !value.is_finite() {
        return String::new();
    }
    without_zeros(&significant(value, count, Rounding::Nearest)).to_owned()
}

/// A text that a spreadsheet would take for a formula is led by an apostrophe.
pub(crate) fn text(cell: &str) -> String {
    if cell.starts_with(['=', '+', '-', '@', '\t', '\r']) {
        format!("'{cell}")
    } else {
        cell.to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_mean_something() {
        assert_eq!(decimals(-0.124_806_510_474_640_73, 6), "-0.124807");
        assert_eq!(decimals(100.0, 4), "100");
        assert_eq!(decimals(-1e-9, 6), "0");
        assert_eq!(decimals(f64::NAN, 6), "");
        assert_eq!(digits(323.827_824, 5), "323.83");
    }
}
