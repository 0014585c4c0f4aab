//! Null directions of the conditions of equilibrium, and simple bifurcation points by Newton.

use nalgebra::{DMatrix, DVector};

use crate::reduced::Reduced;
use crate::singular_values::SingularValues;

/// Null directions of an `m x n` matrix, the most certain first, with the singular values of all.
pub(crate) fn null_directions(matrix: &DMatrix<f64>) -> Vec<(f64, DVector<f64>)> {
    if !matrix.iter().all(|v| v.is_finite()) {
        return Vec::new();
    }
    let own = SingularValues::of(matrix);
    let all = own.all_right();
    let value = |k: usize| own.values.get(k).copied().unwrap_or(0.0);
    let falling = all.column_iter().enumerate();
    let list = falling.map(|(k, v)| (value(k), v.into_owned()));
    let mut list: Vec<_> = list.collect();
    list.reverse();
    list
}

/// Direction in which a curve starts: the null direction, and among several the one along which the
/// parameter changes most.
pub(crate) fn start_direction(matrix: &DMatrix<f64>) -> DVector<f64> {
    let m = matrix.nrows();
    let list = null_directions(matrix);
    let most = list.last().map_or(1.0, |l| l.0);
    let null: Vec<&DVector<f64>> = list
        .iter()
        .enumerate()
        .filter(|(k, l)| *k == 0 || l.0 < 1e-9 * most)
        .map(|(_, l)| &l.1)
        .collect();
    let mut sum = DVector::zeros(m + 1);
    for v in &null {
        sum += *v * v[m];
    }
    if sum.norm() > 1e-9 {
        sum.normalize()
    } else {
        let mut first = DVector::zeros(m + 1);
        if let Some(v) = null.first() {
            first.copy_from(v);
        }
        first
    }
}

/// Unit left null vector of a wide matrix of rank `m - 1`.
pub(crate) fn left_null(matrix: &DMatrix<f64>) -> DVector<f64> {
    let m = matrix.nrows();
    if !matrix.iter().all(|v| v.is_finite()) {
        return DVector::zeros(m);
    }
    let left = SingularValues::of(matrix).left;
    match left.ncols() {
        0 => DVector::zeros(m),
        k => left.column(k - 1).into_owned(),
    }
}

/// Step of the differences of `G_z` in balanced units.
const DIFFERENCE: f64 = 1e-5;

/// Derivative of `G_z(z) ` along `p`, by central differences.
fn change(reduced: &mut Reduced<'_, '_>, z: &DVector<f64>, p: &DVector<f64>) -> DMatrix<f64> {
    let (_, _, plus) = reduced.linearised_densely(&(z + p * DIFFERENCE));
    let (_, _, minus) = reduced.linearised_densely(&(z - p * DIFFERENCE));
    (plus - minus) / (2.0 * DIFFERENCE)
}

/// Newton on the extended system of a simple bifurcation point.
pub(crate) fn refine(reduced: &mut Reduced<'_, '_>, guess: &DVector<f64>) -> Option<DVector<f64>> {
    let m = reduced.count();
    let mut z = guess.clone();
    let (_, _, matrix) = reduced.linearised_densely(&z);
    let mut psi = left_null(&matrix);
    let mut beta = 0.0;
    let size = 2 * m + 2;
    let mut last = f64::INFINITY;
    for _ in 0..12 {
        let (lack, balance, g) = reduced.linearised_densely(&z);
        let mut residual = DVector::zeros(size);
        residual.rows_mut(0, m).copy_from(&(&lack + &psi * beta));
        residual
            .rows_mut(m, m + 1)
            .copy_from(&(g.transpose() * &psi));
        residual[size - 1] = psi.norm_squared() - 1.0;
        if last < 1e-9 && reduced.converged(&balance) {
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
            let column = change(reduced, &z, &p).transpose() * &psi;
            a.view_mut((m, j), (m + 1, 1)).copy_from(&column);
        }
        let step = a.lu().solve(&(-residual))?;
        let length = step.norm();
        if !length.is_finite() || length > 10.0 * last.min(1.0) {
            return None;
        }
        last = length;
        z += step.rows(0, m + 1);
        psi += step.rows(m + 1, m);
        beta += step[size - 1];
    }
    let (_, balance) = reduced.evaluate(&z);
    (last < 1e-8 && reduced.converged(&balance)).then_some(z)
}

/// Directions of the two branches through a simple bifurcation: roots of `a11 x^2 + 2 a12 x y + a22
/// y^2 = 0`, `a_ij = psi^T G_zz phi_i phi_j`. The path's own comes first.
pub(crate) fn tangents(
    reduced: &mut Reduced<'_, '_>,
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
    let d1 = change(reduced, z, &first);
    let d2 = change(reduced, z, &second);
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
