//! Blocks in which the tool stands still for some time.

/// A block in which the tool stands still.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Pause {
    /// Line of the block, counted from 1.
    pub line: usize,
    /// Kind of the pause.
    pub kind: PauseKind,
}

/// Kind of a pause.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum PauseKind {
    /// A dwell (G4) with the number of its P: seconds on some controllers, milliseconds on others.
    Dwell(f64),
    /// A dwell with X or U, which are seconds where controllers have them.
    DwellSeconds(f64),
    /// A dwell whose time is not stated, or is stated in turns of the spindle.
    DwellUnknown,
    /// A stop until somebody starts again (M0, M1, M60).
    Stop,
    /// A change of tools (M6).
    ToolChange,
}

impl PauseKind {
    /// Kind in words.
    ///
    /// ```
    /// use kinetostat_program::PauseKind;
    ///
    /// assert_eq!(PauseKind::ToolChange.description(), "a change of tools (M6)");
    /// ```
    #[must_use]
    pub fn description(self) -> &'static str {
        match self {
            Self::Dwell(_) | Self::DwellSeconds(_) | Self::DwellUnknown => "a dwell (G4)",
            Self::Stop => "a stop (M0, M1 or M60)",
            Self::ToolChange => "a change of tools (M6)",
        }
    }
}
