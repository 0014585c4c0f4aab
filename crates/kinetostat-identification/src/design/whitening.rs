//! Rank of the observation rows, and parameters in which all information together is the identity.

use nalgebra::DMatrix;

use super::error::{DesignError, InputMatrix, Unobservable};
use super::linalg::right_singular;

/// Eigenvalues of a semidefinite matrix up to this share of the largest are rounding.
const EIGENVALUE: f64 = 1e-13;

/// Change of parameters `x = T z` for which the information of all candidates and the fixed information together is `I`.
pub(super) struct Whitening {
    pub(super) matrix: DMatrix<f64>,
    /// Logarithm of the absolute determinant of `T`.
    pub(super) ln_determinant: f64,
}

impl Whitening {
    /// Decides the rank on the observation rows themselves: their squares would hide singular values below 1e-8.
    pub(super) fn new(
        candidates: &[DMatrix<f64>],
        fixed: &DMatrix<f64>,
        tolerance: f64,
    ) -> Result<Self, DesignError> {
        let p = candidates[0].ncols();
        let count: usize = candidates.iter().map(DMatrix::nrows).sum();
        // At least as many rows as columns, so that the triangle is square.
        let mut all = DMatrix::zeros(count + fixed.ncols() + p, p);
        let mut start = 0;
        for a in candidates {
            all.rows_mut(start, a.nrows()).copy_from(a);
            start += a.nrows();
        }
        all.rows_mut(start, fixed.ncols())
            .copy_from(&fixed.transpose());
        let mut lengths = Vec::with_capacity(p);
        for mut column in all.column_iter_mut() {
            let norm = column.norm();
            let length = if norm > 0.0 { norm } else { 1.0 };
            column /= length;
            lengths.push(length);
        }
        let (values, mut right) = right_singular(all.qr().r());
        let cut = tolerance * values.iter().copied().fold(0.0, f64::max);
        let rank = values.iter().filter(|v| **v > cut).count();
        for (mut row, length) in right.row_iter_mut().zip(&lengths) {
            row /= *length;
        }
        if rank < p {
            let lost: Vec<usize> = (0..p).filter(|k| values[*k] <= cut).collect();
            let mut combinations = right.select_columns(&lost);
            for mut column in combinations.column_iter_mut() {
                column /= column.amax();
            }
            return Err(DesignError::NotIdentifiable(Unobservable {
                rank,
                parameters: p,
                combinations,
            }));
        }
        for (mut column, value) in right.column_iter_mut().zip(&values) {
            column /= *value;
        }
        let ln = |x: &f64| x.ln();
        Ok(Self {
            matrix: right,
            ln_determinant: -lengths.iter().map(ln).sum::<f64>()
                - values.iter().map(ln).sum::<f64>(),
        })
    }
}

/// Matrix `B` (parameters x rank) with `B B^T` equal to a symmetric positive semidefinite matrix.
pub(super) fn root(
    m: &DMatrix<f64>,
    matrix: InputMatrix,
    parameters: usize,
) -> Result<DMatrix<f64>, DesignError> {
    if m.shape() != (parameters, parameters) {
        return Err(DesignError::MatrixShape {
            matrix,
            rows: m.nrows(),
            columns: m.ncols(),
            parameters,
        });
    }
    // Unit diagonal: units of the parameters must not decide about the rank.
    let sizes: Vec<f64> = (0..parameters)
        .map(|i| {
            if m[(i, i)] > 0.0 {
                m[(i, i)].sqrt()
            } else {
                1.0
            }
        })
        .collect();
    let scaled = DMatrix::from_fn(parameters, parameters, |i, j| {
        m[(i, j)] / sizes[i] / sizes[j]
    });
    let symmetric = (&scaled - scaled.transpose()).amax() <= 1e-9;
    let negative = (0..parameters).any(|i| m[(i, i)] < 0.0);
    if !scaled.iter().all(|x| x.is_finite()) || !symmetric || negative {
        return Err(DesignError::NotSemidefinite { matrix });
    }
    let eigen = ((&scaled + scaled.transpose()) * 0.5).symmetric_eigen();
    let largest = eigen.eigenvalues.max().max(0.0);
    if eigen.eigenvalues.min() < -1e-9 * largest || (largest == 0.0 && scaled.amax() > 0.0) {
        return Err(DesignError::NotSemidefinite { matrix });
    }
    let kept: Vec<usize> = (0..parameters)
        .filter(|k| eigen.eigenvalues[*k] > EIGENVALUE * largest)
        .collect();
    let mut b = eigen.eigenvectors.select_columns(&kept);
    for (mut column, k) in b.column_iter_mut().zip(&kept) {
        column *= eigen.eigenvalues[*k].sqrt();
    }
    for (mut row, size) in b.row_iter_mut().zip(&sizes) {
        row *= *size;
    }
    Ok(b)
}
