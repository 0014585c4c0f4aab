//! Runs a program line by line.

use crate::error::ProgramError;
use crate::expanding::expression::Expression;
use crate::expanding::run::calls::{CallBlock, Closing};
use crate::expanding::run::cycles::InCycle;
use crate::expanding::run::frame::{Label, LoopKind};
use crate::expanding::run::parameters::STOP;
use crate::expanding::run::saves::SavingBlock;
use crate::expanding::run::{Next, Runner};
use crate::expanding::source::{Piece, Statement, Structure};
use crate::expanding::translate::cycle::is_cycle;
use crate::expanding::translate::turns::counts_turns;
use crate::expanding::translate::{MotionBlock, Polar, without_blanks_in_numbers};
use crate::expanding::{Dialect, Origin};
use crate::number::number;
use crate::reading::options::BlockDelete;
use crate::text::lex::has_comment_within;

/// Lines that are run for each flat block that is allowed: loops that only count are not endless.
const LINES_PER_BLOCK: usize = 20;

impl Runner<'_> {
    /// Runs to the end of the program.
    pub fn run(&mut self) -> Result<(), ProgramError> {
        loop {
            let frame = self.frame();
            let (file, index) = (frame.file, frame.next);
            if index >= self.sources[file].lines.len() {
                match self.end_of_file()? {
                    Next::Line => continue,
                    Next::End => return self.end(),
                }
            }
            self.steps += 1;
            if self.has_run_too_long() {
                return Err(self.refuse(
                    "the program does not end: its loops run on and on",
                    "check the conditions of its loops",
                ));
            }
            self.frame_mut().next = index + 1;
            if let Next::End = self.step(file, index)? {
                return self.end();
            }
        }
    }

    /// Loops that only count are not endless, but bounded.
    pub fn has_run_too_long(&self) -> bool {
        self.steps > LINES_PER_BLOCK.saturating_mul(self.options.most_blocks)
    }

    fn end(&mut self) -> Result<(), ProgramError> {
        let ended = self.radius.finish();
        ended.map_err(|(reason, remedy)| self.refuse(&reason, remedy))?;
        if self.flat.is_closed() {
            return Ok(());
        }
        match self.sources[0].closing_mark() {
            // The program ended before it: a tape stays one.
            Some(index) => {
                let text = self.sources[0].text(index).to_vec();
                let line = index + 1;
                self.flat.add(&text, Origin { line, file: 0 })
            }
            None => Ok(()),
        }
    }

    fn step(&mut self, file: usize, index: usize) -> Result<Next, ProgramError> {
        if self.flat.is_closed() {
            // Text for people: nothing of it is run.
            let text = self.sources[file].text(index).to_vec();
            self.flat.add(&text, self.origin())?;
            return Ok(Next::Line);
        }
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
        let statement = line.statement.clone();
        if line.skip_number.is_some() {
            self.note_skip_number()?;
        }
        let before = self.flat.blocks();
        match statement {
            Statement::Plain => {
                let next = self.plain(file, index)?;
                let text = self.sources[file].text(index).to_vec();
                self.note_points(&text, before);
                Ok(next)
            }
            Statement::Block(pieces) => {
                let next = self.block(&pieces, file, index)?;
                let whole = self.sources[file].text(index);
                let plain = pieces.iter().filter_map(|piece| match piece {
                    Piece::Text(range) => whole.get(range.clone()),
                    _ => None,
                });
                let text = plain.collect::<Vec<_>>().join(&b' ');
                self.note_points(&text, before);
                Ok(next)
            }
            control => self.control(control),
        }
    }

    fn plain(&mut self, file: usize, index: usize) -> Result<Next, ProgramError> {
        let first = self.sources[file].lines[index].skip_number.unwrap_or(0);
        let text = self.sources[file].text(index)[first..].to_vec();
        self.emit(&text, Polar::default())
    }

    /// Words with values, then the assignments of the line.
    fn block(&mut self, pieces: &[Piece], file: usize, index: usize) -> Result<Next, ProgramError> {
        let mut text = Vec::new();
        let mut polar = Polar::default();
        let mut assignments = Vec::new();
        let rules = self.frame().numbered.rules;
        let fanuc = rules == Dialect::Fanuc;
        let mut assigns = false;
        for piece in pieces {
            match piece {
                Piece::Text(range) => {
                    text.extend_from_slice(&self.sources[file].text(index)[range.clone()]);
                }
                // A word without a value is as if it were not there (Fanuc).
                Piece::Word(_, of, _) if fanuc && self.is_vacant(of.unsigned())? => {}
                Piece::Word(letter, of, _) => {
                    self.has_a_value(of)?;
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
                Piece::Assignment(to, of) if fanuc => {
                    // At once, and from left to right.
                    match self.number_of(to)? == Some(STOP) {
                        true => text.extend_from_slice(b"M0"),
                        false => self.assign_value(to, of)?,
                    }
                    assigns = true;
                }
                Piece::Assignment(to, of) => {
                    self.has_a_value(of)?;
                    let value = self.value(of)?;
                    assignments.push((to, self.number_of(to)?, value));
                }
            }
        }
        let text = match assignments.is_empty() && !assigns {
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

    /// A parameter without a value is refused where it is not known whose rules hold.
    fn has_a_value(&self, of: &Expression) -> Result<(), ProgramError> {
        match self.frame().numbered.rules == Dialect::Undecided && self.is_vacant(of.unsigned())? {
            true => Err(self.refuse(
                "a parameter without a value: for LinuxCNC it is 0, Fanuc leaves the word out",
                "give it a value before, or name the dialect (--dialect)",
            )),
            false => Ok(()),
        }
    }

    /// A block of plain words, behind all blocks so far; cycles and polar words as moves.
    fn emit(&mut self, text: &[u8], polar: Polar) -> Result<Next, ProgramError> {
        let is_linuxcnc = self.options.dialect == Dialect::LinuxCnc;
        if is_linuxcnc && has_comment_within(text) {
            return Err(self.refuse(
                "a comment stands within a comment: LinuxCNC stops there",
                "take the inner brackets out",
            ));
        }
        if let (true, Some(joined)) = (is_linuxcnc, without_blanks_in_numbers(text)) {
            return self.emit(&joined, polar);
        }
        if let Some(mut block) = CallBlock::of(text) {
            block.does_more |= polar.is_there();
            self.check_beside_call(&block)?;
            if block.does_more
                && let Next::End = self.emit(&block.rest, polar)?
            {
                return Ok(Next::End);
            }
            return self.called(&block);
        }
        if self.macro_call(text)? {
            return Ok(Next::Line);
        }
        if let Some(saving) = SavingBlock::of(text) {
            self.add_rest(&saving.before)?;
            self.save_or_restore(saving.code)?;
            return match saving.after.is_empty() && !polar.is_there() {
                true => Ok(Next::Line),
                false => self.emit(&saving.after, polar),
            };
        }
        if let Some(text) = self.last_distance(text) {
            self.flat.warn_of_lines(self.flat.blocks() + 1, "G90 and G91 stand in one block: the last of them holds (Fanuc: of several codes of one group the last one is valid), for the point on the way of G28 or G30 as well");
            return self.emit(&text, polar);
        }
        if let Some(rest) = self.hold_rigid(text) {
            return match rest.trim_ascii().is_empty() && !polar.is_there() {
                true => Ok(Next::Line),
                false => self.emit(rest.trim_ascii_end(), polar),
            };
        }
        if let Some([modes, shift]) = self.beside_shift(text) {
            self.emit(&modes, Polar::default())?;
            return self.emit(&shift, polar);
        }
        if let Some(texts) = self.offsets(text)? {
            for text in texts {
                self.add(text.as_bytes())?;
            }
            return self.after_block();
        }
        let block = MotionBlock::of(text, polar);
        if let Some(what) = &block.twice {
            return Err(self.refuse(what, "keep one of the two words, or write two blocks"));
        }
        if let Some(code) = self.code_of_spline(&block) {
            self.cycle = None;
            self.spline(code, &block)?;
            return self.after_block();
        }
        if block.motion == Some(331) && self.options.dialect != Dialect::Fanuc {
            self.cycle = None;
            self.leave_spline()?;
            self.rigid_tap(&block)?;
            return self.after_block();
        }
        if self.options.dialect == Dialect::LinuxCnc && counts_turns(&block, self.state()) {
            self.cycle = None;
            self.leave_spline()?;
            self.turns(&block)?;
            return self.after_block();
        }
        self.end_rigid(&block)?;
        self.note_move(&block);
        let code = match (block.motion, self.cycle) {
            (Some(code), _) => Some(code).filter(|code| is_cycle(*code)),
            (None, Some(cycle)) => match self.in_cycle(&block)? {
                InCycle::Hole => Some(cycle.code),
                InCycle::Words => {
                    self.add_rest(&block.before)?;
                    self.add_rest(&block.after)?;
                    return self.after_block();
                }
                InCycle::Nothing => None,
            },
            (None, None) => None,
        };
        if block.motion.is_some() {
            self.leave_spline()?;
        }
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

    fn after_block(&self) -> Result<Next, ProgramError> {
        match self.flat.interpreter.has_ended() {
            true => Ok(Next::End),
            false => Ok(Next::Line),
        }
    }
}

/// Statements of control: O words, IF, WHILE, GOTO.
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

    fn structure(&mut self, label: Label, structure: Structure) -> Result<Next, ProgramError> {
        let line = self.running();
        match structure {
            Structure::Sub => {
                let is_end = |s: &Structure| matches!(s, Structure::EndSub(_));
                let end = self.o_word_behind(line, &label, is_end, "endsub")?;
                self.frame_mut().next = end + 1;
            }
            Structure::EndSub(value) => return self.close(Closing::End, value.as_ref()),
            Structure::Return(value) => return self.close(Closing::Return, value.as_ref()),
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

    /// The N word to go on at: behind the line, then from the beginning.
    fn go_to(&mut self, to: &Expression) -> Result<(), ProgramError> {
        let number = self.whole(to, "a block")?;
        self.go_to_block(number)
    }
}
