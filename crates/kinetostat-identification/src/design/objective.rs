//! Criteria in whitened parameters, with their derivatives by the information matrix.

use kinetostat::linalg::SingularValues;
use nalgebra::DMatrix;

/// Smallest pivot of a Cholesky factorisation, relative to the diagonal entry. Smaller ones are rounding.
const PIVOT: f64 = 1e-13;

/// Criterion in whitened parameters `z`, where the caller's parameters are `T z`.
pub(super) enum Objective {
    /// `trace(B^T M^-1 B)`, parameters x rank.
    Linear(DMatrix<f64>),
    /// `det(M)^(-1/p)` times the exponential of this number, which stems from the whitening.
    Determinant(f64),
    /// Largest eigenvalue of `B^T M^-1 B`, with `B = T^T`.
    Worst(DMatrix<f64>),
}

/// Value of the criterion with its derivative at one information matrix.
///
/// For every other information matrix `M'` the value is at least `value * mass / trace(M' S S^T)`. For linear criteria this is the
/// inequality of Cauchy and Schwarz, for the determinant that of the geometric and the arithmetic mean, for the worst direction the
/// Rayleigh quotient. At the optimum of the continuous design the bound is sharp (Kiefer and Wolfowitz 1960).
pub(super) struct State {
    pub(super) value: f64,
    /// `trace(M S S^T)`.
    pub(super) mass: f64,
    /// Matrix `S` of the sensitivities `|A_x S|^2`: `M^-1 B`, `L^-T` of `M = L L^T`, or a single column.
    pub(super) solution: DMatrix<f64>,
    /// Cholesky factor `L` of the information.
    pub(super) factor: DMatrix<f64>,
}

impl State {
    /// Lower bound of the value after an exchange that changes the sum of the sensitivities.
    pub(super) fn bound(&self, change: f64) -> f64 {
        // Infinite if the trace is not positive.
        self.value * self.mass / (self.mass + change).max(0.0)
    }
}

impl Objective {
    /// Value of the criterion for an information matrix; `None` if that is singular or the value is not below a limit.
    pub(super) fn value(&self, information: DMatrix<f64>, limit: f64) -> Option<f64> {
        if let Self::Worst(b) = self
            && limit.is_finite()
        {
            // The largest eigenvalue is below the limit exactly if this is positive definite. A factorisation tests that faster
            // than an eigenvalue is found.
            cholesky(&information - b * b.transpose() / limit)?;
        }
        let factor = cholesky(information)?;
        Some(match self {
            Self::Linear(b) => factor.solve_lower_triangular(b)?.norm_squared(),
            Self::Determinant(scale) => determinant(&factor, *scale),
            Self::Worst(b) => {
                let solved = factor.solve_lower_triangular(b)?;
                (solved.transpose() * &solved).symmetric_eigenvalues().max()
            }
        })
    }

    /// Value and derivative for an information matrix; `None` if that is singular.
    pub(super) fn state(&self, information: DMatrix<f64>) -> Option<State> {
        let p = information.nrows();
        let factor = cholesky(information)?;
        let (value, mass, right) = match self {
            Self::Linear(b) => {
                let solved = factor.solve_lower_triangular(b)?;
                let value = solved.norm_squared();
                (value, value, solved)
            }
            Self::Determinant(scale) => {
                let value = determinant(&factor, *scale);
                (value, p as f64, DMatrix::identity(p, p))
            }
            Self::Worst(b) => {
                let solved = SingularValues::of(&factor.solve_lower_triangular(b)?);
                // The combination of parameters with the largest variance, in whitened parameters.
                let (worst, direction) = (solved.largest(), solved.left.columns(0, 1));
                (worst * worst, worst.powi(-2), direction / worst)
            }
        };
        let solution = factor.tr_solve_lower_triangular(&right)?;
        value.is_finite().then_some(State {
            value,
            mass,
            solution,
            factor,
        })
    }
}

/// Cholesky factor; `None` if the matrix is singular up to rounding.
fn cholesky(matrix: DMatrix<f64>) -> Option<DMatrix<f64>> {
    let diagonal = matrix.diagonal();
    let factor = matrix.cholesky()?.unpack();
    let pivots = factor.diagonal();
    let is_regular = |(l, d): (&f64, &f64)| l * l > PIVOT * d && l.is_normal();
    pivots
        .iter()
        .zip(&diagonal)
        .all(is_regular)
        .then_some(factor)
}

/// `det(M)^(-1/p)` of a Cholesky factor, times the exponential of `scale`.
fn determinant(factor: &DMatrix<f64>, scale: f64) -> f64 {
    let logarithm = factor.diagonal().map(f64::ln).sum();
    (scale - 2.0 * logarithm / factor.nrows() as f64).exp()
}
