//! Slices of the objective through the best placement.

use rayon::prelude::*;

use crate::answer::MapPanel;
use crate::space::{Place, Space};
use crate::value::Value;

/// Cells along each axis of a slice, of one that is the only one, and places of a curve.
const CELLS: usize = 25;
const CELLS_OF_ONE: usize = 41;
const OF_CURVE: usize = 101;

/// Maximum number of slices.
const MOST: usize = 3;

/// Slices over pairs of variables, all others as in the best placement.
pub(crate) fn maps(
    space: &Space,
    best: &Place,
    worth: impl Fn(&Place) -> Value + Sync,
) -> Vec<MapPanel> {
    let ranges = space.ranges();
    let values = |k: usize, count: usize| -> Vec<f64> {
        let range = ranges[k];
        let share = |i: usize| i as f64 / (count - 1) as f64;
        let value = |i: usize| range.from + share(i) * (range.to - range.from);
        (0..count).map(value).collect()
    };
    let with = |changes: &[(usize, f64)]| {
        let mut place = best.clone();
        for (k, value) in changes {
            place.values[*k] = *value;
        }
        place
    };
    if ranges.len() == 1 {
        let across = values(0, OF_CURVE);
        let found = across.par_iter().map(|value| worth(&with(&[(0, *value)])));
        return vec![MapPanel {
            variables: vec![ranges[0].variable],
            values: found.collect(),
            across: across.clone(),
            up: Vec::new(),
        }];
    }
    let pairs = (0..ranges.len()).flat_map(|a| (a + 1..ranges.len()).map(move |b| (a, b)));
    let panel = |(a, b): (usize, usize)| {
        let count = match ranges.len() {
            2 => CELLS_OF_ONE,
            _ => CELLS,
        };
        let (across, up) = (values(a, count), values(b, count));
        let cells = (0..count * count).into_par_iter();
        let found = cells
            .map(|i| worth(&with(&[(a, across[i % count]), (b, up[i / count])])))
            .collect();
        MapPanel {
            variables: vec![ranges[a].variable, ranges[b].variable],
            across,
            up,
            values: found,
        }
    };
    pairs.take(MOST).map(panel).collect()
}
