//! The last check before a written program is put in place: what it promises is read off its bytes.

use std::ops::Range;

use serde::Serialize;

use crate::accounting::Accounting;
use crate::curve::Curve;
use crate::error::{ProgramError, WriteError};
use crate::header::lines_above;
use crate::interpret::interpret;
use crate::number::decimals_of;
use crate::options::ReadOptions;
use crate::path::{ExtraMode, FeedMode, Knowledge, Move, MoveKind, Path};
use crate::program::{Line, Program, Word};
use crate::render::motion_word;
use crate::write::{Corrected, Piece, WriteOptions};

/// Largest difference between a place as written and as read again, in mm: arithmetic only.
const SAME_PLACE_MM: f64 = 1e-6;

/// Largest relative error of the speed along the part.
const SPEED_TOLERANCE: f64 = 1e-3;

/// What the check found in a program that passed.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct Verification {
    /// Lines of the output that were read.
    pub lines: usize,
    /// Motions of the output that were read.
    pub moves: usize,
    /// Largest distance of the output's path from the input's, in mm.
    pub largest_distance_mm: f64,
    /// Largest relative difference of the speed along the part from the programmed one.
    pub largest_speed_error: f64,
    /// Longest line, in bytes.
    pub longest_line_bytes: usize,
}

/// Reads a written program with the same reader and checks what every written program satisfies:
///
/// - the motions read are the pieces accounted for, in the order of the input's blocks, and their
///   shares cover every block without gap;
/// - all are straight, no I J K R P is left in them, and the codes are those of the input (G1 for the
///   arcs);
/// - no point is farther from the input's path than the largest correction (and the tolerances of
///   chords and rounding);
/// - the speed along the part is the programmed one within 0.1 %, and the other axes reach what the
///   input wanted;
/// - what is not a coordinate is there byte for byte, numbers are fixed-point with the decimals asked
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
    let mut verifier = Verifier {
        input,
        input_path,
        output: &output,
        pieces: &corrected.pieces,
        accounting: &corrected.accounting,
        writing,
        found: Verification {
            lines: output.line_count(),
            moves: output_path.moves.len(),
            ..Verification::default()
        },
    };
    verifier.check_moves(&output_path)?;
    verifier.check_text()?;
    Ok(verifier.found)
}

struct Verifier<'a> {
    input: &'a Program,
    input_path: &'a Path,
    output: &'a Program,
    pieces: &'a [Piece],
    accounting: &'a Accounting,
    writing: &'a WriteOptions,
    found: Verification,
}

impl Verifier<'_> {
    fn check_moves(&mut self, output_path: &Path) -> Result<(), WriteError> {
        let count = output_path.moves.len();
        if count != self.pieces.len() {
            return Err(fail(
                0,
                0,
                format!(
                    "{count} motions are read, {} were written",
                    self.pieces.len()
                ),
            ));
        }
        let mut expected = (0, 0.0);
        for (piece, read) in self.pieces.iter().zip(&output_path.moves) {
            let Some(motion) = self.input_path.moves.get(piece.move_index) else {
                return Err(fail(0, piece.output_line, "a piece of no move".to_owned()));
            };
            let broken = |what: String| Err(fail(motion.line, piece.output_line, what));
            if (piece.move_index, piece.share_from) != expected {
                return broken(
                    "the pieces are not in the order of the path, or one is missing".to_owned(),
                );
            }
            expected = if piece.share_to >= 1.0 {
                (piece.move_index + 1, 0.0)
            } else {
                (piece.move_index, piece.share_to)
            };
            if read.line != piece.output_line
                || read.kind != motion.kind
                || read.curve != Curve::Line
            {
                return broken("the motion read is another than the one written".to_owned());
            }
            let start = (read.start - piece.commanded_from).norm();
            let end = (read.end - piece.commanded_to).norm();
            // Where an axis is not known yet, only its later places can be compared.
            if end > SAME_PLACE_MM || start > SAME_PLACE_MM && motion.known == Knowledge::Whole {
                return broken(format!(
                    "its place is read {:.7} mm away from where it was written",
                    start.max(end)
                ));
            }
            self.check_distance(motion, piece)?;
            self.check_speed(motion, piece, read)?;
            check_extra_axes(motion, piece, read)?;
        }
        if expected != (self.input_path.moves.len(), 0.0) {
            return Err(fail(
                0,
                0,
                "the last moves of the input are missing".to_owned(),
            ));
        }
        Ok(())
    }

    fn check_distance(&mut self, motion: &Move, piece: &Piece) -> Result<(), WriteError> {
        if motion.known != Knowledge::Whole {
            return Ok(());
        }
        let unit = motion.words.mm_per_unit;
        let rounding = unit * 10_f64.powi(-(self.writing.decimals_for(unit) as i32));
        let mut allowed = self.accounting.largest_correction_mm + rounding + SAME_PLACE_MM;
        if motion.curve != Curve::Line {
            // A chord is compared with its arc at equal shares, which are not quite the nearest points.
            allowed += 2.0 * self.writing.chord_tolerance_mm;
        }
        for part in [0.25, 0.5, 0.75, 1.0] {
            if motion.kind == MoveKind::Rapid && part < 1.0 {
                continue;
            }
            let share = piece.share_from + (piece.share_to - piece.share_from) * part;
            let commanded = piece.commanded_from.lerp(&piece.commanded_to, part);
            let distance = (commanded - motion.point(share)).norm();
            self.found.largest_distance_mm = self.found.largest_distance_mm.max(distance);
            if distance > allowed {
                return Err(fail(
                    motion.line,
                    piece.output_line,
                    format!(
                        "it leaves the input's path by {distance:.5} mm, {allowed:.5} mm are allowed"
                    ),
                ));
            }
        }
        Ok(())
    }

    fn check_speed(&mut self, motion: &Move, piece: &Piece, read: &Move) -> Result<(), WriteError> {
        let Some(feed) = motion.feed.filter(|_| motion.kind == MoveKind::Feed) else {
            return Ok(());
        };
        let Some(written) = read.feed.filter(|written| written.mode == feed.mode) else {
            return Err(fail(
                motion.line,
                piece.output_line,
                "the feed is lost".to_owned(),
            ));
        };
        let length = (piece.commanded_to - piece.commanded_from).norm();
        let part = motion.length_between_mm(piece.share_from, piece.share_to);
        let known = motion.known == Knowledge::Whole;
        let speed = match feed.mode {
            FeedMode::InverseTime if piece.corner_step && length > 0.0 => {
                written.value * length / motion.length_mm()
            }
            FeedMode::InverseTime if part > 0.0 => written.value * part / motion.length_mm(),
            FeedMode::PerMinute | FeedMode::PerRevolution
                if known && part > 0.0 && length > 0.0 =>
            {
                written.value * part / length
            }
            _ => written.value,
        };
        let error = (speed / feed.value - 1.0).abs();
        self.found.largest_speed_error = self.found.largest_speed_error.max(error);
        if error > SPEED_TOLERANCE {
            return Err(fail(
                motion.line,
                piece.output_line,
                format!("its speed along the part is off by {:.3} %", error * 100.0),
            ));
        }
        Ok(())
    }

    fn check_text(&mut self) -> Result<(), WriteError> {
        let mut output = self.output.lines().iter().enumerate();
        let mut moves = self.input_path.moves.iter().enumerate().peekable();
        let mut pieces = self.pieces.iter().peekable();
        let header_at = lines_above(self.input);
        let mut blocks = 0;
        if self.input.bytes()[..self.input.first_byte()]
            != self.output.bytes()[..self.output.first_byte()]
        {
            return Err(fail(1, 1, "the byte order mark differs".to_owned()));
        }
        for (index, line) in self.input.lines().iter().enumerate() {
            if index == header_at {
                self.check_header(&mut output)?;
            }
            let mut group = Vec::new();
            let mut motion = None;
            if let Some((move_index, found)) = moves.next_if(|(_, motion)| motion.line == index + 1)
            {
                motion = Some(found);
                while pieces
                    .next_if(|piece| piece.move_index == move_index)
                    .is_some()
                {
                    group.extend(output.next());
                }
            } else {
                group.extend(output.next());
            }
            self.check_group(index + 1, line, motion, &group)?;
            if !self.input.words(line).is_empty() {
                blocks += group.len();
            }
        }
        if let Some((index, _)) = output.next() {
            return Err(fail(
                0,
                index + 1,
                "a line that no line of the input accounts for".to_owned(),
            ));
        }
        let account = self.accounting;
        let complete = account.blocks_in == self.input.block_count()
            && account.blocks_carried + account.blocks_corrected == account.blocks_in
            && account.blocks_out == blocks
            && account.blocks_out == self.output.block_count()
            && account.bytes_out == self.output.bytes().len();
        if !complete {
            return Err(fail(
                0,
                0,
                "the account of blocks is not complete".to_owned(),
            ));
        }
        Ok(())
    }

    fn check_header<'l>(
        &self,
        output: &mut impl Iterator<Item = (usize, &'l Line)>,
    ) -> Result<(), WriteError> {
        for _ in 0..self.accounting.header_lines {
            let Some((index, line)) = output.next() else {
                return Err(fail(1, 0, "the header is missing".to_owned()));
            };
            let text = &self.output.bytes()[self.output.content(line)];
            let own_style = if self.input.uses_semicolons() {
                text.starts_with(b";")
            } else {
                text.starts_with(b"(") && text.ends_with(b")")
            };
            if !own_style
                || !text.iter().all(|byte| (b' '..=b'~').contains(byte))
                || text.len() > self.writing.max_line_bytes
                || self.output.ending(line) != self.input.usual_ending()
            {
                return Err(fail(
                    1,
                    index + 1,
                    "the header is not in the style of the file".to_owned(),
                ));
            }
        }
        if self.writing.header.is_some() != (self.accounting.header_lines > 0)
            || self.writing.header.is_some() && !self.output.is_marked_compensated()
        {
            return Err(fail(
                1,
                0,
                "the mark of a compensated program is missing".to_owned(),
            ));
        }
        Ok(())
    }

    /// The lines of the output that stand for one line of the input.
    fn check_group(
        &mut self,
        number: usize,
        line: &Line,
        motion: Option<&Move>,
        group: &[(usize, &Line)],
    ) -> Result<(), WriteError> {
        let Some(((first_index, first), further)) = group.split_first() else {
            return Err(fail(number, 0, "the line is missing".to_owned()));
        };
        let broken = |what: &str| Err(fail(number, first_index + 1, what.to_owned()));
        for (index, line) in group {
            let length = self.output.content(line).len();
            self.found.longest_line_bytes = self.found.longest_line_bytes.max(length);
            if length > self.writing.max_line_bytes {
                return Err(fail(
                    number,
                    index + 1,
                    format!("the line has {length} bytes"),
                ));
            }
        }
        let last = group[group.len() - 1].1;
        if self.output.ending(last) != self.input.ending(line) {
            return broken("the line ending differs");
        }
        let written = self.output.content(first);
        let original = self.input.content(line);
        let Some(motion) = motion else {
            if self.output.bytes()[written] != self.input.bytes()[original] {
                return broken("a line without a coordinate has changed");
            }
            return Ok(());
        };
        let split = !further.is_empty();
        let is_arc = motion.curve != Curve::Line;
        let kept = |program: &Program, line: &Line| {
            bytes_without(
                program,
                program.content(line),
                program.words(line),
                |word| {
                    !(b"XYZF".contains(&word.letter)
                        || is_arc && (b"IJKRP".contains(&word.letter) || is_motion(word))
                        || split && (b"ABCEUVW".contains(&word.letter) || is_after_motion(word)))
                },
            )
        };
        if kept(self.input, line) != kept(self.output, first) {
            return broken("something that is no coordinate has changed");
        }
        let mut codes = self.codes(self.output, first);
        let names_motion = motion_word(self.input.words(line)).is_some();
        for (index, line) in further {
            self.check_further(number, motion, *index, line)?;
            let repeated = |code: &(u8, i64)| names_motion && *code == (b'G', 10);
            let further_codes = self.codes(self.output, line);
            codes.extend(further_codes.into_iter().filter(|code| !repeated(code)));
        }
        let mut wanted = self.codes(self.input, line);
        if is_arc {
            wanted.retain(|code| !(code.0 == b'G' && [20, 30].contains(&code.1)));
            // G1 takes the place of G2 and G3, or is added where the mode needs it.
            codes.retain(|code| *code != (b'G', 10));
        }
        wanted.sort_unstable();
        codes.sort_unstable();
        if wanted != codes {
            return broken("the codes of the block have changed");
        }
        let words = self.output.words(first);
        if is_arc && words.iter().any(|word| b"IJKRP".contains(&word.letter)) {
            return broken("a word of the arc is left in a straight move");
        }
        Ok(())
    }

    fn codes(&self, program: &Program, line: &Line) -> Vec<(u8, i64)> {
        program
            .words(line)
            .iter()
            .filter(|word| matches!(word.letter, b'G' | b'M'))
            .map(|word| (word.letter, (word.value * 10.0).round() as i64))
            .collect()
    }

    /// A further piece: nothing but coordinates, F, and on the last one what acts after the motion.
    fn check_further(
        &self,
        number: usize,
        motion: &Move,
        index: usize,
        line: &Line,
    ) -> Result<(), WriteError> {
        let words = self.output.words(line);
        let content = self.output.content(line);
        let rest = bytes_without(self.output, content, words, |_| false);
        let decimals = self.writing.decimals_for(motion.words.mm_per_unit);
        for word in words {
            let text = &self.output.bytes()[word.number as usize..word.end as usize];
            let allowed = match word.letter {
                b'X' | b'Y' | b'Z' => decimals_of(text) == decimals,
                b'F' => true,
                // Whether the input named the motion too is checked with the codes.
                b'G' | b'M' => is_after_motion(word) || word.letter == b'G' && word.value == 1.0,
                letter => motion
                    .extra
                    .iter()
                    .any(|extra| extra.letter == char::from(letter)),
            };
            if !allowed {
                return Err(fail(
                    number,
                    index + 1,
                    "a piece has a word or a number it should not".to_owned(),
                ));
            }
        }
        let wanted: &[u8] = if line.block_delete { b"/" } else { b"" };
        if rest != wanted {
            return Err(fail(
                number,
                index + 1,
                "a piece has more than words".to_owned(),
            ));
        }
        Ok(())
    }
}

fn fail(line: usize, output_line: usize, what: String) -> WriteError {
    WriteError::Verification {
        line,
        output_line,
        what,
    }
}

/// The other axes are where their share of the block wants them.
fn check_extra_axes(motion: &Move, piece: &Piece, read: &Move) -> Result<(), WriteError> {
    let broken = |letter: char| {
        Err(fail(
            motion.line,
            piece.output_line,
            format!("axis {letter} does not reach its place"),
        ))
    };
    for extra in &motion.extra {
        let word = read
            .extra
            .iter()
            .find(|word| word.letter == extra.letter)
            .map(|word| word.word);
        let share = piece.share_to - piece.share_from;
        let last = piece.share_to >= 1.0;
        let tolerance = 1.1e-5;
        let right = match (extra.mode, extra.start) {
            (ExtraMode::Incremental, _) => {
                (word.unwrap_or(0.0) - extra.word * share).abs() <= tolerance
            }
            (ExtraMode::Absolute, Some(start)) => {
                let wanted = start + (extra.word - start) * piece.share_to;
                piece.corner_step || word.is_some_and(|word| (word - wanted).abs() <= tolerance)
            }
            _ => word == Some(extra.word) && last && share == 1.0,
        };
        if !right {
            return broken(extra.letter);
        }
    }
    match read
        .extra
        .iter()
        .find(|word| !motion.extra.iter().any(|extra| extra.letter == word.letter))
    {
        Some(word) => broken(word.letter),
        None => Ok(()),
    }
}

fn is_motion(word: &Word) -> bool {
    motion_word(std::slice::from_ref(word)).is_some()
}

fn is_after_motion(word: &Word) -> bool {
    word.letter == b'M' && [0.0, 1.0, 2.0, 30.0, 60.0].contains(&word.value)
        || word.letter == b'G' && word.value == 9.0
}

/// Bytes of a line without blanks and without the words that are not kept.
fn bytes_without(
    program: &Program,
    content: Range<usize>,
    words: &[Word],
    keep: impl Fn(&Word) -> bool,
) -> Vec<u8> {
    let bytes = program.bytes();
    let mut rest = Vec::with_capacity(content.len());
    let mut at = content.start;
    for word in words.iter().filter(|word| !keep(word)) {
        rest.extend_from_slice(&bytes[at..word.start as usize]);
        at = word.end as usize;
    }
    rest.extend_from_slice(&bytes[at..content.end]);
    rest.retain(|byte| !matches!(byte, b' ' | b'\t'));
    rest
}
