//! Outliers, drift and ripple, in this order.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::error::{CutError, CutErrorKind, Result};
use crate::measured::cleaning;
use crate::measured::cleaning::{DriftModel, Outlier};
use crate::measured::correlation::Integral;
use crate::measured::log::{CHANNELS, ForceLog};
use crate::measured::report::ConditioningReport;
use crate::number::larger;

/// Share of a channel's rows that may be outliers.
const MOST_OUTLIERS: f64 = 0.01;

/// Outliers that are named; the others are counted.
const MOST_NAMED: usize = 1000;

/// Treatment of outliers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, JsonSchema, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum OutlierTreatment {
    /// Each is replaced by the median of the rows around it.
    #[default]
    Replace,
    /// Outliers are not searched for: for logs in which a peak of a tooth is as narrow as a row or two.
    Keep,
}

/// Conditioning of a log, in this order:
///
/// 1. Outliers (Hampel filter: eleven rows, six scaled median deviations) are replaced by the median of the rows around them.
///    A peak that is narrower than five rows counts as one; where more than one row in a hundred would, nothing is replaced and
///    the log is refused. In fewer than fifty rows none are looked for.
/// 2. Drift is removed: what the log shows in stretches in which the tool is in air, as a straight line through all of them by
///    least squares, or as straight lines from stretch to stretch. With one stretch its mean is removed; without any, nothing.
/// 3. The mean over a window around each row takes the place of its value; at the ends of the log the window shrinks on both
///    sides. What is constant or a straight line is not changed.
///
/// ```
/// use kinetostat_cutting::{Conditioning, DriftModel, ForceLog, LoggedBy, OutlierTreatment};
///
/// // 50 N along x from 1 to 2 s, with the ripple of a tooth that passes every 10 ms, and 3 N of drift in a second.
/// let at: Vec<f64> = (0..3000).map(|i| f64::from(i) * 1e-3).collect();
/// let cut = |t: f64| if (1.0..2.0).contains(&t) { 50.0 + 20.0 * (628.3185 * t).sin() } else { 0.0 };
/// let fx = at.iter().map(|t| cut(*t) + 3.0 * t).collect();
/// let zero = vec![0.0; 3000];
/// let log = ForceLog::new(LoggedBy::Time, at, [fx, zero.clone(), zero], None)?;
/// let done = Conditioning::new(0.01)
///     .with_air(vec![[0.0, 0.9], [2.1, 2.9]])
///     .with_drift(DriftModel::Line)
///     .with_outliers(OutlierTreatment::Replace)
///     .apply(&log)?;
/// let fx = |t: f64| done.log.at(t).unwrap().0[0];
/// assert!((fx(1.5) - 50.0).abs() < 0.1 && fx(0.5).abs() < 1e-6 && fx(2.5).abs() < 1e-6);
/// assert!((done.report.drift.unwrap().at_end[0] - 9.0).abs() < 0.01);
/// # Ok::<(), kinetostat_cutting::CutError>(())
/// ```
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Conditioning {
    outliers: OutlierTreatment,
    air: Vec<[f64; 2]>,
    drift: DriftModel,
    window: f64,
}

/// A log without outliers, drift and ripple, and what was done to it.
#[derive(Clone, Debug)]
pub struct Conditioned {
    /// The log.
    pub log: ForceLog,
    /// Record of the steps.
    pub report: ConditioningReport,
}

impl Conditioning {
    /// Conditioning with a window of the moving mean, s or mm as the log is counted; 0 takes no mean. One revolution of
    /// the spindle takes out the ripple of the teeth whatever their run-out is.
    #[must_use]
    pub fn new(window: f64) -> Self {
        Self {
            window,
            ..Self::default()
        }
    }

    /// Sets stretches in which the tool is in air, from and to, s or mm of the log.
    #[must_use]
    pub fn with_air(self, air: Vec<[f64; 2]>) -> Self {
        Self { air, ..self }
    }

    /// Sets the model of the drift.
    #[must_use]
    pub fn with_drift(self, drift: DriftModel) -> Self {
        Self { drift, ..self }
    }

    /// Sets the treatment of outliers.
    #[must_use]
    pub fn with_outliers(self, outliers: OutlierTreatment) -> Self {
        Self { outliers, ..self }
    }

    /// Does it. Takes a time proportional to the rows.
    ///
    /// # Errors
    /// More than one outlier in a hundred rows of a channel; stretches of air that hold no two rows, end before they begin or
    /// overlap; a window below zero or longer than the log.
    pub fn apply(&self, log: &ForceLog) -> Result<Conditioned> {
        let [from, to] = log.range();
        let refuse = |quantity: &str, found: String, expected: String| {
            let kind = CutErrorKind::Measurement;
            Err(CutError::new(kind, quantity, found, expected))
        };
        let unit = log.by().unit();
        if !(0.0..=to - from).contains(&self.window) {
            let found = format!("{} {unit}", self.window);
            let expected = format!("0 to {} {unit}, the length of the log", to - from);
            return refuse("window of the mean", found, expected);
        }
        let look =
            self.outliers == OutlierTreatment::Replace && log.rows() >= cleaning::FEWEST_ROWS;
        let found = match look {
            true => found_in(log)?,
            false => Vec::new(),
        };
        let mut log = log.clone();
        for outlier in &found {
            let channel = CHANNELS.iter().position(|name| *name == outlier.channel);
            if let Some(values) = channel.and_then(|channel| log.channels.get_mut(channel)) {
                values[outlier.row - 1] = outlier.median;
            }
        }
        let drift = cleaning::remove(&mut log, &self.air, self.drift)?;
        // These figures are those of the log itself: smoothing may add places between its rows.
        let (rows, spacing, longest_step) = (log.rows(), log.spacing(), longest_step(&log.at));
        if self.window > 0.0 {
            let places = places_of_mean(&log.at, self.window);
            for channel in &mut log.channels {
                let values = at_places(&log.at, channel, &places);
                *channel = moving_mean(&places, &values, self.window);
            }
            log.at = places;
        }
        let report = ConditioningReport {
            by: log.by(),
            rows,
            channels: log.channels.len(),
            outlier_count: found.len(),
            worst_outlier: worst(&found),
            outliers: found.into_iter().take(MOST_NAMED).collect(),
            outliers_looked_for: look,
            drift,
            window: self.window,
            spacing,
            longest_step,
        };
        Ok(Conditioned { log, report })
    }
}

/// The outliers of all channels.
fn found_in(log: &ForceLog) -> Result<Vec<Outlier>> {
    let mut all = Vec::new();
    for (name, values) in log.named() {
        let own = cleaning::of_channel(log, name, values);
        let most = larger(1.0, MOST_OUTLIERS * values.len() as f64);
        if own.len() as f64 > most {
            return Err(CutError::new(
                CutErrorKind::Measurement,
                format!("outliers in {name}"),
                format!("{} of {} rows", own.len(), values.len()),
                "one in a hundred at most: so many are peaks of the teeth or a signal that is logged too slowly; log faster, or keep them (outliers = \"keep\")",
            ));
        }
        all.extend(own);
    }
    Ok(all)
}

fn worst(found: &[Outlier]) -> Option<Outlier> {
    let off = |outlier: &Outlier| (outlier.value - outlier.median).abs();
    found
        .iter()
        .reduce(|a, b| if off(b) > off(a) { b } else { a })
        .cloned()
}

/// Start of the longest step from row to row, and its length.
fn longest_step(at: &[f64]) -> [f64; 2] {
    let steps = at.windows(2).map(|pair| [pair[0], pair[1] - pair[0]]);
    steps
        .reduce(|a, b| if b[1] > a[1] { b } else { a })
        .unwrap_or_default()
}

/// The mean over a window around each row, of the signal as straight lines between its rows. Near the ends the window shrinks
/// on both sides until it fits, down to nothing at the first row and the last: what is constant or a straight line stays as it
/// is everywhere.
fn moving_mean(at: &[f64], values: &[f64], window: f64) -> Vec<f64> {
    let (Some(first), Some(last)) = (at.first().copied(), at.last().copied()) else {
        return Vec::new();
    };
    let integral = Integral::of(at, values);
    let mut ends = [0, 0];
    let mut mean = Vec::with_capacity(at.len());
    for (place, value) in at.iter().zip(values) {
        let half = [0.5 * window, place - first, last - place]
            .into_iter()
            .fold(f64::INFINITY, |a, b| if b < a { b } else { a });
        // The ends of the window only move forward, from row to row.
        let mut to = |end: usize, at_end: f64| {
            while ends[end] + 2 < at.len() && at[ends[end] + 1] <= at_end {
                ends[end] += 1;
            }
            integral.to_after(ends[end], at_end)
        };
        let width = 2.0 * half;
        mean.push(match width > 0.0 {
            true => (to(1, place + half) - to(0, place - half)) / width,
            false => *value,
        });
    }
    mean
}

/// The rows, and between rows that are farther apart than half a window the places where the mean bends: half a window from each.
fn places_of_mean(at: &[f64], window: f64) -> Vec<f64> {
    let half = 0.5 * window;
    let mut places = Vec::with_capacity(at.len());
    places.extend(at.first().copied());
    for pair in at.windows(2) {
        let (a, b) = (pair[0], pair[1]);
        let mut between = [a + half, b - half];
        between.sort_by(f64::total_cmp);
        for place in between {
            let last = places.last().copied().unwrap_or(a);
            if b - a > half && place > last && place < b {
                places.push(place);
            }
        }
        places.push(b);
    }
    places
}

/// Values at places, in order, on the straight lines between rows.
fn at_places(at: &[f64], values: &[f64], places: &[f64]) -> Vec<f64> {
    let mut row = 0;
    let value = |place: &f64| {
        while row + 2 < at.len() && at[row + 1] < *place {
            row += 1;
        }
        match (at.get(row + 1), values.get(row + 1)) {
            (Some(to), Some(end)) if to > &at[row] => {
                values[row] + (end - values[row]) * (place - at[row]) / (to - at[row])
            }
            _ => values[row],
        }
    };
    places.iter().map(value).collect()
}
