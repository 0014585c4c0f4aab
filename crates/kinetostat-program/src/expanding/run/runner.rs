//! A program while it runs, and what its statements ask of it.

use crate::error::{ProgramError, ProgramErrorKind, excerpt};
use crate::expanding::coordinates::stage::Coordinates;
use crate::expanding::expanded::Origin;
use crate::expanding::expression::evaluate::whole;
use crate::expanding::expression::tree::{Expression, Parameter};
use crate::expanding::flat::Flat;
use crate::expanding::options::{Dialect, ExpandOptions};
use crate::expanding::radius::stage::Radius;
use crate::expanding::run::frame::{Frame, Label, Locals, Opened};
use crate::expanding::run::modal::Functions;
use crate::expanding::run::parameters::{Seen, Shared, assign};
use crate::expanding::run::rigid::Rigid;
use crate::expanding::run::source::{Source, Subprograms};
use crate::expanding::source::statement::OLabel;
use crate::expanding::translate::cycle::Cycle;
use crate::expanding::translate::spline::Spline;
use crate::reading::interpreting::interpreter::Interpreter;

/// Subprograms within each other.
const DEEPEST: usize = 100;

/// Continuation after a line.
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
    pub radius: Radius<'o>,
    pub coordinates: Coordinates<'o>,
    /// The cycle that bare places repeat.
    pub cycle: Option<Cycle>,
    /// The last of G0 to G3 that the program names: what holds behind G80 on Fanuc.
    pub move_named: Option<&'static str>,
    /// The spline that bare places go on with.
    pub spline: Option<Spline>,
    pub steps: usize,
    /// Modal functions that the path does not know.
    pub functions: Functions,
    /// M72 has put back the modes from before the first F.
    pub no_feed: bool,
    /// M29 in force.
    pub rigid: Option<Rigid>,
    /// The clearance of pecks has been warned of.
    pub pecks_warned: bool,
}

/// The frame of the program itself.
fn program_frame(dialect: Dialect) -> Frame {
    Frame {
        numbered: Locals::new(dialect),
        ..Frame::new(0, 0, Opened::Program)
    }
}

impl<'o> Runner<'o> {
    pub fn new(bytes: Vec<u8>, options: &'o ExpandOptions, library: &'o dyn Subprograms) -> Self {
        let mut shared = Shared::default();
        shared.numbered.clone_from(&options.parameters);
        Self {
            options,
            library,
            flat: Flat::of(&bytes, options),
            sources: vec![Source::new(String::new(), bytes)],
            frames: vec![program_frame(options.dialect)],
            shared,
            radius: Radius::new(options),
            coordinates: Coordinates::default(),
            cycle: None,
            move_named: None,
            spline: None,
            steps: 0,
            functions: Functions::default(),
            no_feed: false,
            rigid: None,
            pecks_warned: false,
        }
    }

    /// The run that knows the modes and the programmed places.
    pub fn state(&self) -> &Interpreter<'o> {
        let own = self.coordinates.interpreter();
        own.unwrap_or_else(|| self.radius.interpreter(&self.flat))
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
        let reason = self.flat.in_source_lines(reason);
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

    /// The value of an expression at the line that runs.
    pub fn value(&self, of: &Expression) -> Result<f64, ProgramError> {
        let found = of.value(&self.seen());
        found.map_err(|reason| self.refuse(&reason, "correct the expression"))
    }

    /// True if an expression is a parameter without a value.
    pub fn is_vacant(&self, of: &Expression) -> Result<bool, ProgramError> {
        let found = of.is_vacant(&self.seen());
        found.map_err(|reason| self.refuse(&reason, "correct the expression"))
    }

    fn seen(&self) -> Seen<'_, 'o> {
        Seen {
            shared: &self.shared,
            frame: self.frame(),
            state: self.state(),
            place_is_hidden: self.radius.hides_the_place(),
            is_turned: self.coordinates.interpreter().is_some(),
            depth: self.frames.len() - 1,
        }
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
    pub fn number_of(&self, parameter: &Parameter) -> Result<Option<u32>, ProgramError> {
        match parameter {
            Parameter::Number(of) => self.whole(of, "a parameter").map(Some),
            Parameter::Name(_) => Ok(None),
        }
    }

    pub fn assign(
        &mut self,
        to: &Parameter,
        number: Option<u32>,
        value: f64,
    ) -> Result<(), ProgramError> {
        let last = self.frames.len() - 1;
        let (frame, shared) = (&mut self.frames[last], &mut self.shared);
        let done = assign(to, number, value, frame, shared);
        done.map_err(|(reason, remedy)| self.refuse(&reason, remedy))
    }

    /// `THEN #1 = ...`; what has no value gives none.
    pub fn assign_value(&mut self, to: &Parameter, of: &Expression) -> Result<(), ProgramError> {
        if self.frame().numbered.rules == Dialect::Fanuc && self.is_vacant(of)? {
            return self.vacate(to);
        }
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
