//! The correlation at all shifts, on a grid of time, by fast Fourier transform.

use rustfft::FftPlanner;
use rustfft::num_complex::Complex;

use crate::measured::correlation::{Correlation, coefficient};
use crate::number::larger;

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
