//! Principal directions of a machine's tool, and what its platforms' tangent says about it.

use nalgebra::{DMatrix, DVector, Matrix6, Vector3, Vector6};

use crate::chain::Scale;
use crate::directions::scaled_twist;
use crate::saddle::{column_space, complement};
use crate::spatial::shift_matrix;
use crate::stiffness::{ChainStiffness, Direction, DirectionKind, directions};

/// Principal directions of a platform's stiffness; motions that a limb (its own stiffness and the
/// arm to its tip) cannot follow are rigid.
pub(crate) fn balanced_directions<'a>(
    matrix: &Matrix6<f64>,
    scale: Scale,
    limbs: impl Iterator<Item = (&'a ChainStiffness, Vector3<f64>, Scale)>,
) -> Vec<Direction> {
    let root = scale.stiffness.sqrt();
    let factor = |i: usize| if i < 3 { root } else { root * scale.length };
    let balanced = Matrix6::from_fn(|i, j| matrix[(i, j)] / (factor(i) * factor(j)));
    let mut blocked: Vec<DVector<f64>> = Vec::new();
    for (limb, arm, own) in limbs {
        for direction in limb
            .directions
            .iter()
            .filter(|d| d.kind == DirectionKind::Rigid)
        {
            // The limb's balanced normal, as a wrench on the platform, in the platform's balance.
            let t = direction.twist.0;
            let square = own.length * own.length;
            let wrench = Vector6::from_fn(|k, _| if k < 3 { t[k] } else { t[k] * square });
            let on_platform = shift_matrix(&arm).transpose() * wrench;
            blocked.push(DVector::from_fn(6, |k, _| on_platform[k] / factor(k)).normalize());
        }
    }
    let range = if blocked.is_empty() {
        DMatrix::identity(6, 6)
    } else {
        complement(&column_space(&DMatrix::from_columns(&blocked)))
    };
    let mut list = directions(scale, &balanced, &range);
    for kind in [DirectionKind::Rigid, DirectionKind::Free] {
        along_axes(&mut list, kind, scale);
    }
    list
}

/// Rigid and free directions are spaces without a basis of their own: motions along and about
/// coordinate axes come first where they lie in it.
fn along_axes(list: &mut [Direction], kind: DirectionKind, scale: Scale) {
    let own: Vec<usize> = (0..list.len()).filter(|&i| list[i].kind == kind).collect();
    if own.len() < 2 {
        return;
    }
    let unit = |i: usize| if i < 3 { 1.0 } else { scale.length };
    let given = own
        .iter()
        .map(|&i| DVector::from_fn(6, |k, _| list[i].twist.0[k] * unit(k)));
    let given: Vec<DVector<f64>> = given.collect();
    let space = column_space(&DMatrix::from_columns(&given));
    let axes = (0..6).filter_map(|k| {
        let axis = DVector::from_fn(6, |i, _| if i == k { 1.0 } else { 0.0 });
        let outside = (&axis - &space * (space.transpose() * &axis)).norm();
        (outside <= 1e-9).then_some(axis)
    });
    let mut chosen: Vec<DVector<f64>> = Vec::new();
    for candidate in axes.collect::<Vec<_>>().into_iter().chain(given) {
        let mut rest = candidate.normalize();
        for other in &chosen {
            rest -= other * other.dot(&rest);
        }
        if rest.norm() > 1e-3 && chosen.len() < own.len() {
            chosen.push(rest.normalize());
        }
    }
    if chosen.len() == own.len() {
        for (i, motion) in own.into_iter().zip(chosen) {
            list[i].twist = scaled_twist(scale, &Vector6::from_fn(|k, _| motion[k]));
        }
    }
}

/// Whether the platforms' tangent has no negative direction; with `held`, while the tool is held.
pub(crate) fn others_hold(
    tangent: &DMatrix<f64>,
    platform: usize,
    scale: Scale,
    held: bool,
) -> bool {
    let unit = |i: usize| {
        let root = scale.stiffness.sqrt();
        if i % 6 < 3 { root } else { root * scale.length }
    };
    let kept: Vec<usize> = (0..tangent.nrows())
        .filter(|i| !held || i / 6 != platform)
        .collect();
    if tangent.nrows() == 6 || kept.is_empty() {
        return true;
    }
    let balanced = DMatrix::from_fn(kept.len(), kept.len(), |a, b| {
        let (i, j) = (kept[a], kept[b]);
        0.5 * (tangent[(i, j)] + tangent[(j, i)]) / (unit(i) * unit(j))
    });
    let eigenvalues = balanced.symmetric_eigenvalues();
    eigenvalues.min() >= -1e-9 * eigenvalues.amax()
}

/// Stiffness of one platform with all others free: Schur complement.
pub(crate) fn condensed(tangent: &DMatrix<f64>, platform: usize, scale: Scale) -> Matrix6<f64> {
    let own: Vec<usize> = (6 * platform..6 * platform + 6).collect();
    let pick =
        |rows: &[usize], columns: &[usize]| tangent.select_rows(rows).select_columns(columns);
    let mut k = pick(&own, &own);
    let others: Vec<usize> = (0..tangent.nrows()).filter(|i| !own.contains(i)).collect();
    if !others.is_empty() {
        let mut b = pick(&others, &own);
        let root = scale.stiffness.sqrt();
        let units: Vec<f64> = others
            .iter()
            .map(|i| {
                if i % 6 < 3 {
                    1.0 / root
                } else {
                    1.0 / (root * scale.length)
                }
            })
            .collect();
        crate::saddle::Saddle::new(pick(&others, &others), &units, &units).solve(&mut b);
        k -= pick(&own, &others) * b;
    }
    k.fixed_view::<6, 6>(0, 0).into_owned()
}
