//! Warnings for a person who did not ask for them: one list, made once, shown on the terminal, in JSON and in the
//! report.

use std::fmt;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::flat_program::FlatProgram;

/// Kind of a warning: a stable word for programs that read the JSON. Kinds may be added.
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, JsonSchema, Deserialize,
)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum WarningCode {
    /// Something in the program, found while it was read.
    Program,
    /// Something in the written program.
    Writing,
    /// Blocks that the check of the written program found off, and that were divided again.
    DividedAgain,
    /// Something in the model file that looks wrong.
    Model,
    /// An equilibrium that the machine would leave.
    NotStable,
    /// The program is scaled.
    Scaled,
    /// The machine turns its tool as it moves.
    OrientationFollows,
    /// A singular posture is near.
    NearSingular,
    /// A feed motion in which an arm changes its configuration, or passes beside a singular posture.
    PostureChanges,
    /// A joint that turns on and on in a cut, and meets a limit so.
    JointTurnsOn,
    /// The program states another configuration of the arm than that in which the model reaches the place.
    OtherConfiguration,
    /// More blocks per second than the controller takes.
    BlocksPerSecond,
    /// A feature on whose lines nothing is cut.
    EmptyFeature,
    /// A figure beyond a limit, in an analysis that writes no program.
    OverLimit,
    /// A figure that comes near a limit.
    NearLimit,
    /// Corrections that are allowed and unusually large.
    LargeCorrection,
    /// Corrections that are smaller than the tolerance.
    SmallCorrection,
    /// A table of corrections that is far wider than the program.
    WideTable,
    /// A tolerance that is unusually wide.
    WideTolerance,
    /// The tool is held unusually softly or stiffly.
    OddStiffness,
    /// A load that is unusually small.
    SmallLoad,
    /// A load that is unusually large.
    LargeLoad,
    /// A moment that does not belong to its force.
    LongLever,
    /// A force that pulls the tool into the part.
    PullingForce,
    /// A rapid goes through material.
    RapidThroughStock,
    /// The tool goes down into material with its whole end.
    Plunge,
    /// The force changes faster in a cut than the correction may.
    ForceChangesFast,
    /// The correction changes faster along the path than is stated for the load.
    CorrectionChangesFast,
    /// A verified program has another feed, spindle, tool or frame than its original.
    OtherThanOriginal,
    /// A load that acts nowhere along the program.
    LoadNeverActs,
    /// A program of a robot that does not start the spindle as its source does.
    SpindleNotStarted,
    /// The question says nothing of a tool.
    NoTool,
    /// Weight is to be corrected of a machine that has none.
    NoWeight,
    /// A tool that is very short, or long beside the machine.
    OddTool,
    /// An uncertain number that several limbs share, so that it scatters in all of them together.
    SharedNumber,
    /// The question says nothing of the place of the part, in which the machine's base then stands, or beside it.
    NoPlacement,
    /// A place of the part, or an angle of the job, that looks like one in another unit.
    OddPlacement,
    /// The tool's axis that is stated, or usual, lies along the cut.
    OddToolAxis,
    /// The tool lies along a rotary axis, whose angle is not corrected there.
    AtPole,
    /// The tip of the tool lies behind the flange, on the side of the holder.
    TipBehindFlange,
    /// The program leaves the workspace that the model states.
    OutsideWorkspace,
    /// A place that the machine cannot take exactly: the nearest one is used.
    NearestPlace,
    /// Nothing can be solved at the machine's home.
    UnsolvedHome,
    /// A load that has no equilibrium.
    NoEquilibrium,
    /// A direction without any stiffness.
    FreeDirection,
    /// Stiffnesses that lie so far apart that digits of the small ones are lost.
    UnevenStiffness,
    /// A large share of the way to buckling.
    NearBuckling,
    /// The machine snaps into another shape on the way to the load.
    Snaps,
    /// A load without a potential: divergence is examined, flutter (oscillation with growing amplitude) is not.
    NoPotential,
    /// A displacement that is large beside the machine.
    LargeDisplacement,
    /// A curve that ends, or was cut, before its range does.
    CurveEnds,
    /// A search for equilibria that ended before it was complete.
    SearchEnds,
    /// Branches cross that are not followed.
    MoreBranches,
    /// Chips of another thickness than those with which the material was measured.
    ChipsOutsideMeasured,
    /// A cutting speed at which the material was not measured.
    SpeedOutsideMeasured,
    /// A feed per tooth, or a chip, beyond what the tool bears.
    ChipOverLimit,
    /// A cut that asks more of the spindle than it has.
    SpindleExceeded,
    /// A cut that is deeper than the edges of its tool, or than the tool stands out of its holder.
    ToolTooShort,
    /// Values of a log that no neighbour bears out.
    OutliersInLog,
    /// A time or length over which a log has no rows.
    GapInLog,
    /// Moves that the log of the forces does not cover.
    NotMeasured,
    /// A force that was measured in a rapid.
    ForceInRapid,
    /// A move of which nobody knows how long it takes.
    TimeUnknown,
    /// A cut that nobody makes: its feed, depth, speed or run-out.
    ImplausibleCut,
    /// Lines of the program that chatter.
    Chatters,
    /// Cuts of which it is not said whether they chatter, or said of another arc than theirs.
    ChatterNotJudged,
    /// A fitted coefficient that hardly any material has.
    ImplausibleCoefficient,
    /// A fitted coefficient that is hardly known.
    UncertainCoefficient,
    /// Too few feeds for a fit, feeds close together, far apart or in another unit.
    FeedsOfFit,
    /// A mean force far beside the line through the others.
    OutliersInMeans,
    /// Mean forces that do not follow a straight line over the feed.
    PoorFit,
}

/// Something a person should know and did not ask for.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, JsonSchema, Deserialize)]
pub struct Warning {
    /// Kind of the warning.
    pub code: WarningCode,
    /// Finding and its consequence.
    pub message: String,
    /// Line, from 1; `None` if it speaks of all of a file.
    pub line: Option<usize>,
    /// File of that line; `None` for the program, and where it speaks of no file.
    pub file: Option<String>,
    /// Source line of the line in a program that was written flat.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub source_line: Option<usize>,
    /// The file of that line.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub source_file: Option<String>,
}

impl Warning {
    /// About the whole run, or about the question.
    #[must_use]
    pub fn new(code: WarningCode, message: impl Into<String>) -> Self {
        Self {
            code,
            message: message.into(),
            line: None,
            file: None,
            source_line: None,
            source_file: None,
        }
    }

    /// About a line of the program.
    #[must_use]
    pub fn at_line(code: WarningCode, line: usize, message: impl Into<String>) -> Self {
        Self {
            line: Some(line),
            ..Self::new(code, message)
        }
    }

    /// A warning of reading or writing a program, with its line.
    #[must_use]
    pub fn of_program(code: WarningCode, found: &kinetostat_program::Warning) -> Self {
        Self::at_line(code, found.line, found.text.clone())
    }

    /// Assigns the warning to another file than the program.
    #[must_use]
    pub fn of_file(mut self, file: impl Into<String>) -> Self {
        self.file = Some(file.into());
        self
    }

    /// Adds the source lines of a program that was written flat.
    ///
    /// ```
    /// use kinetostat_machining::{FlatProgram, Warning, WarningCode};
    ///
    /// let flat = FlatProgram::new(vec!["plate.ngc".to_owned()], 2, vec![(0, 1), (0, 7)]);
    /// let warning = Warning::at_line(WarningCode::Plunge, 2, "a plunge").with_sources(&flat);
    /// assert_eq!(warning.to_string(), "line 7 of plate.ngc (line 2 of the flat program): a plunge");
    /// ```
    #[must_use]
    pub fn with_sources(mut self, flat: &FlatProgram) -> Self {
        if self.file.is_none() {
            self.message = flat.with_sources(&self.message);
            if let Some((file, line)) = self.line.and_then(|line| flat.source_of(line)) {
                self.source_line = Some(line);
                self.source_file = Some(file.to_owned());
            }
        }
        self
    }
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let (Some(file), Some(from), Some(line)) =
            (&self.source_file, self.source_line, self.line)
        {
            return write!(
                f,
                "line {from} of {file} (line {line} of the flat program): {}",
                self.message
            );
        }
        match (&self.file, self.line) {
            (Some(file), Some(line)) => write!(f, "{file}, line {line}: {}", self.message),
            (Some(file), None) => write!(f, "{file}: {}", self.message),
            (None, Some(line)) => write!(f, "line {line}: {}", self.message),
            (None, None) => f.write_str(&self.message),
        }
    }
}

/// Warnings with those of one kind put together: same code, file and words, whatever the numbers are. The one with the largest
/// first number that differs counts as the worst; its message ends with the count, the first place and the worst one.
///
/// ```
/// use kinetostat_machining::{Warning, WarningCode, merged};
///
/// let thick = |line, mm: f64| {
///     Warning::at_line(WarningCode::ChipOverLimit, line, format!("a chip of {mm} mm"))
/// };
/// let one = merged(vec![thick(4, 0.2), thick(7, 0.5), thick(9, 0.3)]);
/// assert_eq!(
///     one[0].to_string(),
///     "line 7: a chip of 0.5 mm (the worst of 3 of this kind; the first at line 4, the last at line 9)"
/// );
/// ```
#[must_use]
pub fn merged(all: Vec<Warning>) -> Vec<Warning> {
    let mut kinds: Vec<(Vec<String>, Vec<Warning>)> = Vec::new();
    for warning in all {
        let (words, _) = words_and_numbers(&warning.message);
        let same = |(own, list): &&mut (Vec<String>, Vec<Warning>)| {
            let first = &list[0];
            *own == words && first.code == warning.code && first.file == warning.file
        };
        match kinds.iter_mut().find(same) {
            Some((_, list)) if !list.contains(&warning) => list.push(warning),
            Some(_) => {}
            None => kinds.push((words, vec![warning])),
        }
    }
    kinds.into_iter().map(|(_, list)| worst(list)).collect()
}

/// The worst warning of one kind, with their count and places.
fn worst(mut list: Vec<Warning>) -> Warning {
    let numbers: Vec<Vec<f64>> = list
        .iter()
        .map(|warning| words_and_numbers(&warning.message).1)
        .collect();
    let differs = |k: &usize| numbers.iter().any(|own| own.get(*k) != numbers[0].get(*k));
    let deciding = (0..numbers[0].len()).find(differs);
    let size = |i: usize| {
        deciding
            .and_then(|k| numbers[i].get(k))
            .copied()
            .unwrap_or(0.0)
    };
    // The first of equal ones is kept.
    let index = (0..list.len())
        .rev()
        .max_by(|a, b| size(*a).abs().total_cmp(&size(*b).abs()));
    let count = list.len();
    let lines = list.iter().filter_map(|warning| warning.line);
    let ends = lines.clone().min().zip(lines.max());
    let mut worst = list.swap_remove(index.unwrap_or(0));
    if count > 1 {
        let which = match deciding {
            Some(_) => "the worst",
            None => "the first",
        };
        let places = ends.map_or_else(String::new, |(first, last)| match deciding {
            Some(_) => format!("; the first at line {first}, the last at line {last}"),
            None => format!("; the last at line {last}"),
        });
        let more = format!(" ({which} of {count} of this kind{places})");
        worst.message.push_str(&more);
    }
    worst
}

/// Words of a message, and its numbers; coordinates such as `X12.3` and counts of lines are neither.
fn words_and_numbers(text: &str) -> (Vec<String>, Vec<f64>) {
    let (mut words, mut numbers) = (Vec::new(), Vec::new());
    let mut is_line = false;
    for token in text.split_whitespace() {
        let bare = token.trim_matches(|c: char| !c.is_alphanumeric() && c != '-');
        let digits = bare.trim_start_matches(|c: char| "XYZ".contains(c));
        match digits.parse::<f64>() {
            Ok(value) if digits.len() == bare.len() && !is_line => numbers.push(value),
            Ok(_) => {}
            Err(_) => words.push(token.to_owned()),
        }
        is_line = bare == "line" || bare == "lines";
    }
    (words, numbers)
}
