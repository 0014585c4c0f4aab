//! Statements of control: O words, M98 and M99, IF, WHILE, GOTO.

use crate::error::ProgramError;
use crate::expanding::expression::tree::Expression;
use crate::expanding::run::frame::{Frame, LOCAL, Label, Loop, LoopKind, Opened};
use crate::expanding::run::runner::{Next, Runner};
use crate::expanding::run::source::{Source, constant};
use crate::expanding::source::statement::{Statement, Structure};
use crate::text::lex::{Token, tokens_of};

const STRUCTURE: &str = "each O word of a branch or loop needs its end with the same number";

impl Runner<'_> {
    pub fn control(&mut self, statement: Statement) -> Result<Next, ProgramError> {
        match statement {
            Statement::Structure(label, structure) => {
                let label = self.label(&label)?;
                self.structure(label, structure)
            }
            Statement::Goto(condition, to) => {
                if self.holds(condition.as_ref())? {
                    self.go_to(&to)?;
                }
                Ok(Next::Line)
            }
            Statement::Then(condition, to, of) => {
                if self.holds(Some(&condition))? {
                    self.assign_value(&to, &of)?;
                }
                Ok(Next::Line)
            }
            Statement::While(condition, number) => {
                let line = self.running();
                if !self.holds(condition.as_ref())? {
                    let end = self.behind(line, |s| matches!(s, Statement::End(n) if *n == number));
                    let end = end.ok_or_else(|| self.no_end(&format!("END{number}")))?;
                    self.frame_mut().next = end + 1;
                }
                Ok(Next::Line)
            }
            Statement::End(number) => {
                let line = self.running();
                let start = self.before(
                    line,
                    |s| matches!(s, Statement::While(_, n) if *n == number),
                );
                let start = start.ok_or_else(|| self.no_end(&format!("DO{number}")))?;
                self.frame_mut().next = start;
                Ok(Next::Line)
            }
            // The number of the program itself; running into that of another is its end.
            Statement::ProgramNumber(number) => self.program_number(number),
            Statement::Plain | Statement::Block(_) => Ok(Next::Line),
        }
    }

    fn holds(&self, condition: Option<&Expression>) -> Result<bool, ProgramError> {
        condition.map_or(Ok(true), |of| Ok(self.value(of)? != 0.0))
    }

    fn no_end(&self, what: &str) -> ProgramError {
        self.refuse(&format!("{what} is missing"), STRUCTURE)
    }

    /// The first statement behind a line of the file that runs.
    fn behind(&self, line: usize, is: impl Fn(&Statement) -> bool) -> Option<usize> {
        let lines = &self.sources[self.frame().file].lines;
        (line + 1..lines.len()).find(|i| is(&lines[*i].statement))
    }

    fn before(&self, line: usize, is: impl Fn(&Statement) -> bool) -> Option<usize> {
        let lines = &self.sources[self.frame().file].lines;
        (0..line).rev().find(|i| is(&lines[*i].statement))
    }

    /// The first O word of a label and kind behind a line.
    fn o_word_behind(
        &self,
        line: usize,
        label: &Label,
        is: impl Fn(&Structure) -> bool,
        what: &str,
    ) -> Result<usize, ProgramError> {
        let found = self.behind(line, |statement| match statement {
            Statement::Structure(of, structure) => {
                constant(of).as_ref() == Some(label) && is(structure)
            }
            _ => false,
        });
        found.ok_or_else(|| self.no_end(what))
    }

    fn structure(&mut self, label: Label, structure: Structure) -> Result<Next, ProgramError> {
        let line = self.running();
        match structure {
            Structure::Sub => {
                let is_end = |s: &Structure| matches!(s, Structure::EndSub(_));
                let end = self.o_word_behind(line, &label, is_end, "endsub")?;
                self.frame_mut().next = end + 1;
            }
            Structure::EndSub(value) | Structure::Return(value) => {
                return self.close(value.as_ref());
            }
            Structure::Call(values) => self.call(label, &values)?,
            Structure::If(condition) => {
                if !self.holds(Some(&condition))? {
                    self.next_branch(line, &label)?;
                }
            }
            // A branch before this one was run.
            Structure::ElseIf(_) | Structure::Else => {
                let is_end = |s: &Structure| *s == Structure::EndIf;
                self.frame_mut().next = 1 + self.o_word_behind(line, &label, is_end, "endif")?;
            }
            Structure::EndIf => {}
            Structure::While(condition) => self.while_(line, label, &condition)?,
            Structure::Do => self.begin(line, label, LoopKind::Do),
            Structure::Repeat(count) => self.repeat(line, label, &count)?,
            Structure::EndWhile | Structure::EndRepeat => self.again(&label)?,
            Structure::Break => self.leave(&label)?,
            Structure::Continue => self.go_on(&label)?,
        }
        Ok(Next::Line)
    }

    /// The first branch behind a line whose condition holds.
    fn next_branch(&mut self, line: usize, label: &Label) -> Result<(), ProgramError> {
        let is_branch =
            |s: &Structure| matches!(s, Structure::ElseIf(_) | Structure::Else | Structure::EndIf);
        let mut at = self.o_word_behind(line, label, is_branch, "endif")?;
        loop {
            let file = self.frame().file;
            let statement = &self.sources[file].lines[at].statement;
            let condition = match statement {
                Statement::Structure(_, Structure::ElseIf(condition)) => Some(condition.clone()),
                _ => None,
            };
            self.frame_mut().next = at + 1;
            match condition {
                Some(condition) if !self.holds(Some(&condition))? => {
                    at = self.o_word_behind(at, label, is_branch, "endif")?;
                }
                _ => return Ok(()),
            }
        }
    }

    fn begin(&mut self, line: usize, label: Label, kind: LoopKind) {
        self.frame_mut().loops.push(Loop { label, line, kind });
    }

    /// The innermost open loop, if it is this one.
    fn open_loop(&self, label: &Label) -> Option<&Loop> {
        self.frame()
            .loops
            .last()
            .filter(|open| open.label == *label)
    }

    fn while_(
        &mut self,
        line: usize,
        label: Label,
        condition: &Expression,
    ) -> Result<(), ProgramError> {
        let holds = self.holds(Some(condition))?;
        match self.open_loop(&label).map(|open| (open.kind, open.line)) {
            Some((LoopKind::Do, start)) => match holds {
                true => self.frame_mut().next = start + 1,
                false => drop(self.frame_mut().loops.pop()),
            },
            open => {
                let is_open = open.is_some_and(|(_, start)| start == line);
                match (holds, is_open) {
                    (true, false) => self.begin(line, label, LoopKind::While),
                    (true, true) => {}
                    (false, is_open) => {
                        if is_open {
                            self.frame_mut().loops.pop();
                        }
                        self.skip(line, &label)?;
                    }
                }
            }
        }
        Ok(())
    }

    fn repeat(
        &mut self,
        line: usize,
        label: Label,
        count: &Expression,
    ) -> Result<(), ProgramError> {
        // LinuxCNC rounds the number; one below one is none.
        let times = self.value(count)?.round();
        if times < 1.0 {
            return self.skip(line, &label);
        }
        let times = times.min(f64::from(u32::MAX)) as u32;
        self.begin(line, label, LoopKind::Repeat(times - 1));
        Ok(())
    }

    /// Goes behind the end of the loop that stands on a line.
    fn skip(&mut self, line: usize, label: &Label) -> Result<(), ProgramError> {
        let file = self.frame().file;
        let statement = &self.sources[file].lines[line].statement;
        let (end, what): (fn(&Structure) -> bool, _) = match statement {
            Statement::Structure(_, Structure::Repeat(_)) => {
                (|s| *s == Structure::EndRepeat, "endrepeat")
            }
            Statement::Structure(_, Structure::Do) => {
                (|s| matches!(s, Structure::While(_)), "while")
            }
            _ => (|s| *s == Structure::EndWhile, "endwhile"),
        };
        let end = self.o_word_behind(line, label, end, what)?;
        self.frame_mut().next = end + 1;
        Ok(())
    }

    /// `endwhile`, `endrepeat`.
    fn again(&mut self, label: &Label) -> Result<(), ProgramError> {
        let Some(open) = self.open_loop(label).cloned() else {
            return Err(self.refuse("the end of a loop that is not open", STRUCTURE));
        };
        match open.kind {
            LoopKind::Repeat(0) => drop(self.frame_mut().loops.pop()),
            LoopKind::Repeat(left) => {
                let frame = self.frame_mut();
                frame.loops.pop();
                frame.next = open.line + 1;
                self.begin(open.line, open.label, LoopKind::Repeat(left - 1));
            }
            LoopKind::While | LoopKind::Do => self.frame_mut().next = open.line,
        }
        Ok(())
    }

    /// Closes the loops within one.
    fn innermost(&mut self, label: &Label) -> Result<Loop, ProgramError> {
        let loops = &mut self.frame_mut().loops;
        let Some(at) = loops.iter().rposition(|open| open.label == *label) else {
            return Err(self.refuse(
                "break or continue of a loop that is not open",
                "give it the number of the loop that it stands in",
            ));
        };
        loops.truncate(at + 1);
        Ok(loops[at].clone())
    }

    fn leave(&mut self, label: &Label) -> Result<(), ProgramError> {
        let open = self.innermost(label)?;
        self.frame_mut().loops.pop();
        self.skip(open.line, label)
    }

    fn go_on(&mut self, label: &Label) -> Result<(), ProgramError> {
        let open = self.innermost(label)?;
        if let LoopKind::While = open.kind {
            self.frame_mut().next = open.line;
            return Ok(());
        }
        // To the line at the end, which decides.
        self.skip(open.line, label)?;
        self.frame_mut().next -= 1;
        Ok(())
    }

    /// `O.. call`.
    fn call(&mut self, label: Label, values: &[Expression]) -> Result<(), ProgramError> {
        if values.len() > LOCAL {
            return Err(self.refuse("a call takes at most 30 values", "give it fewer"));
        }
        let mut numbered = [0.0; LOCAL];
        for (slot, value) in numbered.iter_mut().zip(values) {
            *slot = self.value(value)?;
        }
        let (file, line) = self.find_sub(&label)?;
        let mut frame = Frame::new(file, line + 1, Opened::Call);
        frame.numbered = numbered;
        self.open(frame)
    }

    /// Where a subprogram is: in the file that runs, in the program, in a file of its own.
    fn find_sub(&mut self, label: &Label) -> Result<(usize, usize), ProgramError> {
        let known = [self.frame().file, 0].into_iter();
        let known = known.chain(0..self.sources.len());
        let sub = |file: usize| Some((file, *self.sources[file].subs.get(label)?));
        if let Some(found) = known.into_iter().find_map(sub) {
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
    fn close(&mut self, value: Option<&Expression>) -> Result<Next, ProgramError> {
        let value = value.map(|of| self.value(of)).transpose()?;
        if self.frame().opened != Opened::Call {
            return Err(self.refuse(
                "the end of a subprogram that was not called",
                "call it, or take the line out",
            ));
        }
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
        match self.frame().opened {
            Opened::Program => Ok(Next::End),
            Opened::Call => Err(self.refuse("a subprogram does not end", "write its endsub")),
            Opened::Repeated(_) => self.return_from_m98(),
        }
    }

    fn program_number(&mut self, number: u32) -> Result<Next, ProgramError> {
        let line = self.running();
        let frame = self.frame();
        let is_first = self.sources[frame.file].programs.get(&number) == Some(&line)
            && self.sources[frame.file].programs.values().min() == Some(&line);
        match (frame.opened, is_first || frame.first == line) {
            (_, true) => Ok(Next::Line),
            (Opened::Program, false) => Ok(Next::End),
            (Opened::Repeated(_) | Opened::Call, false) => self.return_from_m98(),
        }
    }

    /// The N word to go on at: behind the line, then from the beginning.
    fn go_to(&mut self, to: &Expression) -> Result<(), ProgramError> {
        let number = self.whole(to, "a block")?;
        let line = self.running();
        let frame = self.frame();
        let lines = &self.sources[frame.file].lines;
        let is = |i: &usize| lines[*i].label == Some(number);
        let mut from_here = (line + 1..lines.len()).chain(frame.first..=line);
        match from_here.find(is) {
            Some(found) => {
                self.frame_mut().next = found;
                Ok(())
            }
            None => Err(self.refuse(
                &format!("GOTO {number}: there is no block N{number}"),
                "give the block that is meant this number",
            )),
        }
    }

    /// M98 and M99 of a block of plain words.
    pub fn called(&mut self, text: &[u8]) -> Result<Option<Next>, ProgramError> {
        if !text.contains(&b'9') {
            return Ok(None);
        }
        let mut tokens = Vec::new();
        tokens_of(text, &mut tokens);
        let word = |wanted: u8| {
            tokens.iter().find_map(|spanned| match spanned.token {
                Token::Word { letter, value, .. } if letter == wanted => Some(value),
                _ => None,
            })
        };
        let is_m = |code: f64| {
            tokens.iter().any(|spanned| {
                matches!(spanned.token, Token::Word { letter: b'M', value, .. } if value == code)
            })
        };
        if is_m(99.0) {
            return self.return_from_m98().map(Some);
        }
        if !is_m(98.0) {
            return Ok(None);
        }
        let Some(number) = word(b'P').filter(|p| p.fract() == 0.0 && (0.0..1e9).contains(p)) else {
            return Err(self.refuse(
                "M98 calls no subprogram",
                "write its number as P, as in M98 P1000",
            ));
        };
        let (mut number, mut times) = (number as u32, word(b'L'));
        // P00031000 is three times O1000.
        if number > 9999 && times.is_none() {
            (number, times) = (number % 10_000, Some(f64::from(number / 10_000)));
        }
        let times = times.unwrap_or(1.0);
        if times.fract() != 0.0 || !(0.0..1e6).contains(&times) {
            return Err(self.refuse("M98 is repeated a whole number of times (L)", "correct L"));
        }
        if times >= 1.0 {
            let (file, line) = self.find_program(number)?;
            let again = Opened::Repeated(times as u32 - 1);
            self.open(Frame {
                numbered: self.frame().numbered,
                named: self.frame().named.clone(),
                ..Frame::new(file, line, again)
            })?;
        }
        Ok(Some(Next::Line))
    }

    fn find_program(&mut self, number: u32) -> Result<(usize, usize), ProgramError> {
        let known = [self.frame().file, 0]
            .into_iter()
            .chain(0..self.sources.len());
        let of = |file: usize| Some((file, *self.sources[file].programs.get(&number)?));
        if let Some(found) = known.into_iter().find_map(of) {
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
            "put the file into the folder of the program, or name the folder of the subprograms",
        ))
    }

    /// M99: once more, or back behind the call. In the program itself it starts again for ever: it is run once.
    fn return_from_m98(&mut self) -> Result<Next, ProgramError> {
        let frame = self.frame();
        match frame.opened {
            Opened::Program => Ok(Next::End),
            Opened::Call => Err(self.refuse(
                "M99 ends a subprogram that an O word has called",
                "end it with endsub",
            )),
            Opened::Repeated(left) => {
                let numbered = frame.numbered;
                let first = frame.first;
                match left.checked_sub(1) {
                    Some(left) => {
                        let frame = self.frame_mut();
                        (frame.opened, frame.next) = (Opened::Repeated(left), first);
                        frame.loops.clear();
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
