//! Feed, spindle and pauses of a path on its lines and moves.

use crate::path::moves::{FeedMode, Move, MoveKind, Path, Pause};
use crate::path::spindle::Spindle;

impl Path {
    /// Spindle state in the block on a line.
    ///
    /// Words are taken in the order in which LinuxCNC executes those of one block: speed (S, in the mode that G96 or G97 of
    /// the same block sets), change of tools (M6, which stops the spindle), M3 M4 M5 M19, motion, end of program (M2 and M30,
    /// which stop it). A pause (M0, M1) changes nothing. Before the first word it stands still. An M5 beside a feed motion
    /// acts after it on some controllers ([`crate::MOMENTS`]); a warning names the line, and here it acts before.
    ///
    /// ```
    /// use kinetostat_program::*;
    ///
    /// let program = Program::read("G21\nM3 S900\nG0 X0 Y0 Z0\nT2 M6\nM4\nG1 X5 F90 S450\n")?;
    /// let path = interpret(&program, &ReadOptions::default())?;
    /// assert_eq!(path.spindle_on(4).rotation, SpindleRotation::Stopped);
    /// assert_eq!(path.spindle_on(5).rotation, SpindleRotation::CounterClockwise);
    /// assert_eq!(path.spindle_on(5).speed, Some(900.0));
    /// assert_eq!(path.spindle_on(6).speed, Some(450.0));
    /// # Ok::<(), ProgramError>(())
    /// ```
    #[must_use]
    pub fn spindle_on(&self, line: usize) -> Spindle {
        let after = self
            .spindle_changes
            .partition_point(|change| change.line <= line);
        let last = after.checked_sub(1).map(|i| self.spindle_changes[i]);
        last.map_or_else(Spindle::default, |change| change.spindle)
    }
}

impl Move {
    /// Way of the tool point in a turn of the spindle, in mm, while that turns at a speed in rpm: what is divided by the
    /// number of teeth is the feed per tooth. The speed does not matter with G95.
    ///
    /// `None` for a rapid, without an F, and where the spindle does not turn although the feed is one of time.
    ///
    /// ```
    /// use kinetostat_program::*;
    ///
    /// let program = Program::read("G21 G90\nS8000 M3\nG0 X0 Y0 Z0\nG1 X10 F960\n")?;
    /// let path = interpret(&program, &ReadOptions::default())?;
    /// let cut = &path.moves[1];
    /// let rpm = path.spindle_on(cut.line).rpm().unwrap();
    /// let teeth = 2.0;
    /// assert_eq!(cut.feed_mm_per_revolution(rpm).unwrap() / teeth, 0.06); // mm per tooth
    /// # Ok::<(), ProgramError>(())
    /// ```
    #[must_use]
    pub fn feed_mm_per_revolution(&self, rpm: f64) -> Option<f64> {
        let per_turn = |mm_per_minute: f64| (rpm > 0.0).then(|| mm_per_minute / rpm);
        let feed = self.feed.filter(|_| self.kind == MoveKind::Feed)?;
        match feed.mode {
            FeedMode::PerRevolution => Some(feed.value),
            FeedMode::PerMinute => per_turn(feed.value),
            FeedMode::InverseTime => per_turn(feed.value * self.length_mm()),
        }
    }

    /// Way of the tool point in a minute, in mm, while the spindle turns at a speed in rpm (which matters with G95 only).
    ///
    /// `None` for a rapid, whose speed is the machine's, and without an F.
    ///
    /// ```
    /// use kinetostat_program::*;
    ///
    /// let program = Program::read("G21 G90\nS1200 M3\nG0 X0 Y0 Z0\nG95 G1 X10 F0.25\n")?;
    /// let path = interpret(&program, &ReadOptions::default())?;
    /// assert_eq!(path.moves[1].feed_mm_per_minute(1200.0), Some(300.0));
    /// # Ok::<(), ProgramError>(())
    /// ```
    #[must_use]
    pub fn feed_mm_per_minute(&self, rpm: f64) -> Option<f64> {
        let feed = self.feed.filter(|_| self.kind == MoveKind::Feed)?;
        Some(match feed.mode {
            FeedMode::PerMinute => feed.value,
            FeedMode::PerRevolution => feed.value * rpm,
            FeedMode::InverseTime => feed.value * self.length_mm(),
        })
    }
}

/// Pauses between the moves of a path.
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
