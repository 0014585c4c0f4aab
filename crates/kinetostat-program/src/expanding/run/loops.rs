//! Branches and loops of O words.

use crate::error::ProgramError;
use crate::expanding::Dialect;
use crate::expanding::expression::Expression;
use crate::expanding::run::Runner;
use crate::expanding::run::frame::{Label, Loop, LoopKind};
use crate::expanding::run::source::constant;
use crate::expanding::source::{Statement, Structure};

const STRUCTURE: &str = "each O word of a branch or loop needs its end with the same number";

impl Runner<'_> {
    pub fn holds(&self, condition: Option<&Expression>) -> Result<bool, ProgramError> {
        condition.map_or(Ok(true), |of| Ok(self.value(of)? != 0.0))
    }

    pub fn no_end(&self, what: &str) -> ProgramError {
        self.refuse(&format!("{what} is missing"), STRUCTURE)
    }

    /// The first statement behind a line of the file that runs.
    pub fn behind(&self, line: usize, is: impl Fn(&Statement) -> bool) -> Option<usize> {
        let lines = &self.sources[self.frame().file].lines;
        (line + 1..lines.len()).find(|i| is(&lines[*i].statement))
    }

    pub fn before(&self, line: usize, is: impl Fn(&Statement) -> bool) -> Option<usize> {
        let lines = &self.sources[self.frame().file].lines;
        (0..line).rev().find(|i| is(&lines[*i].statement))
    }

    /// The first O word of a label and kind behind a line.
    pub fn o_word_behind(
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

    /// The first branch behind a line whose condition holds.
    pub fn next_branch(&mut self, line: usize, label: &Label) -> Result<(), ProgramError> {
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

    pub fn begin(&mut self, line: usize, label: Label, kind: LoopKind) {
        self.frame_mut().loops.push(Loop { label, line, kind });
    }

    /// The innermost open loop, if it is this one.
    pub fn open_loop(&self, label: &Label) -> Option<&Loop> {
        self.frame()
            .loops
            .last()
            .filter(|open| open.label == *label)
    }

    pub fn while_(
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
                        self.skip_to_end(line, &label)?;
                    }
                }
            }
        }
        Ok(())
    }

    pub fn repeat(
        &mut self,
        line: usize,
        label: Label,
        count: &Expression,
    ) -> Result<(), ProgramError> {
        // LinuxCNC rounds the number; one below one is none.
        let times = self.value(count)?.round();
        if times < 1.0 {
            return self.skip_to_end(line, &label);
        }
        let times = times.min(f64::from(u32::MAX)) as u32;
        self.begin(line, label, LoopKind::Repeat(times - 1));
        Ok(())
    }

    /// Goes behind the end of the loop that stands on a line.
    pub fn skip_to_end(&mut self, line: usize, label: &Label) -> Result<(), ProgramError> {
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
    pub fn again(&mut self, label: &Label) -> Result<(), ProgramError> {
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
    pub fn innermost(&mut self, label: &Label) -> Result<Loop, ProgramError> {
        let loops = &mut self.frame_mut().loops;
        let Some(at) = loops.iter().rposition(|open| open.label == *label) else {
            return Err(self.refuse(
                "break or continue of a loop that is not open",
                "give it the number of the loop that it stands in",
            ));
        };
        if let LoopKind::Repeat(_) = loops[at].kind {
            return Err(self.refuse(
                "break or continue of a repeat loop, which LinuxCNC refuses",
                "make it a while loop with a variable that counts",
            ));
        }
        loops.truncate(at + 1);
        Ok(loops[at].clone())
    }

    pub fn leave(&mut self, label: &Label) -> Result<(), ProgramError> {
        let open = self.innermost(label)?;
        self.frame_mut().loops.pop();
        self.skip_to_end(open.line, label)
    }

    pub fn go_on(&mut self, label: &Label) -> Result<(), ProgramError> {
        let open = self.innermost(label)?;
        if let LoopKind::While = open.kind {
            self.frame_mut().next = open.line;
            return Ok(());
        }
        // To the line at the end, which decides.
        self.skip_to_end(open.line, label)?;
        self.frame_mut().next -= 1;
        Ok(())
    }

    /// M99 P: back in the program that has called.
    pub fn go_on_at(&mut self, number: f64) -> Result<(), ProgramError> {
        if self.options.dialect == Dialect::LinuxCnc {
            return Ok(());
        }
        match number.fract() == 0.0 && (0.0..1e9).contains(&number) {
            true => self.go_to_block(number as u32),
            false => Err(self.refuse(
                "M99 P goes on at a block of the program that has called",
                "write the whole number of its N word",
            )),
        }
    }

    /// Goes on at the block of an N word: behind the line, then from the beginning.
    pub fn go_to_block(&mut self, number: u32) -> Result<(), ProgramError> {
        let line = self.running();
        let frame = self.frame();
        let lines = &self.sources[frame.file].lines;
        let is = |i: &usize| lines[*i].label == Some(number);
        // Blocks of another program of the file are none of this one.
        let end = self.sources[frame.file].end_of_program(frame.first);
        let mut from_here = (line + 1..end).chain(frame.first..(line + 1).min(end));
        match from_here.find(is) {
            Some(found) => {
                self.frame_mut().next = found;
                Ok(())
            }
            None => Err(self.refuse(
                &format!("GOTO {number}: there is no block N{number} in this program"),
                "give the block that is meant this number",
            )),
        }
    }
}
