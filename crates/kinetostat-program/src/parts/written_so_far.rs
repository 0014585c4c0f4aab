//! State of a written program between two parts of its source.

use std::io::BufRead;

use crate::error::ProgramError;
use crate::parts::survey::{Lines, PartError, Survey};
use crate::path::moves::Path;
use crate::reading::interpreting::interpreter::Interpreter;
use crate::reading::options::ReadOptions;
use crate::text::line::first_line;
use crate::text::program::{PartOfText, Program, Reader, ReaderState};
use crate::writing::written::{Corrected, WriterState};

/// State of a written program: the modal state of a controller that has run it so far, and that of its writer.
pub struct WrittenSoFar<'o> {
    survey: &'o Survey,
    reader: ReaderState,
    interpreter: Interpreter<'o>,
    writer: Option<WriterState>,
}

impl<'o> WrittenSoFar<'o> {
    /// State before anything is written.
    #[must_use]
    pub fn nothing(survey: &'o Survey, reading: &'o ReadOptions) -> Self {
        Self {
            survey,
            reader: ReaderState::default(),
            interpreter: Interpreter::new(reading),
            writer: None,
        }
    }

    /// Continues after these written lines, with this state of the writer: from what an interrupted run has left.
    ///
    /// # Errors
    /// They cannot be read.
    pub fn go_on(&mut self, written: impl BufRead, writer: WriterState) -> Result<(), PartError> {
        let mut lines = Lines::new(written);
        let mut line = Vec::new();
        let mut reader = Reader::following(&self.reader);
        let mut count = 0;
        loop {
            line.clear();
            if !lines.next(&mut line)? {
                break;
            }
            reader.next_line(&line)?;
            self.interpreter.run_line(reader.program(), count)?;
            count += 1;
            if count == 4096 {
                self.interpreter.pass_moves(|_, _| ());
                reader.keep_nothing();
                count = 0;
            }
        }
        self.reader = reader.state();
        self.interpreter = self.interpreter.following();
        self.writer = Some(writer);
        Ok(())
    }

    /// State of the writer; `None` before the first part.
    #[must_use]
    pub fn writer(&self) -> Option<&WriterState> {
        self.writer.as_ref()
    }

    /// Lines of the written program so far.
    #[must_use]
    pub fn lines(&self) -> usize {
        self.reader.lines
    }

    /// Reads the text of a part again after all that was written before, and returns the state of the written program after it.
    pub(crate) fn read_again(
        &self,
        written: &Corrected,
    ) -> Result<(Program, Path, Self), ProgramError> {
        let bytes = written.bytes.as_slice();
        let mut reader = Reader::following(&self.reader);
        let mut interpreter = self.interpreter.following();
        let (mut start, mut index) = (0, 0);
        while start < bytes.len() {
            let (length, ending) = first_line(&bytes[start..]);
            let next = start + length + ending.len();
            reader.next_line(&bytes[start..next])?;
            interpreter.run_line(reader.program(), index)?;
            (start, index) = (next, index + 1);
        }
        let behind = Self {
            survey: self.survey,
            reader: reader.state(),
            interpreter: interpreter.following(),
            writer: written.writer.as_deref().cloned(),
        };
        let mut program = reader.into_program();
        let before = self.reader.lines;
        program.set_part(PartOfText {
            core: before + 1..before + index + 1,
            usual_ending: self.survey.usual_ending.clone(),
            repeats_motion: false,
        });
        let path = interpreter.finish_part(&program, self.survey.stated)?;
        Ok((program, path, behind))
    }
}
