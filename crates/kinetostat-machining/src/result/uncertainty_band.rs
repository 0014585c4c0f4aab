//! Scatter of the errors of a program for an uncertain machine and force.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::number::{Rounding, counted, largest_length, length_plus_minus, significant};

/// A number that is uncertain, as stated.
#[derive(Clone, Debug, Default, PartialEq, Serialize, JsonSchema, Deserialize)]
pub struct UncertainNumber {
    /// Path in the model, or part of the load.
    pub name: String,
    /// Nominal value.
    pub value: f64,
    /// Unit of value and spread.
    pub unit: String,
    /// Distribution of the number.
    pub distribution: String,
    /// Standard deviation of a normal one, half width of another.
    pub spread: f64,
}

/// The largest error along the program, over many machines, mm.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, JsonSchema, Deserialize)]
pub struct ScatteredError {
    /// Error of the machine as drawn, at the same places.
    pub as_drawn_mm: f64,
    /// Mean over all machines.
    pub mean_mm: f64,
    /// Standard deviation.
    pub deviation_mm: f64,
    /// Half width of the interval in which that lies with the confidence stated.
    pub deviation_plus_minus_mm: f64,
    /// Nineteen in twenty machines have more.
    pub low_mm: f64,
    /// Nineteen in twenty machines have less.
    pub high_mm: f64,
    /// Upper bound of that, with the confidence stated; `None` if too few machines were drawn for one.
    pub high_at_most_mm: Option<f64>,
    /// Standard deviation by linear propagation.
    pub deviation_by_line_mm: f64,
    /// True if linear propagation is accurate enough.
    pub linear_is_enough: bool,
}

/// A place of the program, with the errors of nineteen in twenty machines at least, of half of them, and of one in twenty, mm.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, JsonSchema, Deserialize)]
pub struct BandPlace {
    /// Line of the input program, from 1.
    pub line: usize,
    /// Length of the path up to here, mm.
    pub path_mm: f64,
    /// Quantiles of the program as it is.
    pub before_mm: [f64; 3],
    /// Quantiles of the written program.
    pub after_mm: Option<[f64; 3]>,
}

/// Scatter of the errors of a program: machines drawn at random, commanded by the program as it is and by the one that was written
/// for the machine as drawn.
#[derive(Clone, Debug, Default, PartialEq, Serialize, JsonSchema, Deserialize)]
#[non_exhaustive]
pub struct UncertaintyBand {
    /// File that states the uncertain numbers.
    pub file: String,
    /// Uncertain numbers.
    pub uncertain: Vec<UncertainNumber>,
    /// Machines that were drawn.
    pub machines: usize,
    /// Number of these machines without an answer at some place.
    pub unanswered: usize,
    /// Number of these machines that are not stable under the load at some place.
    pub unstable: usize,
    /// Seed of the draws.
    pub seed: u64,
    /// Confidence of the bounds.
    pub confidence: f64,
    /// Places at which all machines were solved.
    pub places: Vec<BandPlace>,
    /// Errors of the program as it is.
    pub before: ScatteredError,
    /// Errors of the written program.
    pub after: Option<ScatteredError>,
}

impl ScatteredError {
    /// Mean and standard deviation, as `0.403 mm +- 0.071`.
    ///
    /// ```
    /// let mut error = kinetostat_machining::ScatteredError::default();
    /// (error.mean_mm, error.deviation_mm) = (0.403, 0.0712);
    /// assert_eq!(error.band_text(), "0.403 mm +- 0.071");
    /// ```
    #[must_use]
    pub fn band_text(&self) -> String {
        length_plus_minus(self.mean_mm, self.deviation_mm)
    }
}

impl UncertaintyBand {
    /// Result in words.
    pub(crate) fn description(&self) -> String {
        let numbers = counted(self.uncertain.len(), "uncertain number");
        let mut text = format!(
            "With the {numbers} of {} ({} machines drawn, solved at {}), the tool is up to {} off its path as programmed",
            self.file,
            self.machines,
            counted(self.places.len(), "place"),
            self.before.band_text()
        );
        match &self.after {
            Some(after) => text.push_str(&format!(
                ", and up to {} with the compensated program (mean and standard deviation; nineteen in twenty machines stay within {}).",
                after.band_text(),
                largest_length(after.high_mm)
            )),
            None => text.push_str(&format!(
                " (mean and standard deviation; nineteen in twenty machines stay within {}).",
                largest_length(self.before.high_mm)
            )),
        }
        if !self.before.linear_is_enough {
            text.push_str(
                " These errors are not linear in the numbers: linear propagation is not enough.",
            );
        }
        let [unanswered, unstable] = [self.unanswered, self.unstable];
        if unanswered > 0 {
            text.push_str(&format!(
                " {unanswered} of these machines have no answer somewhere and are not in these figures."
            ));
        }
        if unstable > 0 {
            text.push_str(&format!(
                " {unstable} OF THESE MACHINES ARE NOT STABLE somewhere on the program."
            ));
        }
        text
    }
}

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
