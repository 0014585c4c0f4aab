//! The correlation of a measured course with an expected one, at any shift between them.

use crate::measured::activity::Activity;
use crate::measured::integral::{Integral, of_square};

/// Integrals of an expected course and of its square, up to each point.
struct Sums<'a> {
    of: &'a Activity,
    sums: Vec<[f64; 2]>,
}

impl<'a> Sums<'a> {
    fn new(of: &'a Activity) -> Self {
        let mut sums = vec![[0.0; 2]];
        let mut total = [0.0; 2];
        for i in 1..of.at.len() {
            let [sum, square] = piece(&of.at[i - 1..=i], &of.values[i - 1..=i]);
            total = [total[0] + sum, total[1] + square];
            sums.push(total);
        }
        Self { of, sums }
    }

    /// Integrals up to a time.
    fn to(&self, at: f64) -> [f64; 2] {
        let [first, last] = self.of.range();
        let at = at.clamp(first, last);
        let (times, values) = (&self.of.at, &self.of.values);
        let after = times.partition_point(|t| *t <= at);
        let i = after.clamp(1, times.len() - 1);
        let (a, b) = (times[i - 1], times[i]);
        let value = match b > a {
            true => values[i - 1] + (values[i] - values[i - 1]) * (at - a) / (b - a),
            false => values[i],
        };
        let [sum, square] = piece(&[a, at], &[values[i - 1], value]);
        let before = self.sums[i - 1];
        [before[0] + sum, before[1] + square]
    }
}

/// Integral of a straight piece, and of its square.
fn piece(at: &[f64], values: &[f64]) -> [f64; 2] {
    let sum = 0.5 * (at[1] - at[0]) * (values[0] + values[1]);
    [sum, of_square(at, values)]
}

/// A measured course over a stretch of time against an expected one.
pub(crate) struct Correlation<'a> {
    measured: Integral<'a>,
    /// First and last time of the measured course.
    range: [f64; 2],
    mean: f64,
    /// Integral of the square of what is measured about its mean.
    variance: f64,
    expected: Sums<'a>,
}

impl<'a> Correlation<'a> {
    /// Prepares the correlation with a signal of at least two rows.
    pub fn new(at: &'a [f64], values: &'a [f64], expected: &'a Activity) -> Self {
        let range = [at[0], at[at.len() - 1]];
        let length = range[1] - range[0];
        let measured = Integral::with_first_moment(at, values);
        let mean = measured.to(range[1]) / length;
        Self {
            variance: of_square(at, values) - mean * mean * length,
            mean,
            measured,
            range,
            expected: Sums::new(expected),
        }
    }

    pub fn mean(&self) -> f64 {
        self.mean
    }

    /// Integrals of the measured course, and of what is expected, up to a time of either.
    pub fn measured_to(&self, at: f64) -> f64 {
        self.measured.to(at)
    }

    pub fn expected_to(&self, at: f64) -> f64 {
        self.expected.to(at)[0]
    }

    /// Pearson's coefficient where time of the measured course is that of the expected one plus `shift`, over all that was
    /// measured; 0 where one of them does not change.
    pub fn at(&self, shift: f64) -> f64 {
        let [from, to] = self.range;
        let (a, b) = (self.expected.to(from - shift), self.expected.to(to - shift));
        let (sum, square) = (b[0] - a[0], b[1] - a[1]);
        let variance = square - sum * sum / (to - from);
        let product = self.product(shift) - self.mean * sum;
        coefficient(product, self.variance, variance)
    }

    /// Integral of measured times expected, where time of the measured course is that of the expected one plus `shift`.
    pub fn product(&self, shift: f64) -> f64 {
        let of = self.expected.of;
        let origin = self.range[0];
        let pieces = of.at.windows(2).zip(of.values.windows(2));
        let product = |(t, v): (&[f64], &[f64])| {
            if t[1] <= t[0] || (v[0] == 0.0 && v[1] == 0.0) {
                return 0.0;
            }
            let (from, to) = (t[0] + shift, t[1] + shift);
            let sum = self.measured.to(to) - self.measured.to(from);
            let slope = (v[1] - v[0]) / (t[1] - t[0]);
            if slope == 0.0 {
                return v[0] * sum;
            }
            let moment = self.measured.first_moment_to(to) - self.measured.first_moment_to(from);
            (v[0] + slope * (origin - from)) * sum + slope * moment
        };
        pieces.map(product).sum()
    }
}

/// A coefficient of correlation; 0 where one of two courses does not change.
pub(crate) fn coefficient(product: f64, a: f64, b: f64) -> f64 {
    match a > 0.0 && b > 0.0 {
        true => (product / (a.sqrt() * b.sqrt())).clamp(-1.0, 1.0),
        false => 0.0,
    }
}
