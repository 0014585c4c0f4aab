//! The run of a program.

use std::ops::Range;

use crate::flat_run::{Behind, BlockId, Runs, Written};
use crate::model::stated_value::SlashBlocks;
use crate::siemens::block::Item;
use crate::siemens::declarations::define;
use crate::siemens::expression::Expression;
use crate::siemens::flat::print::End;
use crate::siemens::flat::runner::{Fault, Level, MOST_LEVELS, Runner, Section};
use crate::siemens::flat::statements::{Control, Jump, Way};
use crate::siemens::values::Value;
use crate::text::source::SourceFile;

/// Limit of the nesting of repeated sections.
const MOST_SECTIONS: usize = 32;

impl Runs for Runner<'_> {
    fn files(&self) -> &[SourceFile] {
        self.files
    }

    fn written(&mut self) -> &mut Written {
        &mut self.written
    }

    fn at(&self) -> Option<BlockId> {
        self.levels.last().map(Level::at)
    }

    fn running(&self) -> Vec<BlockId> {
        self.levels.iter().map(Level::at).collect()
    }

    fn span_of(&self, at: BlockId) -> Range<usize> {
        let line = self.units[at.file].lines.get(at.block);
        line.map_or(0..0, |line| line.block.span.clone())
    }

    fn step(&mut self, at: BlockId) -> Result<(), Fault> {
        match at.block >= self.units[at.file].lines.len() {
            true => self.leave(),
            false => self.line(at),
        }
    }

    fn behind(&self, at: BlockId) -> Behind {
        if self.levels.len() >= MOST_LEVELS {
            return Behind::Nothing;
        }
        let Some(line) = self.units[at.file].lines.get(at.block) else {
            return Behind::Depends;
        };
        let items = &line.block.items;
        let assigns = |item: &Item| self.is_assignment(&item.name, &item.what);
        let is_same = self.at() == Some(at)
            && matches!(line.control, Control::None)
            && !items.iter().any(assigns)
            && matches!(self.end(items), Ok(End::No));
        match is_same {
            true => Behind::Same,
            false => Behind::Depends,
        }
    }

    fn pass(&mut self, at: BlockId, has_written: bool) {
        if let (Some(line), false) = (self.units[at.file].lines.get(at.block), has_written) {
            self.write_line(self.file().part(&line.block.line));
        }
        self.arrive(at.block + 1, false);
    }
}

impl Runner<'_> {
    fn line(&mut self, place: BlockId) -> Result<(), Fault> {
        let units = self.units;
        let (unit, line) = (place.file, place.block);
        let at = &units[unit].lines[line];
        if at.block.skip && self.slash_blocks == SlashBlocks::Skipped {
            // The reader does not run it, either.
            self.pass(place, false);
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
            Control::Mark => {}
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
            Control::Unless { condition, to } => {
                if self.number(condition)? == 0.0 {
                    next = *to;
                }
            }
            Control::Goto(to) => next = *to,
            Control::Jump(jumps) => {
                for (condition, jump) in jumps {
                    let condition = condition.as_ref().map(|condition| self.number(condition));
                    if condition.transpose()? != Some(0.0) {
                        next = self.destination(jump, line)?;
                        jumped = true;
                        break;
                    }
                }
            }
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
