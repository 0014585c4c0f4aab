//! Distances of states on curves: full turns of passive joints make no difference.

use nalgebra::DVector;

use crate::continuation::chain_system::ChainSystem;
use crate::model::chain::Role;
use crate::spatial::MotionKind;

/// Full turn of every coordinate in balanced units, 0 where a turn makes a difference.
pub(crate) fn wraps(system: &ChainSystem<'_, '_>) -> Vec<f64> {
    let chain = system.problem.chain;
    let mut one = DVector::zeros(system.count() + 1);
    (0..chain.coordinate_count())
        .map(|i| {
            let c = &chain.coordinates()[i];
            if c.role == Role::Passive && c.kind == MotionKind::Revolute {
                one.fill(0.0);
                one[system.reactions() + i] = 1.0;
                std::f64::consts::TAU / system.coordinates(&one)[i]
            } else {
                0.0
            }
        })
        .collect()
}

/// `a - b`, full turns of passive joints taken out.
pub(crate) fn wrapped(
    a: &DVector<f64>,
    b: &DVector<f64>,
    turns: &[f64],
    offset: usize,
) -> DVector<f64> {
    let mut d = a - b;
    for (i, turn) in turns.iter().enumerate() {
        if *turn > 0.0 {
            d[offset + i] -= turn * (d[offset + i] / turn).round();
        }
    }
    d
}

/// Distance of two states, full turns of passive joints taken out.
pub(crate) fn distance(system: &ChainSystem<'_, '_>, a: &DVector<f64>, b: &DVector<f64>) -> f64 {
    wrapped(a, b, &wraps(system), system.reactions()).norm()
}

pub(crate) fn off_segment(
    system: &ChainSystem<'_, '_>,
    p: &DVector<f64>,
    a: &DVector<f64>,
    b: &DVector<f64>,
) -> f64 {
    segment_distance(p, a, b, &wraps(system), system.reactions())
}

/// Distance of `p` from the segment `a b`.
pub(crate) fn segment_distance(
    p: &DVector<f64>,
    a: &DVector<f64>,
    b: &DVector<f64>,
    turns: &[f64],
    offset: usize,
) -> f64 {
    let along = b - a;
    let from = wrapped(p, a, turns, offset);
    let share = (from.dot(&along) / along.norm_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
    (from - along * share).norm()
}
