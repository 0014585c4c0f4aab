//! Stability along a path: computed in some places, and interpolated in between where it is shown to be a parabola.
//!
//! Stiffness and share to buckling take four times as long as the equilibrium that they are of, and along a smooth way they are smooth. So a
//! stretch of postures, whose places and loads go on a parabola from end to end, is looked at in its ends, its middle and its quarters. The parabola
//! through ends and middle is off most near the quarters: the third-order term goes with `s (1 - s^2)` of the half stretch, 0.375 at a quarter and 0.385
//! at most. Where it meets both quarters ([`EVENLY`]) the rest is taken from it; a corner, as where another direction becomes the softest, cannot
//! meet both. Else both halves are looked at in the same way, with what is known of them already.
//!
//! The digits of a program put its places beside the way that is meant by half of the last one ([`BESIDE`]). What that changes is of first order in
//! so small a distance, and comes from the slopes along x, y and z, found once for a list by three more postures.

use crate::batch::equilibria::{BatchEquilibrium, PostureStability};
use crate::number::{larger, smaller};
use crate::spatial::{Pose, Wrench};

/// Postures of a stretch at first.
const STRETCH: usize = 128;

/// A stretch of fewer steps is computed in every place: the parabola would save nothing.
const FEWEST: usize = 5;

/// Share of a value by which the quarters of a stretch may lie off the parabola through its ends and middle.
const EVENLY: f64 = 3e-8;

/// By how much (rad, or share of the largest load) orientations and loads of a stretch may lie off the parabola through its ends and middle, and
/// places (share of the machine's size) without counting as beside it.
const STRAIGHT: f64 = 1e-8;

/// Share of the machine's size by which places of a stretch may lie beside the parabola through its ends and middle: a ten-thousandth of a
/// millimetre on a machine of a third of a metre, rounded in three axes. The square of it is nothing beside [`EVENLY`], and slopes that change by some
/// hundredths along a list leave a part of that.
const BESIDE: f64 = 1e-6;

/// Between two steps of which the shorter is so much shorter than the way from their corner to the line between their ends, the way is smooth.
const CORNER: f64 = 0.05;

/// Share of the machine's size over which slopes are found: their own change over it is of second order.
const SLOPE: f64 = 1e-4;

/// Beyond this share of the way to buckling every posture is looked at.
const FAR_FROM_BUCKLING: f64 = 0.8;

/// Numbers of a posture's stability: stable, stiffness, share to buckling, as in [`BatchEquilibrium`].
type Numbers = [f64; 3];

/// A posture by its number, and how far it is moved before it is looked at, m, base axes.
pub(crate) type Look = (usize, [f64; 3]);

/// Numbers in which a stretch is to go evenly, in units in which one is all of the machine, of the turn or of the load: place first.
type Inputs = [f64; 13];

/// The way of many postures along all that a stability depends on.
pub(crate) struct Way {
    inputs: Vec<Inputs>,
    /// Its length up to each posture.
    length: Vec<f64>,
    /// Natural length of the machine, m.
    size: f64,
}

impl Way {
    /// Of postures under loads, of a machine of so many metres.
    pub fn of(poses: &[Pose], wrenches: &[Wrench], size: f64) -> Self {
        let inputs = inputs(poses, wrenches, size);
        let mut sum = 0.0;
        let mut length = vec![0.0; inputs.len().min(1)];
        for pair in inputs.windows(2) {
            sum += distance(&pair[0], &pair[1]);
            length.push(sum);
        }
        Self {
            inputs,
            length,
            size,
        }
    }

    /// All postures in stretches that go evenly, where looking at ends, middles and quarters of them would leave out at least a third of the
    /// postures. Each of those costs as much as an equilibrium more, which is found of all of them before.
    pub fn worth_it(&self) -> Option<Vec<[usize; 2]>> {
        let stretches = self.stretches().into_iter();
        let even: Vec<[usize; 2]> = stretches.flat_map(|s| self.even(s)).collect();
        let left_out: usize = even
            .iter()
            .map(|[a, b]| (b - a + 1) - places([*a, *b]).len())
            .sum();
        (3 * left_out >= self.inputs.len()).then_some(even)
    }

    /// The stability of all in these stretches, `look` finding it at some; none where one of those could not be looked at, or is too near to
    /// buckling for anything in between to be told.
    pub fn stabilities(
        &self,
        mut even: Vec<[usize; 2]>,
        mut look: impl FnMut(&[Look]) -> Option<Vec<Numbers>>,
    ) -> Option<Vec<Numbers>> {
        let mut look_safely = |wanted: &[Look]| {
            let found = look(wanted)?;
            let far_from_buckling = found.iter().all(|[stable, _, share]| {
                // Also where it is no number, unless there are no inner motions.
                let far = share.is_nan() || *share < FAR_FROM_BUCKLING;
                *stable >= 1.0 && far
            });
            far_from_buckling.then_some(found)
        };
        let slopes = match even.iter().any(|s| self.has_places_beside(*s)) {
            true => self.slopes(&mut look_safely)?,
            false => [[0.0; 3]; 3],
        };
        let mut known: Vec<Option<Numbers>> = vec![None; self.inputs.len()];
        while !even.is_empty() {
            let wanted = even.iter().flat_map(|s| places(*s));
            let mut wanted: Vec<usize> = wanted.filter(|i| known[*i].is_none()).collect();
            wanted.sort_unstable();
            wanted.dedup();
            if !wanted.is_empty() {
                let looks: Vec<Look> = wanted.iter().map(|i| (*i, [0.0; 3])).collect();
                for (i, numbers) in wanted.iter().zip(look_safely(&looks)?) {
                    known[*i] = Some(numbers);
                }
            }
            let mut halves = Vec::new();
            for [a, b] in even {
                if b - a < FEWEST {
                    continue;
                }
                let m = a.midpoint(b);
                let (Some(first), Some(here), Some(end)) = (known[a], known[m], known[b]) else {
                    return None;
                };
                let at = |i| -> Numbers {
                    let mut numbers = self.parabola([a, m, b], i, [&first, &here, &end]);
                    for (beside, slope) in self.beside([a, m, b], i).iter().zip(&slopes) {
                        for (number, slope) in numbers.iter_mut().zip(slope) {
                            *number += beside * slope;
                        }
                    }
                    numbers
                };
                let met = [a.midpoint(m), m.midpoint(b)]
                    .iter()
                    .all(|i| known[*i].is_some_and(|found| agrees(&at(*i), &found)));
                if !met {
                    halves.extend([[a, m], [m, b]]);
                    continue;
                }
                for i in a + 1..b {
                    if known[i].is_none() {
                        known[i] = Some(at(i));
                    }
                }
            }
            even = halves.into_iter().flat_map(|s| self.even(s)).collect();
        }
        known.into_iter().collect()
    }

    /// By how much the numbers change per machine's size along x, y and z, in the middle of the list.
    fn slopes(
        &self,
        look: &mut impl FnMut(&[Look]) -> Option<Vec<Numbers>>,
    ) -> Option<[Numbers; 3]> {
        let middle = self.inputs.len() / 2;
        let by = SLOPE * self.size;
        let moved = [[0.0; 3], [by, 0.0, 0.0], [0.0, by, 0.0], [0.0, 0.0, by]];
        let found = look(&moved.map(|shift| (middle, shift)))?;
        let (here, moved) = found.split_first()?;
        let slope =
            |there: &Numbers| -> Numbers { std::array::from_fn(|k| (there[k] - here[k]) / SLOPE) };
        let slopes: Vec<Numbers> = moved.iter().map(slope).collect();
        slopes.try_into().ok()
    }

    /// Where a posture is between two others, 0 to 1.
    fn share(&self, [a, i, b]: [usize; 3]) -> f64 {
        let whole = self.length[b] - self.length[a];
        match whole > 0.0 {
            true => (self.length[i] - self.length[a]) / whole,
            false => 0.0,
        }
    }

    /// All postures in stretches that end at corners and are of at most [`STRETCH`] steps.
    fn stretches(&self) -> Vec<[usize; 2]> {
        let Some(last) = self.inputs.len().checked_sub(1) else {
            return Vec::new();
        };
        let corners = (1..last).filter(|i| self.is_corner(*i));
        let mut stretches = Vec::new();
        let mut from = 0;
        for to in corners.chain([last]) {
            let (steps, first) = (to - from, from);
            let pieces = steps.div_ceil(STRETCH).max(1);
            let at = |k: usize| first + k * steps / pieces;
            stretches.extend((0..pieces).map(|k| [at(k), at(k + 1)]));
            from = to;
        }
        stretches
    }

    /// Whether the way has another direction behind a posture than before it.
    fn is_corner(&self, i: usize) -> bool {
        let (before, behind) = (i - 1, i + 1);
        let share = self.share([before, i, behind]);
        let ends = self.inputs[before].iter().zip(&self.inputs[behind]);
        let between: Vec<f64> = ends.map(|(from, to)| from + (to - from) * share).collect();
        let off = self.inputs[i]
            .iter()
            .zip(&between)
            .map(|(x, on)| (x - on) * (x - on));
        let off = off.sum::<f64>().sqrt();
        let [one, other] = [i, behind].map(|k| self.length[k] - self.length[k - 1]);
        let most = larger(BESIDE, CORNER * smaller(one, other));
        off.is_nan() || off > most
    }

    /// How far the place of a posture is from the parabola through three others.
    fn beside(&self, through: [usize; 3], i: usize) -> [f64; 3] {
        let on = self.parabola(through, i, through.map(|k| &self.inputs[k]));
        std::array::from_fn(|k| self.inputs[i][k] - on[k])
    }

    fn has_places_beside(&self, [a, b]: [usize; 2]) -> bool {
        let through = [a, a.midpoint(b), b];
        (a + 1..b).any(|i| {
            self.beside(through, i)
                .iter()
                .any(|off| off.abs() > STRAIGHT)
        })
    }

    /// A stretch, or the parts of it in which everything goes evenly.
    fn even(&self, [a, b]: [usize; 2]) -> Vec<[usize; 2]> {
        let middle = a.midpoint(b);
        let through = [a, middle, b];
        let off = |i: usize| {
            let on = self.parabola(through, i, through.map(|k| &self.inputs[k]));
            let mut all = self.inputs[i].iter().zip(&on).enumerate();
            // Also where one of them is no number.
            all.any(|(k, (x, on))| {
                let off = (x - on).abs();
                off.is_nan() || off > if k < 3 { BESIDE } else { STRAIGHT }
            })
        };
        if b - a <= 1 || !(a + 1..b).any(off) {
            return vec![[a, b]];
        }
        let mut parts = self.even([a, middle]);
        parts.extend(self.even([middle, b]));
        parts
    }

    /// What the parabola through three known ones is at another. The middle one stands where its index is, in the length of the way.
    fn parabola<const N: usize>(
        &self,
        [a, m, b]: [usize; 3],
        i: usize,
        of: [&[f64; N]; 3],
    ) -> [f64; N] {
        let (x, y) = (self.share([a, i, b]), self.share([a, m, b]));
        // A tool that rests has the same numbers everywhere.
        let bow = match y > 0.0 && y < 1.0 {
            true => (x * (1.0 - x)) / (y * (1.0 - y)),
            false => 0.0,
        };
        std::array::from_fn(|k| {
            let [first, middle, end] = of.map(|numbers| numbers[k]);
            let straight = first + (end - first) * x;
            straight + (middle - (first + (end - first) * y)) * bow
        })
    }
}

fn distance(a: &Inputs, b: &Inputs) -> f64 {
    let squares = a.iter().zip(b).map(|(a, b)| (a - b) * (a - b));
    squares.sum::<f64>().sqrt()
}

/// See [`Way`].
fn inputs(poses: &[Pose], wrenches: &[Wrench], size: f64) -> Vec<Inputs> {
    let of = |w: &Wrench| [w.force().norm(), w.moment().norm() / size];
    let most = wrenches.iter().flat_map(of).fold(f64::MIN_POSITIVE, larger);
    let both = poses.iter().zip(wrenches);
    let all = both.map(|(pose, wrench)| {
        let (at, turn) = (pose.translation.vector / size, pose.rotation.coords);
        let (force, moment) = (wrench.force() / most, wrench.moment() / (most * size));
        let numbers = at.iter().chain(turn.iter());
        let mut numbers = numbers.chain(force.iter()).chain(moment.iter());
        std::array::from_fn(|_| numbers.next().copied().unwrap_or(0.0))
    });
    all.collect()
}

/// Where a stretch is looked at: everywhere if it is short, else at ends, middle and quarters.
fn places([a, b]: [usize; 2]) -> Vec<usize> {
    let m = a.midpoint(b);
    match b - a < FEWEST {
        true => (a..=b).collect(),
        false => vec![a, a.midpoint(m), m, m.midpoint(b), b],
    }
}

/// Whether two of them are the same but for [`EVENLY`].
fn agrees(expected: &Numbers, found: &Numbers) -> bool {
    let near = |a: f64, b: f64, least: f64| (a - b).abs() <= EVENLY * b.abs().max(least);
    let share = match (expected[2].is_nan(), found[2].is_nan()) {
        (true, true) => true,
        // Far from buckling the hundredth of it is as good as any.
        _ => near(expected[2], found[2], 0.01),
    };
    near(expected[1], found[1], 0.0) && share
}

/// The numbers of one posture, as they stand in a result.
pub(crate) fn numbers(found: &BatchEquilibrium, posture: usize) -> Option<Numbers> {
    let PostureStability {
        stable,
        stiffness_against_force,
        share_to_buckling,
    } = found.stability(posture)?;
    Some([
        f64::from(u8::from(stable)),
        stiffness_against_force,
        share_to_buckling.unwrap_or(f64::NAN),
    ])
}
