//! Integrals of a signal that is straight between its rows.

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
