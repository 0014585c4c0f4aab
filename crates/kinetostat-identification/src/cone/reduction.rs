//! Scaling of the unknowns and reduction of all rows to an upper triangle.

use nalgebra::{DMatrix, DVector};

use super::ordering::{Block, norms, ordered};
use super::reflection::reflect_rows;
use super::symmetric::symmetric_from_triangle;
use super::{ConeError, ConeLeastSquares};

/// Singular directions below this fraction of the largest column are unseen: rounding errors of columns of unit length.
const RANK_TOLERANCE: f64 = 1e-11;

/// Penalty of unseen combinations, relative to the objective.
const PENALTY: f64 = 1e-8;

/// Smallest weight of the penalty, for data without residuals.
const SMALLEST_WEIGHT: f64 = 1e-20;

/// Rows that are reduced at once; such a block stays in the cache.
const ROWS_AT_ONCE: usize = 256;

/// Scaled problem: minimise `1/2 |triangle u - data|^2` with blocks first and free unknowns last.
///
/// The longest column and the data have unit length. Off-diagonal unknowns are multiplied by the square root of 2, which makes
/// the inner product of two blocks the trace of the product of their matrices.
#[derive(Clone)]
pub(super) struct Reduced {
    /// Upper triangle, p x p, with the rows of the penalty.
    pub triangle: DMatrix<f64>,
    /// Reduced data (p), with the penalty.
    pub data: DVector<f64>,
    /// Residual that no unknown can change.
    pub residual: f64,
    /// Constrained blocks, in the order of the constraints.
    pub blocks: Vec<Block>,
    /// Answer without constraints, the one nearest to the reference.
    pub unconstrained: DVector<f64>,
    /// Orthonormal basis of the combinations that neither rows nor prior determine.
    pub unseen: DMatrix<f64>,
    /// Unit of the objective: squared length of the data.
    pub objective_unit: f64,
    reference: DVector<f64>,
    weight: f64,
    seen_triangle: DMatrix<f64>,
    seen_data: DVector<f64>,
    /// Unknown of each ordered column, and its size.
    order: Vec<usize>,
    pub scale: Vec<f64>,
}

impl Reduced {
    /// Scales and reduces a problem whose sizes and numbers were checked.
    pub fn new(problem: &ConeLeastSquares<'_>) -> Result<Self, ConeError> {
        let p = problem.matrix.ncols();
        let (order, mut scale, blocks) = ordered(problem);
        let x0 = |k: usize| problem.reference.map_or(0.0, |x| x[order[k]]);
        // The last column holds the data.
        let mut triangle = DMatrix::zeros(p + 1, p + 1);
        for first in (0..problem.matrix.nrows()).step_by(ROWS_AT_ONCE) {
            let rows = ROWS_AT_ONCE.min(problem.matrix.nrows() - first);
            let mut chunk = DMatrix::from_fn(rows, p + 1, |i, k| {
                if k < p {
                    problem.matrix[(first + i, order[k])] * scale[k]
                } else {
                    problem.data[first + i]
                }
            });
            reflect_rows(&mut triangle, &mut chunk, p + 1, |_| rows);
        }
        if let Some(precision) = problem.precision {
            let scaled = DMatrix::from_fn(p, p, |i, k| {
                precision[(order[i], order[k])] * scale[i] * scale[k]
            });
            let root = square_root(scaled).ok_or(ConeError::Precision)?;
            let mean = DVector::from_fn(p, |k, _| x0(k) / scale[k]);
            let mut chunk = with_column(root.clone(), &(root * mean));
            reflect_rows(&mut triangle, &mut chunk, p + 1, |_| p);
        }
        // Squares of numbers beyond 1e150 are infinite.
        if !triangle.iter().chain(&scale).all(|v| v.is_finite()) {
            return Err(ConeError::NotFinite("the scaled problem"));
        }
        let positive = |v: f64| if v > 0.0 { v } else { 1.0 };
        let column = positive(norms(&triangle).rows(0, p).amax());
        let length = positive(triangle.column(p).norm());
        scale.iter_mut().for_each(|s| *s *= length / column);
        let data = triangle.view((0, p), (p, 1)).column(0) / length;
        let residual = triangle[(p, p)] / length;
        let triangle = triangle.view((0, 0), (p, p)) / column;
        let reference = DVector::from_fn(p, |k, _| x0(k) / scale[k]);
        let (unseen, unconstrained) = nearest(&triangle, &data, &reference);
        let least = (&triangle * &unconstrained - &data).norm_squared() + residual * residual;
        let mut reduced = Self {
            seen_triangle: triangle.clone(),
            seen_data: data.clone(),
            triangle,
            data,
            residual,
            blocks,
            unconstrained,
            unseen,
            objective_unit: length * length,
            reference,
            weight: 0.0,
            order,
            scale,
        };
        if reduced.unseen.ncols() > 0 {
            reduced.penalise(penalty_weight(least, &reduced.unconstrained));
        }
        Ok(reduced)
    }

    /// Problem with a weight of the penalty that suits the optimum `u`; `None` if the present one does.
    ///
    /// Before the first optimisation only the answer without constraints is known. Its residuals may be much smaller, and its
    /// unknowns, too.
    pub fn adapted(&self, u: &DVector<f64>) -> Option<Self> {
        let residual = &self.seen_triangle * u - &self.seen_data;
        let squares = residual.norm_squared() + self.residual * self.residual;
        let mut weight = penalty_weight(squares, u);
        if self.unseen.ncols() == 0 || (weight < 100.0 * self.weight && weight > 0.01 * self.weight)
        {
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

    /// Adds the rows `weight^1/2 N^T (u - reference)` to the reduced ones.
    fn penalise(&mut self, weight: f64) {
        let p = self.seen_data.len();
        let rows = self.unseen.transpose() * weight.sqrt();
        let count = rows.nrows();
        let mut chunk = with_column(rows.clone(), &(rows * &self.reference));
        let mut wide = with_column(self.seen_triangle.clone(), &self.seen_data);
        reflect_rows(&mut wide, &mut chunk, p, |_| count);
        self.data = wide.column(p).into_owned();
        self.triangle = wide.columns(0, p).into_owned();
        self.weight = weight;
    }

    /// Number of constrained unknowns; they come first.
    pub fn constrained(&self) -> usize {
        self.blocks.last().map_or(0, |b| b.columns().end)
    }

    /// True if every block is positive semi-definite.
    pub fn is_feasible(&self, u: &DVector<f64>) -> bool {
        self.blocks.iter().all(|block| {
            let matrix = symmetric_from_triangle(&u.as_slice()[block.columns()], block.order);
            matrix.symmetric_eigenvalues().min() >= 0.0
        })
    }

    /// Gradient of the scaled objective, without the penalty.
    pub fn gradient(&self, u: &DVector<f64>) -> DVector<f64> {
        self.seen_triangle
            .tr_mul(&(&self.seen_triangle * u - &self.seen_data))
    }

    /// Penalty of unseen combinations, scaled.
    pub fn penalty(&self, u: &DVector<f64>) -> f64 {
        0.5 * self.weight * self.unseen.tr_mul(&(u - &self.reference)).norm_squared()
    }

    /// Second derivative of the objective, with the penalty, along a change of one block.
    pub fn curvature(&self, block: &Block, change: &DVector<f64>) -> f64 {
        let columns = block.columns();
        (self.triangle.columns(columns.start, columns.len()) * change).norm_squared()
    }

    /// Unknowns in their own units and order.
    pub fn unscaled(&self, u: &DVector<f64>) -> DVector<f64> {
        let mut x = DVector::zeros(u.len());
        for (k, &column) in self.order.iter().enumerate() {
            x[column] = u[k] * self.scale[k];
        }
        x
    }

    /// Unseen combinations in the units and order of the unknowns.
    pub fn unscaled_directions(&self) -> DMatrix<f64> {
        let mut directions = self.unseen.clone();
        for (mut out, u) in directions.column_iter_mut().zip(self.unseen.column_iter()) {
            out.copy_from(&self.unscaled(&u.into_owned()));
        }
        directions
    }
}

/// Weight of the penalty for the sum of squared residuals of an answer `u`.
fn penalty_weight(squares: f64, u: &DVector<f64>) -> f64 {
    (PENALTY * squares / u.norm_squared().max(1.0)).max(SMALLEST_WEIGHT)
}

/// Matrix with one more column.
fn with_column(matrix: DMatrix<f64>, column: &DVector<f64>) -> DMatrix<f64> {
    let last = matrix.ncols();
    let mut wide = matrix.insert_column(last, 0.0);
    wide.set_column(last, column);
    wide
}

/// Matrix `B` with `B^T B = matrix`; `None` if the matrix has a negative eigenvalue.
fn square_root(matrix: DMatrix<f64>) -> Option<DMatrix<f64>> {
    if let Some(cholesky) = matrix.clone().cholesky() {
        return Some(cholesky.l().transpose());
    }
    let eigen = matrix.symmetric_eigen();
    if eigen.eigenvalues.min() < -1e-12 * eigen.eigenvalues.amax() {
        return None;
    }
    let roots = eigen.eigenvalues.map(|v| v.max(0.0).sqrt());
    Some(DMatrix::from_diagonal(&roots) * eigen.eigenvectors.transpose())
}

/// Basis of the unseen combinations, and the least-squares answer nearest to the reference.
///
/// The rank is read from the diagonal of a triangle with pivoted columns.
fn nearest(
    triangle: &DMatrix<f64>,
    data: &DVector<f64>,
    reference: &DVector<f64>,
) -> (DMatrix<f64>, DVector<f64>) {
    let p = triangle.ncols();
    let pivoted = triangle.clone().col_piv_qr();
    let r = pivoted.r();
    let rank = (0..p)
        .take_while(|&k| r[(k, k)].abs() > RANK_TOLERANCE * r[(0, 0)].abs())
        .count();
    let mut rotated = data.clone();
    pivoted.q_tr_mul(&mut rotated);
    // Answers of the leading triangle for the data, and for unit changes of the other unknowns.
    let mut answers = DMatrix::zeros(p, 1 + p - rank);
    answers
        .view_mut((0, 0), (rank, 1))
        .copy_from(&rotated.rows(0, rank));
    answers
        .view_mut((0, 1), (rank, p - rank))
        .copy_from(&(-r.view((0, rank), (rank, p - rank))));
    let leading = r.view((0, 0), (rank, rank));
    // The diagonal of the leading triangle has no zero.
    leading.solve_upper_triangular_mut(&mut answers.rows_mut(0, rank));
    answers
        .view_mut((rank, 1), (p - rank, p - rank))
        .fill_with_identity();
    pivoted.p().inv_permute_rows(&mut answers);
    let unseen = if rank < p {
        answers.columns(1, p - rank).into_owned().qr().q()
    } else {
        DMatrix::zeros(p, 0)
    };
    let basic = answers.column(0).into_owned();
    let away = unseen.tr_mul(&(&basic - reference));
    let unconstrained = basic - &unseen * away;
    (unseen, unconstrained)
}
