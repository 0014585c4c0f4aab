//! A program in windows, each read as a program of its own.

use std::io::BufRead;

use crate::parts::lines::{Lines, PartError};
use crate::parts::survey::Survey;
use crate::path::moves::Path;
use crate::path::part::PathPart;
use crate::reading::interpreting::interpreter::Interpreter;
use crate::reading::options::ReadOptions;
use crate::text::program::{PartOfText, Program, Reader, ReaderState};

/// How long the parts are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PartLength {
    /// Lines that are a part's own.
    pub own: usize,
    /// Lines on either side that say how these begin and end.
    pub beside: usize,
}

impl Default for PartLength {
    /// 5 000 lines, and 256 on either side. It is the same everywhere: which bytes are written must not depend on a machine's
    /// memory.
    fn default() -> Self {
        Self {
            own: 5_000,
            beside: 256,
        }
    }
}

/// A part of a program.
#[derive(Debug, Clone)]
pub struct Part {
    /// Its lines, and some on either side.
    pub program: Program,
    /// Where the tool goes on them.
    pub path: Path,
    /// It is the last one.
    pub is_last: bool,
}

impl Part {
    /// Number of its first own line.
    #[must_use]
    pub fn first_line(&self) -> usize {
        self.program.own_numbers().start
    }

    /// Number of the line behind its last own one.
    #[must_use]
    pub fn next_line(&self) -> usize {
        self.program.own_numbers().end
    }
}

/// Reads a program part by part.
pub struct Parts<'o, R> {
    lines: Lines<R>,
    survey: &'o Survey,
    length: PartLength,
    /// Lines that were read and are still needed, and where each ends.
    held: Vec<u8>,
    ends: Vec<usize>,
    /// The state before the first of them.
    reader: ReaderState,
    interpreter: Interpreter<'o>,
    /// Number of the first own line of the next part.
    next: usize,
    before_mm: f64,
    /// Moves of all parts before it.
    moves_before: usize,
    is_done: bool,
}

impl<'o, R: BufRead> Parts<'o, R> {
    /// Of a program of which a survey was made, with the same options.
    ///
    /// ```
    /// use kinetostat_program::{PartLength, Parts, ReadOptions, Survey, Program, interpret};
    ///
    /// let text = "G21 G90\nG0 X0 Y0 Z5\nG1 Z0 F300\nX10\nX20\nG91 X5\nX5\nM2\n";
    /// let reading = ReadOptions::default();
    /// let whole = interpret(&Program::read(text)?, &reading)?;
    /// let survey = Survey::of(text.as_bytes(), &reading)?;
    /// let length = PartLength { own: 3, beside: 1 };
    /// let mut moves = Vec::new();
    /// for part in Parts::new(text.as_bytes(), (&survey, &reading), length) {
    ///     let path = part?.path;
    ///     moves.extend_from_slice(&path.moves[path.own_moves()]);
    /// }
    /// assert_eq!(moves, whole.moves);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn new(
        text: R,
        (survey, reading): (&'o Survey, &'o ReadOptions),
        length: PartLength,
    ) -> Self {
        Self {
            lines: Lines::new(text),
            survey,
            length,
            held: Vec::new(),
            ends: Vec::new(),
            reader: ReaderState::default(),
            interpreter: Interpreter::new(reading),
            next: 1,
            before_mm: 0.0,
            moves_before: 0,
            is_done: false,
        }
    }

    fn hold(&mut self, most: usize) -> Result<(), PartError> {
        while self.ends.len() < most && self.lines.next(&mut self.held)? {
            self.ends.push(self.held.len());
        }
        Ok(())
    }

    fn read(&mut self) -> Result<Part, PartError> {
        let before = self.reader.lines;
        let behind = self.next + self.length.own.max(1);
        // Lines from the first held to the last that is looked at.
        // One line behind tells that there are more.
        let beside = self.length.beside.max(1);
        self.hold(behind - 1 + beside - before)?;
        let end = behind.min(before + self.ends.len() + 1);
        let is_last = end == before + self.ends.len() + 1;
        // The first line that the next part looks at.
        let next_first = end.saturating_sub(beside).max(before + 1);
        let mut reader = Reader::following(&self.reader);
        let mut interpreter = self.interpreter.following();
        reader.reserve(self.ends.len(), self.held.len());
        interpreter.reserve(self.ends.len());
        let mut kept = None;
        let mut start = 0;
        for (index, stop) in self.ends.iter().enumerate() {
            if before + index + 1 == next_first {
                kept = Some((reader.state(), interpreter.following(), index, start));
            }
            reader.next_line(&self.held[start..*stop])?;
            interpreter.run_line(reader.program(), index)?;
            start = *stop;
        }
        let mut program = reader.into_program();
        let own = self.next..end;
        program.set_semicolons(self.survey.semicolons);
        program.set_part(PartOfText {
            core: own.clone(),
            usual_ending: self.survey.usual_ending.clone(),
            repeats_motion: self.survey.repeats_motion,
        });
        let mut path = interpreter.finish_part(&program, self.survey.stated)?;
        let at = |line: usize| path.moves.partition_point(|motion| motion.line < line);
        let moves = at(own.start)..at(own.end);
        let before_mm = self.before_mm;
        for motion in &path.moves[moves.clone()] {
            self.before_mm += motion.known_length_mm();
        }
        let moves_before = self.moves_before - moves.start;
        self.moves_before += moves.len();
        path.part = Some(PathPart {
            moves,
            moves_before,
            begins: own.start == 1,
            before_mm,
            whole_feed_mm: self.survey.feed_mm,
            whole_feed_arcs: self.survey.feed_arcs,
        });
        if let Some((state, following, lines, bytes)) = kept {
            (self.reader, self.interpreter) = (state, following);
            self.held.drain(..bytes);
            self.ends.drain(..lines);
            for end in &mut self.ends {
                *end -= bytes;
            }
        }
        self.next = end;
        self.is_done = is_last;
        Ok(Part {
            program,
            path,
            is_last,
        })
    }
}

impl<R: BufRead> Iterator for Parts<'_, R> {
    type Item = Result<Part, PartError>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.is_done {
            return None;
        }
        let part = self.read();
        self.is_done |= part.is_err();
        Some(part)
    }
}
