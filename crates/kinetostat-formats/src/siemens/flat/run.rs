//! The run of a program: whether it needs to be expanded, and its lines one after the other.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::ops::Range;

use crate::error::ProgramError;
use crate::flat_run::{Behind, BlockId, MOST_STEPS, RefusedRun, Runs, Written, with_corners};
use crate::model::stated_value::{SlashBlocks, told_of_values};
use crate::options::ReadOptions;
use crate::siemens::block::{Block, Item, What};
use crate::siemens::called::{program_name, whole_file};
use crate::siemens::declarations::define;
use crate::siemens::expression::Expression;
use crate::siemens::flat::corners::written_out;
use crate::siemens::flat::print::End;
use crate::siemens::flat::runner::{Fault, Level, MOST_LEVELS, Runner, Section};
use crate::siemens::flat::statements::{Control, Jump, Way};
use crate::siemens::flat::structure::Unit;
use crate::siemens::values::Value;
use crate::text::source::{FlatText, SourceFile};

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

/// Words that say what runs.
const FLOW: [&str; 28] = [
    "IF", "ELSE", "ENDIF", "WHILE", "ENDWHILE", "FOR", "ENDFOR", "REPEAT", "REPEATB", "UNTIL",
    "LOOP", "ENDLOOP", "GOTO", "GOTOF", "GOTOB", "GOTOC", "GOTOS", "CASE", "CALL", "PCALL",
    "MCALL", "CYCLE81", "CYCLE82", "CYCLE83", "HOLES1", "HOLES2", "L", "P",
];

/// Runs a SINUMERIK program once and writes it flat: without jumps, loops, subprograms, variables, the drilling cycles CYCLE81,
/// CYCLE82 and CYCLE83, rows and circles of holes (HOLES1, HOLES2), and corners between two lines that are rounded or broken (RND, CHF, CHR). The program is the first file that ends in `.mpf`, or the first; the others are its subprograms, by their
/// names. What needs none of that comes back byte for byte.
///
/// Expressions become numbers with up to nine decimals; frames (TRANS, ROT) and all else stay as they are. At most 5 million
/// blocks and 20 million steps are run.
///
/// ```
/// use kinetostat_formats::{SourceFile, expand_siemens};
///
/// let main = "G0 X0 Y0 Z10\nF100\nMCALL CYCLE81(10,0,2,-5)\nX20\nMCALL\nPART(3)\nM30\n";
/// let part = "PROC PART(REAL DEPTH)\nG1 Z=-DEPTH\nG0 Z10\nRET\n";
/// let files = [SourceFile::new("MAIN.MPF", main), SourceFile::new("PART.SPF", part)];
/// let flat = expand_siemens(&files).unwrap();
/// let text = String::from_utf8(flat.file.bytes().to_vec()).unwrap();
/// assert_eq!(text, "G0 X0 Y0 Z10\nF100\nX20\nG0 Z=AC(2)\nG1 G9 Z=AC(-5)\nG0 Z=AC(10)\nG1 Z=-3\nG0 Z10\nM30\n");
/// assert_eq!(flat.origins[6], (1, 2));
/// ```
///
/// # Errors
/// What cannot be run, in the order of files and lines. Behind a line that is refused the run goes on, unless what runs, or a value,
/// depends on it.
pub fn expand_siemens(files: &[SourceFile]) -> Result<FlatText, Vec<ProgramError>> {
    run_within(files, &ReadOptions::default(), MOST_STEPS).map_err(|refused| refused.faults)
}

/// Expands a program with a limit of the executed lines.
pub fn expand_within(files: &[SourceFile], most_steps: u64) -> Result<FlatText, Vec<ProgramError>> {
    run_within(files, &ReadOptions::default(), most_steps).map_err(|refused| refused.faults)
}

/// Expands a program; a refused program is returned with the part that was written.
pub(crate) fn run_or_refused(
    files: &[SourceFile],
    options: &ReadOptions,
) -> Result<FlatText, RefusedRun> {
    run_within(files, options, MOST_STEPS)
}

fn run_within(
    files: &[SourceFile],
    options: &ReadOptions,
    most_steps: u64,
) -> Result<FlatText, RefusedRun> {
    let is_main = |file: &&SourceFile| file.name().to_ascii_lowercase().ends_with(".mpf");
    let main = files.iter().position(|file| is_main(&file)).unwrap_or(0);
    let Some(file) = files.get(main) else {
        return Ok(FlatText::unchanged(&SourceFile::new("", ""), 0));
    };
    let (mut names, mut faults) = (BTreeMap::new(), Vec::new());
    for (index, other) in files.iter().enumerate().filter(|(index, _)| *index != main) {
        match names.entry(program_name(other.name())) {
            Entry::Vacant(free) => {
                free.insert(index);
            }
            Entry::Occupied(held) => faults.push(ProgramError::named_alike(
                other,
                begin_of(other),
                &files[*held.get()],
                begin_of(&files[*held.get()]),
            )),
        }
    }
    if !faults.is_empty() {
        return Err(faults.into());
    }
    if !files.iter().all(|file| whole_file(file, &mut faults)) {
        return Err(faults.into());
    }
    if !needs(file, &names) {
        let mut flat = FlatText::unchanged(file, main);
        // The text after the last line end is a line, too.
        flat.origins = (1..=file.line_count()).map(|line| (main, line)).collect();
        return with_corners(flat, faults, |flat| written_out(flat, files));
    }
    let units = files.iter();
    let units: Vec<Unit> = units.map(|file| Unit::of(file, &mut faults)).collect();
    if !faults.is_empty() && !units.iter().all(|unit| unit.runs) {
        return Err(faults.into());
    }
    let mut runner = Runner::new(files, &units, names, main, options);
    runner.run(most_steps);
    let mut findings = runner.doubts.into_findings();
    findings.extend(told_of_values(&options.values, file.bytes()));
    let written = runner.written;
    written.into_flat(file, faults, findings, |flat| written_out(flat, files))
}

/// The first line of a subprogram that says something: PROC, as a rule.
fn begin_of(file: &SourceFile) -> Range<usize> {
    let mut lines = (1..=file.line_count()).map(|line| file.range_of(line));
    let says = |line: &Range<usize>| {
        let text = file.part(line).trim_ascii_start();
        !matches!(text.first(), None | Some(b';' | b'%'))
    };
    lines.find(says).unwrap_or(0..0)
}

/// True if the control flow of a program is not linear.
fn needs(file: &SourceFile, names: &BTreeMap<Vec<u8>, usize>) -> bool {
    (1..=file.line_count()).any(|line| {
        let Ok((block, _)) = Block::of(file.bytes(), file.range_of(line)) else {
            return false;
        };
        block.items.iter().any(|item| {
            let name = String::from_utf8_lossy(file.part(&item.name)).to_ascii_uppercase();
            let digits = name.strip_prefix('L').unwrap_or("-");
            let numbered = !digits.is_empty() && digits.bytes().all(|byte| byte.is_ascii_digit());
            let calls = !matches!(item.what, What::Value { .. })
                && (names.contains_key(name.as_bytes()) || numbered);
            calls || FLOW.contains(&name.as_str())
        })
    })
}
