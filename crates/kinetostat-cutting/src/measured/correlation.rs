//! The correlation of a measured course with an expected one, at any shift between them.

use crate::error::{CutError, CutErrorKind, Result};

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

/// Integrals of a signal and of itself times the time, from its first row on. Two rows may have one time: the signal jumps.
#[derive(Clone, Debug)]
pub(crate) struct Integral<'a> {
    at: &'a [f64],
    values: &'a [f64],
    /// Integral up to each row.
    sum: Vec<f64>,
    /// Integral of the signal times the time since the first row, up to each row; empty if not requested.
    first_moment: Vec<f64>,
}

impl<'a> Integral<'a> {
    /// Integrates a signal.
    pub fn of(at: &'a [f64], values: &'a [f64]) -> Self {
        let mut sum = Vec::with_capacity(at.len());
        let mut total = 0.0;
        for i in 0..at.len() {
            if i > 0 {
                total += 0.5 * (values[i - 1] + values[i]) * (at[i] - at[i - 1]);
            }
            sum.push(total);
        }
        let first_moment = Vec::new();
        Self {
            at,
            values,
            sum,
            first_moment,
        }
    }

    /// Integrates a signal, and its product with the time.
    pub fn with_first_moment(at: &'a [f64], values: &'a [f64]) -> Self {
        let mut own = Self::of(at, values);
        let mut total = 0.0;
        for i in 0..at.len() {
            if i > 0 {
                total += own.first_moment_in(i, at[i]);
            }
            own.first_moment.push(total);
        }
        own
    }

    /// Row after which a time lies, so that there is a next one; the times are those of at least two rows.
    fn before(&self, at: f64) -> usize {
        let after = self.at.partition_point(|place| *place <= at);
        after.clamp(1, self.at.len() - 1) - 1
    }

    fn value_in(&self, i: usize, at: f64) -> f64 {
        let (a, b) = (self.at[i - 1], self.at[i]);
        match b > a {
            true => self.values[i - 1] + (self.values[i] - self.values[i - 1]) * (at - a) / (b - a),
            false => self.values[i],
        }
    }

    /// Integral from row `i - 1` to a time before row `i`, of the signal times the time since the first row.
    fn first_moment_in(&self, i: usize, at: f64) -> f64 {
        let (a, b) = (self.at[i - 1] - self.at[0], at - self.at[0]);
        let (x, y) = (self.values[i - 1], self.value_in(i, at));
        (b - a) * (a * (2.0 * x + y) + b * (x + 2.0 * y)) / 6.0
    }

    /// The integral up to a time; beyond the ends the signal is zero.
    pub fn to(&self, at: f64) -> f64 {
        let at = at.clamp(self.at[0], self.at[self.at.len() - 1]);
        self.to_after(self.before(at), at)
    }

    /// The integral up to a time between row `before` and the next.
    pub fn to_after(&self, before: usize, at: f64) -> f64 {
        let from = self.at[before];
        let value = self.value_in(before + 1, at);
        self.sum[before] + 0.5 * (self.values[before] + value) * (at - from)
    }

    /// The integral of the signal times the time since its first row, up to a time.
    pub fn first_moment_to(&self, at: f64) -> f64 {
        let at = at.clamp(self.at[0], self.at[self.at.len() - 1]);
        let before = self.before(at);
        self.first_moment[before] + self.first_moment_in(before + 1, at)
    }
}

/// The integral of the square of a signal that is straight between its rows.
pub(crate) fn of_square(at: &[f64], values: &[f64]) -> f64 {
    let pieces = at.windows(2).zip(values.windows(2));
    pieces
        .map(|(t, v)| (t[1] - t[0]) * (v[0] * v[0] + v[0] * v[1] + v[1] * v[1]) / 3.0)
        .sum()
}

/// An expected course: straight between points, zero before the first and behind the last; two points at one time are a jump.
/// Only its shape counts, not its size.
///
/// ```
/// use kinetostat_cutting::Activity;
///
/// // A cut of two seconds, a rapid of one, a cut of three.
/// let expected = Activity::new(vec![[0.0, 1.0], [2.0, 1.0], [2.0, 0.0], [3.0, 0.0], [3.0, 1.0], [6.0, 1.0]])?;
/// assert_eq!(expected.range(), [0.0, 6.0]);
/// # Ok::<(), kinetostat_cutting::CutError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Activity {
    pub(crate) at: Vec<f64>,
    pub(crate) values: Vec<f64>,
}

impl Activity {
    /// Through points of time (s) and expected size.
    ///
    /// # Errors
    /// Fewer than two points, no time between first and last, times that go back, what is no number.
    pub fn new(points: Vec<[f64; 2]>) -> Result<Self> {
        let wrong = |found: String| {
            let expected = "two points at least, in the order of time, with finite numbers";
            Err(CutError::new(
                CutErrorKind::Measurement,
                "expected course",
                found,
                expected,
            ))
        };
        if let Some(pair) = points.windows(2).find(|pair| pair[1][0] < pair[0][0]) {
            return wrong(format!("{} s after {} s", pair[1][0], pair[0][0]));
        }
        if let Some(point) = points.iter().find(|p| !p.iter().all(|x| x.is_finite())) {
            return wrong(format!("{point:?}"));
        }
        let (at, values): (Vec<f64>, Vec<f64>) = points.into_iter().map(|[t, v]| (t, v)).unzip();
        match at.first() < at.last() {
            true => Ok(Self { at, values }),
            false => wrong(format!("{} points of one time", at.len())),
        }
    }

    /// Time of the first point and of the last, s.
    #[must_use]
    pub fn range(&self) -> [f64; 2] {
        match self.at.as_slice() {
            [first, .., last] => [*first, *last],
            _ => [0.0; 2],
        }
    }

    /// Points of it between two times, with zeros where it has none, as times and values.
    pub(crate) fn between(&self, from: f64, to: f64) -> (Vec<f64>, Vec<f64>) {
        let first = self.range()[0].clamp(from, to);
        let mut points = vec![[from, 0.0], [first, 0.0]];
        for (t, v) in self.at.windows(2).zip(self.values.windows(2)) {
            let (a, b) = (t[0].clamp(from, to), t[1].clamp(from, to));
            let value = |x: f64| v[0] + (v[1] - v[0]) * (x - t[0]) / (t[1] - t[0]);
            if b > a {
                points.extend([[a, value(a)], [b, value(b)]]);
            }
        }
        let last = points[points.len() - 1][0];
        points.extend([[last, 0.0], [to, 0.0]]);
        points.into_iter().map(|[t, v]| (t, v)).unzip()
    }
}
