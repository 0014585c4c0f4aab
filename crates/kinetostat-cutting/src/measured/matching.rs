//! The shift between a log and what is expected.

use rustfft::FftPlanner;
use rustfft::num_complex::Complex;

use crate::error::{CutError, CutErrorKind, Result};
use crate::measured::correlation::{Activity, Correlation, coefficient};
use crate::measured::log::{ForceLog, LoggedBy};
use crate::number::larger;

/// Smallest correlation that a match may have.
const LEAST_CORRELATION: f64 = 0.5;
/// Required lead of the best shift over the next peak.
const LEAST_LEAD: f64 = 0.05;
/// A peak stands out from its surroundings by so much.
const RIPPLE: f64 = 0.02;
/// A shift is known to within this, s, or it is not known.
const MOST_UNCERTAIN_S: f64 = 0.5;
/// Share of the force that a log exactly as expected would lose by a shift, which this one must lose at least.
const LEAST_LOSS: f64 = 0.25;

/// A shift at which a log agrees with what is expected.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShiftMatch {
    /// Time of the log less time of what is expected, s.
    pub shift_s: f64,
    /// Pearson's coefficient of the size of the force with what is expected, over all of the log.
    pub correlation: f64,
    /// Shift (s) and coefficient of the next best peak, if there is another.
    pub next: Option<[f64; 2]>,
    /// A shift that is off by this much, s, leaves at least a quarter as much force where none is expected as it would if the log
    /// were exactly as expected; one that is off by less may not be told from this one.
    pub within_s: f64,
}

/// Finds the shift of a log over time against an expected course of the force.
///
/// At every shift the size of the logged force is compared with what is expected, over all of the log: where nothing is
/// expected, before and after the course too, the force should be small. The best of all shifts is found on a grid by fast
/// Fourier transform and then refined far below the time from row to row.
///
/// ```
/// use kinetostat_cutting::{Activity, ForceLog, LoggedBy, match_shift};
///
/// // Cuts of 2 and 3 s with a second between them, in a log that begins 1.2345 s earlier.
/// let cut = |t: f64| (0.0..2.0).contains(&t) || (3.0..6.0).contains(&t);
/// let at: Vec<f64> = (0..1000).map(|i| f64::from(i) * 0.01).collect();
/// let fx = at.iter().map(|t| if cut(t - 1.2345) { 80.0 } else { 1.0 }).collect();
/// let log = ForceLog::new(LoggedBy::Time, at, [fx, vec![0.0; 1000], vec![0.0; 1000]], None)?;
///
/// let expected = vec![[0.0, 1.0], [2.0, 1.0], [2.0, 0.0], [3.0, 0.0], [3.0, 1.0], [6.0, 1.0]];
/// let found = match_shift(&log, &Activity::new(expected)?)?;
/// assert!((found.shift_s - 1.2345).abs() < 0.01);
/// assert!(found.correlation > 0.99 && found.next.unwrap()[1] < 0.8);
/// # Ok::<(), kinetostat_cutting::CutError>(())
/// ```
///
/// # Errors
/// A log along the path; no shift with a correlation of 0.5; another shift that is as good to within 0.05; a peak so flat that
/// the shift is not known to within half a second (cuts that begin or end in air look so).
pub fn match_shift(log: &ForceLog, expected: &Activity) -> Result<ShiftMatch> {
    if log.by() != LoggedBy::Time {
        return refuse(
            "a log along the path",
            "a log over time; one along the path has no shift",
        );
    }
    let sizes = log.sizes();
    let correlation = Correlation::new(&log.at, &sizes, expected);
    let rows = log.spacing();
    let shifts = Shifts::of(&correlation, log.range(), expected.range(), rows);
    let best = shifts.best();
    let next = shifts.next(best, RIPPLE);
    let next = next.map(|i| [shifts.shift(i), shifts.correlation[i]]);
    let next = next.filter(|[_, also]| *also > 0.0);
    let (shift_s, found) = refined(&correlation, shifts.shift(best), shifts.step, rows);
    if !found.is_finite() || found < LEAST_CORRELATION {
        return refuse(
            format!("a correlation of {found:.2} at most, at {shift_s:.3} s"),
            "0.5 at least: this log does not look like the program; state the shift",
        );
    }
    if let Some([other, also]) = next
        && also > found - LEAST_LEAD
    {
        return refuse(
            format!(
                "a correlation of {found:.3} at {shift_s:.3} s and of {also:.3} at {other:.3} s"
            ),
            "one shift that is better than all others by 0.05: the log looks the same at both; state the shift",
        );
    }
    let within_s = within(&correlation, log, expected, shift_s);
    if within_s > MOST_UNCERTAIN_S {
        return refuse(
            format!("a shift of {shift_s:.3} s that may as well be {within_s:.2} s more or less"),
            "a shift that is known to within 0.5 s: feed moves that begin or end in air hide when the cut begins; state the shift",
        );
    }
    Ok(ShiftMatch {
        shift_s,
        correlation: found,
        next,
        within_s,
    })
}

fn refuse<T>(found: impl ToString, expected: &str) -> Result<T> {
    Err(CutError::new(
        CutErrorKind::Measurement,
        "shift by correlation",
        found,
        expected,
    ))
}

/// The best shift around one of a grid, by halving the step until it is far below the time from row to row.
fn refined(correlation: &Correlation<'_>, from: f64, grid: f64, rows: f64) -> (f64, f64) {
    let mut best = (from, correlation.at(from));
    let mut step = grid;
    while step > rows / 100.0 {
        for shift in [best.0 - step, best.0 + step] {
            let here = correlation.at(shift);
            if here > best.1 {
                best = (shift, here);
            }
        }
        step *= 0.5;
    }
    best
}

/// Uncertainty of the shift: the error at which measured force remains where none is expected, in doubling steps up to
/// a quarter of the compared length. Correlation itself would not do: it also grows where the part of the program that
/// does not fit is pushed over the end of the log.
fn within(correlation: &Correlation<'_>, log: &ForceLog, expected: &Activity, shift: f64) -> f64 {
    let [from, to] = log.range();
    let (at, values) = expected.between(from - shift, to - shift);
    // Loss of a log that is exactly as expected, for reference; its shift is zero.
    let with_itself = Correlation::new(&at, &values, expected);
    let lost = |of: &Correlation<'_>, from: f64, to: f64| 1.0 - of.product(to) / of.product(from);
    let [first, last] = expected.range();
    let most = 0.25
        * match last - first < to - from {
            true => last - first,
            false => to - from,
        };
    let mut known = log.spacing();
    let mut off = known;
    while off <= most {
        for off in [off, -off] {
            let loss = lost(correlation, shift, shift + off);
            if loss < LEAST_LOSS * lost(&with_itself, 0.0, off) {
                known = 2.0 * off.abs();
            }
        }
        off *= 2.0;
    }
    known
}

/// Maximum number of cells of the grid, of the log and of the program together.
const MOST_CELLS: f64 = 524_288.0;

/// Correlation at shifts of equal distance.
pub(crate) struct Shifts {
    first: f64,
    pub step: f64,
    pub correlation: Vec<f64>,
}

impl Shifts {
    /// Correlates a log (from, to) with the expected signal (from, to), s, on cells no shorter than the rows.
    pub fn of(correlation: &Correlation<'_>, log: [f64; 2], expected: [f64; 2], rows: f64) -> Self {
        let lengths = [log[1] - log[0], expected[1] - expected[0]];
        let step = larger(rows, (lengths[0] + lengths[1]) / MOST_CELLS);
        let [a, b] = [0, 1].map(|i| (lengths[i] / step).ceil() as usize);
        // Means of the cells; what is measured about its mean, for the sake of its digits.
        let cells = |count: usize, from: f64, integral: &dyn Fn(f64) -> f64| -> Vec<f64> {
            let edges: Vec<f64> = (0..=count)
                .map(|i| integral(from + i as f64 * step))
                .collect();
            edges.windows(2).map(|e| (e[1] - e[0]) / step).collect()
        };
        let mut measured = cells(a, log[0], &|t| correlation.measured_to(t));
        for cell in &mut measured {
            *cell -= correlation.mean();
        }
        let expected_cells = cells(b, expected[0], &|t| correlation.expected_to(t));
        Self {
            first: log[0] - expected[0] - (b - 1) as f64 * step,
            step,
            correlation: coefficients(&measured, &expected_cells),
        }
    }

    pub fn shift(&self, index: usize) -> f64 {
        self.first + index as f64 * self.step
    }

    /// The largest.
    pub fn best(&self) -> usize {
        let all = self.correlation.iter().enumerate();
        let best = all.reduce(|a, b| if b.1 > a.1 { b } else { a });
        best.map_or(0, |(index, _)| index)
    }

    /// The highest other peak: one that stands out from the lowest place on the way to it by at least `ripple`.
    pub fn next(&self, best: usize, ripple: f64) -> Option<usize> {
        let mut found: Option<usize> = None;
        let mut look = |indices: &mut dyn Iterator<Item = usize>| {
            let mut lowest = self.correlation[best];
            for i in indices {
                let here = self.correlation[i];
                if here < lowest {
                    lowest = here;
                } else if here - lowest >= ripple
                    && found.is_none_or(|known| here > self.correlation[known])
                {
                    found = Some(i);
                }
            }
        };
        look(&mut (best + 1..self.correlation.len()));
        look(&mut (0..best).rev());
        found
    }
}

/// Coefficients of two courses of cells at all shifts at which they overlap, the first with the last cell of `b` on the first
/// of `a`. Where `b` has no cells it is zero.
fn coefficients(a: &[f64], b: &[f64]) -> Vec<f64> {
    let products = products(a, b);
    let of_a: (f64, f64) = (a.iter().sum(), a.iter().map(|x| x * x).sum());
    let count = a.len() as f64;
    let spread_a = of_a.1 - of_a.0 * of_a.0 / count;
    let mut sums = vec![(0.0, 0.0)];
    let mut total = (0.0, 0.0);
    for x in b {
        total = (total.0 + x, total.1 + x * x);
        sums.push(total);
    }
    let shifts = products.into_iter().enumerate();
    shifts
        .map(|(index, product)| {
            // Cell `first` of `b` lies on the first of `a`, or would.
            let first = b.len() as isize - 1 - index as isize;
            let place = |i: isize| sums[i.clamp(0, b.len() as isize) as usize];
            let (from, to) = (place(first), place(first + a.len() as isize));
            let (sum, square) = (to.0 - from.0, to.1 - from.1);
            let spread_b = square - sum * sum / count;
            coefficient(product - of_a.0 * sum / count, spread_a, spread_b)
        })
        .collect()
}

/// Sums of products at all shifts at which two lists overlap.
fn products(a: &[f64], b: &[f64]) -> Vec<f64> {
    let count = a.len() + b.len() - 1;
    let size = count.next_power_of_two();
    let padded = |values: &mut dyn Iterator<Item = f64>| -> Vec<Complex<f64>> {
        let mut cells: Vec<Complex<f64>> = values.map(|x| Complex::new(x, 0.0)).collect();
        cells.resize(size, Complex::new(0.0, 0.0));
        cells
    };
    let mut planner = FftPlanner::new();
    let forward = planner.plan_fft_forward(size);
    let mut x = padded(&mut a.iter().copied());
    let mut y = padded(&mut b.iter().rev().copied());
    forward.process(&mut x);
    forward.process(&mut y);
    for (x, y) in x.iter_mut().zip(&y) {
        *x *= y;
    }
    planner.plan_fft_inverse(size).process(&mut x);
    x.truncate(count);
    x.into_iter().map(|z| z.re / size as f64).collect()
}
