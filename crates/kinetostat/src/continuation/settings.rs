//! How far and how finely curves of equilibria are followed.

use std::cmp::Ordering;
use std::f64::consts::PI;

#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

use crate::error::{Place, Result};
use crate::settings::{Settings, wrong};

/// How far and how finely curves are followed.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[non_exhaustive]
pub struct CurveSettings {
    /// The parameter stays between these values (m, rad or a factor).
    pub range: (f64, f64),
    /// Its conjugate stays between these values (N, N m or J). Default: no limit.
    pub conjugate_range: (f64, f64),
    /// Joint rotations stay within plus and minus this angle, rad. Default pi.
    pub largest_angle: f64,
    /// Largest rotation of any joint in one step, rad (slides: as a share of the natural length).
    /// Default 0.1.
    pub largest_turn: f64,
    /// Largest change of the parameter in one step. Default: a twentieth of a finite range.
    pub largest_change: Option<f64>,
    /// Smallest step before a branch is given up, as a share of the natural one. Default 1e-7.
    pub smallest_step: f64,
    /// Points of one branch, in each direction. Default 400.
    pub points: usize,
    /// Branches followed at most; 1 is the start's own only. Default 1.
    pub branches: usize,
    /// Tolerances of each point.
    pub solver: Settings,
}

impl CurveSettings {
    /// Defaults for a range of the parameter.
    #[must_use]
    pub fn within(from: f64, to: f64) -> Self {
        Self {
            range: (from.min(to), from.max(to)),
            conjugate_range: (f64::NEG_INFINITY, f64::INFINITY),
            largest_angle: PI,
            largest_turn: 0.1,
            largest_change: None,
            smallest_step: 1e-7,
            points: 400,
            branches: 1,
            solver: Settings::default(),
        }
    }

    /// Refuses what no curve can be followed with, naming it.
    pub(crate) fn check(&self, place: &Place) -> Result<()> {
        for (what, (from, to)) in [
            ("range", self.range),
            ("conjugate_range", self.conjugate_range),
        ] {
            if from.partial_cmp(&to) != Some(Ordering::Less) {
                return Err(wrong(
                    place,
                    what,
                    (from, to),
                    "a smaller and a larger number",
                ));
            }
        }
        let largest_change = self.largest_change.unwrap_or(1.0);
        for (what, value, most, required) in [
            (
                "largest_angle",
                self.largest_angle,
                f64::INFINITY,
                "an angle above 0",
            ),
            (
                "largest_turn",
                self.largest_turn,
                PI,
                "an angle above 0 and up to pi",
            ),
            (
                "largest_change",
                largest_change,
                f64::INFINITY,
                "a number above 0",
            ),
            (
                "smallest_step",
                self.smallest_step,
                1.0,
                "a share above 0 and up to 1",
            ),
        ] {
            if !(value > 0.0 && value <= most) {
                return Err(wrong(place, what, value, required));
            }
        }
        for (what, count) in [("points", self.points), ("branches", self.branches)] {
            if count == 0 {
                return Err(wrong(place, what, 0, "at least 1"));
            }
        }
        self.solver.check(place)
    }
}

crate::settings::setters!(CurveSettings {
    with_range: range: (f64, f64),
    with_conjugate_range: conjugate_range: (f64, f64),
    with_largest_angle: largest_angle: f64,
    with_largest_turn: largest_turn: f64,
    with_largest_change: largest_change: Option<f64>,
    with_smallest_step: smallest_step: f64,
    with_points: points: usize,
    with_branches: branches: usize,
    with_solver: solver: Settings,
});
