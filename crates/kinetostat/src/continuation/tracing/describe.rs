//! A point of a curve from a corrected state: parameter, conjugate, slope, stability, equilibrium.

use std::sync::Arc;

use nalgebra::DVector;

use crate::continuation::curve::CurvePoint;
use crate::continuation::curve_equilibrium::CurveStability;
use crate::continuation::linear::curve_matrix::CurveMatrix;
use crate::continuation::linear::tangent::Tangent;
use crate::continuation::tracing::system::{Corrected, CurveSystem, Point};

/// Compliance, in natural units, below which a chain is locked along the load.
const LOCKED: f64 = 1e-12;

/// Tangent of the curve that is followed.
pub(crate) fn tangent<S: CurveSystem>(
    system: &S,
    matrix: &CurveMatrix,
    guide: &DVector<f64>,
) -> Option<Tangent> {
    matrix.tangent(guide, system.family().map(|f| &**f))
}

/// A point from a corrected state, with the family as it is there; the system is evaluated
/// there.
pub(crate) fn describe<S: CurveSystem>(
    system: &mut S,
    c: &Corrected,
    direction: DVector<f64>,
) -> Point<S> {
    let before = system.family().cloned();
    if let Some(carried) = before.as_ref().and_then(|f| match &c.matrix {
        CurveMatrix::Dense(own) => f.carried(own, &direction),
        CurveMatrix::Swept(_) => None,
    }) {
        system.set_family(Some(Arc::new(carried)));
    }
    let point = described(system, c, direction);
    system.set_family(before);
    point
}

fn described<S: CurveSystem>(system: &mut S, c: &Corrected, direction: DVector<f64>) -> Point<S> {
    system.evaluate(&c.z);
    let held = system.stability(c, true);
    let dead = system.stability(c, false);
    let m = system.count();
    let rate = system.conjugate_row(&c.matrix.gradient()).dot(&direction);
    let change = direction[m] * system.sigma();
    let (load, displacement) = if system.is_load() {
        (change, rate)
    } else {
        (rate, change)
    };
    // Scales both to natural units.
    let (own, other) = (direction[m], system.natural_conjugate(rate));
    let (pushed, moved) = match system.is_load() {
        true => (own, other),
        false => (other, own),
    };
    let slope = if moved.abs() > LOCKED * pushed.abs() {
        load / displacement
    } else {
        f64::INFINITY
    };
    CurvePoint {
        parameter: system.value(&c.z),
        conjugate: system.conjugate(&c.z),
        equilibrium: system.equilibrium(c),
        slope,
        unstable: [held.unstable_modes(), dead.unstable_modes()],
        displacement_control: held,
        dead_load: dead,
        arc: 0.0,
        z: c.z.clone(),
        tangent: direction,
        family: system.family().cloned(),
    }
}
