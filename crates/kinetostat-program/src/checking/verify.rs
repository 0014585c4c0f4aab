//! The last check before a written program is put in place: what it promises is read off its bytes.

use crate::checking::{Verification, Verifier};
use crate::error::{ProgramError, WriteError};
use crate::path::moves::Path;
use crate::reading::interpreting::interpret::interpret;
use crate::reading::options::ReadOptions;
use crate::text::program::Program;
use crate::writing::options::WriteOptions;
use crate::writing::written::Corrected;

/// Reads a written program with the same reader and checks what every written program satisfies:
///
/// - the motions read are the pieces accounted for, in the order of the input's blocks, and their
///   shares cover every block without gap;
/// - all are straight or the arcs that were fitted (no I J K R P is left in a straight one), and the codes are those of the input
///   (G1 for arcs that became straight), but for arcs that are kept as they were;
/// - no point is farther from the input's path than the largest correction (and the tolerances of
///   chords and rounding), looked at in places that follow no pattern;
/// - where the place is not known, and at places of the machine, the axes that a block names go where the input has
///   them: no correction is left in them, and G28, G30 and G53 are there byte for byte;
/// - the speed along the part is the programmed one within 0.1 %, or slower where the feed was held to
///   its largest, and the other axes reach what the input wanted;
/// - what is not a coordinate is there byte for byte, numbers are fixed-point with the decimals requested
///   for, no line is too long, the header is ASCII and marks the file;
/// - the blocks of the input are all accounted for.
///
/// # Errors
///
/// [`WriteError::Verification`] with the first promise that is broken.
pub fn verify_written(
    input: &Program,
    input_path: &Path,
    corrected: &Corrected,
    reading: &ReadOptions,
    writing: &WriteOptions,
) -> Result<Verification, WriteError> {
    let unreadable = |error: ProgramError| WriteError::Verification {
        line: 0,
        output_line: error.line,
        what: format!("it cannot be read again: {error}"),
    };
    let output = Program::read(corrected.bytes.clone()).map_err(unreadable)?;
    let output_path = interpret(&output, reading).map_err(unreadable)?;
    against_input(input, input_path, &output, &output_path, corrected, writing)
}

/// A written program that was read again, against the program that it was written from.
///
/// # Errors
/// As [`verify_written`].
pub(crate) fn against_input(
    input: &Program,
    input_path: &Path,
    output: &Program,
    output_path: &Path,
    corrected: &Corrected,
    writing: &WriteOptions,
) -> Result<Verification, WriteError> {
    let mut verifier = Verifier {
        input,
        input_path,
        output,
        pieces: &corrected.pieces,
        rotary_deg: &corrected.rotary_deg,
        accounting: &corrected.accounting,
        writing,
        found: Verification {
            lines: output.line_count(),
            moves: output_path.moves.len(),
            ..Verification::default()
        },
    };
    verifier.check_moves(output_path)?;
    verifier.check_text()?;
    Ok(verifier.found)
}
