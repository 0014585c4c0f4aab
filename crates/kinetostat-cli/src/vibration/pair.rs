//! Frequency and growth of a complex pair as they are shown: without rounding.

use kinetostat_dynamics::ComplexMode;

/// Frequency of its swing, 0 where it does not swing beyond rounding.
pub(crate) fn frequency_hz(pair: &ComplexMode) -> f64 {
    match pair.swings() {
        true => pair.frequency_hz(),
        false => 0.0,
    }
}

/// Real part of its eigenvalue, 0 where that is rounding beside its size.
pub(crate) fn growth_per_s(pair: &ComplexMode) -> f64 {
    match pair.damping_ratio().abs() > ROUNDING {
        true => pair.eigenvalue.re,
        false => 0.0,
    }
}

/// Share of critical damping below which a real part is rounding: the root of a double root's.
const ROUNDING: f64 = 1e-9;
