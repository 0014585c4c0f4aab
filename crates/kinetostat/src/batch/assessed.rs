//! Stability along a path: looked at in some places, and in between where it is shown to go evenly.
//!
//! Stiffness and share to buckling take four times as long as the equilibrium that they are of, and along a path they hardly change. So a stretch of
//! postures is looked at in both ends and its middle, if places and loads in it go evenly from end to end. Where the middle agrees with
//! what lies between the ends, every half is filled evenly, which is off by about a quarter of what the middle may be off at most ([`EVENLY`]); else both
//! halves are looked at in the same way.

use crate::batch::equilibria::{BatchEquilibrium, PostureStability};
use crate::number::larger;
use crate::spatial::{Pose, Wrench};

/// Postures of a stretch at first.
const STRETCH: usize = 21;

/// Share of a value by which the middle of a stretch may lie off what is between its ends.
const EVENLY: f64 = 1e-4;

/// Share of the machine's size (rad, or of the largest load) by which places (orientations, loads) of a stretch may lie off what is between its ends.
const STRAIGHT: f64 = 1e-3;

/// Beyond this share of the way to buckling every posture is looked at.
const FAR_FROM_BUCKLING: f64 = 0.8;

/// Numbers of a posture's stability: stable, stiffness, share to buckling, as in [`BatchEquilibrium`].
type Numbers = [f64; 3];

/// What postures are asked about.
pub(crate) struct Postures<'a> {
    pub poses: &'a [Pose],
    pub wrenches: &'a [Wrench],
    /// The machine's size, m.
    pub size: f64,
}

impl Postures<'_> {
    /// Numbers in which a stretch is to go evenly, in units in which one is all of the machine, of the turn or of the load.
    fn inputs(&self) -> Vec<[f64; 13]> {
        let of = |w: &Wrench| [w.force().norm(), w.moment().norm() / self.size];
        let most = self
            .wrenches
            .iter()
            .flat_map(of)
            .fold(f64::MIN_POSITIVE, larger);
        let both = self.poses.iter().zip(self.wrenches);
        let all = both.map(|(pose, wrench)| {
            let (at, turn) = (pose.translation.vector / self.size, pose.rotation.coords);
            let (force, moment) = (wrench.force() / most, wrench.moment() / (most * self.size));
            let numbers = at.iter().chain(turn.iter());
            let mut numbers = numbers.chain(force.iter()).chain(moment.iter());
            std::array::from_fn(|_| numbers.next().copied().unwrap_or(0.0))
        });
        all.collect()
    }

    /// The stability of all, `look` finding it at some; none where one of those could not be looked at, or is too near to buckling for
    /// anything in between to be told.
    pub fn stabilities(
        &self,
        mut look: impl FnMut(&[usize]) -> Option<Vec<Numbers>>,
    ) -> Option<Vec<Numbers>> {
        let count = self.poses.len();
        let last = count.checked_sub(1)?;
        let way = Way::new(self.inputs());
        let mut known: Vec<Option<Numbers>> = vec![None; count];
        let pieces = last.div_ceil(STRETCH).max(1);
        let at = |k: usize| k * last / pieces;
        let mut open: Vec<[usize; 2]> = (0..pieces).map(|k| [at(k), at(k + 1)]).collect();
        while !open.is_empty() {
            let straight = std::mem::take(&mut open);
            let straight: Vec<_> = straight.into_iter().flat_map(|s| way.straight(s)).collect();
            let middle = |[a, b]: [usize; 2]| a.midpoint(b);
            let wanted = straight.iter().flat_map(|s| [s[0], middle(*s), s[1]]);
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
                let m = middle([a, b]);
                let (Some(first), Some(here), Some(end)) = (known[a], known[m], known[b]) else {
                    return None;
                };
                if m == a || b - a <= 1 {
                    continue;
                }
                if !agrees(&way.between([a, m, b], (&first, &end)), &here) {
                    open.extend([[a, m], [m, b]]);
                    continue;
                }
                for i in a + 1..m {
                    known[i] = Some(way.between([a, i, m], (&first, &here)));
                }
                for i in m + 1..b {
                    known[i] = Some(way.between([m, i, b], (&here, &end)));
                }
            }
        }
        known.into_iter().collect()
    }
}

/// The way along all inputs.
struct Way {
    inputs: Vec<[f64; 13]>,
    /// Its length up to each posture.
    length: Vec<f64>,
}

impl Way {
    fn new(inputs: Vec<[f64; 13]>) -> Self {
        let mut sum = 0.0;
        let mut length = vec![0.0; inputs.len().min(1)];
        for pair in inputs.windows(2) {
            let step = pair[0].iter().zip(&pair[1]).map(|(a, b)| (a - b) * (a - b));
            sum += step.sum::<f64>().sqrt();
            length.push(sum);
        }
        Self { inputs, length }
    }

    /// Where a posture is between two others, 0 to 1.
    fn share(&self, [a, i, b]: [usize; 3]) -> f64 {
        let whole = self.length[b] - self.length[a];
        match whole > 0.0 {
            true => (self.length[i] - self.length[a]) / whole,
            false => 0.0,
        }
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

    /// What lies between two known ones.
    fn between(&self, at: [usize; 3], (from, to): (&Numbers, &Numbers)) -> Numbers {
        let share = self.share(at);
        std::array::from_fn(|k| from[k] + (to[k] - from[k]) * share)
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
