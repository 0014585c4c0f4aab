//! Runs a program line by line.

use crate::error::{ProgramError, ProgramErrorKind, excerpt};
use crate::expanding::expanded::Origin;
use crate::expanding::expression::evaluate::whole;
use crate::expanding::expression::tree::{Expression, Parameter};
use crate::expanding::flat::Flat;
use crate::expanding::number::number;
use crate::expanding::options::ExpandOptions;
use crate::expanding::run::frame::{Frame, Label, Opened};
use crate::expanding::run::parameters::{Seen, Shared, assign};
use crate::expanding::run::source::{Source, Subprograms};
use crate::expanding::source::statement::{OLabel, Piece, Statement};
use crate::expanding::translate::block::{MotionBlock, Polar};
use crate::expanding::translate::cycle::{Cycle, cycle, is_cycle};
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
    /// The cycle that bare places repeat.
    cycle: Option<Cycle>,
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
            frames: vec![Frame::new(0, 0, Opened::Program)],
            shared,
            flat: Flat::new(options),
            cycle: None,
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
        self.emit(&text, Polar::default())
    }

    /// Words with values, then the assignments of the line.
    fn block(&mut self, pieces: &[Piece], file: usize, index: usize) -> Result<Next, ProgramError> {
        let mut text = Vec::new();
        let mut polar = Polar::default();
        let mut assignments = Vec::new();
        for piece in pieces {
            match piece {
                Piece::Text(range) => {
                    text.extend_from_slice(&self.sources[file].text(index)[range.clone()]);
                }
                Piece::Word(letter, of, _) => {
                    let value = self.value(of)?;
                    match letter {
                        b'@' => polar.radius = Some(value),
                        b'^' => polar.angle_deg = Some(value),
                        letter => {
                            text.push(*letter);
                            text.extend_from_slice(number(value).as_bytes());
                        }
                    }
                }
                Piece::Assignment(to, of) => {
                    let value = self.value(of)?;
                    assignments.push((to, self.number_of(to)?, value));
                }
            }
        }
        let text = match assignments.is_empty() {
            true => text.trim_ascii_end(),
            false => text.trim_ascii(),
        };
        for (to, number, value) in assignments {
            self.assign(to, number, value)?;
        }
        match !text.trim_ascii().is_empty() || polar.is_there() {
            true => self.emit(text, polar),
            false => Ok(Next::Line),
        }
    }

    /// A block of plain words, behind all blocks so far; cycles and polar words as moves.
    fn emit(&mut self, text: &[u8], polar: Polar) -> Result<Next, ProgramError> {
        if let Some(next) = self.called(text)? {
            return Ok(next);
        }
        let block = MotionBlock::of(text, polar);
        let goes_on = block.motion.is_none() && block.has_place() && !block.wants_axes;
        let code = match (block.motion, self.cycle) {
            (Some(code), _) => Some(code).filter(|code| is_cycle(*code)),
            (None, Some(cycle)) if goes_on => Some(cycle.code),
            (None, _) => None,
        };
        match code {
            Some(code) => self.cycle(code, &block)?,
            None => {
                if block.motion.is_some() {
                    self.cycle = None;
                }
                match polar.is_there() {
                    true => self.polar(&block)?,
                    false => self.add(text)?,
                }
            }
        }
        self.after_block()
    }

    fn add(&mut self, text: &[u8]) -> Result<(), ProgramError> {
        let origin = self.origin();
        let file = &self.sources[origin.file].name;
        self.flat.add(text, origin, file)
    }

    /// What is no motion of a block that is translated.
    fn add_rest(&mut self, words: &[u8]) -> Result<(), ProgramError> {
        match words.trim_ascii() {
            [] => Ok(()),
            words => self.add(words),
        }
    }

    fn cycle(&mut self, code: u32, block: &MotionBlock) -> Result<(), ProgramError> {
        self.add_rest(&block.before)?;
        let made = cycle(code, block, self.cycle, &self.flat.interpreter);
        let (texts, cycle) = made.map_err(|(reason, remedy)| self.refuse(&reason, remedy))?;
        for text in texts {
            self.add(text.as_bytes())?;
        }
        self.cycle = Some(cycle);
        self.add_rest(&block.after)
    }

    /// A straight move or an arc whose end is given by a radius and an angle.
    fn polar(&mut self, block: &MotionBlock) -> Result<(), ProgramError> {
        let remedy = "write the place with X and Y";
        if block.value(b'X').or(block.value(b'Y')).is_some() {
            return Err(self.refuse("X or Y beside polar words", remedy));
        }
        self.add_rest(&block.before)?;
        let state = &self.flat.interpreter;
        let (x, y) = match (state.coordinate(0), state.coordinate(1)) {
            (Ok(x), Ok(y)) => (x, y),
            (Err(reason), _) | (_, Err(reason)) => {
                return Err(self.refuse(&reason, "state X and Y before polar words"));
            }
        };
        let incremental = state.is_incremental();
        let end = block.polar.place([x, y], incremental);
        let end = end.map_err(|reason| self.refuse(reason, remedy))?;
        let words = match incremental {
            true => [end[0] - x, end[1] - y],
            false => end,
        };
        let mut text = block.motion_words();
        text.push_str(&format!("X{} Y{}", number(words[0]), number(words[1])));
        text.push_str(&block.other_words());
        self.add(text.as_bytes())?;
        self.add_rest(&block.after)
    }

    fn after_block(&self) -> Result<Next, ProgramError> {
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
