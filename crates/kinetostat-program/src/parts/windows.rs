//! Parts of a program, each read as a program of its own.

use std::io::{BufRead, Seek, SeekFrom};

use crate::parts::beginnings::Check;
use crate::parts::survey::{Lines, PartError, Survey};
use crate::path::moves::{Path, PathPart};
use crate::reading::interpreting::Interpreter;
use crate::reading::options::ReadOptions;
use crate::text::program::{PartOfText, Program, Reader};

/// A part of a program.
#[derive(Debug, Clone)]
pub struct Part {
    /// Lines of the part, and some on either side.
    pub program: Program,
    /// Path of the tool on them.
    pub path: Path,
    /// True for the last part.
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

/// Reads parts of a program that was surveyed, each by itself.
#[derive(Clone, Copy)]
pub struct Parts<'o> {
    survey: &'o Survey,
    reading: &'o ReadOptions,
}

impl<'o> Parts<'o> {
    /// Parts of a program that was surveyed with the same options.
    ///
    /// ```
    /// use kinetostat_program::{PartLength, Parts, ReadOptions, Survey, Program, interpret};
    /// use std::io::Cursor;
    ///
    /// let text = "G21 G90\nG0 X0 Y0 Z5\nG1 Z0 F300\nX10\nX20\nG91 X5\nX5\nM2\n";
    /// let reading = ReadOptions::default();
    /// let whole = interpret(&Program::read(text)?, &reading)?;
    /// let survey = Survey::of(text.as_bytes(), &reading, PartLength { own: 3, beside: 1 })?;
    /// let parts = Parts::of(&survey, &reading);
    /// let mut moves = Vec::new();
    /// for part in parts.in_order(Cursor::new(text)) {
    ///     let path = part?.path;
    ///     moves.extend_from_slice(&path.moves[path.own_moves()]);
    /// }
    /// assert_eq!(moves, whole.moves);
    /// // The last one, `X5` and `M2`, by itself.
    /// let last = parts.read(2, Cursor::new(text))?;
    /// assert_eq!((last.first_line(), last.is_last), (7, true));
    /// assert_eq!(last.path.moves[last.path.own_moves()], whole.moves[5..]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn of(survey: &'o Survey, reading: &'o ReadOptions) -> Self {
        Self { survey, reading }
    }

    /// Returns the parts one after the other.
    pub fn in_order<R: BufRead + Seek>(
        self,
        mut text: R,
    ) -> impl Iterator<Item = Result<Part, PartError>> + use<'o, R> {
        (0..self.survey.part_count()).map(move |index| self.read(index, &mut text))
    }

    /// The part of an index.
    ///
    /// # Errors
    /// The text cannot be read; its lines are not those that were surveyed, or there is no such part.
    pub fn read(&self, index: usize, mut text: impl BufRead + Seek) -> Result<Part, PartError> {
        let survey = self.survey;
        let beginning = survey.parts.get(index).ok_or(PartError::Changed)?;
        let next = survey.parts.get(index + 1);
        let end = next.map_or(survey.lines + 1, |next| next.own);
        // There is no line after the last one.
        let more = usize::from(beginning.behind > survey.lines);
        let most = beginning.behind - 1 - beginning.states.0.lines + more;
        text.seek(SeekFrom::Start(beginning.offset))?;
        let mut lines = Lines::new(text);
        let (mut held, mut ends) = (Vec::new(), Vec::new());
        while ends.len() < most && lines.next(&mut held)? {
            ends.push(held.len());
        }
        let mut check = Check::default();
        for (start, stop) in std::iter::once(0).chain(ends.iter().copied()).zip(&ends) {
            check.add(&held[start..*stop]);
        }
        if check.number() != beginning.check {
            return Err(PartError::Changed);
        }
        let mut reader = Reader::following(&beginning.states.0);
        let mut interpreter = Interpreter::behind(self.reading, &beginning.states.1);
        reader.reserve(ends.len(), held.len());
        interpreter.reserve(ends.len());
        let mut start = 0;
        for (line, stop) in ends.iter().enumerate() {
            reader.next_line(&held[start..*stop])?;
            interpreter.run_line(reader.program(), line)?;
            start = *stop;
        }
        let mut program = reader.into_program();
        let own = beginning.own..end;
        program.set_semicolons(survey.semicolons);
        program.set_part(PartOfText {
            core: own.clone(),
            usual_ending: survey.usual_ending.clone(),
            repeats_motion: survey.repeats_motion,
        });
        let mut path = interpreter.finish_part(&program, survey.stated)?;
        let at = |line: usize| path.moves.partition_point(|motion| motion.line < line);
        let moves = at(own.start)..at(own.end);
        path.part = Some(PathPart {
            moves_before: beginning.moves_before - moves.start,
            moves,
            begins: own.start == 1,
            before_mm: beginning.before_mm,
            whole_feed_mm: survey.feed_mm,
            whole_feed_arcs: survey.feed_arcs,
        });
        Ok(Part {
            program,
            path,
            is_last: next.is_none(),
        })
    }
}
