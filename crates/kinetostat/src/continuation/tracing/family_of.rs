//! The family of equilibria to which a state belongs: neutral motions, confirmed by equilibria a finite way along them.

use nalgebra::{DMatrix, DVector};

use crate::continuation::linear::family::Family;
use crate::continuation::tracing::system::{CurveSystem, Row};
use crate::linalg::complement::complement;

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
