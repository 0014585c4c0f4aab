//! Checked input in whitened parameters.

use kinetostat::linalg::SingularValues;
use nalgebra::{DMatrix, DVector};

use super::criterion::{Criterion, DesignSettings};
use super::error::DesignError;
use super::objective::Objective;

/// Smallest singular value of all observation rows together, relative to the largest and with columns of unit length, at which a
/// combination of parameters counts as identifiable.
const RANK_TOLERANCE: f64 = 1e-8;

/// Candidates and criterion in parameters for which all candidates and the fixed information together have the information `I`.
///
/// The whitening removes the units of the parameters (radians per newton metre beside metres) from all conditions of matrices.
pub(super) struct Problem {
    pub(super) parameters: usize,
    /// Number of postures to choose.
    pub(super) count: usize,
    /// True if a posture may be chosen more than once.
    pub(super) repeats: bool,
    /// Observation rows of each candidate, at most as many as parameters.
    pub(super) rows: Vec<DMatrix<f64>>,
    /// Entries of the information matrix of each candidate as columns.
    pub(super) information: DMatrix<f64>,
    /// Fixed information.
    pub(super) fixed: DMatrix<f64>,
    pub(super) objective: Objective,
}

impl Problem {
    /// Checks the input and whitens the parameters.
    pub(super) fn new(
        candidates: &[DMatrix<f64>],
        criterion: &Criterion,
        count: usize,
        settings: &DesignSettings,
    ) -> Result<Self, DesignError> {
        check(candidates, count, settings)?;
        let p = candidates[0].ncols();
        let fixed = match &settings.fixed_information {
            Some(m) => root(m, "fixed information", p)?,
            None => DMatrix::zeros(p, 0),
        };
        let test_poses = match criterion {
            Criterion::TestPoses(l) => root(l, "matrix of the test poses", p)?,
            _ => DMatrix::identity(p, p),
        };
        if test_poses.is_empty() {
            return Err(DesignError::ZeroTestPoses);
        }
        let (t, ln_determinant) = whitening(candidates, &fixed)?;
        let test_poses = t.tr_mul(&test_poses);
        let objective = match criterion {
            Criterion::TestPoses(_) | Criterion::Average => Objective::Linear(test_poses),
            Criterion::Determinant => Objective::Determinant(2.0 * ln_determinant / p as f64),
            Criterion::WorstDirection => Objective::Worst(test_poses),
        };
        let whitened = candidates.iter().map(|a| a * &t);
        let rows: Vec<DMatrix<f64>> = whitened
            .map(|a| if a.nrows() > p { a.qr().r() } else { a })
            .collect();
        let mut information = DMatrix::zeros(p * p, rows.len());
        for (a, mut column) in rows.iter().zip(information.column_iter_mut()) {
            column.copy_from_slice(a.tr_mul(a).as_slice());
        }
        let fixed = t.tr_mul(&fixed);
        Ok(Self {
            parameters: p,
            count,
            repeats: settings.repeats,
            rows,
            information,
            fixed: &fixed * fixed.transpose(),
            objective,
        })
    }

    /// Information of one candidate.
    pub(super) fn information_of(&self, x: usize) -> DMatrix<f64> {
        let column = self.information.column(x);
        DMatrix::from_column_slice(self.parameters, self.parameters, column.as_slice())
    }

    /// Information `base + sum w_x A_x^T A_x`.
    pub(super) fn weighted(&self, base: &DMatrix<f64>, weights: &DVector<f64>) -> DMatrix<f64> {
        let sum = &self.information * weights;
        base + DMatrix::from_column_slice(self.parameters, self.parameters, sum.as_slice())
    }

    /// Information of a set of postures, added to `base`.
    pub(super) fn sum(&self, base: &DMatrix<f64>, postures: &[usize]) -> DMatrix<f64> {
        let each = postures.iter().map(|x| self.information_of(*x));
        each.fold(base.clone(), |sum, information| sum + information)
    }

    /// Sensitivity `|A_x S|^2` of each candidate.
    pub(super) fn sensitivities(&self, solution: &DMatrix<f64>) -> DVector<f64> {
        let gradient = solution * solution.transpose();
        let gradient = DVector::from_column_slice(gradient.as_slice());
        self.information.tr_mul(&gradient)
    }

    /// Rank of the information of a set of postures.
    pub(super) fn rank(&self, postures: &[usize]) -> usize {
        SingularValues::of(&self.sum(&self.fixed, postures)).rank(1e-12)
    }

    /// Error of sets of postures whose largest rank is `rank`.
    pub(super) fn too_few_observations(&self, rank: usize) -> DesignError {
        DesignError::TooFewObservations {
            count: self.count,
            rank,
            parameters: self.parameters,
        }
    }
}

/// Change of parameters `x = T z` for which all information together is `I`, with the logarithm of its absolute determinant.
///
/// The rank is decided on the observation rows themselves: their squares would hide singular values below 1e-8.
fn whitening(
    candidates: &[DMatrix<f64>],
    fixed: &DMatrix<f64>,
) -> Result<(DMatrix<f64>, f64), DesignError> {
    let p = fixed.nrows();
    let fixed = fixed.transpose();
    let rows: Vec<_> = (candidates.iter().flat_map(|a| a.row_iter()))
        .chain(fixed.row_iter())
        .collect();
    let mut all = DMatrix::from_rows(&rows);
    let mut lengths = Vec::with_capacity(p);
    for mut column in all.column_iter_mut() {
        let norm = column.norm();
        lengths.push(if norm > 0.0 { norm } else { 1.0 });
        column /= lengths[lengths.len() - 1];
    }
    let singular = SingularValues::of(&all);
    let rank = singular.rank(RANK_TOLERANCE);
    if rank < p {
        let mut combinations = singular.null_space(RANK_TOLERANCE);
        for (mut row, length) in combinations.row_iter_mut().zip(&lengths) {
            row /= *length;
        }
        for mut column in combinations.column_iter_mut() {
            column /= column.amax();
        }
        return Err(DesignError::NotIdentifiable {
            rank,
            parameters: p,
            combinations,
        });
    }
    let values = &singular.values;
    let matrix = DMatrix::from_fn(p, p, |i, k| singular.right[(i, k)] / lengths[i] / values[k]);
    let ln_determinant = -lengths.iter().chain(values).map(|x| x.ln()).sum::<f64>();
    Ok((matrix, ln_determinant))
}

/// Matrix `B` (parameters x rank) with `B B^T` equal to a symmetric positive semidefinite matrix.
fn root(
    m: &DMatrix<f64>,
    matrix: &'static str,
    parameters: usize,
) -> Result<DMatrix<f64>, DesignError> {
    let fits = m.shape() == (parameters, parameters);
    let root = if fits { square_root(m) } else { None };
    root.ok_or(DesignError::NotSemidefinite { matrix, parameters })
}

/// Refuses shapes, numbers and settings that have no design.
fn check(
    candidates: &[DMatrix<f64>],
    count: usize,
    settings: &DesignSettings,
) -> Result<(), DesignError> {
    if !(settings.gap > 0.0 && settings.gap < 1.0) {
        return Err(DesignError::Gap(settings.gap));
    }
    let expected = candidates.first().map_or(0, DMatrix::ncols);
    if expected == 0 {
        return Err(DesignError::NoCandidates);
    }
    if count == 0 || (!settings.repeats && count > candidates.len()) {
        return Err(DesignError::Count {
            count,
            candidates: candidates.len(),
        });
    }
    for (candidate, a) in candidates.iter().enumerate() {
        let (rows, columns) = a.shape();
        if rows == 0 || columns != expected {
            return Err(DesignError::CandidateShape {
                candidate,
                rows,
                columns,
                expected,
            });
        }
        // The limit leaves room for sums of squares.
        if !a.iter().all(|x| x.abs() < 1e140) {
            return Err(DesignError::CandidateNotFinite(candidate));
        }
    }
    Ok(())
}

/// Asymmetry and negative eigenvalues up to this size are rounding, for a unit diagonal.
const ROUNDING: f64 = 1e-9;

/// Eigenvalues below this fraction of the largest are zero.
const ZERO_EIGENVALUE: f64 = 1e-13;

/// Matrix `B` (n x rank) with `B B^T = matrix`; `None` if the matrix is not square, finite, symmetric and positive semi-definite.
pub(super) fn square_root(matrix: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    if !matrix.is_square() {
        return None;
    }
    // Unit diagonal: the units of the unknowns must not decide about the rank.
    let sizes = matrix
        .diagonal()
        .map(|d| if d > 0.0 { d.sqrt() } else { 1.0 });
    let scaled = DMatrix::from_fn(matrix.nrows(), matrix.ncols(), |i, k| {
        matrix[(i, k)] / sizes[i] / sizes[k]
    });
    let is_symmetric = (&scaled - scaled.transpose()).amax() <= ROUNDING;
    let is_negative = scaled.diagonal().iter().any(|d| *d < 0.0);
    if !scaled.iter().all(|v| v.is_finite()) || !is_symmetric || is_negative {
        return None;
    }
    let eigen = ((&scaled + scaled.transpose()) * 0.5).symmetric_eigen();
    let values = &eigen.eigenvalues;
    if values.min() < -ROUNDING * values.amax() {
        return None;
    }
    let kept: Vec<usize> = (0..values.len())
        .filter(|&k| values[k] > ZERO_EIGENVALUE * values.amax())
        .collect();
    Some(DMatrix::from_fn(matrix.nrows(), kept.len(), |i, k| {
        sizes[i] * eigen.eigenvectors[(i, kept[k])] * values[kept[k]].sqrt()
    }))
}
