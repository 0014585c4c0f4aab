//! Drift of a dynamometer, which it shows while the tool is in air, and outliers.

use serde::{Deserialize, Serialize};

use crate::error::{CutError, CutErrorKind, Result};
use crate::measured::log::{CHANNELS, ForceLog};
use crate::number::larger;

/// Model of the drift between stretches of air.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
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

/// Rows on each side of the one that is looked at.
pub(crate) const SIDE: usize = 5;
/// Minimum number of rows in which a value can be told from its neighbours.
pub(crate) const FEWEST_ROWS: usize = 50;
/// Spreads from the median.
pub(crate) const SPREADS: f64 = 6.0;
/// Rows whose spreads are taken together.
const BLOCK: usize = 200;
/// Standard deviations of a normal distribution in its median distance from the median.
const OF_NORMAL: f64 = 1.4826;
const NEGLIGIBLE: f64 = 1e-3;

/// A value that no neighbour bears out.
///
/// A value is an outlier if it lies farther from the median of the eleven rows around it (five on each side, fewer at the ends)
/// than six times their spread, 1.4826 times the median distance from that median, which is the standard deviation of noise with a
/// normal distribution. Eleven rows alone give the spread of noise badly: it is taken no smaller than the median spread of any of
/// the three blocks of 200 rows around, and no smaller than a thousandth of the force that 99 of 100 rows keep below, under which
/// nothing matters.
#[derive(Clone, Debug, PartialEq)]
pub struct Outlier {
    /// Row of the log, from 1, the header not counted.
    pub row: usize,
    /// Line in the file, if it was read from one.
    pub line: Option<usize>,
    /// Time (s) or length (mm) of the row.
    pub at: f64,
    /// Column.
    pub channel: &'static str,
    /// Logged value, N or N m.
    pub value: f64,
    /// Median of the rows around it, N or N m.
    pub median: f64,
}

/// The outliers of a channel.
pub(crate) fn of_channel(log: &ForceLog, channel: &'static str, values: &[f64]) -> Vec<Outlier> {
    let floor = NEGLIGIBLE * usual_size(values);
    let spreads = spreads_of_blocks(values);
    let around = |row: usize| {
        let block = row / BLOCK;
        let near = &spreads[block.saturating_sub(1)..spreads.len().min(block + 2)];
        near.iter().copied().fold(floor, larger)
    };
    let mut found = Vec::new();
    each_window(values, |row, window| {
        let (median, spread) = window.median_and_spread();
        let value = values[row];
        if (value - median).abs() > SPREADS * larger(spread, around(row)) {
            found.push(Outlier {
                row: row + 1,
                line: log.line(row),
                at: log.at[row],
                channel,
                value,
                median,
            });
        }
    });
    found
}

/// The size below which 99 of 100 values are.
fn usual_size(values: &[f64]) -> f64 {
    let step = (values.len() / 100_000).max(1);
    let mut sizes: Vec<f64> = values.iter().step_by(step).map(|v| v.abs()).collect();
    let at = sizes.len() * 99 / 100;
    *sizes.select_nth_unstable_by(at, f64::total_cmp).1
}

/// Median spread in each block of rows.
fn spreads_of_blocks(values: &[f64]) -> Vec<f64> {
    let mut medians = Vec::with_capacity(values.len() / BLOCK + 1);
    let mut block = Vec::with_capacity(BLOCK);
    each_window(values, |row, window| {
        block.push(window.median_and_spread().1);
        if block.len() == BLOCK || row + 1 == values.len() {
            let middle = block.len() / 2;
            medians.push(*block.select_nth_unstable_by(middle, f64::total_cmp).1);
            block.clear();
        }
    });
    medians
}

/// The rows around one, in the order of their values.
struct Window {
    sorted: Vec<f64>,
}

impl Window {
    fn place(&self, value: f64) -> usize {
        self.sorted
            .partition_point(|other| other.total_cmp(&value).is_lt())
    }

    fn median_and_spread(&self) -> (f64, f64) {
        let all = &self.sorted;
        let middle = all.len() / 2;
        let median = match all.len() % 2 {
            0 => 0.5 * (all[middle - 1] + all[middle]),
            _ => all[middle],
        };
        // Distances grow to both sides of the median: the next is that on one of them.
        let (mut below, mut above) = (middle, middle);
        let mut distance = 0.0;
        for _ in 0..=middle {
            let down = below.checked_sub(1).map(|i| median - all[i]);
            let up = all.get(above).map(|value| value - median);
            match (down, up) {
                (Some(down), Some(up)) if down < up => {
                    distance = down;
                    below -= 1;
                }
                (_, Some(up)) => {
                    distance = up;
                    above += 1;
                }
                (Some(down), None) => {
                    distance = down;
                    below -= 1;
                }
                (None, None) => {}
            }
        }
        (median, OF_NORMAL * distance)
    }
}

/// Calls `look` with each row and those around it.
fn each_window(values: &[f64], mut look: impl FnMut(usize, &Window)) {
    let mut sorted: Vec<f64> = values.iter().take(SIDE).copied().collect();
    sorted.sort_by(f64::total_cmp);
    let mut window = Window { sorted };
    for row in 0..values.len() {
        if let Some(next) = values.get(row + SIDE) {
            let place = window.place(*next);
            window.sorted.insert(place, *next);
        }
        if let Some(gone) = row.checked_sub(SIDE + 1) {
            let place = window.place(values[gone]);
            window.sorted.remove(place);
        }
        look(row, &window);
    }
}
