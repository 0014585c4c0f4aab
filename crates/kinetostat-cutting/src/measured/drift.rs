//! Drift of a dynamometer: what it shows while the tool is in air.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::error::{CutError, CutErrorKind, Result};
use crate::measured::log::{CHANNELS, ForceLog};
use crate::number::larger;

/// Model of the drift between stretches of air.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, JsonSchema, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum DriftModel {
    /// One straight line through all rows in air, by least squares.
    #[default]
    Line,
    /// Straight lines through the mean of each stretch; before the first and behind the last they go on.
    Piecewise,
}

/// The drift that was removed.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct DriftRemoved {
    /// Stretches of air that it was taken from.
    pub stretches: usize,
    /// Drift of each channel at the first row of the log, N and N m.
    pub at_start: Vec<f64>,
    /// Drift at the last row.
    pub at_end: Vec<f64>,
    /// Largest mean of a stretch that is left, of the forces, N.
    pub left_n: f64,
}

/// Rows of a stretch, from the first to behind the last.
type Rows = std::ops::Range<usize>;

/// A course of straight lines between places.
struct Course(Vec<[f64; 2]>);

impl Course {
    fn at(&self, at: f64) -> f64 {
        let points = &self.0;
        let after = points.partition_point(|[place, _]| *place <= at);
        match points.as_slice() {
            [] => 0.0,
            [[_, value]] => *value,
            _ => {
                let i = after.clamp(1, points.len() - 1);
                let ([a, x], [b, y]) = (points[i - 1], points[i]);
                x + (y - x) * (at - a) / (b - a)
            }
        }
    }
}

/// Removes what the log shows in air; `None` without stretches of air.
pub(crate) fn remove(
    log: &mut ForceLog,
    air: &[[f64; 2]],
    model: DriftModel,
) -> Result<Option<DriftRemoved>> {
    if air.is_empty() {
        return Ok(None);
    }
    let stretches = rows_of(log, air)?;
    let mut removed = DriftRemoved {
        stretches: stretches.len(),
        ..DriftRemoved::default()
    };
    let [first, last] = log.range();
    let ForceLog { at, channels, .. } = log;
    for (channel, name) in channels.iter_mut().zip(CHANNELS) {
        let means: Vec<[f64; 2]> = stretches
            .iter()
            .map(|rows| [mean(&at[rows.clone()]), mean(&channel[rows.clone()])])
            .collect();
        let course = Course(match (model, means.len()) {
            (DriftModel::Line, 2..) => line(at, channel, &stretches),
            _ => means.clone(),
        });
        for (place, value) in at.iter().zip(channel.iter_mut()) {
            *value -= course.at(*place);
        }
        removed.at_start.push(course.at(first));
        removed.at_end.push(course.at(last));
        if name.starts_with('f') {
            for rows in &stretches {
                removed.left_n = larger(removed.left_n, mean(&channel[rows.clone()]).abs());
            }
        }
    }
    Ok(Some(removed))
}

/// The rows of each stretch, in the order of the log.
fn rows_of(log: &ForceLog, air: &[[f64; 2]]) -> Result<Vec<Rows>> {
    let unit = log.by().unit();
    let refuse = |[from, to]: [f64; 2], expected: &str| {
        let found = format!("{from} to {to} {unit}");
        let kind = CutErrorKind::Measurement;
        Err(CutError::new(kind, "stretch in air", found, expected))
    };
    let mut sorted = air.to_vec();
    sorted.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let mut rows: Vec<Rows> = Vec::with_capacity(sorted.len());
    for stretch in sorted {
        let [from, to] = stretch;
        let known = from.is_finite() && to.is_finite();
        if !known || to <= from {
            return refuse(stretch, "an end behind the beginning");
        }
        let own = log.at.partition_point(|at| *at < from)..log.at.partition_point(|at| *at <= to);
        if own.len() < 2 {
            let [first, last] = log.range();
            let expected =
                format!("two rows in it at least; the log goes from {first} to {last} {unit}");
            return refuse(stretch, &expected);
        }
        if rows.last().is_some_and(|before| own.start < before.end) {
            return refuse(stretch, "stretches that do not overlap");
        }
        rows.push(own);
    }
    Ok(rows)
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// The line of least squares through the rows of all stretches: two points of it.
fn line(at: &[f64], values: &[f64], stretches: &[Rows]) -> Vec<[f64; 2]> {
    let all = || stretches.iter().flat_map(Clone::clone);
    let count = all().count() as f64;
    let middle = all().map(|i| at[i]).sum::<f64>() / count;
    let level = all().map(|i| values[i]).sum::<f64>() / count;
    let (mut square, mut product) = (0.0, 0.0);
    for i in all() {
        square += (at[i] - middle) * (at[i] - middle);
        product += (at[i] - middle) * (values[i] - level);
    }
    vec![[middle, level], [middle + 1.0, level + product / square]]
}
