//! Depths between which a cut is stable at one speed, as they were found.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::stability::multiplier::Instability;
use crate::stability::swinging::LeftOut;

/// A depth at which the cut becomes unstable or stable.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema, Deserialize)]
pub struct Crossing {
    /// Depth of cut, m.
    pub depth: f64,
    /// True if the cut is unstable above it.
    pub unstable_above: bool,
    /// Type of the instability.
    pub kind: Instability,
    /// Strongest frequency of the vibration there, Hz.
    pub frequency_hz: f64,
    /// The multiplier there, real and imaginary part.
    pub multiplier: (f64, f64),
    /// Relative change of the depth when the points of collocation were last increased by a third.
    pub resolved: f64,
}

/// Stability of a cut at one spindle speed, from depth 0 to a largest depth.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema, Deserialize)]
pub struct SpeedStability {
    /// Spindle speed, rpm.
    pub speed_rpm: f64,
    /// Largest depth that was looked at, m.
    pub up_to: f64,
    /// Changes of stability, from the smallest depth upwards; the first is the limit.
    pub crossings: Vec<Crossing>,
    /// Frequency of the fastest mode that swings in the calculation, Hz; those above are springs.
    pub modes_up_to_hz: f64,
    /// Mode with the largest share among those treated as springs although they contribute ([`crate::Swinging`]).
    pub left_out: Option<LeftOut>,
}

impl SpeedStability {
    /// The smallest depth at which the cut becomes unstable; `None` where it is stable up to the largest depth.
    #[must_use]
    pub fn limit(&self) -> Option<&Crossing> {
        self.crossings.first()
    }

    /// All stretches of depth in which the cut is stable, m: those above the first are islands.
    #[must_use]
    pub fn stable(&self) -> Vec<(f64, f64)> {
        let mut all = Vec::new();
        let mut from = Some(0.0);
        for crossing in &self.crossings {
            match (from, crossing.unstable_above) {
                (Some(low), true) => {
                    all.push((low, crossing.depth));
                    from = None;
                }
                (None, false) => from = Some(crossing.depth),
                _ => {}
            }
        }
        all.extend(from.map(|low| (low, self.up_to)));
        all
    }

    /// True if a depth, m, is stable; `None` beyond the searched depths.
    #[must_use]
    pub fn is_stable(&self, depth: f64) -> Option<bool> {
        let within = (0.0..=self.up_to).contains(&depth);
        let inside = |(low, high): &(f64, f64)| *low <= depth && depth < *high;
        within.then(|| self.stable().iter().any(inside))
    }
}
