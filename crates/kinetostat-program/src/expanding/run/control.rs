//! Statements of control: O words, IF, WHILE, GOTO.

use crate::error::ProgramError;
use crate::expanding::expression::tree::Expression;
use crate::expanding::run::calls::Closing;
use crate::expanding::run::frame::{Label, LoopKind};
use crate::expanding::run::runner::{Next, Runner};
use crate::expanding::source::statement::{Statement, Structure};

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
