//! Pauses between the moves of a path.

use crate::path::moves::Path;
use crate::path::pause::Pause;

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
