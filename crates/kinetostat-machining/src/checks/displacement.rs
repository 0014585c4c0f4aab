//! Displacements that are no deflections any more: the machine folds over.

use kinetostat::number::{Rounding, significant};

use crate::warning::{Warning, WarningCode};

/// A displacement by this share of the machine's size is no deflection any more.
const LARGE: f64 = 0.05;

/// The tool moves by `far`, which is no deflection any more of a machine of this size, m.
#[must_use]
pub fn folds(far: f64, size: f64) -> Option<Warning> {
    folds_at(far, size, "")
}

/// Warning for `places` of a grid, in words; empty for one place.
#[must_use]
pub fn folds_at(far: f64, size: f64, places: &str) -> Option<Warning> {
    is_large(far, size).then(|| {
        Warning::new(WarningCode::LargeDisplacement, format!(
            "the tool moves by {} % of the machine's size{places}: the machine folds over under this load; check the force and the stiffnesses",
            significant(100.0 * far / size, 2, Rounding::Nearest)
        ))
    })
}

/// True if a displacement is too large to be a deflection of a machine of this size, m.
#[must_use]
pub fn is_large(far: f64, size: f64) -> bool {
    far > LARGE * size
}
