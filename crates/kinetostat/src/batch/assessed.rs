//! Stability along a path: computed in some places, and interpolated in between where it is shown to be a parabola.
//!
//! Stiffness and share to buckling take four times as long as the equilibrium that they are of, and along a straight line they are smooth. So a
//! stretch of postures, whose places and loads go evenly from end to end, is looked at in its ends, its middle and its quarters. The parabola
//! through ends and middle is off most near the quarters: the third-order term goes with `s (1 - s^2)` of the half stretch, 0.375 at a quarter and 0.385
//! at most. Where it meets both quarters ([`EVENLY`]) the rest is taken from it; a corner, as where another direction becomes the softest, cannot
//! meet both. Else both halves are looked at in the same way, with what is known of them already.

use crate::batch::equilibria::{BatchEquilibrium, PostureStability};
use crate::number::larger;
use crate::spatial::{Pose, Wrench};

/// Postures of a stretch at first.
const STRETCH: usize = 40;

/// A stretch of fewer steps is computed in every place: the parabola would save nothing.
const FEWEST: usize = 5;

/// Share of a value by which the quarters of a stretch may lie off the parabola through its ends and middle.
const EVENLY: f64 = 3e-8;

/// Share of the machine's size (rad, or of the largest load) by which places (orientations, loads) of a stretch may lie off what is between its ends.
const STRAIGHT: f64 = 1e-8;

/// Share of the way to buckling beyond which every posture is computed.
const FAR_FROM_BUCKLING: f64 = 0.8;

/// Numbers of a posture's stability: stable, stiffness, share to buckling, as in [`BatchEquilibrium`].
type Numbers = [f64; 3];

/// The way of many postures along all that a stability depends on.
pub(crate) struct Way {
    /// Numbers in which a stretch is to go evenly, in units in which one is all of the machine, of the turn or of the load.
    inputs: Vec<[f64; 13]>,
    /// Length of the path up to each posture.
    length: Vec<f64>,
}

impl Way {
    /// Path of postures under loads, of a machine of so many metres.
    pub fn of(poses: &[Pose], wrenches: &[Wrench], size: f64) -> Self {
        let inputs = inputs(poses, wrenches, size);
        let mut sum = 0.0;
        let mut length = vec![0.0; inputs.len().min(1)];
        for pair in inputs.windows(2) {
            let step = pair[0].iter().zip(&pair[1]).map(|(a, b)| (a - b) * (a - b));
            sum += step.sum::<f64>().sqrt();
            length.push(sum);
        }
        Self { inputs, length }
    }

    /// Looking at ends, middles and quarters of its stretches would leave out at least a third of the postures. Each of those costs
    /// as much as an equilibrium more, which is found of all of them before.
    pub fn could_save(&self) -> bool {
        let straight = self.stretches().into_iter().flat_map(|s| self.straight(s));
        let left_out: usize = straight
            .map(|[a, b]| (b - a + 1) - places([a, b]).len())
            .sum();
        3 * left_out >= self.inputs.len()
    }

    /// The stability of all, `look` finding it at some; none where one of those could not be looked at, or is too near to buckling for
    /// anything in between to be told.
    pub fn stabilities(
        &self,
        mut look: impl FnMut(&[usize]) -> Option<Vec<Numbers>>,
    ) -> Option<Vec<Numbers>> {
        let count = self.inputs.len();
        let mut known: Vec<Option<Numbers>> = vec![None; count];
        let mut open = self.stretches();
        while !open.is_empty() {
            let straight = std::mem::take(&mut open);
            let straight: Vec<_> = straight
                .into_iter()
                .flat_map(|s| self.straight(s))
                .collect();
            let wanted = straight.iter().flat_map(|s| places(*s));
            let mut wanted: Vec<usize> = wanted.filter(|i| known[*i].is_none()).collect();
            wanted.sort_unstable();
            wanted.dedup();
            if !wanted.is_empty() {
                for (i, numbers) in wanted.iter().zip(look(&wanted)?) {
                    let [stable, _, share] = numbers;
                    // Also where it is no number, unless there are no inner motions.
                    let far = share.is_nan() || share < FAR_FROM_BUCKLING;
                    if stable < 1.0 || !far {
                        return None;
                    }
                    known[*i] = Some(numbers);
                }
            }
            for [a, b] in straight {
                if b - a < FEWEST {
                    continue;
                }
                let m = a.midpoint(b);
                let (Some(first), Some(here), Some(end)) = (known[a], known[m], known[b]) else {
                    return None;
                };
                let at = |i| self.parabola([a, m, b], i, [&first, &here, &end]);
                let met = [a.midpoint(m), m.midpoint(b)]
                    .iter()
                    .all(|i| known[*i].is_some_and(|found| agrees(&at(*i), &found)));
                if !met {
                    open.extend([[a, m], [m, b]]);
                    continue;
                }
                for i in a + 1..b {
                    if known[i].is_none() {
                        known[i] = Some(at(i));
                    }
                }
            }
        }
        known.into_iter().collect()
    }

    /// Position of a posture between two others, 0 to 1.
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
        let corners = (1..last).filter(|i| self.straight([i - 1, i + 1]).len() > 1);
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

    /// A stretch, or the parts of it in which everything goes evenly.
    fn straight(&self, [a, b]: [usize; 2]) -> Vec<[usize; 2]> {
        let off = |i: usize| {
            let share = self.share([a, i, b]);
            let ends = self.inputs[a].iter().zip(&self.inputs[b]);
            let mut all = ends.zip(&self.inputs[i]);
            // Also where one of them is no number.
            all.any(|((from, to), x)| {
                let off = (from + (to - from) * share - x).abs();
                off.is_nan() || off > STRAIGHT
            })
        };
        if b - a <= 1 || !(a + 1..b).any(off) {
            return vec![[a, b]];
        }
        let middle = a.midpoint(b);
        let mut parts = self.straight([a, middle]);
        parts.extend(self.straight([middle, b]));
        parts
    }

    /// Interpolates at `i` by the parabola through three known postures, over the length of the path.
    fn parabola(&self, [a, m, b]: [usize; 3], i: usize, of: [&Numbers; 3]) -> Numbers {
        let (x, y) = (self.share([a, i, b]), self.share([a, m, b]));
        // A tool that rests has the same numbers everywhere.
        let through = y > 0.0 && y < 1.0;
        std::array::from_fn(|k| {
            let [first, middle, end] = of.map(|numbers| numbers[k]);
            let straight = first + (end - first) * x;
            let bow = middle - (first + (end - first) * y);
            match through {
                true => straight + bow * (x * (1.0 - x)) / (y * (1.0 - y)),
                false => straight,
            }
        })
    }
}

/// See [`Way`].
fn inputs(poses: &[Pose], wrenches: &[Wrench], size: f64) -> Vec<[f64; 13]> {
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

/// Sampled indices of a stretch: all if it is short, else ends, middle and quarters.
fn places([a, b]: [usize; 2]) -> Vec<usize> {
    let m = a.midpoint(b);
    match b - a < FEWEST {
        true => (a..=b).collect(),
        false => vec![a, a.midpoint(m), m, m.midpoint(b), b],
    }
}

/// True if two of them are equal within [`EVENLY`].
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
