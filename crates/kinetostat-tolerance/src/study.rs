//! Many machines, on all cores.

use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use kinetostat::number::short;
use kinetostat_machining::{RunError, Watch};
use rayon::prelude::*;
use serde::Serialize;

use crate::draws::Draws;
use crate::linear::{ENOUGH, Linear, linear, linear_points, nonlinearity};
use crate::machine::{DependsOnMachine, Room, TaskError};
use crate::sensitivity::{SobolIndex, design_row, design_rows, sobol_indices};
use crate::statistics::Summary;
use crate::uncertain::Uncertainties;

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
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
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
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Verdict {
    /// Root mean square of exact minus linear over all draws, in standard deviations of the draws.
    pub nonlinearity: f64,
    /// True if it is at most [`ENOUGH`].
    pub linear_is_enough: bool,
}

/// Results of one output at one place.
#[derive(Clone, Debug, PartialEq, Serialize)]
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
