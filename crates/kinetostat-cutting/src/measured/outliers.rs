//! Outliers by the Hampel filter.
//!
//! A value is an outlier if it lies farther from the median of the eleven rows around it (five on each side, fewer at the ends)
//! than six times their spread, 1.4826 times the median distance from that median, which is the standard deviation of noise with a
//! normal distribution. Eleven rows alone give the spread of noise badly: it is taken no smaller than the median spread of any of
//! the three blocks of 200 rows around, and no smaller than a thousandth of the force that 99 of 100 rows keep below, under which
//! nothing matters.

use crate::measured::log::ForceLog;
use crate::number::larger;

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
