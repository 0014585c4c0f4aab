//! Difference in a command of the two programs.

use kinetostat_machining::{Condition, OtherCondition};
use schemars::JsonSchema;
use serde::Serialize;

/// A word or a statement that one of both programs has and the other does not, or has otherwise.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub(crate) struct OtherWord {
    pub(crate) word: String,
    /// Line of the program; none where only the original has it.
    pub(crate) line: Option<usize>,
    /// Line of the original; none where only the program has it.
    pub(crate) line_of_original: Option<usize>,
    /// True if it names a frame.
    pub(crate) is_frame: bool,
    /// Fault of the program; none for a warning, if the program may be right.
    pub(crate) fault: Option<FaultKind>,
    /// Text of the message.
    pub(crate) text: String,
}

/// Kind of difference from the original.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub(crate) enum FaultKind {
    Frame,
    Tool,
    Spindle,
    Rotation,
    Feed,
    PathMode,
    /// Sequence of the motions.
    Course,
}

impl FaultKind {
    /// Start of the text of a fault.
    pub(crate) fn words(self) -> &'static str {
        match self {
            Self::Frame => "ANOTHER FRAME",
            Self::Tool => "ANOTHER TOOL",
            Self::Spindle => "ANOTHER SPEED OF THE SPINDLE",
            Self::Rotation => "THE SPINDLE DOES NOT TURN AS IN THE ORIGINAL",
            Self::Feed => "ANOTHER FEED",
            Self::PathMode => "ANOTHER PATH MODE",
            Self::Course => "ANOTHER COURSE OF THE PROGRAM",
        }
    }
}

/// Consequence of another path mode.
pub(crate) const OTHER_PATH_MODE: &str = ": the control follows the path otherwise, and leaves its corners by what that allows; nothing here has that in it";

/// Consequence of another feed or speed if forces are computed.
const OTHER_FORCES: &str = ": the forces that the program is corrected for come from that cut";

/// Line of the program and of the original; none of the one that does not have the word.
pub(crate) type Lines = [Option<usize>; 2];

impl OtherWord {
    pub(crate) fn new(
        word: impl Into<String>,
        fault: Option<FaultKind>,
        [line, line_of_original]: Lines,
        text: String,
    ) -> Self {
        Self {
            word: word.into(),
            line,
            line_of_original,
            is_frame: fault == Some(FaultKind::Frame),
            fault,
            text,
        }
    }

    /// Cuts that are made with another value than in the original; `source` says where a line of that came from.
    pub(crate) fn at_cuts(
        [first, last, there]: [usize; 3],
        [own, of_original]: [&str; 2],
        fault: Option<FaultKind>,
        follows: &str,
        source: &dyn Fn(usize) -> String,
    ) -> Self {
        let cut = match first == last {
            true => format!("line {first} cuts"),
            false => format!("lines {first} to {last} cut"),
        };
        let text = format!(
            "{cut} with {own}, the original with {of_original} (line {there}{} there){follows}",
            source(there)
        );
        Self::new(own, fault, [Some(first), Some(there)], text)
    }

    /// Another feed or spindle along the path.
    pub(crate) fn of_condition(
        other: &OtherCondition,
        forces_from_cut: bool,
        source: &dyn Fn(usize) -> String,
    ) -> Self {
        let (fault, follows) = match other.condition {
            Condition::Feed if forces_from_cut => (FaultKind::Feed, OTHER_FORCES),
            Condition::Feed => (FaultKind::Feed, ""),
            Condition::Spindle if forces_from_cut => (FaultKind::Spindle, OTHER_FORCES),
            Condition::Spindle => (FaultKind::Spindle, ""),
            Condition::Rotation => (FaultKind::Rotation, ""),
        };
        let [first, last] = other.lines;
        let lines = [first, last, other.line_of_original];
        let said = [other.of_program.as_str(), &other.of_original];
        Self::at_cuts(lines, said, Some(fault), follows, source)
    }

    /// Text about a word in only one of the programs.
    pub(crate) fn only_in_one(word: &str, lines: Lines) -> String {
        match lines {
            [Some(line), _] => format!("{word} at line {line} is not in the original"),
            [None, of] => format!(
                "{word} at line {} of the original is not in this program",
                of.unwrap_or(0)
            ),
        }
    }

    /// The fault as a sentence, if it is one.
    pub(crate) fn fault_text(&self) -> Option<String> {
        let fault = self.fault?;
        Some(format!("{}: {}.", fault.words(), self.text))
    }
}
