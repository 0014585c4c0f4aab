//! Spindle state of a block, and conversion of feed per revolution.

/// Direction of the spindle, seen from the spindle towards the part.
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

/// Speed mode, the meaning of the S word.
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

/// Spindle state that the program states.
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Serialize)]
pub struct Spindle {
    /// Direction of rotation.
    pub rotation: SpindleRotation,
    /// Speed mode of `speed`.
    pub mode: SpeedMode,
    /// The S in force: in rpm with G97, in m/min with G96 (feet are converted). `None` before the first S, after a change
    /// of G96 and G97 without S, and where it is not known whether an S beside G96 was in metres or feet.
    pub speed: Option<f64>,
}

impl Spindle {
    /// Turns in a minute, never negative; 0 while it stands still. `None` where the program has given no speed, and with
    /// G96, where the speed is that of a radius.
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
}

/// A block from which on the spindle turns otherwise.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct SpindleChange {
    /// Line of the first block that is made so, counted from 1. The stop of an M2 or M30 beside a motion holds from the
    /// line after it.
    pub line: usize,
    /// State from this block on.
    pub spindle: Spindle,
}
