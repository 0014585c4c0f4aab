//! Order of the unknowns, constrained blocks first, and their sizes.

use std::f64::consts::FRAC_1_SQRT_2;
use std::ops::Range;

use nalgebra::{DMatrix, DVector};

use super::ConeLeastSquares;
use super::symmetric::triangle_index;

/// Columns below this fraction of the longest one are rounding errors, even if units differ by 1e6.
const COLUMN_TOLERANCE: f64 = 1e-13;

/// Place of a constrained block among the ordered unknowns.
#[derive(Clone)]
pub(super) struct Block {
    /// First of its n(n+1)/2 unknowns.
    pub start: usize,
    /// Order n of the matrix.
    pub order: usize,
    /// Sizes `D` of `X = D Xs D`.
    pub sizes: Vec<f64>,
}

impl Block {
    /// Range of its unknowns.
    pub fn columns(&self) -> Range<usize> {
        self.start..self.start + self.order * (self.order + 1) / 2
    }
}

/// Lengths of the columns.
pub(super) fn norms(matrix: &DMatrix<f64>) -> DVector<f64> {
    DVector::from_iterator(matrix.ncols(), matrix.column_iter().map(|c| c.norm()))
}

/// Order of the unknowns (blocks first), their scales, and the blocks.
pub(super) fn ordered(problem: &ConeLeastSquares<'_>) -> (Vec<usize>, Vec<f64>, Vec<Block>) {
    let p = problem.matrix.ncols();
    let mut lengths = norms(problem.matrix);
    if let Some(precision) = problem.precision {
        for k in 0..p {
            lengths[k] = lengths[k].hypot(precision[(k, k)].max(0.0).sqrt());
        }
    }
    let longest = lengths.amax();
    let size = |column: usize| match problem.nominal {
        Some(sizes) => sizes[column],
        None if longest == 0.0 => 1.0,
        None if lengths[column] <= COLUMN_TOLERANCE * longest => 1.0 / longest,
        None => 1.0 / lengths[column],
    };
    let (mut order, mut scale, mut blocks) = (Vec::new(), Vec::new(), Vec::new());
    let mut is_free = vec![true; p];
    for constraint in problem.constraints {
        let columns = constraint.columns();
        let n = constraint.order().unwrap_or(0);
        let diagonal = (0..n).map(|i| size(columns[triangle_index(n, i, i)]).sqrt());
        let sizes: Vec<f64> = diagonal.collect();
        let start = order.len();
        for i in 0..n {
            scale.push(sizes[i] * sizes[i]);
            let off = |k: usize| sizes[i] * sizes[k] * FRAC_1_SQRT_2;
            scale.extend((i + 1..n).map(off));
        }
        for &column in columns {
            is_free[column] = false;
            order.push(column);
        }
        blocks.push(Block {
            start,
            order: n,
            sizes,
        });
    }
    for column in (0..p).filter(|&k| is_free[k]) {
        order.push(column);
        scale.push(size(column));
    }
    (order, scale, blocks)
}
