//! Limits of a chain's coordinates within which equilibria count.

#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

use crate::error::{Error, Result};
use crate::model::chain::{Chain, Role};
use crate::spatial::MotionKind;

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
