//! Runs a program line by line.

use crate::error::{ProgramError, ProgramErrorKind, excerpt};
use crate::expanding::expanded::Origin;
use crate::expanding::expression::evaluate::whole;
use crate::expanding::expression::tree::{Expression, Parameter};
use crate::expanding::flat::Flat;
use crate::expanding::options::ExpandOptions;
use crate::expanding::run::frame::{Frame, Label, Opened};
use crate::expanding::run::parameters::{Seen, Shared, assign};
use crate::expanding::run::source::{Source, Subprograms};
use crate::expanding::source::statement::{OLabel, Piece, Statement};
use crate::reading::options::BlockDelete;

/// Subprograms within each other.
const DEEPEST: usize = 100;

/// Lines that are run for each flat block that is allowed: loops that only count are not endless.
const LINES_PER_BLOCK: usize = 20;

/// What goes on after a line.
pub(crate) enum Next {
    Line,
    End,
}

/// A program while it runs.
pub(crate) struct Runner<'o> {
    pub options: &'o ExpandOptions,
    pub library: &'o dyn Subprograms,
    pub sources: Vec<Source>,
    pub frames: Vec<Frame>,
    pub shared: Shared,
    pub flat: Flat<'o>,
    steps: usize,
}

impl<'o> Runner<'o> {
    pub fn new(bytes: Vec<u8>, options: &'o ExpandOptions, library: &'o dyn Subprograms) -> Self {
        let mut shared = Shared::default();
        shared.numbered.clone_from(&options.parameters);
        Self {
            options,
            library,
            sources: vec![Source::new(String::new(), bytes)],
            frames: vec![Frame::new(0, 0, Opened::Program, None)],
            shared,
            flat: Flat::new(options),
            steps: 0,
        }
    }

    /// Runs to the end of the program.
    pub fn run(&mut self) -> Result<(), ProgramError> {
        loop {
            let frame = self.frame();
            let (file, index) = (frame.file, frame.next);
            if index >= self.sources[file].lines.len() {
                match self.end_of_file()? {
                    Next::Line => continue,
                    Next::End => return Ok(()),
                }
            }
            self.steps += 1;
            if self.steps > LINES_PER_BLOCK * self.options.most_blocks {
                return Err(self.refuse(
                    "the program does not end: its loops run on and on",
                    "check the conditions of its loops, or allow more blocks",
                ));
            }
            self.frame_mut().next = index + 1;
            if let Next::End = self.line(file, index)? {
                return Ok(());
            }
        }
    }

    pub fn frame(&self) -> &Frame {
        // The program's own frame is never closed.
        &self.frames[self.frames.len() - 1]
    }

    pub fn frame_mut(&mut self) -> &mut Frame {
        let last = self.frames.len() - 1;
        &mut self.frames[last]
    }

    /// The line that runs.
    pub fn running(&self) -> usize {
        let frame = self.frame();
        let lines = self.sources[frame.file].lines.len();
        frame.next.saturating_sub(1).min(lines.saturating_sub(1))
    }

    pub fn origin(&self) -> Origin {
        Origin {
            line: self.running() + 1,
            file: self.frame().file,
        }
    }

    /// A refusal of the line that runs.
    pub fn refuse(&self, reason: &str, remedy: &str) -> ProgramError {
        let source = &self.sources[self.frame().file];
        let index = self.running();
        let span = source
            .lines
            .get(index)
            .map_or(0..0, |line| line.span.clone());
        let within = match source.name.as_str() {
            "" => String::new(),
            name => format!("in the subprogram '{name}': "),
        };
        ProgramError {
            kind: ProgramErrorKind::Malformed,
            line: index + 1,
            found: excerpt(&source.bytes[span.clone()]),
            span,
            reason: format!("{within}{reason}"),
            remedy: remedy.to_owned(),
        }
    }

    fn line(&mut self, file: usize, index: usize) -> Result<Next, ProgramError> {
        if let Some(fault) = self.sources[file]
            .faults
            .iter()
            .find(|f| f.line == index + 1)
        {
            let (reason, at) = (fault.reason.clone(), fault.at);
            let mut error = self.refuse(&reason, "write it as LinuxCNC or Fanuc have it");
            error.span = at..error.span.end.max(at);
            return Err(error);
        }
        let line = &self.sources[file].lines[index];
        if line.block_delete && self.options.reading.block_delete == BlockDelete::Skip {
            return Ok(Next::Line);
        }
        match line.statement.clone() {
            Statement::Plain => self.plain(file, index),
            Statement::Block(pieces) => self.block(&pieces, file, index),
            control => self.control(control),
        }
    }

    fn plain(&mut self, file: usize, index: usize) -> Result<Next, ProgramError> {
        let text = self.sources[file].text(index).to_vec();
        self.emit(&text)
    }

    /// Words with values, then the assignments of the line.
    fn block(&mut self, pieces: &[Piece], file: usize, index: usize) -> Result<Next, ProgramError> {
        let mut text = Vec::new();
        let mut assignments = Vec::new();
        for piece in pieces {
            match piece {
                Piece::Text(range) => {
                    text.extend_from_slice(&self.sources[file].text(index)[range.clone()]);
                }
                Piece::Word(letter, of, _) => {
                    let value = self.value(of)?;
                    text.push(*letter);
                    text.extend_from_slice(number(value).as_bytes());
                }
                Piece::Assignment(to, of) => {
                    let value = self.value(of)?;
                    assignments.push((to, self.number_of(to)?, value));
                }
            }
        }
        for (to, number, value) in assignments {
            self.assign(to, number, value)?;
        }
        let has_words = !text.trim_ascii().is_empty();
        match has_words {
            true => self.emit(text.trim_ascii_end()),
            false => Ok(Next::Line),
        }
    }

    /// A block of plain words, behind all blocks so far.
    fn emit(&mut self, text: &[u8]) -> Result<Next, ProgramError> {
        if let Some(next) = self.called(text)? {
            return Ok(next);
        }
        let origin = self.origin();
        self.flat.add(text, origin)?;
        match self.flat.interpreter.has_ended() {
            true => Ok(Next::End),
            false => Ok(Next::Line),
        }
    }

    /// The value of an expression at the line that runs.
    pub fn value(&self, of: &Expression) -> Result<f64, ProgramError> {
        let seen = Seen {
            shared: &self.shared,
            frame: self.frame(),
            state: &self.flat.interpreter,
            depth: self.frames.len() - 1,
        };
        let found = of.value(&seen);
        found.map_err(|reason| self.refuse(&reason, "correct the expression"))
    }

    pub fn whole(&self, of: &Expression, what: &str) -> Result<u32, ProgramError> {
        let value = self.value(of)?;
        whole(value, what).map_err(|reason| self.refuse(&reason, "write a whole number"))
    }

    pub fn label(&self, of: &OLabel) -> Result<Label, ProgramError> {
        Ok(match of {
            OLabel::Name(name) => Label::Name(name.clone()),
            OLabel::Number(number) => Label::Number(self.whole(number, "an O word")?),
        })
    }

    /// The number that a parameter has, where it has one.
    fn number_of(&self, parameter: &Parameter) -> Result<Option<u32>, ProgramError> {
        match parameter {
            Parameter::Number(of) => self.whole(of, "a parameter").map(Some),
            Parameter::Name(_) => Ok(None),
        }
    }

    fn assign(
        &mut self,
        to: &Parameter,
        number: Option<u32>,
        value: f64,
    ) -> Result<(), ProgramError> {
        let last = self.frames.len() - 1;
        let (frame, shared) = (&mut self.frames[last], &mut self.shared);
        let done = assign((to, number), value, frame, shared);
        done.map_err(|reason| {
            self.refuse(&reason, "use another parameter, or G10 and work offsets")
        })
    }

    /// `THEN #1 = ...`.
    pub fn assign_value(&mut self, to: &Parameter, of: &Expression) -> Result<(), ProgramError> {
        let value = self.value(of)?;
        let number = self.number_of(to)?;
        self.assign(to, number, value)
    }

    /// Opens a subprogram.
    pub fn open(&mut self, frame: Frame) -> Result<(), ProgramError> {
        if self.frames.len() > DEEPEST {
            return Err(self.refuse(
                &format!("more than {DEEPEST} subprograms are open: one calls itself without end"),
                "check what calls what",
            ));
        }
        self.frames.push(frame);
        Ok(())
    }
}

/// A number as a controller reads it, with all its digits; what is left of zero after the arithmetic is zero.
pub(crate) fn number(value: f64) -> String {
    match value.abs() < NOTHING {
        true => "0".to_owned(),
        false => format!("{value}"),
    }
}

/// Less than any program means.
const NOTHING: f64 = 1e-12;
