//! Starts of a search of a chain's equilibria and bounds of its coordinates: postures that a person would try, variations of an
//! equilibrium, and a sequence that fills the bounds evenly.

use nalgebra::DVector;
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

use crate::chain::equilibrium::Equilibrium;
use crate::chain::scaling::nudged;
use crate::continuation::chain::system::ChainSystem;
use crate::error::{Error, Result};
use crate::model::chain::{Chain, Role};
use crate::number::{larger, smaller};
use crate::spatial::MotionKind;

/// Starts that a person would try: the posture, home, their mirror images, the stretched chain.
pub(crate) fn structured(posture: &[f64], chain: &Chain) -> Vec<Vec<f64>> {
    let home = chain.home_coordinates();
    let mirrored = |x: &[f64]| x.iter().map(|v| -v).collect::<Vec<f64>>();
    let mut list = vec![mirrored(&home), home, mirrored(posture), posture.to_vec()];
    for size in [0.05, 0.5, -0.5] {
        list.push(nudged(chain, posture, size));
    }
    list
}

/// Starts suggested by an equilibrium: its mirror image, and in both directions along its critical mode.
pub(crate) fn around(known: &Equilibrium, chain: &Chain) -> Vec<Vec<f64>> {
    let x = &known.coordinates;
    let mut list = vec![x.iter().map(|v| -v).collect::<Vec<f64>>()];
    let mode = &known.stability.mode;
    if mode.len() == x.len() {
        for size in [0.4, -0.4, 1.2, -1.2] {
            let along = x.iter().zip(mode).zip(chain.coordinates());
            list.push(
                along
                    .map(|((x, m), c)| match c.kind {
                        MotionKind::Revolute => x + size * m,
                        MotionKind::Prismatic => x + size * m * chain.scale().length,
                    })
                    .collect(),
            );
        }
    }
    list
}

/// Point `index` of an additive recurrence that fills the bounds evenly. Springs are spread over
/// what the natural energy can deflect, a third of it, and a tenth of it in turn; where some are very much
/// stiffer than others, what a turn by one radian of the softest one stores.
pub(crate) fn spread(system: &ChainSystem<'_, '_>, bounds: &Bounds, index: usize) -> Vec<f64> {
    let chain = system.problem.chain;
    let n = chain.coordinate_count();
    // Root of g^(n+1) = g + 1: the most even recurrence in n dimensions.
    let mut g = 2.0_f64;
    for _ in 0..60 {
        g = (1.0 + g).powf(1.0 / (n as f64 + 1.0));
    }
    let share = [4.0, 1.5, 0.4][index % 3];
    let mut one = DVector::zeros(system.count() + 1);
    one.rows_mut(system.reactions(), n).fill(share);
    let mut reach = system.coordinates(&one);
    if spread_of_springs(chain, &reach) > UNEVEN {
        let rotations = chain.coordinates().iter().zip(&reach);
        let softest = rotations
            .filter(|(c, _)| c.role == Role::Spring && c.kind == MotionKind::Revolute)
            .fold(0.0_f64, |most, (_, x)| larger(most, *x));
        if softest > share {
            reach.iter_mut().for_each(|x| *x *= share / softest);
        }
    }
    let mut weight = 1.0;
    (0..n)
        .map(|i| {
            weight /= g;
            let u = (0.5 + index as f64 * weight).fract();
            let c = &chain.coordinates()[i];
            let (mut low, mut high) = (bounds.low[i], bounds.high[i]);
            if c.role == Role::Spring {
                low = larger(low, -reach[i]);
                high = high.min(reach[i]);
            }
            let wide = match c.kind {
                MotionKind::Revolute => std::f64::consts::PI,
                MotionKind::Prismatic => 2.0 * chain.scale().length,
            };
            (low, high) = (low.max(-wide.max(-high)), high.min(wide.max(low)));
            low + u * (high - low)
        })
        .collect()
}

/// Springs of which one is this many times as stiff as another are spread by the energy of the softest.
const UNEVEN: f64 = 1e4;

/// Stiffness of the stiffest spring over that of the softest, from deflections of equal energy.
fn spread_of_springs(chain: &Chain, reach: &[f64]) -> f64 {
    let length = chain.scale().length;
    let springs = chain.coordinates().iter().zip(reach);
    let springs = springs.filter(|(c, _)| c.role == Role::Spring);
    let moved = springs.map(|(c, x)| match c.kind {
        MotionKind::Prismatic => *x,
        MotionKind::Revolute => x * length,
    });
    let (least, most) = moved.fold((f64::INFINITY, 0.0_f64), |(a, b), x| {
        (smaller(a, x), larger(b, x))
    });
    (most / least).powi(2)
}

/// Limits of the coordinates within which equilibria count.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct Bounds {
    /// Lowest value of every coordinate, m or rad.
    pub low: Vec<f64>,
    /// Highest value of every coordinate, m or rad.
    pub high: Vec<f64>,
}

impl Bounds {
    /// Rotations within plus and minus pi, passive slides within two natural lengths of the chain,
    /// springs that slide within half of one. The rotations of springs of six coordinates (pieces of
    /// elastic links) stay within plus and minus a quarter turn: three turns about x, y, z describe
    /// the same orientation as the turns by `a + pi`, `pi - b`, `c + pi`, so that farther out the
    /// same shape would count again.
    #[must_use]
    pub fn of(chain: &Chain) -> Self {
        let length = chain.scale().length;
        let mut high: Vec<f64> = chain
            .coordinates()
            .iter()
            .map(|c| match (c.kind, c.role) {
                (MotionKind::Revolute, _) => std::f64::consts::PI,
                (MotionKind::Prismatic, Role::Passive) => 2.0 * length,
                (MotionKind::Prismatic, Role::Spring) => 0.5 * length,
            })
            .collect();
        for block in chain.springs().iter().filter(|s| s.len() == 6) {
            for (high, c) in high
                .iter_mut()
                .zip(chain.coordinates())
                .skip(block.first)
                .take(6)
            {
                if c.kind == MotionKind::Revolute {
                    *high = high.min(std::f64::consts::FRAC_PI_2);
                }
            }
        }
        Self {
            low: high.iter().map(|x| -x).collect(),
            high,
        }
    }

    pub(crate) fn check(&self, chain: &Chain) -> Result<()> {
        let n = chain.coordinate_count();
        for (what, list) in [("lower bounds", &self.low), ("upper bounds", &self.high)] {
            if list.len() != n {
                return Err(Error::Size {
                    place: chain.place(),
                    what,
                    expected: n,
                    found: list.len(),
                });
            }
        }
        match (0..n)
            .find(|&i| self.low[i].partial_cmp(&self.high[i]) != Some(std::cmp::Ordering::Less))
        {
            Some(i) => Err(Error::model(
                chain.place(),
                format!(
                    "the bounds of '{}' are {} and {}: the first must be less than the second",
                    chain.coordinates()[i].name,
                    self.low[i],
                    self.high[i]
                ),
            )),
            None => Ok(()),
        }
    }

    /// True if the springs among the coordinates stay within the bounds.
    pub(crate) fn hold_springs(&self, chain: &Chain, x: &[f64]) -> bool {
        let springs = chain.springs().iter();
        let mut springs = springs.flat_map(|s| s.first..s.first + s.len());
        springs.all(|i| x[i] > self.low[i] && x[i] < self.high[i])
    }

    pub(crate) fn hold(&self, x: &[f64]) -> bool {
        x.iter()
            .enumerate()
            .all(|(i, x)| *x > self.low[i] - 1e-9 && *x < self.high[i] + 1e-9)
    }
}
