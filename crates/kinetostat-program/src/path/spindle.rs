//! How the spindle turns while a block is made, and what a feed is in a turn of it.

use std::f64::consts::TAU;

use crate::path::moves::{FeedMode, Move, MoveKind, Path};

/// Which way the spindle turns, seen from the spindle towards the part.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub enum SpindleRotation {
    /// M3, M13: a right-hand cutter cuts.
    Clockwise,
    /// M4, M14.
    CounterClockwise,
    /// M5, M19, a change of tools, the end of the program; and before the first of these words.
    #[default]
    Stopped,
}

/// How the S word counts.
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub enum SpeedMode {
    /// G97: turns in a minute.
    #[default]
    Constant,
    /// G96: constant surface speed, the spindle turning the faster the smaller the radius.
    ConstantSurface {
        /// The D beside G96: speed that is not exceeded, in rpm.
        most_rpm: Option<f64>,
    },
}

/// What the program says about the spindle.
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Serialize)]
pub struct Spindle {
    /// Which way it turns.
    pub rotation: SpindleRotation,
    /// How `speed` counts.
    pub mode: SpeedMode,
    /// The S in force: in rpm with G97, in m/min with G96 (feet are converted). `None` before the first S, after a change
    /// of G96 and G97 without S, and where it is not known whether an S beside G96 was in metres or feet.
    pub speed: Option<f64>,
}

impl Spindle {
    /// Turns in a minute, never negative; 0 while it stands still. `None` where the program has given no speed, and with
    /// G96, where the speed is that of a radius ([`Spindle::rpm_at_radius_mm`]).
    ///
    /// ```
    /// use kinetostat_program::*;
    ///
    /// let program = Program::read("G21 G90\nT1 M6\nS8000 M3\nG0 X0 Y0 Z0\nG1 X10 F960\nM30\n")?;
    /// let path = interpret(&program, &ReadOptions::default())?;
    /// let spindle = path.spindle_on(5);
    /// assert_eq!(spindle.rotation, SpindleRotation::Clockwise);
    /// assert_eq!(spindle.rpm(), Some(8000.0));
    /// assert_eq!(path.spindle_on(2).rpm(), Some(0.0));
    /// # Ok::<(), ProgramError>(())
    /// ```
    #[must_use]
    pub fn rpm(&self) -> Option<f64> {
        match (self.rotation, self.mode) {
            (SpindleRotation::Stopped, _) => Some(0.0),
            (_, SpeedMode::Constant) => self.speed,
            (_, SpeedMode::ConstantSurface { .. }) => None,
        }
    }

    /// Turns in a minute while the edge cuts at a distance from the spindle's axis, in mm: `v/(2 pi r)` with G96, at most
    /// the D beside it; what [`Spindle::rpm`] says with G97.
    ///
    /// `None` where the program has given no speed, and at the axis itself where it has given no largest one.
    ///
    /// ```
    /// use kinetostat_program::{SpeedMode, Spindle, SpindleRotation};
    ///
    /// let mode = SpeedMode::ConstantSurface { most_rpm: Some(2500.0) };
    /// let spindle = Spindle { rotation: SpindleRotation::Clockwise, mode, speed: Some(200.0) };
    /// let rpm = spindle.rpm_at_radius_mm(20.0).unwrap(); // 200 m/min on a diameter of 40 mm
    /// assert!((rpm - 1591.549).abs() < 1e-3);
    /// assert_eq!(spindle.rpm_at_radius_mm(0.0), Some(2500.0));
    /// ```
    #[must_use]
    pub fn rpm_at_radius_mm(&self, radius_mm: f64) -> Option<f64> {
        let SpeedMode::ConstantSurface { most_rpm } = self.mode else {
            return self.rpm();
        };
        if self.rotation == SpindleRotation::Stopped {
            return Some(0.0);
        }
        let rpm = 1000.0 * self.speed? / (TAU * radius_mm.abs());
        match most_rpm {
            // At the axis a speed of zero over a way of zero is no number: the largest speed holds.
            Some(most) => Some(if rpm <= most { rpm } else { most }),
            None => rpm.is_finite().then_some(rpm),
        }
    }
}

/// A block from which on the spindle turns otherwise.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct SpindleChange {
    /// Line of the first block that is made so, counted from 1. The stop of an M2 or M30 beside a motion holds from the
    /// line after it.
    pub line: usize,
    /// What holds from this block on.
    pub spindle: Spindle,
}

impl Path {
    /// How the spindle turns while the block on a line is made.
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
