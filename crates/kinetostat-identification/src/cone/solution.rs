//! Optimum in the units of the unknowns, with the state of each constraint.

use std::f64::consts::SQRT_2;

use nalgebra::{DMatrix, DVector};

use super::ConeLeastSquares;
use super::newton::Optimum;
use super::reduced::{Block, Reduced};
use super::symmetric::triangle_index;

/// Eigenvalues below this fraction of the largest are zero, even if their dual is zero, too.
const ZERO_EIGENVALUE: f64 = 1e-8;

/// Optimum of a [`ConeLeastSquares`] problem.
#[derive(Clone, Debug)]
pub struct ConeSolution {
    /// Unknowns, in their own units. They meet the constraints up to rounding.
    pub x: DVector<f64>,
    /// Minimum of `1/2 |A x - y|^2 + 1/2 (x - x0)^T P (x - x0)`, without the penalty of unseen combinations.
    pub objective: f64,
    /// Sum of squared residuals `|A x - y|^2`: chi-squared for weighted rows.
    pub chi_squared: f64,
    /// Duality gap, in units of the objective: no feasible `x` has a smaller objective (penalty included) by more than this.
    pub gap: f64,
    /// Penalty of unseen combinations at the optimum, in units of the objective. Zero for full rank.
    pub penalty: f64,
    /// Optimality residual, dimensionless.
    pub kkt: KktResidual,
    /// State of each constraint, in the order of the constraints.
    pub blocks: Vec<BlockState>,
    /// Number of combinations of unknowns that the rows and the prior determine.
    pub rank: usize,
    /// Unseen combinations: the columns are changes of `x` (in the units of the unknowns) that leave the objective unchanged.
    pub unseen: DMatrix<f64>,
    /// Number of Newton steps; zero if the unconstrained answer meets the constraints.
    pub newton_steps: usize,
}

/// Residual of the conditions of Karush, Kuhn and Tucker, for unknowns scaled to unit columns and data scaled to unit length.
///
/// The gradient of the objective is zero for free unknowns. For a constrained block it is the dual matrix `Z`, which is positive
/// semi-definite and orthogonal to the block: `trace(X Z) = 0`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct KktResidual {
    /// Largest gradient by a free unknown.
    pub stationarity: f64,
    /// Largest negative eigenvalue of a dual matrix, as a positive number.
    pub dual_infeasibility: f64,
    /// Largest `|trace(X Z)|` of a block.
    pub complementarity: f64,
}

/// State of one constraint at the optimum.
#[derive(Clone, Debug)]
pub struct BlockState {
    /// Eigenvalues of the scaled block relative to the largest, ascending. For a scalar: its scaled value, of the order of one if
    /// it has a large effect on the data.
    pub eigenvalues: Vec<f64>,
    /// Number of eigenvalues at zero, the first ones. A scalar at its bound has one.
    pub at_bound: usize,
    /// Null vectors of a matrix at its bound, n x `at_bound`: loads `w` (N and N m for a link) without deflection, `X w = 0`.
    /// The largest component of each is one.
    pub rigid_loads: DMatrix<f64>,
    /// Dual matrix `Z`, n x n: derivative of the objective by the entries of the block.
    pub dual: DMatrix<f64>,
}

/// Result in the units of the unknowns, from the optimum of the reduced problem.
pub(super) fn unscale(
    problem: &ConeLeastSquares<'_>,
    reduced: &Reduced<'_>,
    optimum: &Optimum,
) -> ConeSolution {
    let u = &optimum.u;
    let x = u.component_mul(&reduced.scale);
    let chi_squared = (problem.matrix * &x - problem.data).norm_squared();
    let prior = match (problem.precision, problem.reference) {
        (Some(p), Some(x0)) => (&x - x0).dot(&(p * (&x - x0))),
        _ => 0.0,
    };
    let gradient = reduced.gradient(u);
    let mut free = gradient.clone();
    let mut kkt = KktResidual::default();
    for block in &reduced.blocks {
        let slope = block.matrix(&gradient);
        kkt.complementarity = kkt.complementarity.max(block.matrix(u).dot(&slope).abs());
        let negative = -slope.symmetric_eigenvalues().min();
        kkt.dual_infeasibility = kkt.dual_infeasibility.max(negative);
        block.columns.iter().for_each(|k| free[*k] = 0.0);
    }
    kkt.stationarity = free.amax();
    let state = |b: &Block<'_>| block_state(reduced, optimum, b, &b.matrix(&gradient));
    ConeSolution {
        x,
        objective: 0.5 * (chi_squared + prior),
        chi_squared,
        gap: optimum.gap * reduced.objective_unit,
        penalty: reduced.penalty(u) * reduced.objective_unit,
        kkt,
        blocks: reduced.blocks.iter().map(state).collect(),
        rank: u.len() - reduced.unseen.ncols(),
        unseen: DMatrix::from_diagonal(&reduced.scale) * &reduced.unseen,
        newton_steps: optimum.steps,
    }
}

/// State of a block, from the optimum and the gradient by its scaled matrix.
fn block_state(
    reduced: &Reduced<'_>,
    optimum: &Optimum,
    block: &Block<'_>,
    slope: &DMatrix<f64>,
) -> BlockState {
    let n = block.sizes.len();
    let dual = block.matrix(&optimum.dual);
    let eigen = block.matrix(&optimum.u).symmetric_eigen();
    let mut ascending: Vec<usize> = (0..n).collect();
    ascending.sort_by(|&i, &k| eigen.eigenvalues[i].total_cmp(&eigen.eigenvalues[k]));
    let largest = if n > 1 { eigen.eigenvalues.amax() } else { 1.0 };
    // At the optimum eigenvalues of the primal and dual matrix pair up: one of each pair is zero. They have different units,
    // which the curvature of the objective along the eigenvector converts.
    let is_zero = |&&i: &&usize| {
        let v = eigen.eigenvectors.column(i);
        let value = eigen.eigenvalues[i];
        let curvature = reduced.curvature(block, &(v * v.transpose()));
        value * curvature <= v.dot(&(&dual * v)) || value <= ZERO_EIGENVALUE * largest
    };
    let at_bound = ascending.iter().take_while(is_zero).count();
    // A matrix of zeros has eigenvalues of zero, not NaN.
    let unit = if largest > 0.0 { largest } else { 1.0 };
    // An off-diagonal unknown stands for two entries of the matrix.
    let size = |i: usize, k: usize| {
        let scale = reduced.scale[block.columns[triangle_index(n, i, k)]];
        if i == k { scale } else { scale * SQRT_2 }
    };
    BlockState {
        eigenvalues: ascending
            .iter()
            .map(|&i| eigen.eigenvalues[i] / unit)
            .collect(),
        at_bound,
        rigid_loads: DMatrix::from_fn(n, at_bound, |i, k| {
            let v = eigen.eigenvectors.column(ascending[k]);
            let load = DVector::from_fn(n, |j, _| v[j] / block.sizes[j]);
            load[i] / load.amax()
        }),
        dual: DMatrix::from_fn(n, n, |i, k| {
            slope[(i, k)] * reduced.objective_unit / size(i, k)
        }),
    }
}
