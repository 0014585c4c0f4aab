//! What a run means, in plain words.

use kinetostat_machining::{PointKind, RunResult};

use crate::number;
use crate::run::shown::in_type;

/// Rotations below this are not worth a sentence, deg.
const SMALLEST_ROTATION: f64 = 0.000_5;

/// How good the news is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Level {
    /// The written program does what was requested.
    Good,
    /// Nothing was to be corrected.
    Unchanged,
    /// An answer without a tolerance: analysis only.
    Analysis,
    /// Usable only after a look at what is said.
    Attention,
    /// Not to be run.
    Stop,
}

impl Level {
    /// Class in the style sheet.
    pub(crate) fn class(self) -> &'static str {
        match self {
            Self::Good => "good",
            Self::Analysis | Self::Unchanged => "analysis",
            Self::Attention => "attention",
            Self::Stop => "stop",
        }
    }

    /// The level in words, for those who do not see colours.
    pub(crate) fn word(self) -> &'static str {
        match self {
            Self::Good => "Corrected",
            Self::Unchanged => "Unchanged",
            Self::Analysis => "Analysis",
            Self::Attention => "Attention",
            Self::Stop => "Do not run",
        }
    }
}

/// The result of a run against its tolerance.
pub(crate) struct RunAssessment {
    pub(crate) level: Level,
    pub(crate) sentence: String,
}

/// Compares a run with its tolerance.
pub(crate) fn assessment(result: &RunResult) -> RunAssessment {
    let summary = &result.summary;
    let stop = |sentence: String| RunAssessment {
        level: Level::Stop,
        sentence,
    };
    if summary.points == 0 && result.points.is_empty() {
        return RunAssessment {
            level: Level::Attention,
            sentence: "No point of the program was calculated, so there is nothing to judge."
                .to_owned(),
        };
    }
    if !summary.stable {
        let place = first_unstable_line(result).map_or_else(String::new, |line| {
            format!(", first at line {}", number::count(line))
        });
        return stop(format!(
            "The machine gives way under this load{place}: it is not stable there. Do not run this program with \
             this load; the figures below hold only where the machine is stable."
        ));
    }
    if !summary.converged {
        let program = if result.run_inputs.compensated {
            " or on the compensated program"
        } else {
            ""
        };
        return stop(format!(
            "The calculation found no answer for at least one place on the path. Do not rely on the figures \
             below{program} before the reason is found (see the warnings)."
        ));
    }
    let mut meaning = if result.run_inputs.compensated {
        compensated(result)
    } else {
        analysed(result)
    };
    let missed: Vec<&str> = (result.features.iter())
        .filter(|feature| feature.held == Some(false))
        .map(|feature| feature.name.as_str())
        .collect();
    if !missed.is_empty() {
        if meaning.level != Level::Stop && result.run_inputs.compensated {
            meaning.level = Level::Attention;
        }
        meaning.sentence.push_str(&format!(
            " The tolerance is missed of: {}.",
            missed.join(", ")
        ));
    }
    if let Some(own) = result.own_weight_text() {
        meaning.sentence.push(' ');
        meaning.sentence.push_str(&own);
    }
    if let Some(corners) = result.corners_text() {
        meaning.sentence.push(' ');
        meaning.sentence.push_str(&corners);
    }
    if let Some(ramp) = result.ramp_text() {
        meaning.sentence.push(' ');
        meaning.sentence.push_str(&ramp);
    }
    if let Some(band) = result.force_band_text() {
        meaning.sentence.push(' ');
        meaning.sentence.push_str(&band);
    }
    if let Some(band) = result.uncertainty_text() {
        meaning.sentence.push(' ');
        meaning.sentence.push_str(&band.replace("+-", "±"));
    }
    if cuts_without_load(result) {
        meaning.sentence = format!(
            "No cutting force acts on the tool in this run. {}",
            meaning.sentence
        );
    }
    if summary.max_residual_rotation_deg > SMALLEST_ROTATION {
        let angle = in_type(result).rotation;
        let inputs = &result.run_inputs;
        let beside = match (inputs.orientation_corrected, inputs.states_orientation) {
            (true, _) => "",
            (false, true) => ", which --correct pose corrects, too",
            (false, false) => ", which a program of positions cannot correct",
        };
        meaning.sentence.push_str(&match inputs.compensated {
            true => format!(" The tool stays tilted by up to {angle}{beside}."),
            false => format!(" It tilts by up to {angle}."),
        });
    }
    meaning
}

fn analysed(result: &RunResult) -> RunAssessment {
    let before = result.summary.max_position_error_before_mm;
    if !before.is_finite() {
        return unknown();
    }
    RunAssessment {
        level: Level::Analysis,
        sentence: format!(
            "The tool is up to {} off its programmed path. This is an analysis only: no compensated program was \
             written.",
            in_type(result).error_before
        ),
    }
}

fn compensated(result: &RunResult) -> RunAssessment {
    let before = result.summary.max_position_error_before_mm;
    let after = result.summary.max_position_error_after_mm;
    if !before.is_finite() || !after.is_finite() {
        return unknown();
    }
    if let Some(unchanged) = result.unchanged_text() {
        return RunAssessment {
            level: Level::Unchanged,
            sentence: format!(
                "{unchanged} The tool is at most {} off.",
                in_type(result).error_after
            ),
        };
    }
    let allowed = result.allowed_mm();
    let before_text = in_type(result).error_before;
    let (after_text, allowed_text) = number::against(after, allowed);
    if result.holds_tolerance() != Some(true) {
        let sentence = if after < before {
            format!(
                "Without compensation the tool is up to {before_text} off; with the compensated program it is still \
                 up to {after_text} off, more than the {} asked for.",
                allowed_text
            )
        } else {
            format!(
                "The compensated program is no better than the original: the tool is up to {before_text} off without \
                 it and up to {after_text} with it, more than the {} asked for.",
                allowed_text
            )
        };
        let sentence = match &result.tolerance.missed {
            Some(missed) => format!(
                "The tolerance is missed, most at line {}: {}. {sentence}",
                number::count(missed.line),
                crate::text::clean(&missed.reason)
            ),
            None => format!("The tolerance is missed. {sentence}"),
        };
        return RunAssessment {
            level: Level::Attention,
            sentence,
        };
    }
    if before <= allowed {
        return RunAssessment {
            level: Level::Good,
            sentence: format!(
                "Even without compensation the tool is at most {before_text} off, within the {} asked for; with the \
                 compensated program at most {after_text}.",
                allowed_text
            ),
        };
    }
    RunAssessment {
        level: Level::Good,
        sentence: format!(
            "Without compensation the tool is up to {before_text} off; with the compensated program at most \
             {after_text}."
        ),
    }
}

fn unknown() -> RunAssessment {
    RunAssessment {
        level: Level::Stop,
        sentence: "The error of the tool is not available, so the program cannot be judged: do not run it before the \
                   reason is found (see the warnings)."
            .to_owned(),
    }
}

fn first_unstable_line(result: &RunResult) -> Option<usize> {
    result
        .points
        .iter()
        .chain(&result.worst_points)
        .filter(|point| !point.stable)
        .map(|point| point.line)
        .min()
}

/// True if no cutting move carries a force; weight and the machine's own deviations may still be there.
fn cuts_without_load(result: &RunResult) -> bool {
    let mut cutting = result
        .points
        .iter()
        .filter(|p| p.kind != PointKind::Rapid)
        .peekable();
    cutting.peek().is_some() && cutting.all(|p| p.force_n.iter().all(|force| *force == 0.0))
}

#[cfg(test)]
mod tests {
    use kinetostat_machining::PointResult;

    use super::*;

    fn run() -> RunResult {
        let mut result = RunResult::default();
        result.summary.points = 1;
        result.summary.converged = true;
        result.summary.stable = true;
        result.summary.max_position_error_before_mm = 0.7583;
        result.summary.max_position_error_after_mm = 0.000_57;
        result.summary.max_rounding_error_mm = 0.000_1;
        result.run_inputs.compensated = true;
        result.run_inputs.tolerance_mm = 0.000_5;
        result.points.push({
            let mut point = PointResult::default();
            point.force_n = [0.0, 0.0, -100.0];
            point.stable = true;
            point
        });
        result
    }

    fn sentence(result: &RunResult) -> (Level, String) {
        let assessment = assessment(result);
        (
            assessment.level,
            assessment.sentence.replace('\u{202f}', " "),
        )
    }

    #[test]
    fn good_news() {
        let mut result = run();
        result.summary.max_residual_rotation_deg = 0.42;
        let expected = "Without compensation the tool is up to 0.759 mm off; with the compensated program at most \
                        0.570 µm. The tool stays tilted by up to 0.420 deg, which a program of positions cannot \
                        correct.";
        assert_eq!(sentence(&result), (Level::Good, expected.to_owned()));
    }

    #[test]
    fn small_from_the_start() {
        let mut result = run();
        result.summary.max_position_error_before_mm = 0.000_58;
        let (level, text) = sentence(&result);
        assert_eq!(level, Level::Good);
        assert!(text.starts_with("Even without compensation"), "{text}");
    }

    #[test]
    fn missed_tolerance() {
        let mut result = run();
        result.summary.max_position_error_after_mm = 0.012;
        let (level, text) = sentence(&result);
        assert_eq!(level, Level::Attention);
        assert!(
            text.contains("still up to 0.0120 mm off, more than the 0.6 µm asked for"),
            "{text}"
        );
        result.summary.max_position_error_after_mm = 0.9;
        assert!(sentence(&result).1.contains("no better than the original"));
    }

    #[test]
    fn analysis_and_no_load() {
        let mut result = run();
        result.run_inputs.compensated = false;
        result.points[0].force_n = [0.0; 3];
        let (level, text) = sentence(&result);
        assert_eq!(level, Level::Analysis);
        assert!(
            text.starts_with(
                "No cutting force acts on the tool in this run. The tool is up to 0.759 mm"
            ),
            "{text}"
        );
        assert!(text.contains("no compensated program was written"));
    }

    #[test]
    fn bad_news_comes_first() {
        let mut result = run();
        result.summary.converged = false;
        assert_eq!(sentence(&result).0, Level::Stop);
        result.summary.stable = false;
        result.points[0].stable = false;
        result.points[0].line = 27;
        let (level, text) = sentence(&result);
        assert_eq!(level, Level::Stop);
        assert!(text.contains("first at line 27"), "{text}");
        let mut result = run();
        result.summary.max_position_error_after_mm = f64::NAN;
        assert!(sentence(&result).1.contains("not available"));
        assert!(
            sentence(&RunResult::default())
                .1
                .contains("nothing to judge")
        );
    }
}
