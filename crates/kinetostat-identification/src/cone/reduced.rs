//! Order and scale of the unknowns, and reduction of all rows to an upper triangle.

use std::f64::consts::FRAC_1_SQRT_2;

use kinetostat::linalg::SingularValues;
use nalgebra::{DMatrix, DVector};

use super::symmetric::{
    square_root, symmetric_from_triangle, triangle_from_symmetric, triangle_index,
};
use super::{ConeError, ConeLeastSquares};

/// Columns below this fraction of the longest one are rounding errors, even if units differ by 1e6.
const COLUMN_TOLERANCE: f64 = 1e-13;

/// Singular values below this fraction of the largest are unseen: rounding errors of columns of unit length.
const RANK_TOLERANCE: f64 = 1e-11;

/// Penalty of unseen combinations, relative to the objective.
const PENALTY: f64 = 1e-8;

/// Smallest weight of the penalty, for data without residuals.
const SMALLEST_WEIGHT: f64 = 1e-20;

/// Unknowns that form a semi-definite matrix.
#[derive(Clone)]
pub(super) struct Block<'a> {
    /// Columns of its upper triangle, row by row.
    pub columns: &'a [usize],
    /// Sizes `D` of `X = D Xs D`.
    pub sizes: Vec<f64>,
}

impl Block<'_> {
    /// Its matrix, from a vector of all unknowns.
    pub fn matrix(&self, u: &DVector<f64>) -> DMatrix<f64> {
        let own: Vec<f64> = self.columns.iter().map(|k| u[*k]).collect();
        symmetric_from_triangle(&own, self.sizes.len())
    }

    /// Sets its unknowns in a vector of all.
    pub fn set(&self, u: &mut DVector<f64>, matrix: &DMatrix<f64>) {
        let own = triangle_from_symmetric(matrix);
        self.columns.iter().zip(&own).for_each(|(k, v)| u[*k] = *v);
    }
}

/// Scaled problem: minimise `1/2 |triangle u - data|^2` over scaled unknowns `u`.
///
/// The longest column and the data have unit length. Off-diagonal unknowns are multiplied by the square root of 2, which makes
/// the inner product of two blocks the trace of the product of their matrices.
#[derive(Clone)]
pub(super) struct Reduced<'a> {
    /// Upper triangle, p x p, with the rows of the penalty.
    pub triangle: DMatrix<f64>,
    /// Reduced data (p), with the penalty.
    pub data: DVector<f64>,
    /// Residual that no unknown can change.
    pub residual: f64,
    /// Constrained blocks, in the order of the constraints.
    pub blocks: Vec<Block<'a>>,
    /// Answer without constraints, the one nearest to the reference.
    pub unconstrained: DVector<f64>,
    /// Orthonormal basis of the combinations that neither rows nor prior determine.
    pub unseen: DMatrix<f64>,
    /// Unit of the objective: squared length of the data.
    pub objective_unit: f64,
    /// Size of each unknown, in its own unit.
    pub scale: DVector<f64>,
    reference: DVector<f64>,
    weight: f64,
    /// Triangle and data without the penalty, p x (p + 1).
    seen: DMatrix<f64>,
}

impl<'a> Reduced<'a> {
    /// Scales and reduces a problem whose sizes and numbers were checked.
    pub fn new(problem: &ConeLeastSquares<'a>) -> Result<Self, ConeError> {
        let (count, p) = problem.matrix.shape();
        let root = match problem.precision {
            Some(precision) => square_root(precision).ok_or(ConeError::Precision)?,
            None => DMatrix::zeros(p, 0),
        };
        let (mut scale, blocks) = sizes_and_blocks(problem);
        let units = DMatrix::from_diagonal(&scale);
        let x0 = (problem.reference.cloned()).unwrap_or_else(|| DVector::zeros(p));
        // The last column holds the data. Rows of zeros make the triangle square.
        let mut rows = DMatrix::zeros((count + root.ncols()).max(p + 1), p + 1);
        let scaled_rows = problem.matrix * &units;
        rows.view_mut((0, 0), (count, p)).copy_from(&scaled_rows);
        rows.view_mut((0, p), (count, 1)).copy_from(problem.data);
        let mut prior = rows.rows_mut(count, root.ncols());
        prior.columns_mut(0, p).copy_from(&root.tr_mul(&units));
        prior.column_mut(p).copy_from(&root.tr_mul(&x0));
        let mut seen = rows.qr().r();
        // Squares of numbers beyond 1e150 are infinite.
        if !seen.iter().chain(&scale).all(|v| v.is_finite()) {
            return Err(ConeError::NotFinite("the scaled problem"));
        }
        let positive = |v: f64| if v > 0.0 { v } else { 1.0 };
        let lengths = seen.column_iter().take(p).map(|c| c.norm());
        let column = positive(lengths.fold(0.0, f64::max));
        let length = positive(seen.column(p).norm());
        scale *= length / column;
        seen.columns_mut(0, p).unscale_mut(column);
        seen.column_mut(p).unscale_mut(length);
        let residual = seen[(p, p)];
        let seen = seen.remove_row(p);
        let triangle = seen.columns(0, p).into_owned();
        let data = seen.column(p).into_owned();
        let reference = x0.component_div(&scale);
        let values = SingularValues::of(&triangle);
        let away = values.pseudo_inverse(RANK_TOLERANCE) * (&data - &triangle * &reference);
        let mut reduced = Self {
            residual,
            blocks,
            unconstrained: &reference + away,
            unseen: values.null_space(RANK_TOLERANCE),
            objective_unit: length * length,
            scale,
            reference,
            weight: 0.0,
            triangle,
            data,
            seen,
        };
        if reduced.unseen.ncols() > 0 {
            reduced.penalise(reduced.suitable_weight(&reduced.unconstrained));
        }
        Ok(reduced)
    }

    /// Problem with a weight of the penalty that suits the optimum `u`; `None` if the present one does.
    ///
    /// Before the first optimisation only the answer without constraints is known. Its residuals may be much smaller, and its
    /// unknowns, too.
    pub fn adapted(&self, u: &DVector<f64>) -> Option<Self> {
        let mut weight = self.suitable_weight(u);
        let suits = weight < 100.0 * self.weight && weight > 0.01 * self.weight;
        if self.unseen.ncols() == 0 || suits {
            return None;
        }
        if weight < self.weight {
            // Unknowns grow further while the weight decreases.
            weight = (0.01 * weight).max(SMALLEST_WEIGHT);
        }
        let mut adapted = self.clone();
        adapted.penalise(weight);
        Some(adapted)
    }

    /// Weight of the penalty for the sum of squared residuals of an answer `u`.
    fn suitable_weight(&self, u: &DVector<f64>) -> f64 {
        let squares = self.seen_residual(u).norm_squared() + self.residual * self.residual;
        (PENALTY * squares / u.norm_squared().max(1.0)).max(SMALLEST_WEIGHT)
    }

    /// Adds the rows `weight^1/2 N^T (u - reference)` to the reduced ones.
    fn penalise(&mut self, weight: f64) {
        let (p, count) = self.unseen.shape();
        let own = self.unseen.transpose() * weight.sqrt();
        let mut rows = self.seen.clone().insert_rows(p, count, 0.0);
        let mut last = rows.rows_mut(p, count);
        last.columns_mut(0, p).copy_from(&own);
        last.column_mut(p).copy_from(&(own * &self.reference));
        let reduced = rows.qr().r();
        self.data = reduced.view((0, p), (p, 1)).column(0).into_owned();
        self.triangle = reduced.view((0, 0), (p, p)).into_owned();
        self.weight = weight;
    }

    /// True if every block is positive semi-definite.
    pub fn is_feasible(&self, u: &DVector<f64>) -> bool {
        let is_feasible = |b: &Block<'_>| b.matrix(u).symmetric_eigenvalues().min() >= 0.0;
        self.blocks.iter().all(is_feasible)
    }

    /// Residual `data - triangle u`, with the penalty.
    pub fn residual_at(&self, u: &DVector<f64>) -> DVector<f64> {
        &self.data - &self.triangle * u
    }

    /// Objective of a residual, with the penalty.
    pub fn objective(&self, residual: &DVector<f64>) -> f64 {
        0.5 * (residual.norm_squared() + self.residual * self.residual)
    }

    fn seen_residual(&self, u: &DVector<f64>) -> DVector<f64> {
        self.seen.columns(0, u.len()) * u - self.seen.column(u.len())
    }

    /// Gradient of the scaled objective, without the penalty.
    pub fn gradient(&self, u: &DVector<f64>) -> DVector<f64> {
        self.seen.columns(0, u.len()).tr_mul(&self.seen_residual(u))
    }

    /// Penalty of unseen combinations, scaled.
    pub fn penalty(&self, u: &DVector<f64>) -> f64 {
        0.5 * self.weight * self.unseen.tr_mul(&(u - &self.reference)).norm_squared()
    }

    /// Second derivative of the objective, with the penalty, along a change of one block.
    pub fn curvature(&self, block: &Block<'_>, change: &DMatrix<f64>) -> f64 {
        let mut step = DVector::zeros(self.data.len());
        block.set(&mut step, change);
        (&self.triangle * step).norm_squared()
    }
}

/// Sizes of the unknowns, and the blocks.
fn sizes_and_blocks<'a>(problem: &ConeLeastSquares<'a>) -> (DVector<f64>, Vec<Block<'a>>) {
    let p = problem.matrix.ncols();
    let prior = |k: usize| problem.precision.map_or(0.0, |p| p[(k, k)].max(0.0).sqrt());
    let lengths = DVector::from_fn(p, |k, _| problem.matrix.column(k).norm().hypot(prior(k)));
    let longest = lengths.amax();
    let mut scale = DVector::from_fn(p, |k, _| match problem.nominal {
        Some(sizes) => sizes[k],
        None if longest == 0.0 => 1.0,
        None if lengths[k] <= COLUMN_TOLERANCE * longest => 1.0 / longest,
        None => 1.0 / lengths[k],
    });
    let mut blocks = Vec::new();
    for constraint in problem.constraints {
        let (columns, n) = (constraint.columns(), constraint.order().unwrap_or(0));
        let diagonal = (0..n).map(|i| scale[columns[triangle_index(n, i, i)]].sqrt());
        let sizes: Vec<f64> = diagonal.collect();
        for (i, k) in (0..n).flat_map(|i| (i..n).map(move |k| (i, k))) {
            let factor = if i == k { 1.0 } else { FRAC_1_SQRT_2 };
            scale[columns[triangle_index(n, i, k)]] = sizes[i] * sizes[k] * factor;
        }
        blocks.push(Block { columns, sizes });
    }
    (scale, blocks)
}
