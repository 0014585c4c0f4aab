//! The text of a written program against the text of its input: what is no coordinate is the same.

use std::ops::Range;

use crate::checking::{Verifier, fail};
use crate::error::WriteError;
use crate::number::decimals_of;
use crate::path::curve::Curve;
use crate::path::moves::{Feed, FeedMode, Move};
use crate::path::tool_turn::StatedBy;
use crate::text::program::Program;
use crate::text::{Line, Word};
use crate::writing::blocks::{is_after_motion, motion_word};
use crate::writing::written::{Piece, lines_above};

impl Verifier<'_> {
    /// Checks all lines of the output in order.
    pub(crate) fn check_text(&mut self) -> Result<(), WriteError> {
        let mut output = self
            .output
            .own_lines()
            .map(|(number, line)| (number - 1, line));
        let own = self.input_path.own_moves();
        let mut moves = own.clone().zip(&self.input_path.moves[own]).peekable();
        let mut pieces = self.pieces.iter().peekable();
        let header_at = (self.input.begins()).then(|| lines_above(self.input) + 1);
        let mut blocks = 0;
        if self.input.bytes()[..self.input.first_byte()]
            != self.output.bytes()[..self.output.first_byte()]
        {
            return Err(fail(1, 1, "the byte order mark differs".to_owned()));
        }
        for (number, line) in self.input.own_lines() {
            if header_at == Some(number) {
                self.check_header(&mut output)?;
            }
            let mut group = Vec::new();
            let mut shapes = Vec::new();
            let mut motion = None;
            if let Some((move_index, found)) = moves.next_if(|(_, motion)| motion.line == number) {
                motion = Some(found);
                while let Some(piece) = pieces.next_if(|piece| piece.move_index == move_index) {
                    shapes.push(Shape::of(piece));
                    group.extend(output.next());
                }
                let by_time = group
                    .first()
                    .is_some_and(|line| self.is_by_time(found, line.1));
                if by_time && !self.ends_program(line) {
                    // The feed as it was, behind the pieces.
                    group.extend(output.next());
                }
            } else {
                group.extend(output.next());
            }
            self.check_group(number, line, motion, &shapes, &group)?;
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
        if self.accounting.blocks_corrected == 0 && self.output.bytes() == self.input.bytes() {
            // A copy is no compensated program.
            return Ok(());
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
        shapes: &[Shape],
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
        let corrected = motion.filter(|motion| !motion.words.is_to_machine());
        let Some(motion) = corrected else {
            if self.output.bytes()[written] != self.input.bytes()[original] {
                return broken("a line without a coordinate has changed");
            }
            return Ok(());
        };
        let by_time = self.is_by_time(motion, first);
        let is_feed_mode =
            |code: &(u8, i64)| by_time && code.0 == b'G' && [930, 940].contains(&code.1);
        let split = shapes.len() > 1;
        let (turned, directed) = (self.turned(motion), is_directed(motion));
        let kept_arc = shapes.contains(&Shape::Kept);
        let is_arc = motion.curve != Curve::Line && !kept_arc;
        let names_motion = motion_word(self.input.words(line)).is_some();
        let kept = |program: &Program, line: &Line| {
            bytes_without(
                program,
                program.content(line),
                program.words(line),
                |word| {
                    !(b"XYZF".contains(&word.letter)
                        || is_arc && (b"IJKRP".contains(&word.letter) || is_motion(word))
                        || kept_arc && !names_motion && is_motion(word)
                        || turned && b"ABC".contains(&word.letter)
                        || (turned || split) && directed && b"IJK".contains(&word.letter)
                        || by_time && is_feed_mode(&code_of(word))
                        || split && (b"ABCEUVW".contains(&word.letter) || is_after_motion(word)))
                },
            )
        };
        if kept(self.input, line) != kept(self.output, first) {
            return broken("something that is no coordinate has changed");
        }
        if let Some((index, line)) = group.get(shapes.len()) {
            self.check_line_of_feed(number, *index, line)?;
        }
        let mut codes = self.codes(self.output, first);
        for ((index, line), shape) in further.iter().zip(&shapes[1..]) {
            self.check_further(number, motion, *shape, *index, line)?;
            let repeated = |code: &(u8, i64)| names_motion && *code == (b'G', 10);
            let further_codes = self.codes(self.output, line);
            codes.extend(further_codes.into_iter().filter(|code| !repeated(code)));
        }
        let mut wanted = self.codes(self.input, line);
        codes.retain(|code| !is_feed_mode(code));
        wanted.retain(|code| !is_feed_mode(code));
        if is_arc {
            wanted.retain(|code| !(code.0 == b'G' && [20, 30].contains(&code.1)));
            // G1 takes the place of G2 and G3, or is added where the mode needs it, as these are; what is read has its curve.
            codes.retain(|code| !(code.0 == b'G' && [10, 20, 30].contains(&code.1)));
        }
        if kept_arc && !names_motion {
            // The motion code may have to be repeated after arcs that were divided.
            codes.retain(|code| !(code.0 == b'G' && [20, 30].contains(&code.1)));
        }
        wanted.sort_unstable();
        codes.sort_unstable();
        if wanted != codes {
            return broken("the codes of the block have changed");
        }
        let words = self.output.words(first);
        if is_arc
            && shapes[0] == Shape::Straight
            && words.iter().any(|word| b"IJKRP".contains(&word.letter))
        {
            return broken("a word of the arc is left in a straight move");
        }
        Ok(())
    }

    fn codes(&self, program: &Program, line: &Line) -> Vec<(u8, i64)> {
        program
            .words(line)
            .iter()
            .filter(|word| matches!(word.letter, b'G' | b'M'))
            .map(code_of)
            .collect()
    }

    /// True if a rotation in place is written with inverse time feed where the block had degrees per minute.
    fn is_by_time(&self, motion: &Move, first: &Line) -> bool {
        let per_minute = |feed: Feed| feed.mode == FeedMode::PerMinute;
        motion.turns_in_place()
            && motion.feed.is_some_and(per_minute)
            && self.codes(self.output, first).contains(&(b'G', 930))
    }

    /// True if the rotary axes of the program are corrected: their words are checked with the moves.
    fn turned(&self, motion: &Move) -> bool {
        let turn = motion.tool_turn.as_ref();
        !self.rotary_deg.is_empty() && turn.is_some_and(|turn| turn.rotary.is_some())
    }

    fn ends_program(&self, line: &Line) -> bool {
        let ends = |code: &(u8, i64)| [(b'M', 20), (b'M', 300)].contains(code);
        self.codes(self.input, line).iter().any(ends)
    }

    /// The line behind pieces in inverse time: G94 and F. The value of F is checked with the moves after it.
    fn check_line_of_feed(
        &self,
        number: usize,
        index: usize,
        line: &Line,
    ) -> Result<(), WriteError> {
        let words = self.output.words(line);
        let content = self.output.content(line);
        let rest = bytes_without(self.output, content, words, |_| false);
        let letters: Vec<u8> = words.iter().map(|word| word.letter).collect();
        let restores = self.codes(self.output, line) == [(b'G', 940)] && letters == *b"GF";
        match restores && (rest.is_empty() || line.block_delete && rest == b"/") {
            true => Ok(()),
            false => Err(fail(
                number,
                index + 1,
                "the feed is not put back behind pieces in inverse time".to_owned(),
            )),
        }
    }

    /// A further piece: nothing but coordinates, F, and on the last one what acts after the motion.
    fn check_further(
        &self,
        number: usize,
        motion: &Move,
        shape: Shape,
        index: usize,
        line: &Line,
    ) -> Result<(), WriteError> {
        let words = self.output.words(line);
        let content = self.output.content(line);
        let rest = bytes_without(self.output, content, words, |_| false);
        let decimals = self.writing.decimals_for(motion.words.mm_per_unit);
        let is_own = |word: &Word| match shape {
            Shape::Fitted => [2.0, 3.0].contains(&word.value),
            _ => word.value == 1.0,
        };
        for word in words {
            let text = &self.output.bytes()[word.number as usize..word.end as usize];
            let allowed = match word.letter {
                b'X' | b'Y' | b'Z' => decimals_of(text) == decimals,
                b'I' | b'J' | b'K' | b'R' if shape == Shape::Fitted => {
                    decimals_of(text) == decimals
                }
                b'F' => true,
                // The codes are checked for a motion that the input does not name.
                b'G' | b'M' => is_after_motion(word) || word.letter == b'G' && is_own(word),
                b'A' | b'B' | b'C' if self.turned(motion) => true,
                // The direction itself is checked with the moves.
                b'I' | b'J' | b'K' if is_directed(motion) => true,
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

/// True if the tool direction is given as a vector (G43.5).
fn is_directed(motion: &Move) -> bool {
    let turn = motion.tool_turn.as_ref();
    let rotary = turn.and_then(|turn| turn.rotary.as_ref());
    rotary.is_some_and(|rotary| rotary.stated == StatedBy::Direction)
}

/// Form in which a piece of a block is written.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Shape {
    Straight,
    /// An arc as it was.
    Kept,
    /// An arc that was fitted.
    Fitted,
}

impl Shape {
    fn of(piece: &Piece) -> Self {
        match (piece.kept_arc, piece.arc) {
            (true, _) => Self::Kept,
            (false, Some(_)) => Self::Fitted,
            (false, None) => Self::Straight,
        }
    }
}

/// Letter and number of a code, in tenths.
fn code_of(word: &Word) -> (u8, i64) {
    (word.letter, (word.value * 10.0).round() as i64)
}

fn is_motion(word: &Word) -> bool {
    motion_word(std::slice::from_ref(word)).is_some()
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
