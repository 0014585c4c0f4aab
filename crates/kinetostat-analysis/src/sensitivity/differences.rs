//! Steps and weights of central differences.

use kinetostat_model::{Parameter, ParameterKind};

/// Shares of the largest step.
pub(crate) const STEPS: [f64; 3] = [1.0, 0.5, 0.25];
/// Weights of central differences with these steps in the derivative of sixth order.
pub(crate) const WEIGHTS: [f64; 3] = [1.0 / 45.0, -20.0 / 45.0, 64.0 / 45.0];

/// A step that is small beside what the number does, in its unit.
pub(crate) fn step_of(parameter: &Parameter) -> f64 {
    let least = match parameter.kind {
        ParameterKind::Length => 1e-3,
        ParameterKind::Angle | ParameterKind::Direction => 4e-3,
        ParameterKind::Mass | ParameterKind::Inertia | ParameterKind::Acceleration => 1e-2,
        ParameterKind::Force | ParameterKind::Moment => 1.0,
        ParameterKind::Ratio | ParameterKind::PoissonsRatio | ParameterKind::Factor => 1e-3,
        _ => 0.0,
    };
    let least = least / parameter.in_si;
    let step = (4e-3 * parameter.value.abs()).max(least);
    // An entry of a matrix that is zero: as one of its unit.
    if step > 0.0 { step } else { 1.0 }
}
