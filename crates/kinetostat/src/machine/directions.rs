//! Principal directions of a machine's tool, and what its platforms' tangent says about it.

use std::collections::BTreeSet;

use nalgebra::{DMatrix, DVector, Matrix6, Vector3, Vector6};

use crate::chain::directions::scaled_twist;
use crate::chain::stability::{TangentMotions, diverging_motions};
use crate::chain::stiffness::{ChainStiffness, Direction, DirectionKind, directions};
use crate::linalg::block_elimination::Pivots;
use crate::linalg::complement::complement;
use crate::linalg::saddle::{Saddle, column_space, independent_columns};
use crate::linalg::sparse::Sparse;
use crate::machine::graded::GradedPlatforms;
use crate::machine::platform_system::{PlatformSystem, RigidRows, motion_units};
use crate::model::chain::Scale;
use crate::spatial::shift_matrix;

/// Principal directions of the stiffness of a machine's only moving platform; motions that a limb (its own
/// stiffness and the arm to its tip) cannot follow are rigid.
pub(crate) fn scaled_directions<'a>(
    matrix: &Matrix6<f64>,
    graded: Option<&GradedPlatforms>,
    scale: Scale,
    limbs: impl Iterator<Item = (&'a ChainStiffness, Vector3<f64>, Scale)>,
) -> Vec<Direction> {
    let root = scale.stiffness.sqrt();
    let factor = |i: usize| if i < 3 { root } else { root * scale.length };
    let scaled = |k: &Matrix6<f64>| Matrix6::from_fn(|i, j| k[(i, j)] / (factor(i) * factor(j)));
    let mut blocked: Vec<DVector<f64>> = Vec::new();
    for (limb, arm, own) in limbs {
        let shift = shift_matrix(&arm).transpose();
        for direction in limb
            .directions
            .iter()
            .filter(|d| d.kind == DirectionKind::Rigid)
        {
            // The limb's scaled normal, as a wrench on the platform, in the platform's scaling.
            let t = direction.twist.0;
            let square = own.length * own.length;
            let wrench = Vector6::from_fn(|k, _| if k < 3 { t[k] } else { t[k] * square });
            let on_platform = shift * wrench;
            blocked.push(DVector::from_fn(6, |k, _| on_platform[k] / factor(k)).normalize());
        }
    }
    let range = if blocked.is_empty() {
        DMatrix::identity(6, 6)
    } else {
        complement(&column_space(&DMatrix::from_columns(&blocked)))
    };
    along_all_axes(
        match graded {
            Some(graded) => graded.directions(&range),
            None => directions(scale, &scaled(matrix), &range),
        },
        scale,
    )
}

/// [`along_axes`] of both kinds that have no basis of their own.
fn along_all_axes(mut list: Vec<Direction>, scale: Scale) -> Vec<Direction> {
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

/// Motions of the platforms that limbs which cannot move that way allow: an orthonormal basis of
/// the null space of `rigid`, scaled. `None`: all of them.
fn possible_motions(rigid: &DMatrix<f64>, units: &[f64]) -> Option<DMatrix<f64>> {
    if rigid.nrows() == 0 {
        return None;
    }
    let mut rows = DMatrix::from_fn(units.len(), rigid.nrows(), |i, k| rigid[(k, i)] * units[i]);
    for mut column in rows.column_iter_mut() {
        let size = column.norm();
        if size > 0.0 {
            column /= size;
        }
    }
    Some(complement(&independent_columns(&rows)))
}

/// True if the platforms' tangent has no negative direction among the motions that no row of `rigid` forbids; with
/// `held`, while the tool is held.
pub(crate) fn others_hold(
    tangent: &Sparse,
    graded: Option<&GradedPlatforms>,
    rigid: &RigidRows,
    platform: usize,
    scale: Scale,
    held: bool,
) -> bool {
    let size = tangent.rows;
    if size == 6 {
        return true;
    }
    if let Some(graded) = graded {
        let held = held.then_some(platform);
        let kept: Vec<usize> = (0..size).filter(|i| Some(i / 6) != held).collect();
        let units = motion_units(kept.len(), scale);
        let possible = possible_motions(&rigid.matrix.dense().select_columns(&kept), &units);
        return graded.hold(possible.as_ref(), held);
    }
    if let Some(answer) = others_certainly_hold(tangent, rigid, platform, scale, held) {
        return answer;
    }
    let scaled = scaled_tangent(tangent, rigid, platform, scale, held);
    if scaled.is_empty() {
        return true;
    }
    let eigenvalues = (0.5 * (&scaled + scaled.transpose())).symmetric_eigenvalues();
    eigenvalues.min() >= -ZERO_STIFFNESS * eigenvalues.amax()
}

/// True if no platform diverges under loads without a potential, whatever the tangent's symmetric part is; with `held`,
/// while the tool is held. `motions`: all, if the limbs have none of their own besides.
pub(crate) fn none_diverges(
    tangent: &Sparse,
    directions: &[Direction],
    rigid: &RigidRows,
    platform: usize,
    scale: Scale,
    held: bool,
    motions: TangentMotions,
) -> bool {
    let mut scaled = scaled_tangent(tangent, rigid, platform, scale, held);
    // For the limbs of a single platform the directions tell which motions are impossible.
    if scaled.nrows() == 6 && tangent.rows == 6 {
        let all = DMatrix::identity(6, 6);
        let possible = without(directions, DirectionKind::Rigid, scale.length, &all);
        scaled = possible.transpose() * scaled * possible;
    }
    let zero = ZERO_STIFFNESS * scaled.amax();
    diverging_motions(&scaled, zero, motions) == 0
}

/// Restricts some motions (scaled, orthonormal, by a natural length) to those across all directions of a kind.
pub(crate) fn without(
    directions: &[Direction],
    kind: DirectionKind,
    length: f64,
    motions: &DMatrix<f64>,
) -> DMatrix<f64> {
    let taken: Vec<DVector<f64>> = directions
        .iter()
        .filter(|d| d.kind == kind)
        .map(|d| {
            let scaled =
                DVector::from_fn(6, |i, _| d.twist.0[i] * if i < 3 { 1.0 } else { length });
            motions.transpose() * scaled
        })
        .filter(|part| part.norm() > 1e-6)
        .collect();
    if taken.is_empty() {
        return motions.clone();
    }
    motions * complement(&independent_columns(&DMatrix::from_columns(&taken)))
}

/// Tangent of the platforms, scaled, in the motions that no row of `rigid` forbids; with `held`, without those of
/// the tool.
fn scaled_tangent(
    tangent: &Sparse,
    rigid: &RigidRows,
    platform: usize,
    scale: Scale,
    held: bool,
) -> DMatrix<f64> {
    let size = tangent.rows;
    let (tangent, rigid) = (tangent.dense(), rigid.matrix.dense());
    let kept: Vec<usize> = (0..size).filter(|i| !held || i / 6 != platform).collect();
    let units = motion_units(size, scale);
    let units: Vec<f64> = kept.iter().map(|&i| units[i]).collect();
    let scaled = DMatrix::from_fn(kept.len(), kept.len(), |a, b| {
        tangent[(kept[a], kept[b])] * (units[a] * units[b])
    });
    match possible_motions(&rigid.select_columns(&kept), &units) {
        Some(possible) => possible.transpose() * scaled * possible,
        None => scaled,
    }
}

/// [`others_hold`] by the inertia of the sparse system, where it leaves no doubt: every
/// independent row that forbids a motion adds one negative eigenvalue, whatever holds.
fn others_certainly_hold(
    tangent: &Sparse,
    rigid: &RigidRows,
    platform: usize,
    scale: Scale,
    held: bool,
) -> Option<bool> {
    let mut symmetric = tangent.clone();
    symmetric.entries = tangent
        .entries
        .iter()
        .flat_map(|&(i, j, v)| [(i, j, 0.5 * v), (j, i, 0.5 * v)])
        .collect();
    let mut system = PlatformSystem::new(symmetric, rigid, scale);
    if held {
        system = system.holding(platform);
    }
    let entries = &system.matrix.entries;
    let rows: BTreeSet<usize> = entries.iter().map(|(i, _, _)| *i).collect();
    let forbidden = rows.range(tangent.rows..).count();
    let (inertia, least) = system.factors(Pivots::Any)?.inertia();
    // Positive ones hold however small they are; a negative one may be rounding.
    if inertia.negative == forbidden {
        Some(true)
    } else {
        (least > ZERO_STIFFNESS).then_some(false)
    }
}

/// Negative stiffness counts above this share of the largest.
const ZERO_STIFFNESS: f64 = 1e-9;

/// Differences between entries and their mirror images count above this share of the largest entry.
const SKEW: f64 = 1e-11;

/// Stiffness of one platform with all others free.
struct Condensed {
    /// Condensed stiffness; impossible motions contribute nothing.
    matrix: Matrix6<f64>,
    /// Motions that it can make: orthonormal basis, 6 x r, scaled.
    range: DMatrix<f64>,
}

/// Stiffness (SI) and principal directions of a platform with others behind it, all others free; rows of `rigid`
/// are motions of the platforms that limbs forbid.
pub(crate) fn condensed_directions(
    tangent: &Sparse,
    graded: Option<&GradedPlatforms>,
    rigid: &RigidRows,
    platform: usize,
    scale: Scale,
) -> (Matrix6<f64>, Vec<Direction>) {
    let found = condensed(tangent, rigid, platform, scale);
    let (matrix, list) = if let Some(graded) = graded {
        let possible = possible_motions(&rigid.matrix.dense(), &motion_units(tangent.rows, scale));
        let (matrix, list) = graded.condensed(possible.as_ref(), platform);
        // Loads without a potential make it unsymmetric.
        let skew = 0.5 * (found.matrix - found.matrix.transpose());
        let rounding = SKEW * found.matrix.amax();
        (
            matrix + skew.map(|x| if x.abs() > rounding { x } else { 0.0 }),
            list,
        )
    } else {
        let root = scale.stiffness.sqrt();
        let factor = |i: usize| if i < 3 { root } else { root * scale.length };
        let scaled = Matrix6::from_fn(|i, j| found.matrix[(i, j)] / (factor(i) * factor(j)));
        (found.matrix, directions(scale, &scaled, &found.range))
    };
    (matrix, along_all_axes(list, scale))
}

/// Stiffness of one platform with all others free; rows of `rigid` are motions of the platforms
/// that limbs forbid.
fn condensed(tangent: &Sparse, rigid: &RigidRows, platform: usize, scale: Scale) -> Condensed {
    if let Some(matrix) = condensed_sparse(tangent, rigid, platform, scale) {
        return Condensed {
            matrix,
            range: DMatrix::identity(6, 6),
        };
    }
    let (tangent, rigid) = (&tangent.dense(), &rigid.matrix.dense());
    let own: Vec<usize> = (6 * platform..6 * platform + 6).collect();
    let units = motion_units(tangent.nrows(), scale);
    if let Some(possible) = possible_motions(rigid, &units) {
        return among(tangent, &possible, &own, &units);
    }
    let pick =
        |rows: &[usize], columns: &[usize]| tangent.select_rows(rows).select_columns(columns);
    let mut k = pick(&own, &own);
    let others: Vec<usize> = (0..tangent.nrows()).filter(|i| !own.contains(i)).collect();
    if !others.is_empty() {
        let mut b = pick(&others, &own);
        let units: Vec<f64> = others.iter().map(|&i| units[i]).collect();
        Saddle::new(pick(&others, &others), &units, &units).solve(&mut b);
        k -= pick(&own, &others) * b;
    }
    Condensed {
        matrix: k.fixed_view::<6, 6>(0, 0).into_owned(),
        range: DMatrix::identity(6, 6),
    }
}

/// [`condensed`] of many platforms where all others are held by the one: any motion of it can be
/// followed, and in one way.
fn condensed_sparse(
    tangent: &Sparse,
    rigid: &RigidRows,
    platform: usize,
    scale: Scale,
) -> Option<Matrix6<f64>> {
    let whole = PlatformSystem::new(tangent.clone(), rigid, scale);
    let first = 6 * platform;
    let own = first..first + 6;
    let (mut moved, mut answer) = (DMatrix::zeros(whole.units.len(), 6), Matrix6::zeros());
    for &(i, j, value) in &whole.matrix.entries {
        match (own.contains(&i), own.contains(&j)) {
            (true, true) => answer[(i - first, j - first)] += value,
            (false, true) => moved[(i, j - first)] -= value,
            _ => {}
        }
    }
    let entries = whole.matrix.entries.clone();
    let others = whole.holding(platform);
    let used: BTreeSet<usize> = others.matrix.entries.iter().map(|(i, _, _)| *i).collect();
    // A row that only holds the platform itself: rigid, and no affair of the others.
    if (tangent.rows..others.units.len()).any(|row| !used.contains(&row)) {
        return None;
    }
    others.factors(Pivots::Any)?.solve(&mut moved);
    for (i, j, value) in entries {
        if own.contains(&i) && !own.contains(&j) {
            for k in 0..6 {
                answer[(i - first, k)] += value * moved[(j, k)];
            }
        }
    }
    Some(answer)
}

/// Stiffness within the possible motions `Z`, scaled: `[Z^T K Z, -S^T; S, 0] [z; f] = [0; 1]` with `S` the part of `Z`
/// that is the platform's own, in a basis of its motions.
fn among(
    tangent: &DMatrix<f64>,
    possible: &DMatrix<f64>,
    own: &[usize],
    units: &[f64],
) -> Condensed {
    let scaled = DMatrix::from_fn(tangent.nrows(), tangent.ncols(), |i, j| {
        tangent[(i, j)] * units[i] * units[j]
    });
    let part = possible.select_rows(own);
    let range = if possible.ncols() == 0 {
        DMatrix::zeros(6, 0)
    } else {
        independent_columns(&part)
    };
    let (z, r) = (possible.ncols(), range.ncols());
    if r == 0 {
        return Condensed {
            matrix: Matrix6::zeros(),
            range,
        };
    }
    let reduced = range.transpose() * part;
    let mut a = DMatrix::zeros(z + r, z + r);
    a.view_mut((0, 0), (z, z))
        .copy_from(&(possible.transpose() * scaled * possible));
    a.view_mut((0, z), (z, r)).copy_from(&-reduced.transpose());
    a.view_mut((z, 0), (r, z)).copy_from(&reduced);
    let mut b = DMatrix::zeros(z + r, r);
    b.view_mut((z, 0), (r, r)).fill_with_identity();
    let ones = vec![1.0; z + r];
    Saddle::new(a, &ones, &ones).solve(&mut b);
    let k = &range * b.rows(z, r) * range.transpose();
    Condensed {
        matrix: Matrix6::from_fn(|i, j| k[(i, j)] / (units[own[i]] * units[own[j]])),
        range,
    }
}
