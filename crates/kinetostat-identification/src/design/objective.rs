//! Criteria in whitened parameters, with their derivatives by the information matrix.

use nalgebra::{DMatrix, DVector};

use super::linalg::{factor, solve_lower, solve_lower_transposed, unpack};
use super::problem::Problem;

/// Criterion in whitened parameters `z`, where the caller's parameters are `T z`.
#[derive(Clone, Debug)]
pub(super) enum Objective {
    /// `trace(B^T M^-1 B)`, parameters x rank.
    Linear(DMatrix<f64>),
    /// `det(M)^(-1/p)` times the exponential of this number, which stems from the whitening.
    Determinant(f64),
    /// Largest eigenvalue of `T M^-1 T^T`; the matrix is `T^T`, beside `T^T T` packed.
    Worst(DMatrix<f64>, DVector<f64>),
}

/// Buffers of [`Problem::value`].
pub(super) struct Scratch {
    packed: DVector<f64>,
    factor: DMatrix<f64>,
    solved: DMatrix<f64>,
}

impl Scratch {
    pub(super) fn new(problem: &Problem) -> Self {
        let p = problem.parameters;
        let columns = match &problem.objective {
            Objective::Linear(b) | Objective::Worst(b, _) => b.ncols(),
            Objective::Determinant(_) => 0,
        };
        Self {
            packed: DVector::zeros(problem.fixed.len()),
            factor: DMatrix::zeros(p, p),
            solved: DMatrix::zeros(p, columns),
        }
    }
}

/// Value of the criterion with its derivative at one information matrix.
///
/// For every other information matrix `M'` the value is at least `value * mass / trace(M' gradient)`. For linear criteria this is the
/// inequality of Cauchy and Schwarz, for the determinant that of the geometric and the arithmetic mean, for the worst direction the
/// Rayleigh quotient. At the optimum of the continuous design the bound is sharp (Kiefer and Wolfowitz 1960).
pub(super) struct State {
    pub(super) value: f64,
    /// `trace(M gradient)`.
    pub(super) mass: f64,
    /// `M^-1`.
    pub(super) inverse: DMatrix<f64>,
    /// Matrix `G` of the sensitivities `d_x = trace(G A_x^T A_x)`: `M^-1 B B^T M^-1`, `M^-1`, or `u u^T`.
    pub(super) gradient: DMatrix<f64>,
    /// `M^-1 B` of linear criteria, otherwise without columns.
    pub(super) solution: DMatrix<f64>,
}

impl State {
    /// Lower bound of the value after an exchange that adds `enters` and removes `leaves` of the sensitivities.
    pub(super) fn bound(&self, enters: f64, leaves: f64) -> f64 {
        let trace = self.mass + enters - leaves;
        if trace > 0.0 {
            self.value * self.mass / trace
        } else {
            f64::INFINITY
        }
    }
}

impl Problem {
    /// Value of the criterion for a packed information matrix; `None` if that is singular.
    pub(super) fn value(&self, packed: &[f64], scratch: &mut Scratch) -> Option<f64> {
        self.value_below(packed, f64::INFINITY, scratch)
    }

    /// Value of the criterion for a packed information matrix. `None` if that is singular; may also be `None` if the value is not below
    /// a limit.
    pub(super) fn value_below(
        &self,
        packed: &[f64],
        limit: f64,
        scratch: &mut Scratch,
    ) -> Option<f64> {
        if let Objective::Worst(_, square) = &self.objective
            && limit.is_finite()
        {
            // The largest eigenvalue of T M^-1 T^T is below the limit exactly if M - T^T T / limit is positive definite. A
            // factorisation tests that faster than an eigenvalue is found.
            scratch.packed.as_mut_slice().copy_from_slice(packed);
            scratch.packed.axpy(-1.0 / limit, square, 1.0);
            unpack(scratch.packed.as_slice(), &mut scratch.factor);
            if !factor(&mut scratch.factor) {
                return None;
            }
        }
        unpack(packed, &mut scratch.factor);
        if !factor(&mut scratch.factor) {
            return None;
        }
        Some(match &self.objective {
            Objective::Linear(b) => {
                scratch.solved.copy_from(b);
                solve_lower(&scratch.factor, &mut scratch.solved);
                scratch.solved.norm_squared()
            }
            Objective::Determinant(scale) => determinant(&scratch.factor, *scale),
            Objective::Worst(b, _) => {
                scratch.solved.copy_from(b);
                solve_lower(&scratch.factor, &mut scratch.solved);
                scratch
                    .solved
                    .tr_mul(&scratch.solved)
                    .symmetric_eigenvalues()
                    .max()
            }
        })
    }

    /// Value and derivative for a packed information matrix; `None` if that is singular.
    pub(super) fn state(&self, packed: &DVector<f64>) -> Option<State> {
        let p = self.parameters;
        let mut lower = DMatrix::zeros(p, p);
        unpack(packed.as_slice(), &mut lower);
        if !factor(&mut lower) {
            return None;
        }
        let mut root = DMatrix::identity(p, p);
        solve_lower(&lower, &mut root);
        let inverse = root.tr_mul(&root);
        let mut solution = DMatrix::zeros(p, 0);
        let (value, mass, gradient) = match &self.objective {
            Objective::Linear(b) => {
                solution = b.clone();
                solve_lower(&lower, &mut solution);
                let value = solution.norm_squared();
                solve_lower_transposed(&lower, &mut solution);
                (value, value, &solution * solution.transpose())
            }
            Objective::Determinant(scale) => {
                (determinant(&lower, *scale), p as f64, inverse.clone())
            }
            Objective::Worst(b, _) => {
                let mut solved = b.clone();
                solve_lower(&lower, &mut solved);
                let eigen = solved.tr_mul(&solved).symmetric_eigen();
                let worst = eigen.eigenvalues.imax();
                let value = eigen.eigenvalues[worst];
                // The combination of parameters with the largest variance, in whitened parameters.
                let direction = &inverse * (b * eigen.eigenvectors.column(worst)) / value;
                (value, 1.0 / value, &direction * direction.transpose())
            }
        };
        value.is_finite().then_some(State {
            value,
            mass,
            inverse,
            gradient,
            solution,
        })
    }
}

/// `det(M)^(-1/p)` of a Cholesky factor, times the exponential of `scale`.
fn determinant(factor: &DMatrix<f64>, scale: f64) -> f64 {
    let n = factor.nrows();
    let logarithm: f64 = (0..n).map(|i| factor[(i, i)].ln()).sum();
    (scale - 2.0 * logarithm / n as f64).exp()
}
