//! On what the claim after compensation rests, in sentences that stand beside it: the same on the
//! terminal and in the report.

use crate::load::CornerLoad;
use crate::number::{largest, largest_length};
use crate::result::RunResult;

impl RunResult {
    /// What a program that came back byte for byte means; none for others.
    #[must_use]
    pub fn unchanged_in_words(&self) -> Option<String> {
        self.summary.unchanged.then(|| {
            "Nothing was to be corrected: no correction along the program reaches the last digit written, and it \
             comes back byte for byte."
                .to_owned()
        })
    }

    /// What is assumed at sharp corners, how many steps that concerns, and what becomes of the claim
    /// otherwise; none for a program without such steps.
    #[must_use]
    pub fn corners_in_words(&self) -> Option<String> {
        let s = &self.summary;
        let known = s.largest_corner_step_mm.is_finite() && s.corner_points_percent.is_finite();
        if s.corner_steps == 0 || !known {
            return None;
        }
        let mm = |value: Option<f64>| match value.filter(|value| value.is_finite()) {
            Some(value) => format!("up to {} off there", largest_length(value)),
            None => "without an equilibrium there".to_owned(),
        };
        let (holds, otherwise) = match self.question.load_at_corners {
            CornerLoad::Turns => (
                "the load turns evenly while the tool steps",
                format!(
                    "if it follows the feed on the steps instead, the tool is {}",
                    mm(s.max_corner_error_if_load_follows_feed_mm)
                ),
            ),
            CornerLoad::FollowsFeed => (
                "the load follows the feed on the steps",
                format!(
                    "if it turns evenly while the tool steps, the tool is {}",
                    mm(s.max_corner_error_if_load_turns_mm)
                ),
            ),
        };
        Some(format!(
            "At sharp corners this takes it that {holds}: {} corner steps, up to {} long, {} of the points; {otherwise}.",
            s.corner_steps,
            largest_length(s.largest_corner_step_mm),
            largest(s.corner_points_percent, "%")
        ))
    }
}
