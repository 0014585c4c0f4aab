//! On what the claim after compensation rests, in sentences that stand beside it: the same on the
//! terminal and in the report.

use crate::load::law::CornerLoad;
use crate::load::ramp_findings::LoadBegins;
use crate::number::{counted, largest, largest_length};
use crate::result::run_result::RunResult;
use crate::result::tolerance::unchanged_text;
use crate::result::uncertainty_band::{ForceBand, UncertaintyBand};
use crate::weight_correction::WeightCorrection;

impl RunResult {
    /// Sentence on a program that came back byte for byte; `None` for others, and for one that misses the tolerance.
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

    /// Sentence on the assumption at sharp corners and at the end of a rapid under load, the number of such steps, and the claim
    /// without it; `None` for a program without such steps.
    #[must_use]
    pub fn corners_text(&self) -> Option<String> {
        let s = &self.summary;
        let lengths = [s.largest_corner_step_mm, s.largest_entry_step_mm];
        let known = lengths.iter().all(|mm| mm.is_finite()) && s.corner_points_percent.is_finite();
        let (places, turns, at_once) = match (s.corner_steps, s.entry_steps) {
            (0, 0) => return None,
            (_, 0) => ("At sharp corners", "turns", "follows the feed on the steps"),
            (0, _) => ("Where a rapid ends", "comes", "is there at once"),
            (_, _) => (
                "At sharp corners and where a rapid ends",
                "turns or comes",
                "follows the feed on the steps",
            ),
        };
        if !known {
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
                format!("the load {turns} evenly while the tool steps"),
                format!("if it {at_once} instead, the tool is {if_follows}"),
            ),
            (Some(CornerLoad::FollowsFeed), _) => (
                format!("the load {at_once}"),
                format!("if it {turns} evenly while the tool steps, the tool is {if_turns}"),
            ),
            (None, [by_turning, following]) => (
                format!(
                    "the load {turns} evenly while the tool steps ({by_turning}), or {at_once} ({following})"
                ),
                format!(
                    "if it {turns} evenly with all tools, they are {if_turns}; if it {at_once} with all of \
                     them, they are {if_follows}"
                ),
            ),
        };
        let kinds = [
            (s.corner_steps, "corner step", s.largest_corner_step_mm),
            (
                s.entry_steps,
                "step where a rapid ends",
                s.largest_entry_step_mm,
            ),
        ];
        let kinds = kinds.into_iter().filter(|(count, ..)| *count > 0);
        let steps: Vec<String> = kinds
            .map(|(count, what, longest)| {
                let counted = match what.split_once(' ') {
                    Some(("step", rest)) => format!("{} {rest}", counted(count, "step")),
                    _ => counted(count, what),
                };
                format!("{counted}, up to {} long", largest_length(longest))
            })
            .collect();
        Some(format!(
            "{places} this takes it that {holds}: {}, {} of the points; {otherwise}.",
            steps.join(", and "),
            largest(s.corner_points_percent, "%")
        ))
    }

    /// Sentence on the length over which a stated load is assumed to come, because the start of the cut was not stated;
    /// `None` if no load is stated.
    #[must_use]
    pub fn ramp_text(&self) -> Option<String> {
        let ramp = self.summary.load_ramp?;
        let length = largest_length(ramp.length_mm);
        Some(match ramp.begins {
            LoadBegins::AfterRapid => format!(
                "It is not stated where a cut begins after a rapid: the load is taken to come over at most the first {length} of feed \
                 there, and to act until the next rapid begins."
            ),
            LoadBegins::BelowHeight => format!(
                "The load comes over the {length} of path before the tool is below the height where it acts, and goes over as \
                 much behind; where a rapid ends nearer than that, over the first {length} of feed."
            ),
        })
    }

    /// Sentence on the displacement of the tool by the machine's own weight, and its part that is an error; `None` if
    /// it is no more than the tolerance.
    #[must_use]
    pub fn own_weight_text(&self) -> Option<String> {
        let s = &self.summary;
        let whole = s.max_displacement_by_weight_mm?;
        if !whole.is_finite() || whole <= self.run_inputs.tolerance_mm {
            return None;
        }
        let error = largest_length(s.max_error_by_own_weight_mm?);
        let becomes = match self.run_inputs.compensated && !s.unchanged {
            true => "is corrected",
            false => "counts as an error",
        };
        let part = match &self.run_inputs.weight {
            WeightCorrection::None => {
                format!("none of it {becomes} (weight \"none\": the controller corrects it)")
            }
            WeightCorrection::TouchOff(at) => format!(
                "only its change of up to {error} from {} {becomes} (weight \"touch-off\")",
                at.description()
            ),
            WeightCorrection::All | WeightCorrection::NotStated => format!(
                "all of it {becomes} (weight \"all\": the part was measured without this machine)"
            ),
        };
        Some(format!(
            "By themselves, the machine's own weight and what else acts in its model (springs, counterweights) move \
             the tool by up to {}; {part}.",
            largest_length(whole)
        ))
    }

    /// Sentence on the errors for a force as far off as its coefficients may be; `None` if the load is not computed from a
    /// cut.
    #[must_use]
    pub fn force_band_text(&self) -> Option<String> {
        self.force_band.as_ref().map(ForceBand::description)
    }

    /// Sentence on the scatter of the errors for an uncertain machine and force; `None` if nothing is stated to be uncertain.
    #[must_use]
    pub fn uncertainty_text(&self) -> Option<String> {
        let band = self.uncertainty.as_ref();
        band.map(UncertaintyBand::description)
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
