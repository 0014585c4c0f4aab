//! Subprograms: O words with `call`, M98 and M99 with the words beside them, and their ends.

use crate::error::ProgramError;
use crate::expanding::Dialect;
use crate::expanding::expression::Expression;
use crate::expanding::run::frame::{Frame, LOCAL, Label, Locals, Opened};
use crate::expanding::run::source::Source;
use crate::expanding::run::{Next, Runner};
use crate::text::lex::{Spanned, Token, tokens_of};

/// Keyword that closes a subprogram.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Closing {
    /// `endsub`.
    End,
    /// `return`.
    Return,
}

impl Runner<'_> {
    /// `O.. call`.
    pub fn call(&mut self, label: Label, values: &[Expression]) -> Result<(), ProgramError> {
        if values.len() > LOCAL {
            return Err(self.refuse("a call takes at most 30 values", "give it fewer"));
        }
        let mut numbered = Locals::new(Dialect::LinuxCnc);
        for (number, value) in (1..).zip(values) {
            numbered.set(number, self.value(value)?);
        }
        let (file, line) = self.find_sub(&label)?;
        let mut frame = Frame::new(file, line + 1, Opened::Call);
        frame.numbered = numbered;
        self.open(frame)
    }

    /// File and line of what a source has: the file that runs, the program, the others.
    fn in_sources(&self, line: impl Fn(&Source) -> Option<&usize>) -> Option<(usize, usize)> {
        let files = [self.frame().file, 0].into_iter();
        let mut files = files.chain(0..self.sources.len());
        files.find_map(|file| Some((file, *line(&self.sources[file])?)))
    }

    /// Finds a subprogram: in the file that runs, in the program, in a file of its own.
    pub fn find_sub(&mut self, label: &Label) -> Result<(usize, usize), ProgramError> {
        if let Some(found) = self.in_sources(|source| source.subs.get(label)) {
            return Ok(found);
        }
        let name = match label {
            Label::Name(name) => name.clone(),
            Label::Number(number) => number.to_string(),
        };
        if let Some(bytes) = self.library.find(&name) {
            let source = Source::new(name.clone(), bytes);
            if let Some(line) = source.subs.get(label).copied() {
                self.sources.push(source);
                return Ok((self.sources.len() - 1, line));
            }
        }
        Err(self.refuse(
            &format!(
                "there is no subprogram '{name}', neither in the program nor as a file '{name}.ngc'"
            ),
            "put the file into the folder of the program, or name the folder of the subprograms",
        ))
    }

    /// `endsub`, `return`, with the value that they give.
    pub fn close(
        &mut self,
        ending: Closing,
        value: Option<&Expression>,
    ) -> Result<Next, ProgramError> {
        let value = value.map(|of| self.value(of)).transpose()?;
        if self.frame().opened != Opened::Call {
            if ending == Closing::Return && self.frame().opened == Opened::Program {
                // LinuxCNC passes over it.
                return Ok(Next::Line);
            }
            return Err(self.refuse(
                "the end of a subprogram that was not called",
                "call it, or take the line out",
            ));
        }
        self.restore_at_return()?;
        let named = &mut self.shared.named;
        named.insert("_value".to_owned(), value.unwrap_or(0.0));
        named.insert(
            "_value_returned".to_owned(),
            f64::from(u8::from(value.is_some())),
        );
        self.frames.pop();
        Ok(Next::Line)
    }

    /// Runs on where the file of a subprogram, or the program, ends.
    pub fn end_of_file(&mut self) -> Result<Next, ProgramError> {
        if let Some(open) = self.frame().loops.last().map(|open| open.line) {
            self.frame_mut().next = open + 1;
            return Err(self.refuse(
                "the loop does not end before its file does",
                "write its end: endwhile, endrepeat, or while behind do",
            ));
        }
        match self.frame().opened {
            Opened::Program => Ok(Next::End),
            Opened::Call => Err(self.refuse("a subprogram does not end", "write its endsub")),
            Opened::Repeated(_) => self.return_from_m98(),
        }
    }

    pub fn program_number(&mut self, number: u32) -> Result<Next, ProgramError> {
        let line = self.running();
        let frame = self.frame();
        let is_first = self.sources[frame.file].programs.get(&number) == Some(&line)
            && self.sources[frame.file].programs.values().min() == Some(&line);
        match (frame.opened, is_first || frame.first == line) {
            (Opened::Program, true) if !self.flat.has_words() => {
                let text = self.sources[frame.file].text(line).to_vec();
                self.flat.add(&text, self.origin())?;
                Ok(Next::Line)
            }
            (_, true) => Ok(Next::Line),
            (Opened::Program, false) => Ok(Next::End),
            (Opened::Repeated(_) | Opened::Call, false) => self.return_from_m98(),
        }
    }

    /// M98 and M99.
    pub fn called(&mut self, block: &CallBlock) -> Result<Next, ProgramError> {
        if block.jump == Jump::Back {
            if let (Some(_), 1) = (block.number, self.frames.len()) {
                return Err(self.refuse(
                    "M99 P in the program itself goes on at a block, again and again",
                    "write GOTO, or M30 at the end",
                ));
            }
            if self.frames.len() == 1 && self.options.dialect == Dialect::Fanuc {
                let line = self.flat.blocks().max(1);
                self.flat.warn_of_lines(line, "M99 in the program itself begins it again on Fanuc's controllers, without end: it is written once, and ends here");
            }
            let next = self.return_from_m98()?;
            if let Some(number) = block.number {
                self.go_on_at(number)?;
            }
            return Ok(next);
        }
        let is_number = |p: &f64| p.fract() == 0.0 && (0.0..1e9).contains(p);
        let Some(number) = block.number.filter(is_number) else {
            return Err(self.refuse(
                "M98 calls no subprogram",
                "write its number as P, as in M98 P1000",
            ));
        };
        let (mut number, mut times) = (number as u32, block.times);
        // P00031000 is three times O1000.
        if number > 9999 && times.is_none() {
            (number, times) = (number % 10_000, Some(f64::from(number / 10_000)));
        }
        let times = times.unwrap_or(1.0);
        if times.fract() != 0.0 || !(0.0..1e6).contains(&times) {
            return Err(self.refuse(
                "M98 is repeated a whole number of times (L), fewer than 1000000",
                "correct L",
            ));
        }
        if times >= 1.0 {
            let call = match times {
                1.0 => format!("M98 P{number:04}"),
                times => format!("M98 P{number:04} L{times}"),
            };
            let Some((file, line)) = self.find_or_keep(number, call.as_bytes())? else {
                return Ok(Next::Line);
            };
            let again = Opened::Repeated(times as u32 - 1);
            self.open(Frame {
                numbered: self.frame().numbered,
                named: self.frame().named.clone(),
                ..Frame::new(file, line, again)
            })?;
        }
        Ok(Next::Line)
    }

    /// A subprogram by its number; none where none of the files holds it: on Fanuc's controllers its call stays.
    pub fn find_or_keep(
        &mut self,
        number: u32,
        call: &[u8],
    ) -> Result<Option<(usize, usize)>, ProgramError> {
        let changes_places =
            self.radius.refuses_cycles().is_some() || self.coordinates.refuses_cycles().is_some();
        match self.find_program(number) {
            Ok(found) => Ok(Some(found)),
            Err(_) if self.options.dialect == Dialect::Fanuc && !changes_places => {
                let origin = self.origin();
                self.flat.add(call, origin)?;
                Ok(None)
            }
            Err(missing) => Err(missing),
        }
    }

    fn find_program(&mut self, number: u32) -> Result<(usize, usize), ProgramError> {
        if let Some(found) = self.in_sources(|source| source.programs.get(&number)) {
            return Ok(found);
        }
        for name in [
            format!("{number}"),
            format!("{number:04}"),
            format!("O{number:04}"),
        ] {
            if let Some(bytes) = self.library.find(&name) {
                let source = Source::new(name, bytes);
                let line = source.programs.get(&number).copied().unwrap_or(0);
                self.sources.push(source);
                return Ok((self.sources.len() - 1, line));
            }
        }
        Err(self.refuse(
            &format!("there is no subprogram O{number}, neither in the program nor as a file '{number:04}.ngc'"),
            match self.options.dialect {
                Dialect::Undecided => "put the file into the folder of the program, or name the folder of the subprograms, or the dialect: with --dialect fanuc it is taken not to move the tool",
                _ => "put the file into the folder of the program, or name the folder of the subprograms",
            },
        ))
    }

    /// M99: once more, or back behind the call. In the program itself it starts again for ever: it is run once.
    pub fn return_from_m98(&mut self) -> Result<Next, ProgramError> {
        let frame = self.frame();
        match frame.opened {
            Opened::Program => Ok(Next::End),
            Opened::Call => Err(self.refuse(
                "M99 ends a subprogram that an O word has called",
                "end it with endsub",
            )),
            Opened::Repeated(left) => {
                self.restore_at_return()?;
                let frame = self.frame();
                let (numbered, arguments) = (frame.numbered, frame.arguments);
                let first = frame.first;
                match left.checked_sub(1) {
                    Some(left) => {
                        let frame = self.frame_mut();
                        frame.numbered = arguments.unwrap_or(numbered);
                        (frame.opened, frame.next) = (Opened::Repeated(left), first);
                        frame.loops.clear();
                    }
                    None if arguments.is_some() => {
                        self.frames.pop();
                    }
                    None => {
                        let named = self.frames.pop().map(|frame| frame.named);
                        let frame = self.frame_mut();
                        frame.numbered = numbered;
                        frame.named = named.unwrap_or_default();
                    }
                }
                Ok(Next::Line)
            }
        }
    }
}

/// Kind of the jump.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Jump {
    /// M98.
    Away,
    /// M99.
    Back,
}

/// A block with M98 or M99.
///
/// Fanuc runs the words beside M98 and M99, and then calls or returns. LinuxCNC reads the block for its number alone.
#[derive(Debug)]
pub(crate) struct CallBlock {
    pub jump: Jump,
    /// P.
    pub number: Option<f64>,
    /// L.
    pub times: Option<f64>,
    /// The block without them, its N word and / in front.
    pub rest: Vec<u8>,
    /// True if the rest has words with an effect.
    pub does_more: bool,
    /// A word that cannot stand here.
    unclear: Option<&'static str>,
}

impl CallBlock {
    /// Returns `None` if the block has neither code; M beside G65 is an argument.
    pub fn of(text: &[u8]) -> Option<Self> {
        if !text.contains(&b'9') {
            return None;
        }
        let mut tokens: Vec<Spanned> = Vec::new();
        tokens_of(text, &mut tokens);
        let has = |wanted: u8, number: f64| {
            tokens.iter().any(|one| {
                matches!(one.token, Token::Word { letter, value, .. } if letter == wanted && value == number)
            })
        };
        // The return goes before, as it does on the controllers.
        let jump = match (has(b'G', 65.0), has(b'M', 99.0), has(b'M', 98.0)) {
            (true, ..) | (false, false, false) => return None,
            (false, true, _) => Jump::Back,
            (false, false, true) => Jump::Away,
        };
        let mut block = Self {
            jump,
            number: None,
            times: None,
            rest: Vec::new(),
            does_more: false,
            unclear: None,
        };
        let mut codes = 0;
        for one in &tokens {
            match one.token {
                Token::Word {
                    letter: b'M',
                    value: 98.0 | 99.0,
                    ..
                } => {
                    codes += 1;
                    continue;
                }
                Token::Word {
                    letter: b'P',
                    value,
                    ..
                } if block.number.is_none() => {
                    block.number = Some(value);
                    continue;
                }
                Token::Word {
                    letter: b'L',
                    value,
                    ..
                } if block.times.is_none() => {
                    block.times = Some(value);
                    continue;
                }
                Token::Word {
                    letter: b'P' | b'L',
                    ..
                } => block.unclear = Some("P or L stands twice beside M98 or M99"),
                Token::Word {
                    letter: b'Q' | b'H',
                    ..
                } => {
                    block.unclear =
                        Some("Q or H beside M98 or M99 is a block to begin at to some controllers");
                    block.does_more = true;
                }
                Token::Word { letter: b'N', .. } => {}
                Token::Word { .. } | Token::Letter(_) => block.does_more = true,
                _ => {}
            }
            block.rest.extend_from_slice(&text[one.span.clone()]);
        }
        if codes > 1 {
            block.unclear = Some("M98 and M99 stand twice or together");
        }
        if jump == Jump::Back && block.times.is_some() {
            block.unclear =
                Some("L beside M99 sets how often the subprogram is run again on some controllers");
        }
        block.rest = block.rest.trim_ascii_end().to_vec();
        Some(block)
    }
}

impl Runner<'_> {
    /// Refuses words beside M98 and M99 whose meaning is not certain.
    pub fn check_beside_call(&self, block: &CallBlock) -> Result<(), ProgramError> {
        if let Some(what) = block.unclear {
            return Err(self.refuse(what, "write M98 or M99 into a block of its own"));
        }
        let remedy = match (block.does_more, self.options.dialect) {
            (false, _) | (true, Dialect::Fanuc) => return Ok(()),
            (true, Dialect::LinuxCnc) => "write them in a block of their own before it",
            (true, Dialect::Undecided) => {
                "write them in a block of their own before it, or name the dialect (--dialect fanuc)"
            }
        };
        Err(self.refuse(
            "words beside M98 or M99: Fanuc runs them first, LinuxCNC does not run them",
            remedy,
        ))
    }
}
