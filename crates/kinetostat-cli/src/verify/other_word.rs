//! What one of both programs says and the other does not.

use serde::Serialize;

/// A word or a statement that one of both programs has and the other does not, or has otherwise.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct OtherWord {
    pub(crate) word: String,
    /// Line of the program; none where only the original has it.
    pub(crate) line: Option<usize>,
    /// Line of the original; none where only the program has it.
    pub(crate) line_of_original: Option<usize>,
    /// Whether it names a frame.
    pub(crate) is_frame: bool,
    /// What it is a fault of; none where it is told and the program may be right.
    pub(crate) fault: Option<FaultKind>,
    /// What is said of it.
    pub(crate) text: String,
}

/// What is another one than in the original.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum FaultKind {
    Frame,
    Tool,
    Spindle,
}

impl FaultKind {
    /// As a fault begins.
    pub(crate) fn words(self) -> &'static str {
        match self {
            Self::Frame => "ANOTHER FRAME",
            Self::Tool => "ANOTHER TOOL",
            Self::Spindle => "ANOTHER SPEED OR DIRECTION OF THE SPINDLE",
        }
    }
}

impl OtherWord {
    /// The fault as a sentence, if it is one.
    pub(crate) fn fault_text(&self) -> Option<String> {
        let fault = self.fault?;
        Some(format!("{}: {}.", fault.words(), self.text))
    }
}
