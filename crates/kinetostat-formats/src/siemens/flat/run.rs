//! The run of a program.

use std::ops::Range;

use crate::error::ProgramError;
use crate::model::slash_blocks::SlashBlocks;
use crate::refused_run::Behind;
use crate::siemens::declarations::define;
use crate::siemens::expression::Expression;
use crate::siemens::flat::control::{Control, Jump, Way};
use crate::siemens::flat::runner::{Fault, Runner, Section, Written};
use crate::siemens::values::Value;

/// Most blocks that are written.
pub(super) const MOST_BLOCKS: usize = 5_000_000;
/// Most lines that are run.
pub(super) const MOST_STEPS: u64 = 20_000_000;
/// Most bytes that are written.
pub(super) const MOST_BYTES: usize = 1 << 28;
/// Most sections that are repeated within one another.
const MOST_SECTIONS: usize = 32;

impl<'r> Runner<'r> {
    /// Runs it to its end, by so many lines at most.
    pub(super) fn run(mut self, most_steps: u64) -> Written {
        let mut steps = 0_u64;
        let mut is_endless = false;
        while let Some(level) = self.levels.last() {
            let (unit, line) = (level.unit, level.line);
            let written = self.origins.len();
            steps += 1;
            let (done, ends) = match self.is_bounded(steps, most_steps) {
                Err(fault) => (Err(fault), true),
                Ok(()) if line >= self.units[unit].lines.len() => (self.leave(), false),
                Ok(()) => (self.line(unit, line), false),
            };
            let Err(fault) = done else {
                continue;
            };
            is_endless = ends;
            let behind = match ends {
                true => Behind::Nothing,
                false => self.behind(unit, line),
            };
            let file = (self.files.iter()).position(|file| file.name() == fault.file);
            if !self.faults.add(file.unwrap_or(0), *fault, behind) {
                break;
            }
            self.go_on(unit, line, written);
        }
        Written {
            output: self.output,
            origins: self.origins,
            faults: self.faults.into_faults(),
            findings: self.doubts.into_findings(),
            is_endless,
        }
    }

    fn is_bounded(&self, steps: u64, most_steps: u64) -> Result<(), Fault> {
        let is_full = self.origins.len() > MOST_BLOCKS || self.output.len() > MOST_BYTES;
        match steps > most_steps || is_full {
            true => Err(self.endless()),
            false => Ok(()),
        }
    }

    /// At the line that goes back to the beginning of the loop, where one runs.
    fn endless(&self) -> Fault {
        let most = "20 million lines, or written 5 million blocks or 256 MiB";
        let Some((unit, line)) = self.loop_in_force() else {
            return self.fault(
                &self.span(),
                format!("the program has run {most}, and has not ended"),
                "divide it",
            );
        };
        let unit = &self.units[unit];
        let span = unit.lines[line].block.span.clone();
        Box::new(ProgramError::at(
            &self.files[unit.file],
            span,
            format!("the loop that goes back here does not end: the program has run {most}"),
            "check its condition, or divide the program",
        ))
    }

    fn line(&mut self, unit: usize, line: usize) -> Result<(), Fault> {
        let units = self.units;
        let at = &units[unit].lines[line];
        if at.block.skip && self.slash_blocks == SlashBlocks::Skipped {
            // The reader does not run it, either.
            let text = self.file().part(&at.block.line).to_vec();
            self.write_line(&text);
            self.arrive(line + 1, false);
            return Ok(());
        }
        let mut next = line + 1;
        let mut jumped = false;
        match &at.control {
            Control::None => {
                // A call or an end goes its own way.
                if !self.words(at)? {
                    return Ok(());
                }
            }
            Control::Skip | Control::Mark => {}
            Control::Define => {
                let from = at
                    .tokens
                    .iter()
                    .position(|token| self.file().part(&token.span).eq_ignore_ascii_case(b"DEF"));
                let bytes = self.file().bytes();
                let tokens = &at.tokens[from.unwrap_or(0)..];
                define(bytes, tokens, &mut self.variables)
                    .map_err(|broken| self.fault(&broken.span, broken.reason, broken.remedy))?;
            }
            Control::If {
                condition,
                otherwise,
            } => {
                if self.number(condition)? == 0.0 {
                    next = *otherwise;
                }
            }
            Control::Else(behind) => next = *behind,
            Control::JumpIf(jumps) => {
                for (condition, jump) in jumps {
                    if self.number(condition)? != 0.0 {
                        next = self.destination(jump, line)?;
                        jumped = true;
                        break;
                    }
                }
            }
            Control::Jump(jump) => {
                next = self.destination(jump, line)?;
                jumped = true;
            }
            Control::Case { of, cases } => {
                let of = self.number(of)?;
                for (value, jump) in cases {
                    let is = match value {
                        Some(value) => self.number(value)? == of,
                        None => true,
                    };
                    if is {
                        next = self.destination(jump, line)?;
                        jumped = true;
                        break;
                    }
                }
            }
            Control::While { condition, end } => {
                if self.number(condition)? == 0.0 {
                    next = *end;
                }
            }
            Control::Back(start) => next = *start,
            Control::For {
                variable,
                indices,
                from,
                to,
                end,
            } => {
                let (from, to) = (self.number(from)?, self.number(to)?);
                self.set(variable, indices, Value::Number(from))?;
                if let Some(level) = self.levels.last_mut() {
                    level.limits.insert(line, to);
                }
                if from > to {
                    next = *end;
                }
            }
            Control::EndFor(start) => next = self.end_for(unit, *start, next)?,
            Control::Until { condition, start } => {
                if self.number(condition)? == 0.0 {
                    next = *start + 1;
                }
            }
            Control::Repeat { .. } => return self.repeat(unit, line),
        }
        self.arrive(next, jumped);
        Ok(())
    }

    fn end_for(&mut self, unit: usize, start: usize, behind: usize) -> Result<usize, Fault> {
        let units = self.units;
        let Control::For {
            variable, indices, ..
        } = &units[unit].lines[start].control
        else {
            return Ok(behind);
        };
        let now = self.number(&Expression::Variable {
            name: variable.clone(),
            indices: indices.clone(),
        })?;
        let limit = self
            .levels
            .last()
            .and_then(|level| level.limits.get(&start));
        // ENDFOR that is reached by a jump has no limit.
        let limit = limit.copied().unwrap_or(f64::NEG_INFINITY);
        match now + 1.0 <= limit {
            true => {
                self.set(variable, indices, Value::Number(now + 1.0))?;
                Ok(start + 1)
            }
            false => Ok(behind),
        }
    }

    fn nearest(&self, lines: &[usize], from: usize, way: Way) -> Option<usize> {
        let forward = lines.iter().find(|line| **line > from).copied();
        let back = lines.iter().rev().find(|line| **line <= from).copied();
        match way {
            Way::Forward => forward,
            Way::Back => back,
            Way::Both | Way::IfThere => forward.or(back),
        }
    }

    fn destination(&self, jump: &Jump, from: usize) -> Result<usize, Fault> {
        let unit = &self.units[self.levels.last().map_or(0, |level| level.unit)];
        let lines = match jump.number {
            Some(number) => unit.numbers.get(&number),
            None => {
                let name = self.file().part(&jump.to).to_ascii_uppercase();
                unit.labels.get(&name)
            }
        };
        let found = lines.and_then(|lines| self.nearest(lines, from, jump.way));
        match (found, jump.way) {
            (Some(line), _) => Ok(line),
            (None, Way::IfThere) => Ok(from + 1),
            (None, _) => Err(self.fault(
                &jump.to,
                "the jump has no destination in its direction",
                "write the label with a colon, or mend the jump",
            )),
        }
    }

    fn repeat(&mut self, unit: usize, line: usize) -> Result<(), Fault> {
        let units = self.units;
        let Control::Repeat {
            from,
            to,
            one_block,
            count,
        } = &units[unit].lines[line].control
        else {
            return Ok(());
        };
        let count = match count {
            Some(count) => self.runs(&self.span(), count)?,
            None => 1,
        };
        let label = |name: &Range<usize>| {
            let name = self.file().part(name).to_ascii_uppercase();
            let lines = units[unit].labels.get(&name)?;
            self.nearest(lines, line, Way::Back)
                .or(self.nearest(lines, line, Way::Forward))
        };
        let missing = |name: &Range<usize>| {
            self.fault(
                name,
                "the label of the section is not there",
                "write it with a colon",
            )
        };
        let start = label(from).ok_or_else(|| missing(from))?;
        let closed = || {
            let lines = units[unit].labels.get(&b"ENDLABEL"[..])?;
            lines.iter().find(|at| **at >= start).copied()
        };
        let end = match to {
            Some(to) => label(to).ok_or_else(|| missing(to))? + 1,
            None if *one_block => start + 1,
            None => match closed() {
                Some(end) if start > line || end < line => end + 1,
                _ if start < line => line,
                _ => return Err(missing(from)),
            },
        };
        if !(start..end).contains(&start) || (start..end).contains(&line) {
            return Err(self.fault(
                &self.span(),
                "the section that is repeated holds the block itself, or nothing",
                "mend its labels",
            ));
        }
        let Some(level) = self.levels.last_mut() else {
            return Ok(());
        };
        if level.sections.len() >= MOST_SECTIONS {
            return Err(self.fault(
                &self.span(),
                "more than 32 sections are repeated within one another",
                "write them as loops",
            ));
        }
        level.sections.push(Section {
            from: start,
            end,
            left: count - 1,
            behind: line + 1,
        });
        level.line = start;
        Ok(())
    }
}
