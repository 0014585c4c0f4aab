//! Sensitivity of the figure around the best placement, and slices of the objective through it.

use rayon::prelude::*;

use crate::placing::answer::{Evaluated, MapPanel, Sensitivity, SideSensitivity};
use crate::placing::space::{Place, Space};
use crate::placing::value::Value;

/// The figure may become larger by this share.
const WORSE: f64 = 0.05;

/// Share of a range over which a slope is taken.
const CLOSE: f64 = 0.005;

/// Steps towards the end of a range in which a refusal or a larger figure is looked for, and halvings of the one that has it.
const STEPS: usize = 24;
const HALVINGS: usize = 8;

pub(crate) fn sensitivity(
    space: &Space,
    best: &Evaluated,
    worth: impl Fn(&Place) -> Value + Sync,
) -> Vec<Sensitivity> {
    let variables: Vec<usize> = (0..space.ranges().len()).collect();
    let one = |k: &usize| Sensitivity {
        variable: space.ranges()[*k].variable,
        down: side(space, best, *k, -1.0, &worth),
        up: side(space, best, *k, 1.0, &worth),
    };
    variables.par_iter().map(one).collect()
}

fn side(
    space: &Space,
    best: &Evaluated,
    k: usize,
    sign: f64,
    worth: impl Fn(&Place) -> Value + Sync,
) -> SideSensitivity {
    let range = space.ranges()[k];
    let (best, value) = (&best.place, &best.value);
    let figure = value.figure().unwrap_or(f64::NAN);
    let room = match sign > 0.0 {
        true => range.to - best.values[k],
        false => best.values[k] - range.from,
    };
    let at = |way: f64| {
        let mut place = best.clone();
        place.values[k] = (place.values[k] + sign * way).clamp(range.from, range.to);
        worth(&place).figure()
    };
    let way = (CLOSE * (range.to - range.from)).min(room);
    let slope = (way > 0.0)
        .then(|| at(way))
        .flatten()
        .map(|there| sign * (there - figure) / way);
    let is_worse = |way: f64| at(way).is_none_or(|there| there > (1.0 + WORSE) * figure);
    let step = |i: usize| room * i as f64 / STEPS as f64;
    let first = (1..=STEPS).find(|i| room > 0.0 && is_worse(step(*i)));
    let until = first.map(|i| {
        let (mut fine, mut worse) = (step(i - 1), step(i));
        for _ in 0..HALVINGS {
            let middle = (fine + worse) / 2.0;
            match is_worse(middle) {
                true => worse = middle,
                false => fine = middle,
            }
        }
        fine
    });
    SideSensitivity {
        slope,
        until_5_percent_worse: until,
    }
}

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
