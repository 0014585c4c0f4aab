//! Subjects of the statements beside the moves.

/// Subject of an event.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
#[non_exhaustive]
pub enum EventKind {
    /// Spindle speed, start and stop.
    Spindle,
    /// Coolant on and off.
    Coolant,
    /// Another tool, its length.
    Tool,
    /// The tool stands still for some time.
    Dwell,
    /// Stop until somebody restarts the program.
    Stop,
    /// A loop that nothing leaves.
    Endless,
    /// Text for people.
    Comment,
    /// The end of the program.
    End,
    /// Anything else.
    Other,
}

impl EventKind {
    /// Description of the subject in reports of losses.
    pub(crate) fn words(self) -> &'static str {
        match self {
            Self::Spindle => "spindle",
            Self::Coolant => "coolant",
            Self::Tool => "tools",
            Self::Dwell => "dwells",
            Self::Stop => "stops",
            Self::Endless => "loops without an end",
            Self::Comment => "comments",
            Self::End => "end of the program",
            Self::Other => "other statements",
        }
    }
}
