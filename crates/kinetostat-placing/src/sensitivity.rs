//! Sensitivity of the figure around the best placement.

use rayon::prelude::*;

use crate::answer::Evaluated;
use crate::answer::{Sensitivity, SideSensitivity};
use crate::space::{Place, Space};
use crate::value::Value;

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
