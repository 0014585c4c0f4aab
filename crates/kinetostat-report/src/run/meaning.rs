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

/// The result of a run against its tolerance: how good it is, and what is to be said of it, in this order.
pub(crate) struct RunAssessment {
    pub(crate) level: Level,
    pub(crate) statements: Vec<Statement>,
}

/// What is said of a run. It holds no words, so that every language says the same.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Statement {
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
    /// Features that miss their tolerance.
    FeaturesMissed,
    /// What the machine's own weight does.
    OwnWeight,
    /// What is assumed at corners.
    Corners,
    /// Over which length the load comes.
    Ramp,
    /// What another force does.
    ForceBand,
    /// What other machines do.
    Uncertainty,
    /// The tilt that stays.
    Tilt,
}

/// Compares a run with its tolerance.
pub(crate) fn assessment(result: &RunResult) -> RunAssessment {
    let summary = &result.summary;
    let only = |level, statement| RunAssessment {
        level,
        statements: vec![statement],
    };
    if summary.points == 0 && result.points.is_empty() {
        return only(Level::Attention, Statement::NoPoint);
    }
    if !summary.stable {
        let line = first_unstable_line(result);
        return only(Level::Stop, Statement::Unstable { line });
    }
    if !summary.converged {
        return only(Level::Stop, Statement::NotConverged);
    }
    let (mut level, main) = match result.run_inputs.compensated {
        true => compensated(result),
        false => analysed(result),
    };
    let missed = result.features.iter().any(|f| f.held == Some(false));
    if missed && level != Level::Stop && result.run_inputs.compensated {
        level = Level::Attention;
    }
    let beside = [
        (cuts_without_load(result), Statement::NoLoad),
        (true, main),
        (missed, Statement::FeaturesMissed),
        (result.own_weight_text().is_some(), Statement::OwnWeight),
        (result.corners_text().is_some(), Statement::Corners),
        (result.ramp_text().is_some(), Statement::Ramp),
        (result.force_band.is_some(), Statement::ForceBand),
        (result.uncertainty.is_some(), Statement::Uncertainty),
        (
            summary.max_residual_rotation_deg > SMALLEST_ROTATION,
            Statement::Tilt,
        ),
    ];
    let said = beside.into_iter().filter(|(is_said, _)| *is_said);
    RunAssessment {
        level,
        statements: said.map(|(_, statement)| statement).collect(),
    }
}

fn analysed(result: &RunResult) -> (Level, Statement) {
    match result.summary.max_position_error_before_mm.is_finite() {
        true => (Level::Analysis, Statement::Analysed),
        false => (Level::Stop, Statement::Unknown),
    }
}

fn compensated(result: &RunResult) -> (Level, Statement) {
    let before = result.summary.max_position_error_before_mm;
    let after = result.summary.max_position_error_after_mm;
    if !before.is_finite() || !after.is_finite() {
        return (Level::Stop, Statement::Unknown);
    }
    if result.unchanged_text().is_some() {
        return (Level::Unchanged, Statement::Unchanged);
    }
    if result.holds_tolerance() != Some(true) {
        let better = after < before;
        return (Level::Attention, Statement::Missed { better });
    }
    match before <= result.allowed_mm() {
        true => (Level::Good, Statement::WithinBefore),
        false => (Level::Good, Statement::Corrected),
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
    /// In English.
    pub(crate) fn sentence(self, result: &RunResult) -> String {
        match self {
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
            Self::FeaturesMissed => {
                format!(
                    "The tolerance is missed of: {}.",
                    missed_features(result).join(", ")
                )
            }
            Self::OwnWeight => result.own_weight_text().unwrap_or_default(),
            Self::Corners => result.corners_text().unwrap_or_default(),
            Self::Ramp => result.ramp_text().unwrap_or_default(),
            Self::ForceBand => result.force_band_text().unwrap_or_default(),
            Self::Uncertainty => {
                let band = result.uncertainty_text().unwrap_or_default();
                band.replace("+-", "±")
            }
            Self::Tilt => tilt(result),
        }
    }
}

/// Largest error with the written program beside what is allowed.
pub(crate) fn after_and_allowed(result: &RunResult) -> (String, String) {
    number::against(
        result.summary.max_position_error_after_mm,
        result.allowed_mm(),
    )
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
            // Of a program of others the reason is not known.
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
