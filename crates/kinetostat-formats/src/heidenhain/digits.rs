//! How finely the control takes lengths.

/// Decimals of a length in a unit of so many mm: 4 in mm, 5 in inches. The control takes no more.
pub(crate) fn decimals(unit_mm: f64) -> usize {
    match unit_mm == 1.0 {
        true => 4,
        false => 5,
    }
}
