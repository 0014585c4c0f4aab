//! Verdict on the tolerance of a written program: corrected with a model or with a table, by one rule and in one wording.

use kinetostat_program::{Accounting, Farthest};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::number::{against, largest_length, length_setting};
use crate::result::point::{PointResult, size};

/// Verdict on the tolerance of a program that was corrected from a table. It can be missed only by corrections that
/// were left out: all other errors are refused when the written program is checked.
#[must_use]
pub fn of_table(farthest: &Farthest, allowed_mm: f64, accounting: &Accounting) -> ToleranceResult {
    let held = farthest.distance_mm <= allowed_mm;
    ToleranceResult {
        allowed_mm,
        held: Some(held),
        missed: (!held).then(|| MissedTolerance {
            line: farthest.line.unwrap_or(0),
            output_line: farthest.output_line,
            position_mm: farthest.position_mm,
            error_mm: farthest.distance_mm,
            reason: left_out(accounting),
        }),
    }
}

/// Reason for a missing correction in a program that never states an axis.
pub(crate) fn left_out(accounting: &Accounting) -> String {
    format!(
        "a correction of {} was left out because the program never states its axis; state X, Y and Z before the first cut",
        largest_length(accounting.left_out_mm)
    )
}

/// True if the uncorrected program keeps the tolerance of the path, for it has no chords; or the allowed error, and
/// is no worse than the corrected one.
#[must_use]
pub fn keeps_as_it_is(before_mm: f64, after_mm: f64, tolerance_mm: f64, allowed_mm: f64) -> bool {
    before_mm <= tolerance_mm || (before_mm <= allowed_mm && before_mm <= after_mm)
}

/// Sentence on a program that came back byte for byte: it was within the tolerance as it is, by so much, or there was
/// nothing that could be written.
#[must_use]
pub fn unchanged_text(within_tolerance_mm: Option<f64>) -> String {
    if let Some(before_mm) = within_tolerance_mm {
        return format!(
            "Nothing was corrected: as the program is, the tool is at most {} off, which is within the tolerance, \
             and it comes back byte for byte. A smaller --tolerance-um corrects that too.",
            largest_length(before_mm)
        );
    }
    "Nothing was to be corrected: no correction along the program reaches the last digit written, and it \
     comes back byte for byte."
        .to_owned()
}

impl ToleranceResult {
    /// Sentence on a missed tolerance: place, amount and reason; `None` if it is held or nothing was written.
    #[must_use]
    pub fn missed_text(&self) -> Option<String> {
        if self.held != Some(false) {
            return None;
        }
        let Some(m) = &self.missed else {
            return Some(format!(
                "THE TOLERANCE of {} IS MISSED.",
                length_setting(self.allowed_mm)
            ));
        };
        let (error, allowed) = against(m.error_mm, self.allowed_mm);
        Some(format!(
            "THE TOLERANCE IS MISSED at line {} (line {} of the written program): the tool is {error} off, more than the {allowed} that are allowed; {}.",
            m.line, m.output_line, m.reason
        ))
    }
}

/// Verdict on the tolerance of a written program.
#[derive(Clone, Debug, Default, PartialEq, Serialize, JsonSchema, Deserialize)]
#[non_exhaustive]
pub struct ToleranceResult {
    /// [`RunResult::allowed_mm`](crate::RunResult::allowed_mm).
    pub allowed_mm: f64,
    /// [`RunResult::holds_tolerance`](crate::RunResult::holds_tolerance).
    pub held: Option<bool>,
    /// Place where it is missed most; `None` if it is held.
    pub missed: Option<MissedTolerance>,
}

/// The place where a written program is farthest beyond its tolerance.
#[derive(Clone, Debug, Default, PartialEq, Serialize, JsonSchema, Deserialize)]
pub struct MissedTolerance {
    /// Line of the input program, from 1.
    pub line: usize,
    /// Line of the written program, from 1.
    pub output_line: usize,
    /// Desired position of the tool, program coordinates, mm.
    pub position_mm: [f64; 3],
    /// Distance of the tool from it, mm.
    pub error_mm: f64,
    /// Reason and remedy.
    pub reason: String,
}

impl MissedTolerance {
    /// Missed tolerance at a place of a program, with the reason in words; empty if it is not known.
    ///
    /// ```
    /// use kinetostat_machining::{MissedTolerance, PointResult};
    ///
    /// let mut point = PointResult::default();
    /// (point.line, point.error_after_mm) = (4, [0.03, 0.0, 0.04]);
    /// let missed = MissedTolerance::at(&point, String::new());
    /// assert!(missed.line == 4 && (missed.error_mm - 0.05).abs() < 1e-15);
    /// ```
    #[must_use]
    pub fn at(point: &PointResult, reason: String) -> Self {
        Self {
            line: point.line,
            output_line: point.output_line,
            position_mm: point.position_mm,
            error_mm: size(&point.error_after_mm),
            reason,
        }
    }
}
