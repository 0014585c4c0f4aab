//! Facts about a whole program, found in one reading that keeps nothing of it.

use std::io::{BufRead, Error as IoError};

use thiserror::Error;

use crate::error::ProgramError;
use crate::parts::PartLength;
use crate::parts::beginnings::{Beginning, Beginnings, ByKnown, NextLine, covers, index_of};
use crate::path::curve::Curve;
use crate::path::moves::{Move, MoveKind, Warning};
use crate::reading::interpreting::Interpreter;
use crate::reading::options::ReadOptions;
use crate::text::first_line;
use crate::text::program::{MAX_READ_LINE_BYTES, Reader, ReaderState};
use crate::writing::blocks::motion_word;

/// Lines that are in memory at a time.
const BLOCK: usize = 4096;

/// Facts that only the whole of a program gives.
#[derive(Default)]
pub struct Survey {
    /// Length of the parts.
    pub length: PartLength,
    /// Lines of the program.
    pub lines: usize,
    /// Lines with words.
    pub blocks: usize,
    /// Bytes of the program.
    pub bytes: u64,
    /// Motions.
    pub moves: usize,
    /// Length of the feed moves from known places, mm.
    pub feed_mm: f64,
    /// Arcs at feed.
    pub feed_arcs: usize,
    /// True for each of X, Y, Z that is ever stated.
    pub stated: [bool; 3],
    /// Warnings, with lines.
    pub warnings: Vec<Warning>,
    /// Line of the mark of a compensated program.
    pub mark_line: Option<usize>,
    /// True if comments begin with `;`.
    pub(crate) semicolons: bool,
    /// The ending of its first line.
    pub(crate) usual_ending: Vec<u8>,
    /// Every motion has its own motion word.
    pub(crate) repeats_motion: bool,
    /// Beginnings of the parts.
    pub(crate) parts: Vec<Beginning>,
}

/// Blocks by the axes that are known behind them.
#[derive(Debug, Clone, Copy, Default)]
struct Behind {
    moves: usize,
    first_line: usize,
}

/// A survey that is being made.
struct Surveyor {
    found: Survey,
    feed: ByKnown,
    /// Lengths of all moves.
    all: ByKnown,
    beginnings: Beginnings,
    behind: [Behind; 8],
    first_feed: Option<Move>,
}

impl Survey {
    /// Reads a program once, to be taken in parts of such a length.
    ///
    /// ```
    /// use kinetostat_program::{PartLength, ReadOptions, Survey};
    ///
    /// let text = "G21 G90\nG0 X0 Y0 Z5\nG1 Z0 F300\nG1 X100\nM2\n";
    /// let found = Survey::of(text.as_bytes(), &ReadOptions::default(), PartLength::default())?;
    /// assert_eq!((found.lines, found.blocks, found.moves), (5, 5, 3));
    /// assert_eq!((found.feed_mm, found.stated, found.part_count()), (105.0, [true; 3], 1));
    /// # Ok::<(), kinetostat_program::PartError>(())
    /// ```
    ///
    /// # Errors
    /// The file cannot be read; the first line that cannot be followed.
    pub fn of(
        text: impl BufRead,
        options: &ReadOptions,
        length: PartLength,
    ) -> Result<Self, PartError> {
        let mut lines = Lines::new(text);
        let mut interpreter = Interpreter::new(options);
        let mut reader = Reader::following(&ReaderState::default());
        let mut surveyor = Surveyor {
            found: Survey {
                usual_ending: b"\n".to_vec(),
                repeats_motion: true,
                length,
                ..Survey::default()
            },
            feed: ByKnown::default(),
            all: ByKnown::default(),
            beginnings: Beginnings::new(length),
            behind: Default::default(),
            first_feed: None,
        };
        let mut line = Vec::new();
        loop {
            let room = BLOCK.min(length.own);
            reader.reserve(room, 0);
            interpreter.reserve(room);
            let mut count = 0;
            let mut is_last = false;
            while count < BLOCK {
                line.clear();
                if !lines.next(&mut line)? {
                    is_last = true;
                    break;
                }
                let moves = surveyor.found.moves + interpreter.move_count();
                let next = NextLine {
                    line: surveyor.found.lines + 1,
                    offset: surveyor.found.bytes,
                    before: (moves, surveyor.all),
                    bytes: &line,
                };
                let states = || (reader.state(), interpreter.state());
                surveyor.beginnings.look(&next, states);
                if surveyor.found.lines == 0 {
                    surveyor.note_ending(&line);
                }
                surveyor.found.lines += 1;
                surveyor.found.bytes += line.len() as u64;
                reader.next_line(&line)?;
                interpreter.run_line(reader.program(), count)?;
                count += 1;
                if surveyor.beginnings.is_first_own(surveyor.found.lines + 1) {
                    break;
                }
            }
            surveyor.note(&reader, &mut interpreter);
            if is_last {
                return surveyor.finish(interpreter, &reader);
            }
            reader.keep_nothing();
        }
    }

    /// Number of parts.
    #[must_use]
    pub fn part_count(&self) -> usize {
        self.parts.len()
    }
}

impl Surveyor {
    fn note_ending(&mut self, line: &[u8]) {
        let (_, ending) = first_line(line);
        if !ending.is_empty() {
            self.found.usual_ending = ending.to_vec();
        }
    }

    fn note(&mut self, reader: &Reader, interpreter: &mut Interpreter<'_>) {
        let program = reader.program();
        self.found.blocks += program.block_count();
        self.found.semicolons |= program.uses_semicolons();
        self.found.mark_line = self.found.mark_line.or(program.mark_line());
        interpreter.pass_moves(|motion, [before, after]| {
            self.found.moves += 1;
            let line = program.line(motion.line);
            let named = line.is_some_and(|line| motion_word(program.words(line)).is_some());
            self.found.repeats_motion &= named;
            if motion.words.is_to_machine() {
                return;
            }
            self.all.add(before, motion.length_mm());
            let behind = &mut self.behind[index_of(after)];
            if behind.moves == 0 {
                behind.first_line = motion.line;
            }
            behind.moves += 1;
            if motion.kind != MoveKind::Feed {
                return;
            }
            self.found.feed_arcs += usize::from(matches!(motion.curve, Curve::Arc(_)));
            self.feed.add(before, motion.length_mm());
            self.first_feed.get_or_insert_with(|| motion.clone());
        });
    }

    fn finish(
        mut self,
        mut interpreter: Interpreter<'_>,
        reader: &Reader,
    ) -> Result<Survey, PartError> {
        let stated = interpreter.places.stated;
        // For warnings that depend on whether a block has cut before.
        if let Some(first) = self.first_feed.take() {
            interpreter.put_move(Move {
                curve: Curve::Line,
                ..first
            });
        }
        let path = interpreter.finish(reader.program())?;
        self.found.feed_mm = self.feed.whole_mm(stated);
        self.found.parts = self.beginnings.finish(self.found.lines, stated);
        let unknown = (0..8).filter(|index| !covers(*index, stated));
        let unknown: Vec<Behind> = unknown.map(|index| self.behind[index]).collect();
        let count: usize = unknown.iter().map(|behind| behind.moves).sum();
        self.found.stated = stated;
        self.found.warnings = path.warnings;
        let first = unknown.iter().filter(|behind| behind.moves > 0);
        if let Some(line) = first.map(|behind| behind.first_line).min() {
            self.found
                .warnings
                .push(crate::reading::interpreting::interpret::unknown_beginning(
                    line, count,
                ));
            self.found.warnings.sort_by_key(|warning| warning.line);
        }
        Ok(self.found)
    }
}

/// Reason for which a part of a program cannot be read.
#[derive(Debug, Error)]
pub enum PartError {
    /// The file cannot be read.
    #[error("{0}")]
    File(#[from] IoError),
    /// The program cannot be followed.
    #[error("{0}")]
    Program(#[from] ProgramError),
    /// The lines are not those that were surveyed.
    #[error("the program was changed since it was surveyed")]
    Changed,
}

/// Lines of a text, each with its line ending.
pub(crate) struct Lines<R> {
    from: R,
}

impl<R: BufRead> Lines<R> {
    pub fn new(from: R) -> Self {
        Self { from }
    }

    /// Appends the next line to `to`; returns false at the end. Only the beginning of a line that is longer than any block
    /// is read, which the reader refuses.
    pub fn next(&mut self, to: &mut Vec<u8>) -> Result<bool, IoError> {
        let start = to.len();
        loop {
            let found = self.from.fill_buf()?;
            if found.is_empty() {
                return Ok(to.len() > start);
            }
            let Some(end) = memchr::memchr2(b'\n', b'\r', found) else {
                let count = found.len();
                to.extend_from_slice(found);
                self.from.consume(count);
                if to.len() - start > 2 * MAX_READ_LINE_BYTES {
                    return Ok(true);
                }
                continue;
            };
            let carriage_return = found[end] == b'\r';
            to.extend_from_slice(&found[..=end]);
            self.from.consume(end + 1);
            if carriage_return && self.from.fill_buf()?.first() == Some(&b'\n') {
                to.push(b'\n');
                self.from.consume(1);
            }
            return Ok(true);
        }
    }
}
