//! What the readings can tell of the unknowns: which combinations they see, and how well each number is known.
//!
//! A combination of unknowns that no reading sees cannot be estimated, however good the instrument is. Which these are is decided by the
//! singular values of the rows, unknowns in units of their sizes: seen ones are above 1e-4 of the largest, unseen ones are rounding.
//! What is seen may still be known badly, because noise covers it.

use kinetostat::linalg::SingularValues;
use nalgebra::{DMatrix, DVector};
use schemars::JsonSchema;
use serde::Serialize;

use crate::cone::UNSEEN;
use crate::least_squares::{PostureRows, reduced};

/// Standard deviation relative to the value above which a number is weakly known.
pub const WEAK: f64 = 0.3;

/// How well a number is known.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Knowledge {
    /// Its standard deviation is below 30 % of its size.
    Identified,
    /// Readings see it, but noise leaves more than 30 % of its size open.
    Weak,
    /// No reading sees it alone; a combination with others may be known.
    Unseen,
}

/// A combination of unknowns that the readings see: `sum factor_k unknown_k / size_k`, the first factor 1.
#[derive(Clone, Debug, PartialEq)]
pub struct Combination {
    /// Unknown and its factor.
    pub parts: Vec<(usize, f64)>,
}

/// What the rows of an experiment see.
#[derive(Clone, Debug)]
pub struct Identifiability {
    /// Number of combinations that the rows see.
    pub rank: usize,
    /// Singular values of the rows, unknowns in units of their sizes, the largest first: the `k`-th combination is known to one over it.
    pub singular_values: Vec<f64>,
    /// For each unknown: whether the rows see it alone.
    pub seen_alone: Vec<bool>,
    /// As many combinations as the rank, none of which has another's first unknown.
    pub combinations: Vec<Combination>,
}

/// Part of an unknown that the rows do not see above which it is not seen alone.
const PART: f64 = 1e-6;

impl Identifiability {
    /// Decides what the rows see of unknowns with these sizes.
    #[must_use]
    pub fn of(postures: &[PostureRows], sizes: &DVector<f64>) -> Self {
        let found = singular_values(postures, sizes);
        let rank = found.rank(UNSEEN);
        let seen = found.right.columns(0, rank).transpose();
        let singular_values = found.values;
        let seen_alone = seen
            .column_iter()
            .map(|c| 1.0 - c.norm_squared() < PART)
            .collect();
        Self {
            rank,
            singular_values,
            seen_alone,
            combinations: combinations(seen),
        }
    }

    /// How well each unknown is known, by their standard deviations relative to their sizes.
    #[must_use]
    pub fn knowledge(&self, relative_deviations: &DVector<f64>) -> Vec<Knowledge> {
        let each = self.seen_alone.iter().zip(relative_deviations.iter());
        each.map(|(seen, deviation)| match (seen, *deviation < WEAK) {
            (false, _) => Knowledge::Unseen,
            (true, true) => Knowledge::Identified,
            (true, false) => Knowledge::Weak,
        })
        .collect()
    }
}

/// Singular values of all rows, unknowns in units of their sizes.
pub(crate) fn singular_values(postures: &[PostureRows], sizes: &DVector<f64>) -> SingularValues {
    let ones: Vec<_> = postures
        .iter()
        .map(|p| DVector::repeat(p.values.len(), 1.0))
        .collect();
    let (triangle, _) = reduced(postures, &ones);
    let scaled = DMatrix::from_fn(triangle.nrows(), triangle.ncols(), |i, j| {
        triangle[(i, j)] * sizes[j]
    });
    SingularValues::of(&scaled)
}

/// Rows reduced to echelon form: each has an unknown of its own with the factor 1, the one with the largest entry that is left.
fn combinations(mut rows: DMatrix<f64>) -> Vec<Combination> {
    let (count, unknowns) = rows.shape();
    let mut own: Vec<usize> = Vec::new();
    for row in 0..count {
        let mut best = (row, 0, 0.0_f64);
        for j in (0..unknowns).filter(|j| !own.contains(j)) {
            // Earlier unknowns are preferred where entries are nearly equal, so that names stay where a reader looks first.
            for i in row..count {
                if rows[(i, j)].abs() > 1.5 * best.2 {
                    best = (i, j, rows[(i, j)].abs());
                }
            }
        }
        let (pivot, column, size) = best;
        if size == 0.0 {
            break;
        }
        rows.swap_rows(row, pivot);
        let factor = 1.0 / rows[(row, column)];
        rows.row_mut(row).scale_mut(factor);
        let line = rows.row(row).into_owned();
        for i in (0..count).filter(|i| *i != row) {
            let factor = rows[(i, column)];
            for j in 0..unknowns {
                rows[(i, j)] -= factor * line[j];
            }
        }
        own.push(column);
    }
    let combination = |(row, first): (usize, &usize)| {
        let mut parts = vec![(*first, 1.0)];
        let others = (0..unknowns).filter(|j| j != first && rows[(row, *j)].abs() > 1e-6);
        parts.extend(others.map(|j| (j, rows[(row, j)])));
        Combination { parts }
    };
    let mut found: Vec<Combination> = own.iter().enumerate().map(combination).collect();
    found.sort_by_key(|c| c.parts[0].0);
    found
}
