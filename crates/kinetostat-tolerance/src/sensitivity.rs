//! Sobol's indices: which part of the variance each number alone explains, and which part is gone when it is known.
//!
//! Two independent matrices of draws A and B, and for each number the matrix A with its column from B [Saltelli et al., Computer
//! Physics Communications 181 (2010) 259]: `S_i = E[f(B) (f(AB_i) - f(A))] / V` and `T_i = E[(f(A) - f(AB_i))^2] / 2V` (Jansen).

use serde::Serialize;

use crate::draws::{Draws, REPLICATES};
use crate::statistics::Estimate;
use crate::uncertain::Uncertainties;

/// Largest share of the draws that may be left out. The others say nothing of what is missing, nor does their scatter: where the draws of
/// one corner are missing, indices are those of what is left, and their intervals as narrow as if that were all.
pub const MOST_MISSING: f64 = 0.02;

/// Share of the variance that a number explains.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct SobolIndex {
    /// Share that it explains alone.
    pub first: Estimate,
    /// Share that it explains together with all others.
    pub total: Estimate,
}

/// Values for which a function is asked: row by row, `draws * (numbers + 2)` rows; of each draw A, B, then A with each column of B.
#[must_use]
pub fn design_row(uncertainties: &Uncertainties, draws: &Draws, row: usize) -> Vec<f64> {
    let n = uncertainties.each().len();
    let (draw, which) = (row / (n + 2), row % (n + 2));
    let point = |column: usize| {
        let from_b = which == 1 || which == column + 2;
        draws.point(draw, column + if from_b { n } else { 0 })
    };
    let points: Vec<f64> = (0..n).map(point).collect();
    uncertainties.at(&points)
}

/// Number of rows of the design.
#[must_use]
pub fn design_rows(uncertainties: &Uncertainties, draws: &Draws) -> usize {
    draws.len() * (uncertainties.each().len() + 2)
}

/// The indices of `numbers` numbers from the answers to the rows of a design, NaN where there is none: what misses one is left out as a
/// whole. NaN where more than [`MOST_MISSING`] are left out. Returns the draws that have an answer, too.
#[must_use]
pub fn sobol_indices(draws: &Draws, numbers: usize, answers: &[f64]) -> (Vec<SobolIndex>, usize) {
    let whole = |row: &&[f64]| row.iter().all(|x| x.is_finite());
    let used: Vec<(usize, &[f64])> = answers
        .chunks_exact(numbers + 2)
        .enumerate()
        .filter(|(_, row)| whole(row))
        .collect();
    if (used.len() as f64) < (1.0 - MOST_MISSING) * draws.len() as f64 {
        let unknown = Estimate {
            value: f64::NAN,
            plus_minus: f64::NAN,
        };
        let index = SobolIndex {
            first: unknown,
            total: unknown,
        };
        return (vec![index; numbers], used.len());
    }
    let all = indices(used.iter().map(|(_, row)| *row), numbers);
    let each: Vec<Vec<[f64; 2]>> = (0..REPLICATES)
        .map(|replicate| {
            let own = used
                .iter()
                .filter(|(draw, _)| draws.replicate(*draw) == replicate);
            indices(own.map(|(_, row)| *row), numbers)
        })
        .collect();
    let estimate = |i: usize, which: usize| {
        let own: Vec<f64> = each
            .iter()
            .map(|e| e[i][which])
            .filter(|x| x.is_finite())
            .collect();
        Estimate::of_replicates(all[i][which], &own)
    };
    let found = (0..numbers).map(|i| SobolIndex {
        first: estimate(i, 0),
        total: estimate(i, 1),
    });
    (found.collect(), used.len())
}

/// First and total index of every number; NaN where nothing varies.
fn indices<'a>(rows: impl Iterator<Item = &'a [f64]> + Clone, numbers: usize) -> Vec<[f64; 2]> {
    let (mut count, mut sum) = (0.0, 0.0);
    for row in rows.clone() {
        count += 2.0;
        sum += row[0] + row[1];
    }
    let mean = sum / count;
    let mut variance = 0.0;
    let mut sums = vec![[0.0; 2]; numbers];
    for row in rows {
        // About the mean: the products lose no digits, and scatter less.
        let (a, b) = (row[0] - mean, row[1] - mean);
        variance += a * a + b * b;
        for (own, mixed) in sums.iter_mut().zip(&row[2..]) {
            own[0] += b * (mixed - row[0]);
            own[1] += (row[0] - mixed).powi(2);
        }
    }
    let variance = variance / count;
    // Variation by rounding alone has no shares.
    let floor = 1e-24 * mean * mean;
    let scale = if variance > floor {
        variance * count / 2.0
    } else {
        f64::NAN
    };
    sums.iter()
        .map(|[first, total]| [first / scale, 0.5 * total / scale])
        .collect()
}
