//! Errors of programs, maps and writing, reported so that a person can mend them.

use std::ops::Range;

use nalgebra::Vector3;
use thiserror::Error;

/// Reason for which a program is refused.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum ProgramErrorKind {
    /// Bytes, words or numbers that no controller reads.
    Malformed,
    /// A code that is not known here, or whose motion is not.
    UnknownCode,
    /// Controllers do different things here, or the program has not stated what it rests on.
    Ambiguous,
    /// An arc that does not exist.
    Arc,
    /// A tool that is not known.
    Tool,
    /// Variables or expressions, which have values only while the program runs.
    Variables,
    /// A word that decides which blocks run.
    ControlStructure,
    /// A subprogram, a macro, or a call of one.
    Subprogram,
}

/// A program that is refused: where, what stands there, why, and what to do.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("line {line}: `{found}`: {reason}; {remedy}")]
#[non_exhaustive]
pub struct ProgramError {
    /// Kind of the refusal.
    pub kind: ProgramErrorKind,
    /// Line of the file, counted from 1.
    pub line: usize,
    /// Bytes of the file that are meant, counted from 0.
    pub span: Range<usize>,
    /// Text found there, shortened and without control characters.
    pub found: String,
    /// Reason of the refusal.
    pub reason: String,
    /// Remedy for the user.
    pub remedy: String,
}

/// Longest excerpt of a program quoted in a message, in characters.
const EXCERPT_CHARACTERS: usize = 60;

/// Text of a program made safe to print on a terminal: bytes that are not text and control
/// characters (a comment may hold escape codes) are shown as `?` or by their number.
pub(crate) fn excerpt(bytes: &[u8]) -> String {
    let text = String::from_utf8_lossy(bytes);
    let trimmed = text.trim();
    let mut shown = String::new();
    for (count, character) in trimmed.chars().enumerate() {
        if count == EXCERPT_CHARACTERS {
            shown.push_str("...");
            break;
        }
        if character == '\t' {
            shown.push(' ');
        } else if character.is_control() {
            shown.push_str(&format!("\\x{:02x}", u32::from(character)));
        } else {
            shown.push(character);
        }
    }
    shown
}

/// A map of corrections that is refused.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("line {line} of the map: {found}: {reason}; {remedy}")]
pub struct MapError {
    /// Line of the file, counted from 1.
    pub line: u64,
    /// Text found there.
    pub found: String,
    /// Reason of the refusal.
    pub reason: String,
    /// Remedy for the user.
    pub remedy: String,
}

/// Reason for which no corrected program was written.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum WriteError {
    /// The field has no correction for a point of the path.
    #[error(
        "line {line}: no correction at X{:.4} Y{:.4} Z{:.4} mm ({:.1} % along the block): {message}; \
         nothing was written", position_mm.x, position_mm.y, position_mm.z, share * 100.0
    )]
    Field {
        /// Line of the input program, counted from 1.
        line: usize,
        /// Share of the block's length, 0 at its start, 1 at its end.
        share: f64,
        /// The point requested, in mm, part axes.
        position_mm: Vector3<f64>,
        /// Message of the field.
        message: String,
    },
    /// The program carries the mark of a compensated one.
    #[error(
        "line {line}: the program is marked as compensated already; a second compensation would \
         count every correction twice: take the original program, or allow it explicitly (--again)"
    )]
    AlreadyCompensated {
        /// Line of the mark, counted from 1.
        line: usize,
    },
    /// A line would be longer than controllers read.
    #[error(
        "line {line}: the line would be written with {bytes} bytes, {limit} are allowed; shorten \
         its comment or put the comment on a line of its own"
    )]
    LineTooLong {
        /// Line of the input program, counted from 1.
        line: usize,
        /// Bytes the written line would have, without its line ending.
        bytes: usize,
        /// Maximum length of a line in bytes, `WriteOptions::max_line_bytes`.
        limit: usize,
    },
    /// An axis other than X, Y, Z cannot be shared out over the pieces of a block.
    #[error("line {line}: the block must be split, but its {letter} word cannot be: {reason}")]
    ExtraAxis {
        /// Line of the input program, counted from 1.
        line: usize,
        /// Letter of the axis.
        letter: char,
        /// Reason and remedy.
        reason: String,
    },
    /// A motion cannot be written with its correction.
    #[error("line {line}: {reason}; {remedy}")]
    Motion {
        /// Line of the input program, counted from 1.
        line: usize,
        /// Reason of the refusal.
        reason: String,
        /// Remedy for the user.
        remedy: String,
    },
    /// The correction varies so fast that the output would have no bound.
    #[error(
        "line {line}: more than {limit} pieces are needed to follow the correction; the field is \
         not smooth here: widen the tolerance or mend the field"
    )]
    TooManyPieces {
        /// Line of the input program, counted from 1.
        line: usize,
        /// Maximum number of pieces, `WriteOptions::max_pieces`.
        limit: usize,
    },
    /// An option is outside its range.
    #[error("{name} is {found}: {allowed}")]
    Option {
        /// Name of the option.
        name: &'static str,
        /// The value found.
        found: String,
        /// The values that are allowed, in words.
        allowed: &'static str,
    },
    /// The path was not read from this program.
    #[error(
        "the path has a move on line {line}, the program has none there: interpret this very program"
    )]
    ForeignPath {
        /// Line of the first move that does not fit, counted from 1.
        line: usize,
    },
    /// The monitor asked to stop.
    #[error("stopped on request; nothing was written")]
    Cancelled,
    /// The written program does not satisfy what every written program must.
    #[error(
        "the written program fails its last check at its line {output_line} (input line {line}): \
         {what}; nothing should be put in place of it, please report this"
    )]
    Verification {
        /// Line of the input program, counted from 1.
        line: usize,
        /// Line of the output, counted from 1.
        output_line: usize,
        /// Description of the error.
        what: String,
    },
}
