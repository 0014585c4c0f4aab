//! Blocks in which the tool stands still for some time.

use crate::path::moves::Path;

/// A block in which the tool stands still.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Pause {
    /// Line of the block, counted from 1.
    pub line: usize,
    /// Why.
    pub kind: PauseKind,
}

/// Why a tool stands still.
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
    /// In words.
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

impl Path {
    /// Blocks behind that of a move in which the tool stands still, up to that of another: in the order of lines.
    ///
    /// ```
    /// use kinetostat_program::{PauseKind, Program, ReadOptions, interpret};
    ///
    /// let program = Program::read("G21\nG0 X0 Y0 Z0\nG4 P2\nG1 X9 F100\nM6 T2\nG1 X0\n")?;
    /// let path = interpret(&program, &ReadOptions::default())?;
    /// let between: Vec<_> = path.pauses_between(2, 4).map(|pause| pause.kind).collect();
    /// assert_eq!(between, [PauseKind::Dwell(2.0)]);
    /// assert_eq!(path.pauses_between(4, 6).next().unwrap().line, 5);
    /// # Ok::<(), kinetostat_program::ProgramError>(())
    /// ```
    pub fn pauses_between(&self, after: usize, before: usize) -> impl Iterator<Item = &Pause> {
        let first = self.pauses.partition_point(|pause| pause.line <= after);
        let behind = self.pauses[first..].iter();
        behind.take_while(move |pause| pause.line < before)
    }
}
