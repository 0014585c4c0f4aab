//! Assessment of a run in plain words.

use kinetostat_machining::{AssumptionKind, Level, PointKind, RunResult, Warning, WarningCode};

use crate::number;
use crate::run::in_type;

/// Rotations below this are not worth a sentence, deg.
const SMALLEST_ROTATION: f64 = 0.000_5;

/// Class of a level in the style sheet.
pub(crate) fn class(level: Level) -> &'static str {
    match level {
        Level::Good => "good",
        Level::Analysis | Level::Unchanged => "analysis",
        Level::Attention => "attention",
        Level::Stop => "stop",
    }
}

/// The level in words, for those who do not see colours.
pub(crate) fn word(level: Level) -> &'static str {
    match level {
        Level::Good => "Corrected",
        Level::Unchanged => "Unchanged",
        Level::Analysis => "Analysis",
        Level::Attention => "Attention",
        Level::Stop => "Do not run",
    }
}

/// The result of a run against its tolerance: how good it is, and what is to be said of it, in this order.
pub(crate) struct RunAssessment {
    pub(crate) level: Level,
    pub(crate) statements: Vec<Statement>,
}

/// Statement on a run. It holds no words, so that every language says the same.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Statement {
    /// The written program never starts the spindle.
    SpindleNotStarted,
    /// No point was calculated.
    NoPoint,
    /// The machine is not stable, first at this line.
    Unstable { line: Option<usize> },
    /// Some place has no answer.
    NotConverged,
    /// The errors are no numbers.
    Unknown,
    /// No cutting force acts.
    NoLoad,
    /// An analysis, with its largest error.
    Analysed,
    /// The program came back byte for byte.
    Unchanged,
    /// The written program misses the tolerance; it may be better than the original.
    Missed { better: bool },
    /// The original keeps the tolerance, too.
    WithinBefore,
    /// The errors before and after.
    Corrected,
    /// The tolerance is kept only if assumptions hold.
    AtWorst,
    /// Features that miss their tolerance.
    FeaturesMissed,
    /// An assumption of the run.
    Assumed(AssumptionKind),
    /// The tilt that stays.
    Tilt,
}

/// Statements about a run, the costliest assumption first.
pub(crate) fn assessment(result: &RunResult) -> RunAssessment {
    let summary = &result.summary;
    let level = result.assessment.level;
    let only = |statement| RunAssessment {
        level,
        statements: vec![statement],
    };
    if summary.points == 0 && result.points.is_empty() {
        return only(Statement::NoPoint);
    }
    if !summary.stable {
        let line = first_unstable_line(result);
        return only(Statement::Unstable { line });
    }
    if !summary.converged {
        return only(Statement::NotConverged);
    }
    let missed = result.features.iter().any(|f| f.held == Some(false));
    let stands = |warning: &Warning| warning.code == WarningCode::SpindleNotStarted;
    let first = [
        (
            result.warnings.iter().any(stands),
            Statement::SpindleNotStarted,
        ),
        (cuts_without_load(result), Statement::NoLoad),
        (true, main(result)),
        (result.is_doubtful(), Statement::AtWorst),
        (missed, Statement::FeaturesMissed),
    ];
    let assumptions = result.assessment.assumptions.iter();
    let assumed = assumptions.map(|assumption| (true, Statement::Assumed(assumption.kind)));
    let is_tilted = summary.max_residual_rotation_deg > SMALLEST_ROTATION;
    let all = first
        .into_iter()
        .chain(assumed)
        .chain([(is_tilted, Statement::Tilt)]);
    let said = all.filter(|(is_said, _)| *is_said);
    RunAssessment {
        level,
        statements: said.map(|(_, statement)| statement).collect(),
    }
}

/// The errors, before and after.
fn main(result: &RunResult) -> Statement {
    let before = result.summary.max_position_error_before_mm;
    let after = result.summary.max_position_error_after_mm;
    let compensated = result.run_inputs.compensated;
    if !before.is_finite() || (compensated && !after.is_finite()) {
        return Statement::Unknown;
    }
    if !compensated {
        return Statement::Analysed;
    }
    if result.unchanged_text().is_some() {
        return Statement::Unchanged;
    }
    if result.holds_tolerance() != Some(true) {
        let better = after < before;
        return Statement::Missed { better };
    }
    match before <= result.allowed_mm() {
        true => Statement::WithinBefore,
        false => Statement::Corrected,
    }
}

impl RunAssessment {
    /// All of it in English.
    pub(crate) fn sentence(&self, result: &RunResult) -> String {
        let sentences = self.statements.iter().map(|s| s.sentence(result));
        sentences.collect::<Vec<_>>().join(" ")
    }
}

impl Statement {
    /// Sentence in English.
    pub(crate) fn sentence(self, result: &RunResult) -> String {
        match self {
            Self::SpindleNotStarted => "SPINDLE NOT STARTED by this program.".to_owned(),
            Self::NoPoint => {
                "No point of the program was calculated, so there is nothing to judge.".to_owned()
            }
            Self::Unstable { line } => {
                let place = line.map_or_else(String::new, |line| {
                    format!(", first at line {}", number::count(line))
                });
                format!(
                    "The machine gives way under this load{place}: it is not stable there. Do not run this program with \
                     this load; the figures below hold only where the machine is stable."
                )
            }
            Self::NotConverged => {
                let program = match result.run_inputs.compensated {
                    true => " or on the compensated program",
                    false => "",
                };
                format!(
                    "The calculation found no answer for at least one place on the path. Do not rely on the figures \
                     below{program} before the reason is found (see the warnings)."
                )
            }
            Self::Unknown => {
                "The error of the tool is not available, so the program cannot be judged: do not run it before the \
                 reason is found (see the warnings)."
                    .to_owned()
            }
            Self::NoLoad => "No cutting force acts on the tool in this run.".to_owned(),
            Self::Analysed => format!(
                "The tool is up to {} off its programmed path. This is an analysis only: no compensated program was \
                 written.",
                in_type(result).error_before
            ),
            Self::Unchanged => format!(
                "{} The tool is at most {} off.",
                result.unchanged_text().unwrap_or_default(),
                in_type(result).error_after
            ),
            Self::Missed { better } => missed(result, better),
            Self::WithinBefore => {
                let (after, allowed) = after_and_allowed(result);
                format!(
                    "Even without compensation the tool is at most {} off, within the {allowed} asked for; with the \
                     compensated program at most {after}.",
                    in_type(result).error_before
                )
            }
            Self::Corrected => format!(
                "Without compensation the tool is up to {} off; with the compensated program at most {}.",
                in_type(result).error_before,
                after_and_allowed(result).0
            ),
            Self::AtWorst => result.at_worst_text().unwrap_or_default(),
            Self::FeaturesMissed => {
                format!(
                    "The tolerance is missed of: {}.",
                    missed_features(result).join(", ")
                )
            }
            Self::Assumed(kind) => assumed(result, kind),
            Self::Tilt => tilt(result),
        }
    }
}

/// The sentences of an assumption, in English.
pub(crate) fn assumed(result: &RunResult, kind: AssumptionKind) -> String {
    let all = result.assessment.assumptions.iter();
    let found = all.filter(|assumption| assumption.kind == kind);
    let texts = found.map(|assumption| assumption.text.replace("+-", "±"));
    texts.collect::<Vec<_>>().join(" ")
}

/// Largest error with the written program beside what is allowed.
pub(crate) fn after_and_allowed(result: &RunResult) -> (String, String) {
    number::against(
        result.summary.max_position_error_after_mm,
        result.allowed_mm(),
    )
}

/// Largest error if an assumption fails, in figures of a report, beside what is allowed; none where nothing bounds it.
pub(crate) fn worst_and_allowed(result: &RunResult) -> (Option<String>, String) {
    let allowed = result.allowed_mm();
    match result.assessment.max_error_um {
        Some(um) => {
            let (worst, allowed) = number::against(1e-3 * um, allowed);
            (Some(worst), allowed)
        }
        None => (None, number::length_setting(allowed)),
    }
}

/// Names of features that miss their tolerance.
pub(crate) fn missed_features(result: &RunResult) -> Vec<&str> {
    let features = result.features.iter();
    let missed = features.filter(|feature| feature.held == Some(false));
    missed.map(|feature| feature.name.as_str()).collect()
}

fn missed(result: &RunResult, better: bool) -> String {
    let before = in_type(result).error_before;
    let (after, allowed) = after_and_allowed(result);
    let sentence = match better {
        true => format!(
            "Without compensation the tool is up to {before} off; with the compensated program it is still \
             up to {after} off, more than the {allowed} asked for."
        ),
        false => format!(
            "The compensated program is no better than the original: the tool is up to {before} off without \
             it and up to {after} with it, more than the {allowed} asked for."
        ),
    };
    match &result.tolerance.missed {
        Some(missed) => {
            // The reason is unknown for a program by others.
            let reason = match crate::text::clean(&missed.reason) {
                reason if reason.is_empty() => reason,
                reason => format!(": {reason}"),
            };
            format!(
                "The tolerance is missed, most at line {}{reason}. {sentence}",
                number::count(missed.line)
            )
        }
        None => format!("The tolerance is missed. {sentence}"),
    }
}

fn tilt(result: &RunResult) -> String {
    let angle = in_type(result).rotation;
    let inputs = &result.run_inputs;
    let beside = match (inputs.orientation_corrected, inputs.states_orientation) {
        (true, _) => "",
        (false, true) => ", which --correct pose corrects, too",
        (false, false) => ", which a program of positions cannot correct",
    };
    match inputs.compensated {
        true => format!("The tool stays tilted by up to {angle}{beside}."),
        false => format!("It tilts by up to {angle}."),
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
        let mut result = result.clone();
        result.assess();
        let result = &result;
        let assessment = assessment(result);
        (
            assessment.level,
            assessment.sentence(result).replace('\u{202f}', " "),
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
        let shown = "still up to 0.0120 mm off, more than the 0.6 µm asked for";
        assert!(text.contains(shown), "{text}");
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

    /// The costliest assumption decides level and first sentence; the others follow by what they cost.
    #[test]
    fn the_worst_of_what_is_stated_decides_the_level() {
        let mut result = run();
        let mut band = kinetostat_machining::ForceBand::default();
        band.max_error_if_larger_mm = Some(0.398);
        band.max_error_if_smaller_mm = Some(0.2);
        result.force_band = Some(band);
        result.summary.backward_steps = 3;
        result.summary.largest_backward_step_mm = 0.52;
        result.summary.backward_step_limit_mm = 0.05;
        result.assess();
        assert_eq!(result.assessment.max_error_um, Some(520.0));
        let kinds: Vec<AssumptionKind> = result
            .assessment
            .assumptions
            .iter()
            .map(|a| a.kind)
            .collect();
        let ranked = [AssumptionKind::BackwardSteps, AssumptionKind::ForceSpread];
        assert_eq!(kinds, ranked);
        let (level, text) = sentence(&result);
        assert_eq!(level, Level::Attention);
        let shown = "otherwise the tool is up to 0.520 mm off";
        assert!(text.contains(shown), "{text}");
        let at = |words: &str| {
            text.find(words)
                .unwrap_or_else(|| panic!("{words}: {text}"))
        };
        assert!(at("Against the direction of motion") < at("If the force of the cut"));
        // Within what is allowed all is well; without an equilibrium nothing bounds the error.
        result.run_inputs.asked_mm = Some(0.53);
        assert_eq!(sentence(&result).0, Level::Good);
        result
            .force_band
            .iter_mut()
            .for_each(|band| band.max_error_if_larger_mm = None);
        let (level, text) = sentence(&result);
        assert_eq!(level, Level::Attention);
        assert!(text.contains("nothing bounds the error"), "{text}");
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
