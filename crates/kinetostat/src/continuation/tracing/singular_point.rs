//! Start of a curve, and simple bifurcation points by Newton.

use nalgebra::{DMatrix, DVector};

use crate::continuation::tracing::system::CurveSystem;

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
