//! From a program, its path and a field of corrections to the corrected program.

use nalgebra::Vector3;
use serde::Serialize;

use crate::accounting::Accounting;
use crate::divide::divide;
use crate::emit::Emitter;
use crate::error::WriteError;
use crate::field::{CorrectionField, Monitor};
use crate::path::Path;
use crate::program::Program;
use crate::turn::Turn;

/// How a corrected program is written.
#[derive(Debug, Clone, PartialEq)]
pub struct WriteOptions {
    /// How far straight pieces may leave the corrected curve because the correction varies, in mm.
    /// Default 0.0005.
    pub tolerance_mm: f64,
    /// Smallest jump of the correction (between blocks, where the load turns with the direction of
    /// motion, or inside one) that gets a step of its own, in mm; a smaller jump is taken up along the
    /// piece that follows. `None`, the default, is `tolerance_mm`.
    pub corner_step_mm: Option<f64>,
    /// How far the chords of an arc may leave it, in mm. Default 0.0004.
    pub chord_tolerance_mm: f64,
    /// A stretch this short (in mm) over which the correction still varies by more than the
    /// tolerance is taken for a jump: the tool steps there. Default 0.001.
    pub smallest_piece_mm: f64,
    /// How many times the programmed feed a piece may be written with, at least 1. More would be
    /// needed to keep the speed along the part where the tool's own path is much longer; there the part
    /// is cut more slowly instead. Default 1.2.
    pub max_feed_factor: f64,
    /// Length against the direction of motion from which on a step or a piece is warned of, in mm.
    /// Default 0.05.
    pub backward_step_mm: f64,
    /// Digits after the point in millimetres, one more in inches; `None` is 4 (and 5).
    pub decimals: Option<u8>,
    /// Lines of text for the header below the mark; `None` writes no header (and no mark).
    pub header: Option<Vec<String>>,
    /// Longest line written, in bytes without its ending. Default 250.
    pub max_line_bytes: usize,
    /// Largest number of pieces in all. Default ten million.
    pub max_pieces: usize,
    /// Whether a program that is marked as compensated may be compensated once more.
    pub again: bool,
}

impl Default for WriteOptions {
    fn default() -> Self {
        Self {
            tolerance_mm: 0.0005,
            corner_step_mm: None,
            chord_tolerance_mm: 0.0004,
            smallest_piece_mm: 0.001,
            max_feed_factor: 1.2,
            backward_step_mm: 0.05,
            decimals: None,
            header: Some(Vec::new()),
            max_line_bytes: 250,
            max_pieces: 10_000_000,
            again: false,
        }
    }
}

impl WriteOptions {
    fn check(&self) -> Result<(), WriteError> {
        let lengths = [
            ("tolerance_mm", self.tolerance_mm),
            ("corner_step_mm", self.smallest_step_mm()),
            ("chord_tolerance_mm", self.chord_tolerance_mm),
            ("smallest_piece_mm", self.smallest_piece_mm),
            ("backward_step_mm", self.backward_step_mm),
        ];
        for (name, value) in lengths {
            if !(1e-6..=10.0).contains(&value) {
                return Err(WriteError::Option {
                    name,
                    found: value.to_string(),
                    allowed: "0.000001 to 10 mm are allowed",
                });
            }
        }
        if !(1.0..=1000.0).contains(&self.max_feed_factor) {
            return Err(WriteError::Option {
                name: "max_feed_factor",
                found: self.max_feed_factor.to_string(),
                allowed: "1 to 1000 are allowed",
            });
        }
        if let Some(decimals) = self.decimals
            && !(3..=8).contains(&decimals)
        {
            return Err(WriteError::Option {
                name: "decimals",
                found: decimals.to_string(),
                allowed: "3 to 8 digits are allowed",
            });
        }
        if !(80..=65_000).contains(&self.max_line_bytes) {
            return Err(WriteError::Option {
                name: "max_line_bytes",
                found: self.max_line_bytes.to_string(),
                allowed: "80 to 65000 bytes are allowed",
            });
        }
        Ok(())
    }

    pub(crate) fn smallest_step_mm(&self) -> f64 {
        self.corner_step_mm.unwrap_or(self.tolerance_mm)
    }

    /// Half of the last digit that is written, in mm: what is smaller cannot be written.
    pub(crate) fn half_digit_mm(&self, mm_per_unit: f64) -> f64 {
        0.5 * mm_per_unit * 10_f64.powi(-(self.decimals_for(mm_per_unit) as i32))
    }

    /// Digits after the point of coordinate words in a unit of this size.
    pub(crate) fn decimals_for(&self, mm_per_unit: f64) -> usize {
        usize::from(self.decimals.unwrap_or(4)) + usize::from(mm_per_unit > 1.0)
    }
}

/// One motion of the written program: straight, but for arcs that are kept.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Piece {
    /// Index of the move it is a part of, in [`Path::moves`].
    pub move_index: usize,
    /// Share of the move's length at which it begins.
    pub share_from: f64,
    /// Share of the move's length at which it ends.
    pub share_to: f64,
    /// Where it begins as written (rounded), in mm, part frame.
    pub commanded_from: Vector3<f64>,
    /// Where it ends as written (rounded), in mm, part frame.
    pub commanded_to: Vector3<f64>,
    /// Line of the output, counted from 1.
    pub output_line: usize,
    /// A step at one place of the part, where the correction jumps.
    pub corner_step: bool,
    /// Which part of the load's turn such a step covers.
    pub turn: Option<Turn>,
    /// Whether the field's correction is in its end; otherwise the move is carried (its place is not
    /// known) or has no length.
    pub corrected: bool,
    /// An arc that stays an arc, because no correction on it could be written.
    pub kept_arc: bool,
    /// Its feed was held to [`WriteOptions::max_feed_factor`] times the programmed one, so the part is
    /// cut more slowly here than programmed.
    pub feed_limited: bool,
}

/// A written program.
#[derive(Debug, Clone, PartialEq)]
pub struct Corrected {
    /// The program, to be written to a file as it is.
    pub bytes: Vec<u8>,
    /// Its motions, in order.
    pub pieces: Vec<Piece>,
    /// What was done.
    pub accounting: Accounting,
}

/// Writes the program whose commanded path is the path plus the field's correction.
///
/// Feed moves are divided so that straight pieces follow the corrected curve; rapids keep one piece
/// and have their ends corrected. A feed move without length keeps the place of the move before. An
/// arc on which no correction reaches the last digit stays an arc. Everything else is carried byte for
/// byte, and a program of which nothing changes comes back as it is, without a header.
///
/// The speed along the part stays the programmed one: F of a piece is the programmed F times the
/// length written over the length on the part, written where the F in force is off by more than
/// 0.05 %, and never more than [`WriteOptions::max_feed_factor`] times the programmed F.
///
/// Call [`crate::verify_written`] before putting the result in place of a file.
///
/// # Errors
///
/// See [`WriteError`]; nothing is returned in part.
pub fn write_corrected(
    program: &Program,
    path: &Path,
    field: &dyn CorrectionField,
    options: &WriteOptions,
    monitor: &dyn Monitor,
) -> Result<Corrected, WriteError> {
    options.check()?;
    if let Some(line) = program.mark_line()
        && !options.again
    {
        return Err(WriteError::AlreadyCompensated { line });
    }
    let mut last = 0;
    for motion in &path.moves {
        let has_words = motion.line > last
            && program
                .lines()
                .get(motion.line - 1)
                .is_some_and(|line| !program.words(line).is_empty());
        if !has_words {
            return Err(WriteError::ForeignPath { line: motion.line });
        }
        last = motion.line;
    }
    let division = divide(path, field, options, monitor)?;
    Emitter::new(program, path, options, division).emit()
}
