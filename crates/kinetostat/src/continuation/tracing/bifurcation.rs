//! Bifurcation points between two steps of a curve: located, refined, classified, with the branches that cross there.
//!
//! A simple bifurcation is a change of sign of `det [G_z; t^T]` along the curve (Keller 1977; Seydel, Practical
//! Bifurcation and Stability Analysis, 5.2). Two modes that become critical together leave the sign as it is: they are
//! found by the number of unstable modes.

use nalgebra::{DMatrix, DVector};

use crate::continuation::curve::{CurveStability, Special, SpecialKind};
use crate::continuation::linear::tangent::{NullDirections, Tangent};
use crate::continuation::tracing::describe::describe;
use crate::continuation::tracing::segment::{Sample, Segment, largest_one};
use crate::continuation::tracing::system::{Corrected, CurveSystem, SpecialPoint};

/// Singular values below this share of the largest belong to directions in which branches may leave.
const NULL: f64 = 1e-5;

/// The bifurcation point of a segment and its share of it; `even` where an even number of modes changes, which the
/// determinant does not show.
pub(crate) fn bifurcation<S: CurveSystem>(
    system: &mut S,
    segment: &Segment<'_, S>,
    before: &Tangent,
    after: &Tangent,
    even: bool,
) -> Option<(f64, SpecialPoint<S>)> {
    let step = (&segment.there.z - &segment.here.z).norm();
    let share = match even {
        true => by_count(system, segment)?,
        false => by_determinant(system, segment, before, after),
    };
    // Right at the point the tangent is undefined: beside it the corrector still works.
    let guess = match segment.at(system, share) {
        Some((c, _)) => c.z,
        None => &segment.here.z + (&segment.there.z - &segment.here.z) * share,
    };
    system.set_dense(true);
    let special = classified(system, segment, &guess, step, even);
    system.set_dense(false);
    special.map(|special| (share, special))
}

/// Change of the number of unstable modes, by bisection.
fn by_count<S: CurveSystem>(system: &mut S, segment: &Segment<'_, S>) -> Option<f64> {
    let count = segment.here.unstable;
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..40 {
        let middle = 0.5 * (low + high);
        let (c, _) = segment.at(system, middle)?;
        system.evaluate(&c.z);
        let same = (0..2).all(|k| system.stability(&c, k == 0).unstable_modes() == count[k]);
        match same {
            true => low = middle,
            false => high = middle,
        }
    }
    Some(0.5 * (low + high))
}

/// Change of the number of unstable modes through parts that are condensed out of the unknowns.
pub(crate) fn stability_change<S: CurveSystem>(
    system: &mut S,
    segment: &Segment<'_, S>,
) -> Option<(f64, SpecialPoint<S>)> {
    let (here, there) = (segment.here, segment.there);
    if here.unstable == there.unstable {
        return None;
    }
    let share = by_count(system, segment)?;
    let (c, t) = segment.at(system, share)?;
    let special = Special {
        kind: SpecialKind::StabilityChange,
        mode: largest_one(system.motion(&t.direction)),
        point: describe(system, &c, t.direction),
        accuracy: 1e-6,
        branches: Vec::new(),
        lost_branch: false,
        stable_side: here.displacement_control.stable() || there.displacement_control.stable(),
        directions: Vec::new(),
    };
    Some((share, special))
}

/// Zero of the determinant.
fn by_determinant<S: CurveSystem>(
    system: &mut S,
    segment: &Segment<'_, S>,
    before: &Tangent,
    after: &Tangent,
) -> f64 {
    let reference = before.logarithm.max(after.logarithm);
    let value = move |t: &Tangent| t.sign * (t.logarithm - reference).exp();
    let (low, high) = (
        Sample::new(0.0, value(before)),
        Sample::new(1.0, value(after)),
    );
    segment.root(system, low, high, 1e-9, &move |_, _, t| value(t))
}

/// Kind of the bifurcation at a place, and the branches that cross there; with dense matrices.
fn classified<S: CurveSystem>(
    system: &mut S,
    segment: &Segment<'_, S>,
    guess: &DVector<f64>,
    step: f64,
    even: bool,
) -> Option<SpecialPoint<S>> {
    // The extended system is singular along a family; the test function alone has found the place.
    let refined = match even || system.family().is_some() {
        true => None,
        false => refine(system, guess).filter(|z| (z - guess).norm() < 0.5 * step),
    };
    let accuracy = if refined.is_some() { 1e-10 } else { 1e-6 };
    let only_located = refined.is_none();
    let z = refined.unwrap_or_else(|| guess.clone());
    let (_, norms, matrix) = system.linearised_densely(&z);
    let found = match system.family().cloned() {
        Some(family) => system.null_directions(&family.beside(&matrix)),
        None => system.null_directions(&matrix),
    };
    let whole = system.whole(matrix.clone());
    if found.values.is_empty() || (only_located && found.count(0, NULL) < 2) {
        return None;
    }
    let null: Vec<DVector<f64>> = (0..found.count(2, NULL))
        .map(|k| found.right.column(k).into_owned())
        .collect();
    let mean = (&segment.here.tangent + &segment.there.tangent).normalize();
    let own = within(&null, &mean);
    let crossing = match null.len() {
        2 => two_branches(system, &z, &matrix, found, &null, &own),
        _ => many_branches(&null, own),
    };
    let corrected = Corrected {
        z,
        matrix: whole,
        norms,
        iterations: 0,
    };
    let mode = largest_one(system.motion(&crossing.mode));
    let point = describe(system, &corrected, crossing.path);
    let (here, there) = (segment.here, segment.there);
    Some(Special {
        kind: crossing.kind,
        point,
        mode,
        accuracy,
        branches: Vec::new(),
        lost_branch: false,
        stable_side: here.displacement_control.stable() || there.displacement_control.stable(),
        directions: crossing.others,
    })
}

/// The curve's own direction within the null space, from what was seen of it.
fn within(null: &[DVector<f64>], seen: &DVector<f64>) -> DVector<f64> {
    let mut sum = DVector::zeros(seen.len());
    for v in null {
        sum += v * v.dot(seen);
    }
    let size = sum.norm();
    match size > 1e-12 {
        true => sum / size,
        false => seen.clone(),
    }
}

/// Branches that cross at a bifurcation point.
struct Crossing {
    kind: SpecialKind,
    /// Direction of the branch on which the point was found.
    path: DVector<f64>,
    /// Directions of the other branches.
    others: Vec<DVector<f64>>,
    /// The critical mode.
    mode: DVector<f64>,
}

/// A simple bifurcation: two branches.
fn two_branches<S: CurveSystem>(
    system: &mut S,
    z: &DVector<f64>,
    matrix: &DMatrix<f64>,
    found: NullDirections,
    null: &[DVector<f64>],
    own: &DVector<f64>,
) -> Crossing {
    let left = match system.family().cloned() {
        Some(family) => system.null_directions(&family.beside_left(matrix)).left,
        None => found.left,
    };
    let psi = left.column(0).into_owned();
    let (path, other) = tangents(system, z, &psi, null, own);
    let m = z.len() - 1;
    let flat = |d: &DVector<f64>| d[m].abs() < 1e-4;
    let kind = if flat(&path) || flat(&other) {
        SpecialKind::Pitchfork
    } else {
        SpecialKind::Transcritical
    };
    // The mode is the null motion at a fixed parameter; where both keep it, the other branch.
    let mode = if path[m].abs() > 1e-9 {
        &other - &path * (other[m] / path[m])
    } else {
        other.clone()
    };
    Crossing {
        kind,
        path,
        others: vec![other],
        mode,
    }
}

/// Several modes at once: what is left of the null space across the curve's own direction.
fn many_branches(null: &[DVector<f64>], path: DVector<f64>) -> Crossing {
    let mut others: Vec<DVector<f64>> = Vec::new();
    for v in null {
        let mut v = v - &path * path.dot(v);
        for d in &others {
            v -= d * d.dot(&v);
        }
        if v.norm() > 1e-3 {
            others.push(v.normalize());
        }
    }
    Crossing {
        kind: SpecialKind::Multiple {
            modes: null.len() - 1,
        },
        mode: others.first().cloned().unwrap_or_else(|| path.clone()),
        path,
        others,
    }
}

/// Direction in which a curve starts: the null direction, and among several the one along which the
/// parameter changes most.
pub(crate) fn start_direction<S: CurveSystem>(system: &mut S, z: &DVector<f64>) -> DVector<f64> {
    let (_, _, matrix) = system.linearised_densely(z);
    let found = system.null_directions(&matrix);
    let m = matrix.nrows();
    let null = found.right.columns(0, found.count(1, 1e-9));
    let sum = null * null.row(m).transpose();
    if sum.norm() > 1e-9 {
        sum.normalize()
    } else if null.ncols() > 0 {
        system.start_where_still(&null.into_owned())
    } else {
        DVector::zeros(m + 1)
    }
}

/// Step of the differences of `G_z` in scaled units.
const DIFFERENCE: f64 = 1e-5;

/// Derivative of `G_z(z) ` along `p`, by central differences.
fn change<S: CurveSystem>(system: &mut S, z: &DVector<f64>, p: &DVector<f64>) -> DMatrix<f64> {
    let (_, _, plus) = system.linearised_densely(&(z + p * DIFFERENCE));
    let (_, _, minus) = system.linearised_densely(&(z - p * DIFFERENCE));
    (plus - minus) / (2.0 * DIFFERENCE)
}

/// Newton on the extended system of a simple bifurcation point.
pub(crate) fn refine<S: CurveSystem>(system: &mut S, guess: &DVector<f64>) -> Option<DVector<f64>> {
    let m = system.count();
    let mut z = guess.clone();
    let (_, _, matrix) = system.linearised_densely(&z);
    let found = system.null_directions(&matrix);
    if found.left.ncols() == 0 {
        return None;
    }
    let mut psi = found.left.column(0).into_owned();
    let mut beta = 0.0;
    let size = 2 * m + 2;
    let mut last = f64::INFINITY;
    for _ in 0..12 {
        let (residual, norms, g) = system.linearised_densely(&z);
        let mut extended = DVector::zeros(size);
        extended
            .rows_mut(0, m)
            .copy_from(&(&residual + &psi * beta));
        extended
            .rows_mut(m, m + 1)
            .copy_from(&(g.transpose() * &psi));
        extended[size - 1] = psi.norm_squared() - 1.0;
        if last < 1e-9 && system.converged(&norms) {
            return Some(z);
        }
        if !g.iter().all(|v| v.is_finite()) {
            return None;
        }
        let mut a = DMatrix::zeros(size, size);
        a.view_mut((0, 0), (m, m + 1)).copy_from(&g);
        for i in 0..m {
            a[(i, m + 1 + i)] = beta;
            a[(i, size - 1)] = psi[i];
            a[(size - 1, m + 1 + i)] = 2.0 * psi[i];
        }
        a.view_mut((m, m + 1), (m + 1, m)).copy_from(&g.transpose());
        for j in 0..=m {
            let mut p = DVector::zeros(m + 1);
            p[j] = 1.0;
            let column = change(system, &z, &p).transpose() * &psi;
            a.view_mut((m, j), (m + 1, 1)).copy_from(&column);
        }
        let step = a.lu().solve(&(-extended))?;
        let length = step.norm();
        if !length.is_finite() || length > 10.0 * last.min(1.0) {
            return None;
        }
        last = length;
        z += step.rows(0, m + 1);
        psi += step.rows(m + 1, m);
        beta += step[size - 1];
    }
    let (_, norms) = system.evaluate(&z);
    (last < 1e-8 && system.converged(&norms)).then_some(z)
}

/// Directions of the two branches through a simple bifurcation: roots of `a11 x^2 + 2 a12 x y + a22
/// y^2 = 0`, `a_ij = psi^T G_zz phi_i phi_j`. The path's own comes first.
pub(crate) fn tangents<S: CurveSystem>(
    system: &mut S,
    z: &DVector<f64>,
    psi: &DVector<f64>,
    null: &[DVector<f64>],
    own: &DVector<f64>,
) -> (DVector<f64>, DVector<f64>) {
    // Basis: the path as it was seen, and across.
    let first = own.clone();
    let pick = if null[0].dot(own).abs() < null[1].dot(own).abs() {
        &null[0]
    } else {
        &null[1]
    };
    let second = (pick - own * own.dot(pick)).normalize();
    let d1 = change(system, z, &first);
    let d2 = change(system, z, &second);
    let a11 = psi.dot(&(&d1 * &first));
    let a12 = 0.5 * (psi.dot(&(&d1 * &second)) + psi.dot(&(&d2 * &first)));
    let a22 = psi.dot(&(&d2 * &second));
    // `first` is nearly a root: a11 is small. x/y of the other from the larger root.
    let discriminant = a12 * a12 - a11 * a22;
    if discriminant <= 0.0 || a12.abs() < 1e-9 * (a11.abs() + a22.abs() + 1e-9) {
        return (first, second);
    }
    let q = -(a12 + a12.signum() * discriminant.sqrt());
    // Roots for (x, y): x/y = q / a11 = large (the path) and a22 / q.
    let path = (&first + &second * (a11 / q)).normalize();
    let other = (&first * (a22 / q) + &second).normalize();
    (path, other)
}
