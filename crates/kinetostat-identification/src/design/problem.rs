//! Checked input in whitened parameters.

use nalgebra::{DMatrix, DVector};

use super::error::{DesignError, InputMatrix};
use super::linalg::{pack, packed_len, unpack};
use super::objective::Objective;
use super::whitening::{Whitening, root};
use super::{Criterion, DesignSettings};

/// Candidates and criterion in parameters for which all candidates and the fixed information together have the information `I`.
///
/// The whitening removes the units of the parameters (radians per newton metre beside metres) from all conditions of matrices.
pub(super) struct Problem {
    pub(super) parameters: usize,
    /// Number of postures to choose.
    pub(super) count: usize,
    /// True if a posture may be chosen more than once.
    pub(super) repeats: bool,
    /// Observation rows of each candidate as columns, parameters x rows. All have equally many, at most as many as parameters;
    /// shorter ones end with zeros.
    pub(super) rows: Vec<DMatrix<f64>>,
    /// Packed information of each candidate as columns.
    pub(super) information: DMatrix<f64>,
    /// Packed fixed information.
    pub(super) fixed: DVector<f64>,
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
            Some(m) => root(m, InputMatrix::FixedInformation, p)?,
            None => DMatrix::zeros(p, 0),
        };
        let test_poses = match criterion {
            Criterion::TestPoses(l) => Some(root(l, InputMatrix::TestPoses, p)?),
            _ => None,
        };
        let whitening = Whitening::new(candidates, &fixed, settings.rank_tolerance)?;
        let t = &whitening.matrix;
        let most = candidates.iter().map(DMatrix::nrows).max().unwrap_or(1);
        let rows: Vec<DMatrix<f64>> = candidates
            .iter()
            .map(|a| compressed(a * t, most.min(p)))
            .collect();
        let mut information = DMatrix::zeros(packed_len(p), rows.len());
        let mut product = DMatrix::zeros(p, p);
        for (a, mut column) in rows.iter().zip(information.column_iter_mut()) {
            a.mul_to(&a.transpose(), &mut product);
            pack(&product, 1.0, column.as_mut_slice());
        }
        let fixed = t.tr_mul(&fixed);
        let mut packed_fixed = DVector::zeros(packed_len(p));
        pack(
            &(&fixed * fixed.transpose()),
            1.0,
            packed_fixed.as_mut_slice(),
        );
        let objective = match (criterion, test_poses) {
            (Criterion::TestPoses(_), Some(b)) if b.ncols() == 0 => {
                return Err(DesignError::ZeroTestPoses);
            }
            (Criterion::TestPoses(_), Some(b)) => Objective::Linear(t.tr_mul(&b)),
            (Criterion::Determinant, _) => {
                Objective::Determinant(2.0 * whitening.ln_determinant / p as f64)
            }
            (Criterion::WorstDirection, _) => {
                let mut packed = DVector::zeros(packed_len(p));
                pack(&t.tr_mul(t), 1.0, packed.as_mut_slice());
                Objective::Worst(t.transpose(), packed)
            }
            _ => Objective::Linear(t.transpose()),
        };
        Ok(Self {
            parameters: p,
            count,
            repeats: settings.repeats,
            rows,
            information,
            fixed: packed_fixed,
            objective,
        })
    }

    /// Packed information of a set of postures, added to `base`.
    pub(super) fn information_of(&self, base: &DVector<f64>, postures: &[usize]) -> DVector<f64> {
        let mut sum = base.clone();
        for x in postures {
            sum += self.information.column(*x);
        }
        sum
    }

    /// Error of a set of postures with singular information.
    pub(super) fn too_few_observations(&self, postures: &[usize]) -> DesignError {
        DesignError::TooFewObservations {
            count: self.count,
            rank: self.rank(postures),
            parameters: self.parameters,
        }
    }

    /// Rank of the information of a set of postures.
    pub(super) fn rank(&self, postures: &[usize]) -> usize {
        let p = self.parameters;
        let packed = self.information_of(&self.fixed, postures);
        let mut matrix = DMatrix::zeros(p, p);
        unpack(packed.as_slice(), &mut matrix);
        matrix.fill_upper_triangle_with_lower_triangle();
        let values = matrix.symmetric_eigenvalues();
        let cut = 1e-12 * values.max();
        values.iter().filter(|v| **v > cut).count()
    }
}

/// Columns `C` (parameters x `count`) with `C C^T = A^T A`.
fn compressed(a: DMatrix<f64>, count: usize) -> DMatrix<f64> {
    let a = if a.nrows() > count { a.qr().r() } else { a };
    let mut columns = DMatrix::zeros(a.ncols(), count);
    for (mut column, row) in columns.column_iter_mut().zip(a.row_iter()) {
        column.tr_copy_from(&row);
    }
    columns
}

/// Refuses shapes, numbers and settings that have no design.
fn check(
    candidates: &[DMatrix<f64>],
    count: usize,
    settings: &DesignSettings,
) -> Result<(), DesignError> {
    for (setting, value) in [
        ("gap", settings.gap),
        ("rank tolerance", settings.rank_tolerance),
    ] {
        if !(value > 0.0 && value < 1.0) {
            return Err(DesignError::SettingOutsideRange { setting, value });
        }
    }
    let expected = candidates.first().map_or(0, DMatrix::ncols);
    if expected == 0 {
        return Err(DesignError::NoCandidates);
    }
    if count == 0 {
        return Err(DesignError::ZeroCount);
    }
    if !settings.repeats && count > candidates.len() {
        return Err(DesignError::TooFewCandidates {
            count,
            candidates: candidates.len(),
        });
    }
    for (candidate, a) in candidates.iter().enumerate() {
        if a.nrows() == 0 || a.ncols() != expected {
            return Err(DesignError::CandidateShape {
                candidate,
                rows: a.nrows(),
                columns: a.ncols(),
                expected,
            });
        }
        // The limit leaves room for sums of squares.
        if !a.iter().all(|x| x.abs() < 1e140) {
            return Err(DesignError::CandidateNotFinite { candidate });
        }
    }
    Ok(())
}
