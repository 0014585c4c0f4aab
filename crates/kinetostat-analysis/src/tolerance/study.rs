//! Many machines, on all cores.
//!
//! Sobol's indices: which part of the variance each number alone explains, and which part is gone when it is known.
//!
//! Two independent matrices of draws A and B, and for each number the matrix A with its column from B [Saltelli et al., Computer
//! Physics Communications 181 (2010) 259]: `S_i = E[f(B) (f(AB_i) - f(A))] / V` and `T_i = E[(f(A) - f(AB_i))^2] / 2V` (Jansen).

use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use kinetostat::number::short;
use kinetostat_machining::{RunError, Watch};
use rayon::prelude::*;
use schemars::JsonSchema;
use serde::Serialize;

use crate::tolerance::draws::{Draws, REPLICATES};
use crate::tolerance::linear::{ENOUGH, Linear, linear, linear_points, nonlinearity};
use crate::tolerance::machine::{DependsOnMachine, Room, TaskError};
use crate::tolerance::statistics::{Estimate, Summary};
use crate::tolerance::uncertain::Uncertainties;

/// Machines that a thread takes at a time.
const BLOCK: usize = 16;

/// Blocks between two looks at the watch.
const BLOCKS: usize = 64;

/// Numbers of all machines that are kept at a time: 1.6 GB.
pub const MOST_NUMBERS: usize = 200_000_000;

/// More numbers than are kept at a time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "these are {count} numbers ({} GB), and {MOST_NUMBERS} ({} GB) can be kept",
    gigabytes(*count),
    gigabytes(MOST_NUMBERS)
)]
pub struct TooManyNumbers {
    /// Numbers that were asked for.
    pub count: usize,
}

fn gigabytes(numbers: usize) -> String {
    short(8e-9 * numbers as f64)
}

/// Checks, before anything is computed, that `rows` answers of `width` numbers each can be kept.
///
/// # Errors
/// [`TooManyNumbers`].
pub fn can_be_kept(rows: usize, width: usize) -> Result<(), TooManyNumbers> {
    let count = rows.saturating_mul(width);
    match count > MOST_NUMBERS {
        true => Err(TooManyNumbers { count }),
        false => Ok(()),
    }
}

/// Draws without a whole answer, by reason. None is dropped in silence.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, JsonSchema)]
pub struct Failures {
    /// Draws whose numbers make no machine.
    pub no_machine: usize,
    /// Draws whose machine has no equilibrium, or is out of reach, at one place or more.
    pub no_answer: usize,
    /// Draws whose machine is not stable under the load at one place or more; their numbers count.
    pub unstable: usize,
    /// Reason for which the first of those that make no machine is refused.
    pub example: Option<String>,
}

/// Results of many machines.
#[derive(Clone, Debug)]
pub struct Samples {
    /// Rows, one for each machine: places times columns, NaN where there is no answer.
    pub numbers: Vec<f64>,
    /// Numbers of a row.
    pub width: usize,
    /// Draws without a whole answer.
    pub failures: Failures,
}

impl Samples {
    /// Column of one number for all machines.
    pub fn column(&self, column: usize) -> Vec<f64> {
        self.numbers
            .iter()
            .skip(column)
            .step_by(self.width.max(1))
            .copied()
            .collect()
    }
}

/// Answers of `count` machines, the i-th with `values(i)`: on all cores, in their order, the same with any number of threads.
///
/// # Errors
/// [`RunError::Cancelled`].
pub fn sample(
    machine: &impl DependsOnMachine,
    count: usize,
    values: impl Fn(usize) -> Vec<f64> + Sync,
    watch: &dyn Watch,
    stage: &str,
) -> Result<Samples, RunError> {
    let width = machine.width();
    let mut numbers = vec![f64::NAN; count * width];
    let [no_machine, no_answer, unstable] = [0; 3].map(AtomicUsize::new);
    let example: Mutex<Option<(usize, String)>> = Mutex::new(None);
    watch.stage(stage, count);
    let each = (BLOCK * BLOCKS * width).max(1);
    for (part, out) in numbers.chunks_mut(each).enumerate() {
        let first = part * BLOCK * BLOCKS;
        let blocks = out.par_chunks_mut((BLOCK * width).max(1)).enumerate();
        blocks.for_each_init(Room::default, |room, (block, out)| {
            for (k, row) in out.chunks_exact_mut(width.max(1)).enumerate() {
                if watch.cancelled() {
                    return;
                }
                let i = first + block * BLOCK + k;
                match machine.answer(&values(i), room, row) {
                    Ok(shaky) => {
                        unstable.fetch_add(usize::from(shaky > 0), Ordering::Relaxed);
                        let whole = row.iter().all(|x| x.is_finite());
                        no_answer.fetch_add(usize::from(!whole), Ordering::Relaxed);
                    }
                    Err(error) => {
                        row.fill(f64::NAN);
                        no_machine.fetch_add(1, Ordering::Relaxed);
                        let mut first = example
                            .lock()
                            .unwrap_or_else(std::sync::PoisonError::into_inner);
                        if first.as_ref().is_none_or(|(known, _)| i < *known) {
                            *first = Some((i, error.to_string()));
                        }
                    }
                }
            }
        });
        if watch.cancelled() {
            return Err(RunError::Cancelled);
        }
        watch.advance((first + BLOCK * BLOCKS).min(count));
    }
    let example = example
        .into_inner()
        .unwrap_or_else(std::sync::PoisonError::into_inner);
    Ok(Samples {
        numbers,
        width,
        failures: Failures {
            no_machine: no_machine.into_inner(),
            no_answer: no_answer.into_inner(),
            unstable: unstable.into_inner(),
            example: example.map(|(_, words)| words),
        },
    })
}

/// Samples of a design's draws.
///
/// # Errors
/// [`RunError::Cancelled`].
pub fn monte_carlo(
    machine: &impl DependsOnMachine,
    uncertainties: &Uncertainties,
    draws: &Draws,
    watch: &dyn Watch,
) -> Result<Samples, RunError> {
    sample(
        machine,
        draws.len(),
        |i| uncertainties.drawn(draws, i),
        watch,
        "machines",
    )
}

/// Linear functions of all outputs.
///
/// # Errors
/// [`TaskError`] where a machine next to the drawing is none.
pub fn linearised(
    machine: &impl DependsOnMachine,
    uncertainties: &Uncertainties,
) -> Result<Vec<Linear>, TaskError> {
    let mut room = Room::default();
    let answers: Result<Vec<Vec<f64>>, TaskError> = linear_points(uncertainties)
        .iter()
        .map(|values| {
            let mut out = vec![0.0; machine.width()];
            machine.answer(values, &mut room, &mut out)?;
            Ok(out)
        })
        .collect();
    Ok(linear(uncertainties, &answers?))
}

/// Verdict on linear propagation for one output.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Verdict {
    /// Root mean square of exact minus linear over all draws, in standard deviations of the draws.
    pub nonlinearity: f64,
    /// True if it is at most [`ENOUGH`].
    pub linear_is_enough: bool,
}

/// Results of one output at one place.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct OutputAnswer {
    /// Result of linear propagation.
    pub linear: Linear,
    /// Statistics of the draws.
    pub draws: Summary,
    /// Verdict on the linear result.
    pub verdict: Verdict,
}

/// All outputs of all places, place after place.
#[must_use]
pub fn answers(
    uncertainties: &Uncertainties,
    draws: &Draws,
    samples: &Samples,
    lines: Vec<Linear>,
) -> Vec<OutputAnswer> {
    let values = |i| uncertainties.drawn(draws, i);
    let inputs: Vec<Vec<f64>> = (0..draws.len()).into_par_iter().map(values).collect();
    lines
        .into_par_iter()
        .enumerate()
        .map(|(column, line)| {
            let values = samples.column(column);
            let nonlinearity = nonlinearity(&values, |i| line.at(uncertainties, &inputs[i]));
            OutputAnswer {
                draws: Summary::of(draws, &values),
                verdict: Verdict {
                    nonlinearity,
                    linear_is_enough: nonlinearity <= ENOUGH,
                },
                linear: line,
            }
        })
        .collect()
}

/// Sobol indices of every output, each with those of every number; and the draws that have no whole answer.
///
/// # Errors
/// [`RunError::Cancelled`].
pub fn sobol(
    machine: &impl DependsOnMachine,
    uncertainties: &Uncertainties,
    draws: &Draws,
    watch: &dyn Watch,
) -> Result<(Vec<Vec<SobolIndex>>, Failures), RunError> {
    let rows = design_rows(uncertainties, draws);
    let samples = sample(
        machine,
        rows,
        |row| design_row(uncertainties, draws, row),
        watch,
        "Sobol indices",
    )?;
    let numbers = uncertainties.each().len();
    let each = (0..samples.width).into_par_iter();
    let indices = each.map(|column| sobol_indices(draws, numbers, &samples.column(column)).0);
    Ok((indices.collect(), samples.failures))
}

/// Largest share of the draws that may be left out. The others say nothing of what is missing, nor does their scatter: where the draws of
/// one corner are missing, indices are those of what is left, and their intervals as narrow as if that were all.
pub const MOST_MISSING: f64 = 0.02;

/// Share of the variance that a number explains.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
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
