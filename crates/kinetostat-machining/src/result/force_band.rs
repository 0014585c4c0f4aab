//! Errors for a force of the cut larger or smaller than its coefficients say.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::number::{Rounding, counted};
use crate::number::{largest_length, significant};

/// The errors if the force of the cut is larger or smaller by the spread of its coefficients, and all else is as it was:
/// where it was compensated, the program is the one that was written for the force as computed.
#[derive(Clone, Debug, Default, PartialEq, Serialize, JsonSchema, Deserialize)]
#[non_exhaustive]
pub struct ForceBand {
    /// Relative deviation of the force, percent.
    pub spread_percent: f64,
    /// Points at which the machine was solved so; where they are not all, those with the largest errors and the largest
    /// forces for their stiffness are among them.
    pub points: usize,
    /// Points on cutting moves in all.
    pub of_points: usize,
    /// Largest distance of the tool from its programmed place with the larger force, mm; `None` if the machine has no
    /// equilibrium under it.
    pub max_error_if_larger_mm: Option<f64>,
    /// Largest error with the smaller force.
    pub max_error_if_smaller_mm: Option<f64>,
    /// Line of the input program with the largest of both, or where there is no equilibrium.
    pub line: usize,
}

impl ForceBand {
    /// The larger of both errors, mm; `None` if one has no equilibrium.
    ///
    /// ```
    /// assert_eq!(kinetostat_machining::ForceBand::default().max_error_mm(), None);
    /// ```
    #[must_use]
    pub fn max_error_mm(&self) -> Option<f64> {
        let (a, b) = (self.max_error_if_larger_mm?, self.max_error_if_smaller_mm?);
        Some(kinetostat::number::larger(a, b))
    }

    /// Errors after compensation if the force of the cut deviates as far as its coefficients may.
    pub(crate) fn description(&self) -> String {
        let band = self;
        let percent = significant(band.spread_percent, 2, Rounding::Nearest);
        let all = band.points >= band.of_points;
        let solved = match all {
            true => String::new(),
            false => format!(
                ", solved at {} with the largest errors and forces among them",
                counted(band.points, "point")
            ),
        };
        match band.max_error_mm() {
            Some(error) => format!(
                "If the force of the cut is {percent} % larger or smaller, as its coefficients may be, the tool is up to {} off (line {}{solved}).",
                largest_length(error),
                band.line
            ),
            None => format!(
                "If the force of the cut is {percent} % larger or smaller, as its coefficients may be, the machine has no equilibrium at line {}.",
                band.line
            ),
        }
    }
}
