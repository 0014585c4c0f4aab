//! A point of a curve from a corrected state: parameter, conjugate, slope, stability, equilibrium, and the family to which it belongs.

use std::sync::Arc;

use nalgebra::{DMatrix, DVector};

use crate::continuation::curve::{CurvePoint, CurveStability};
use crate::continuation::linear::curve_matrix::CurveMatrix;
use crate::continuation::linear::family::Family;
use crate::continuation::linear::tangent::Tangent;
use crate::continuation::tracing::system::{Corrected, CurveSystem, Point, Row};
use crate::linalg::complement::complement;

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

/// Singular values below this share of the largest count as zero, if moved equilibria confirm it.
const NULL: f64 = 1e-7;

/// Displacements of an equilibrium along a motion that seems neutral, scaled units: as far as its family goes, which
/// close to its origin is a small circle.
const MOVED: [f64; 3] = [0.03, 0.003, 0.0003];

/// The family to which a state on a curve along `t` belongs, if any: null motions beside the
/// curve's own, confirmed by equilibria a finite way along each of them, in both directions.
pub(crate) fn family_of<S: CurveSystem>(
    system: &mut S,
    z: &DVector<f64>,
    t: &DVector<f64>,
) -> Option<Family> {
    let (_, _, matrix) = system.linearised_densely(z);
    let found = system.null_directions(&matrix);
    let count = found.count(1, NULL);
    if count < 2 {
        return None;
    }
    let null = found.right.columns(0, count).into_owned();
    let k = null.ncols() - 1;
    // The curve's own direction changes the parameter, the family's motions do not.
    let last = t.len() - 1;
    let rate: DVector<f64> = null.row(last).transpose();
    let own = if rate.norm() > 1e-3 {
        rate
    } else {
        null.transpose() * t
    };
    let own = own.normalize();
    if !own.iter().all(|x| x.is_finite()) {
        return None;
    }
    let motions = &null * complement(&DMatrix::from_columns(&[own]));
    let lefts = found.left.columns(0, k).into_owned();
    let family = Family::new(motions, lefts);
    let before = system.family().cloned();
    system.set_family(Some(family.clone().into()));
    let sizes = family.motions.column_iter();
    let sizes: Vec<f64> = sizes
        .map(|v| system.size_of_motion(&v.into_owned()))
        .collect();
    let mut at_rest = |v: &DVector<f64>, h: f64| {
        let moved = system.followed(z, z + v * h);
        let row = Row::Plane(t, t.dot(&moved));
        let Some(there) = system.correct(&moved, &row, 10) else {
            return false;
        };
        system.size_of_motion(&(there.z - moved)) < 0.3 * system.size_of_motion(&(v * h))
    };
    let holds = family.motions.column_iter().zip(sizes).all(|(v, size)| {
        let v = v / size;
        MOVED.into_iter().any(|h| at_rest(&v, -h) && at_rest(&v, h))
    });
    system.set_family(before);
    system.evaluate(z);
    holds.then_some(family)
}
