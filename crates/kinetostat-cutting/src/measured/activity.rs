//! Expected magnitude of a force over time.

use crate::error::{CutError, CutErrorKind, Result};

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
