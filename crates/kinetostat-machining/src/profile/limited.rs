//! Values along the path that change no faster than they may.
//!
//! A value that counts (the tool cuts there) is kept wherever the values around it can be reached at the rate that is allowed:
//! the change goes into the air before and after, where it does not matter what the value is. Where two values that count are
//! too close to each other, the profile goes midway between the highest and the lowest that they ask for.

use crate::number::{larger, smaller};
use crate::profile::by_move::between;

/// A value at a place of the path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Place<const N: usize> {
    pub move_index: usize,
    /// Share of the move.
    pub share: f64,
    /// Way along the path, mm; grows from place to place.
    pub at_mm: f64,
    pub value: [f64; N],
    /// Whether the value counts, or may be another.
    pub counts: bool,
}

/// How a profile begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Begins {
    /// With any value.
    Anyhow,
    /// With nothing, whatever is asked for: the tool comes out of a rapid.
    WithNothing,
}

/// Parts into which a change is divided.
const PARTS: f64 = 16.0;

/// Places with the values that change by at most `rate` per mm, component by component, and the length (mm) of the longest change
/// that is felt there; `None` where the places themselves do.
pub(crate) fn limited<const N: usize>(
    places: &[Place<N>],
    rate: &[f64; N],
    begins: Begins,
) -> Option<Vec<(Place<N>, [f64; N], f64)>> {
    let reach = reach(places, rate, begins)?;
    let (places, lengths) = refined(places, &reach);
    let mut low: Vec<[f64; N]> = places.iter().map(|p| bound(p, f64::NEG_INFINITY)).collect();
    let mut high: Vec<[f64; N]> = places.iter().map(|p| bound(p, f64::INFINITY)).collect();
    let mut pass = |from: usize, to: usize| {
        let way = (places[to].at_mm - places[from].at_mm).abs();
        for k in 0..N {
            low[to][k] = larger(low[to][k], low[from][k] - rate[k] * way);
            high[to][k] = smaller(high[to][k], high[from][k] + rate[k] * way);
        }
    };
    (1..places.len()).for_each(|i| pass(i - 1, i));
    (1..places.len()).rev().for_each(|i| pass(i, i - 1));
    let start = places.first().map_or(0.0, |p| p.at_mm);
    let steepest = at_the_start(&places, rate);
    let values = low.iter().zip(&high).zip(&places);
    let values: Vec<[f64; N]> = values
        .map(|((low, high), place)| {
            std::array::from_fn(|k| {
                let value = match low[k] > high[k] {
                    true => 0.5 * (low[k] + high[k]),
                    false => within(place.value[k], low[k], high[k]),
                };
                match begins {
                    Begins::Anyhow => value,
                    Begins::WithNothing => {
                        let most = steepest[k] * (place.at_mm - start);
                        within(value, -most, most)
                    }
                }
            })
        })
        .collect();
    let both = places.into_iter().zip(values).zip(lengths);
    Some(
        both.map(|((p, value), length)| (p, value, length))
            .collect(),
    )
}

/// The nearest value within bounds.
fn within(value: f64, low: f64, high: f64) -> f64 {
    smaller(larger(value, low), high)
}

fn bound<const N: usize>(place: &Place<N>, none: f64) -> [f64; N] {
    match place.counts {
        true => place.value,
        false => [none; N],
    }
}

/// The rate at the start: at least so large that every value is reached on the first half of the path.
fn at_the_start<const N: usize>(places: &[Place<N>], rate: &[f64; N]) -> [f64; N] {
    let length = match (places.first(), places.last()) {
        (Some(first), Some(last)) => last.at_mm - first.at_mm,
        _ => 0.0,
    };
    std::array::from_fn(|k| {
        let sizes = places.iter().map(|p| p.value[k].abs());
        let size = sizes.fold(0.0, larger);
        match size > 0.0 && length > 0.0 {
            true => larger(rate[k], 2.0 * size / length),
            false => rate[k],
        }
    })
}

/// Length over which a change between two values goes at the rate that is allowed, mm.
fn length_of<const N: usize>(from: &[f64; N], to: &[f64; N], rate: &[f64; N]) -> f64 {
    let lengths = (0..N)
        .filter(|k| to[*k] != from[*k])
        .map(|k| (to[k] - from[k]).abs() / rate[k]);
    lengths.fold(0.0, larger)
}

/// A change that is felt at a place: how far it still reaches, and over which length it goes, mm.
#[derive(Clone, Copy, Default)]
struct Reach {
    left_mm: f64,
    length_mm: f64,
}

impl Reach {
    /// Length of the change, where it still reaches.
    fn felt(self) -> f64 {
        match self.left_mm > 0.0 {
            true => self.length_mm,
            false => 0.0,
        }
    }

    fn further(self, by_mm: f64) -> Self {
        Self {
            left_mm: self.left_mm - by_mm,
            ..self
        }
    }

    fn or(self, other: Self) -> Self {
        match other.left_mm > self.left_mm {
            true => other,
            false => self,
        }
    }
}

/// How far changes that are too fast reach, at every place forwards and backwards; `None` without such changes.
fn reach<const N: usize>(
    places: &[Place<N>],
    rate: &[f64; N],
    begins: Begins,
) -> Option<Vec<[Reach; 2]>> {
    let mut reach = vec![[Reach::default(); 2]; places.len()];
    let mut found = false;
    if let (Begins::WithNothing, Some(first)) = (begins, places.first()) {
        let length_mm = length_of(&[0.0; N], &first.value, rate);
        found = length_mm > 0.0;
        reach[0][0] = Reach {
            left_mm: length_mm,
            length_mm,
        };
    }
    for (i, pair) in places.windows(2).enumerate() {
        let way = pair[1].at_mm - pair[0].at_mm;
        let length_mm = length_of(&pair[0].value, &pair[1].value, rate);
        if length_mm > way {
            found = true;
            let own = Reach {
                left_mm: length_mm,
                length_mm,
            };
            reach[i][1] = reach[i][1].or(own);
            reach[i + 1][0] = reach[i + 1][0].or(own);
        }
    }
    if !found {
        return None;
    }
    for i in 1..places.len() {
        let way = places[i].at_mm - places[i - 1].at_mm;
        reach[i][0] = reach[i][0].or(reach[i - 1][0].further(way));
    }
    for i in (1..places.len()).rev() {
        let way = places[i].at_mm - places[i - 1].at_mm;
        reach[i - 1][1] = reach[i - 1][1].or(reach[i][1].further(way));
    }
    Some(reach)
}

/// The places, with more of them where changes that are too fast reach, and the length of the longest that is felt at each.
fn refined<const N: usize>(places: &[Place<N>], reach: &[[Reach; 2]]) -> (Vec<Place<N>>, Vec<f64>) {
    let felt_at = |reach: &[Reach; 2]| larger(reach[0].felt(), reach[1].felt());
    let mut fine = Vec::with_capacity(2 * places.len());
    let mut lengths = Vec::with_capacity(2 * places.len());
    fine.extend(places.first().copied());
    lengths.extend(reach.first().map(felt_at));
    for (pair, felt) in places.windows(2).zip(reach.windows(2)) {
        let (a, b) = (&pair[0], &pair[1]);
        let way = b.at_mm - a.at_mm;
        let mut parts: Vec<f64> = Vec::new();
        let sides = [(felt[0][0], false), (felt[1][1], true)];
        for (reach, backwards) in sides.into_iter().filter(|(r, _)| r.left_mm > 0.0) {
            let zone = smaller(reach.left_mm, way);
            let step = reach.length_mm / PARTS;
            let count = (zone / step).ceil().clamp(1.0, PARTS) as usize;
            for i in 1..=count {
                let part = zone * i as f64 / count as f64 / way;
                parts.push(if backwards { 1.0 - part } else { part });
            }
        }
        parts.retain(|part| *part > 1e-9 && *part < 1.0 - 1e-9);
        parts.sort_by(f64::total_cmp);
        parts.dedup_by(|b, a| *b - *a < 1e-9);
        // The places of one move, and the seam between two, are in order.
        let share = |part: f64| match a.move_index == b.move_index {
            true => a.share + part * (b.share - a.share),
            false => b.share,
        };
        fine.extend(parts.iter().map(|&part| Place {
            move_index: b.move_index,
            share: share(part),
            at_mm: a.at_mm + part * way,
            value: between(&a.value, &b.value, part),
            counts: a.counts && b.counts,
        }));
        let between = larger(felt[0][0].felt(), felt[1][1].felt());
        lengths.resize(fine.len(), between);
        fine.push(*b);
        lengths.push(felt_at(&felt[1]));
    }
    (fine, lengths)
}
