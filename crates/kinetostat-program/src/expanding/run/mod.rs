//! A program is run: values of parameters, calls, branches and loops.
//!
//! Takes statements; gives plain blocks to the flat program, one after the other, with the line of each.

pub(crate) mod calls;
pub(crate) mod cycles;
pub(crate) mod frame;
pub(crate) mod loops;
pub(crate) mod macros;
pub(crate) mod modal;
pub(crate) mod offsets;
pub(crate) mod parameters;
pub(crate) mod saves;
pub(crate) mod source;
pub(crate) mod steps;

use crate::error::{ProgramError, ProgramErrorKind, excerpt};
use crate::expanding::coordinates::stage::Coordinates;
use crate::expanding::expression::evaluate::whole;
use crate::expanding::expression::{Expression, Parameter};
use crate::expanding::flat::Flat;
use crate::expanding::radius::stage::Radius;
use crate::expanding::run::frame::{Frame, Label, Locals, Opened};
use crate::expanding::run::modal::Functions;
use crate::expanding::run::parameters::{Seen, Shared, assign};
use crate::expanding::run::source::{Source, Subprograms};
use crate::expanding::source::OLabel;
use crate::expanding::translate::cycle::Cycle;
use crate::expanding::translate::spline::Spline;
use crate::expanding::{Dialect, ExpandOptions, Origin, Trouble};
use crate::path::moves::MoveKind;
use crate::reading::interpreting::Interpreter;
use crate::text::lex::{Spanned, Token, tokens_of};

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

/// M29 in force.
///
/// The taps that follow are tied to the spindle (Fanuc).
#[derive(Debug)]
pub(crate) struct Rigid {
    /// M29 with its S: no motion may stand between it and the tap.
    pub text: String,
    /// True if a tap has written it.
    pub is_written: bool,
}

impl Rigid {
    /// M29 and S of a block, and the rest of it; `None` where it has no M29.
    pub fn of(text: &[u8]) -> Option<(Self, Vec<u8>)> {
        let mut tokens: Vec<Spanned> = Vec::new();
        tokens_of(text, &mut tokens);
        let [mut speed, mut rest] = [Vec::new(), Vec::new()];
        let (mut is_there, mut mark) = (false, "");
        for one in &tokens {
            let piece = &text[one.span.clone()];
            match one.token {
                Token::Word {
                    letter: b'M',
                    value: 29.0,
                    ..
                } => is_there = true,
                // The block may be skipped.
                Token::Other(b'/') => mark = "/",
                Token::Word { letter: b'S', .. } => speed.extend([b" ", piece].concat()),
                _ => rest.extend_from_slice(piece),
            }
        }
        let text = format!("{mark}M29{}", String::from_utf8_lossy(&speed));
        let is_written = false;
        is_there.then_some((Self { text, is_written }, rest))
    }
}

/// Blocks of plain words, behind all blocks so far.
impl Runner<'_> {
    /// Adds a block.
    pub fn add(&mut self, text: &[u8]) -> Result<(), ProgramError> {
        let origin = self.origin();
        self.flat
            .name_file(origin.file, &self.sources[origin.file].name);
        let added = self.coordinates.block(
            text,
            origin,
            &mut self.radius,
            &mut self.flat,
            self.options.dialect,
        );
        added.map_err(|trouble| match trouble {
            // Shows the text of the file: the user has not seen the flat block.
            Trouble::Block(error) if error.line == origin.line => ProgramError {
                found: excerpt(self.sources[origin.file].text(origin.line - 1)),
                ..error
            },
            Trouble::Block(error) => error,
            Trouble::Line((reason, remedy)) => self.refuse(&reason, remedy),
        })?;
        self.note_functions(text)
    }

    /// Adds the words of a translated block that are no motion.
    pub fn add_rest(&mut self, words: &[u8]) -> Result<(), ProgramError> {
        match words.trim_ascii() {
            [] => Ok(()),
            words => self.add(words),
        }
    }

    /// Keeps what a block leaves in force; a feed motion after M72 has put back "no feed" is refused, as LinuxCNC does.
    fn note_functions(&mut self, text: &[u8]) -> Result<(), ProgramError> {
        let mut tokens: Vec<Spanned> = Vec::new();
        tokens_of(text, &mut tokens);
        self.functions.note(&tokens);
        let is_f = |one: &Spanned| matches!(one.token, Token::Word { letter: b'F', .. });
        self.no_feed &= !tokens.iter().any(is_f);
        let last = self.flat.interpreter.last_move();
        let is_new = last.is_some_and(|last| last.line == self.flat.blocks());
        match self.no_feed && is_new && last.is_some_and(|last| last.kind == MoveKind::Feed) {
            true => Err(self.refuse(
                "the modes that were put back are from before the first F: there is no feed",
                "write F before this block",
            )),
            false => Ok(()),
        }
    }
}
