//! Values of the criterion after an exchange, without a new factorisation.

use nalgebra::DMatrix;

use super::linalg::{factor, solve_lower};
use super::objective::{Objective, State};
use super::problem::Problem;

/// Values after exchanges by updates of low rank (Sherman, Morrison and Woodbury), for few rows in many parameters.
pub(super) struct LowRank<'a> {
    problem: &'a Problem,
    state: &'a State,
    members: Vec<Member>,
    /// Rows of the entering posture times the solution `M^-1 B`, reduced by `factor`.
    reduced: DMatrix<f64>,
    /// Cholesky factor of `I + A M^-1 A^T` of the entering posture.
    factor: DMatrix<f64>,
    /// Value after the addition; for the determinant the logarithm of the determinant that it contributes.
    entered: f64,
    enters: usize,
    /// `M^-1 A^T` of the entering posture.
    spread: DMatrix<f64>,
    cross: DMatrix<f64>,
    schur: DMatrix<f64>,
    remainder: DMatrix<f64>,
}

/// Posture of the set: `M^-1 A^T`, `I - A M^-1 A^T` and `A M^-1 B`.
struct Member {
    spread: DMatrix<f64>,
    schur: DMatrix<f64>,
    solution: DMatrix<f64>,
}

impl<'a> LowRank<'a> {
    /// Prepares the updates; `None` if they need more operations than a new factorisation.
    pub(super) fn new(problem: &'a Problem, state: &'a State, members: &[usize]) -> Option<Self> {
        let r = problem.rows.first().map_or(0, DMatrix::ncols);
        if matches!(problem.objective, Objective::Worst(..)) || 2 * r >= problem.parameters {
            return None;
        }
        let columns = state.solution.ncols();
        let member = |x: &usize| {
            let rows = &problem.rows[*x];
            let spread = &state.inverse * rows;
            Member {
                schur: DMatrix::identity(r, r) - rows.tr_mul(&spread),
                solution: rows.tr_mul(&state.solution),
                spread,
            }
        };
        Some(Self {
            problem,
            state,
            members: members.iter().map(member).collect(),
            reduced: DMatrix::zeros(r, columns),
            factor: DMatrix::zeros(r, r),
            entered: 0.0,
            enters: 0,
            spread: DMatrix::zeros(problem.parameters, r),
            cross: DMatrix::zeros(r, r),
            schur: DMatrix::zeros(r, r),
            remainder: DMatrix::zeros(r, columns),
        })
    }

    /// Prepares the entry of a posture. Returns false at rounding errors.
    pub(super) fn enter(&mut self, enters: usize) -> bool {
        let rows = &self.problem.rows[enters];
        self.spread.gemm(1.0, &self.state.inverse, rows, 0.0);
        self.factor.gemm_tr(1.0, rows, &self.spread, 0.0);
        for i in 0..self.factor.nrows() {
            self.factor[(i, i)] += 1.0;
        }
        if !factor(&mut self.factor) {
            return false;
        }
        self.enters = enters;
        self.reduced.gemm_tr(1.0, rows, &self.state.solution, 0.0);
        solve_lower(&self.factor, &mut self.reduced);
        self.entered = match self.problem.objective {
            Objective::Determinant(_) => ln_determinant(&self.factor),
            _ => self.state.value - self.reduced.norm_squared(),
        };
        true
    }

    /// Value after the exchange of the prepared posture for a member; `None` if the information becomes singular.
    pub(super) fn value(&mut self, member: usize) -> Option<f64> {
        let member = &self.members[member];
        let rows = &self.problem.rows[self.enters];
        self.cross.gemm_tr(1.0, rows, &member.spread, 0.0);
        solve_lower(&self.factor, &mut self.cross);
        // Information that the member leaves behind: I - A_o (M + A_i^T A_i)^-1 A_o^T.
        self.schur.copy_from(&member.schur);
        self.schur.gemm_tr(1.0, &self.cross, &self.cross, 1.0);
        if !factor(&mut self.schur) {
            return None;
        }
        if let Objective::Determinant(_) = self.problem.objective {
            let change = self.entered + ln_determinant(&self.schur);
            return Some(self.state.value * (-change / self.problem.parameters as f64).exp());
        }
        self.remainder.copy_from(&member.solution);
        self.remainder
            .gemm_tr(-1.0, &self.cross, &self.reduced, 1.0);
        solve_lower(&self.schur, &mut self.remainder);
        Some(self.entered + self.remainder.norm_squared())
    }
}

/// Logarithm of the determinant of a matrix, from its Cholesky factor.
fn ln_determinant(factor: &DMatrix<f64>) -> f64 {
    2.0 * (0..factor.nrows())
        .map(|i| factor[(i, i)].ln())
        .sum::<f64>()
}
