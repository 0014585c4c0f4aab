//! Distances of states on curves: full turns of passive joints make no difference.

use nalgebra::DVector;

use crate::continuation::tracing::system::CurveSystem;

/// `a - b`, full turns taken out.
pub(crate) fn wrapped(a: &DVector<f64>, b: &DVector<f64>, turns: &[f64]) -> DVector<f64> {
    let mut d = a - b;
    for (d, turn) in d.iter_mut().zip(turns) {
        if *turn > 0.0 {
            *d -= turn * (*d / turn).round();
        }
    }
    d
}

/// Distance of two states, full turns taken out.
pub(crate) fn distance<S: CurveSystem>(system: &S, a: &DVector<f64>, b: &DVector<f64>) -> f64 {
    wrapped(a, b, &system.full_turns()).norm()
}

/// Distance of `p` from the segment `a b`, full turns taken out.
pub(crate) fn off_segment(
    p: &DVector<f64>,
    a: &DVector<f64>,
    b: &DVector<f64>,
    turns: &[f64],
) -> f64 {
    let along = b - a;
    let from = wrapped(p, a, turns);
    let share = (from.dot(&along) / along.norm_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
    (from - along * share).norm()
}
