//! On what the claim after compensation rests, in sentences that stand beside it: the same on the
//! terminal and in the report.

use crate::load::law::CornerLoad;
use crate::number::{counted, largest, largest_length};
use crate::result::force_band::ForceBand;
use crate::result::run_result::RunResult;
use crate::result::tolerance::unchanged_text;

impl RunResult {
    /// What a program that came back byte for byte means; none for others, nor where that misses the tolerance.
    #[must_use]
    pub fn unchanged_text(&self) -> Option<String> {
        let s = &self.summary;
        (s.unchanged && self.tolerance.held != Some(false))
            .then(|| {
                s.within_tolerance_before
                    .then_some(s.max_position_error_before_mm)
            })
            .map(unchanged_text)
    }

    /// What is assumed at sharp corners, how many steps that concerns, and what becomes of the claim
    /// otherwise; none for a program without such steps.
    #[must_use]
    pub fn corners_text(&self) -> Option<String> {
        let s = &self.summary;
        let known = s.largest_corner_step_mm.is_finite() && s.corner_points_percent.is_finite();
        if s.corner_steps == 0 || !known {
            return None;
        }
        let mm = |value: Option<f64>| match value.filter(|value| value.is_finite()) {
            Some(value) => format!("up to {} off there", largest_length(value)),
            None => "without an equilibrium there".to_owned(),
        };
        let if_turns = mm(s.max_corner_error_if_load_turns_mm);
        let if_follows = mm(s.max_corner_error_if_load_follows_feed_mm);
        let (holds, otherwise) = match self.read_at_corners() {
            (Some(CornerLoad::Turns), _) => (
                "the load turns evenly while the tool steps".to_owned(),
                format!("if it follows the feed on the steps instead, the tool is {if_follows}"),
            ),
            (Some(CornerLoad::FollowsFeed), _) => (
                "the load follows the feed on the steps".to_owned(),
                format!("if it turns evenly while the tool steps, the tool is {if_turns}"),
            ),
            (None, [turns, follows]) => (
                format!(
                    "the load turns evenly while the tool steps ({turns}), or follows the feed on the steps ({follows})"
                ),
                format!(
                    "if it turns evenly with all tools, they are {if_turns}; if it follows the feed with all of \
                     them, they are {if_follows}"
                ),
            ),
        };
        Some(format!(
            "At sharp corners this takes it that {holds}: {}, up to {} long, {} of the points; {otherwise}.",
            counted(s.corner_steps, "corner step"),
            largest_length(s.largest_corner_step_mm),
            largest(s.corner_points_percent, "%")
        ))
    }

    /// What the machine's own weight has to do with the errors, and for whom it must not be corrected; none
    /// where it is no more than the tolerance.
    #[must_use]
    pub fn own_weight_text(&self) -> Option<String> {
        let s = &self.summary;
        let own = s.max_error_by_own_weight_mm?;
        if !own.is_finite() || own <= self.run_inputs.tolerance_mm || s.unchanged {
            return None;
        }
        let put = format!(
            "By themselves, the machine's own weight and what else acts in its model (springs, counterweights) put \
             the tool up to {} off",
            largest_length(own)
        );
        Some(match self.run_inputs.compensated {
            true => format!(
                "{put}; the program makes up for that too. Where the part was touched off with this machine, or its \
                 controller corrects the weight, that would be done twice: leave weight and springs out of the model \
                 then."
            ),
            false => format!("{put}."),
        })
    }

    /// What becomes of the claim if the force of the cut is as far off as its coefficients may be; none where the load is not
    /// computed from a cut.
    #[must_use]
    pub fn force_band_text(&self) -> Option<String> {
        self.force_band.as_ref().map(ForceBand::description)
    }

    /// The reading of the load at corners that all tools share, if they share one, and which tools are read by
    /// each of the two: "tools 1 and 3".
    fn read_at_corners(&self) -> (Option<CornerLoad>, [String; 2]) {
        let tools = &self.run_inputs.tools_at_corners;
        let Some(first) = tools.first().map(|tool| tool.load_at_corners) else {
            return (Some(self.run_inputs.load_at_corners), Default::default());
        };
        let read = |reading: CornerLoad| {
            let own = tools.iter().filter(|tool| tool.load_at_corners == reading);
            let numbers: Vec<String> = own.map(|tool| tool.number.to_string()).collect();
            match numbers.split_last() {
                Some((last, rest)) if !rest.is_empty() => {
                    format!("tools {} and {last}", rest.join(", "))
                }
                _ => format!("tool {}", numbers.concat()),
            }
        };
        let shared = tools.iter().all(|tool| tool.load_at_corners == first);
        (
            shared.then_some(first),
            [read(CornerLoad::Turns), read(CornerLoad::FollowsFeed)],
        )
    }
}
