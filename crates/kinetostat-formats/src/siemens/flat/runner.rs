//! A program that is run: where it is, what its variables hold, what is written.

use std::collections::BTreeMap;
use std::ops::Range;

use crate::error::ProgramError;
use crate::flat_run::{BlockId, Written};
use crate::model::stated_value::SlashBlocks;
use crate::options::ReadOptions;
use crate::siemens::block::What;
use crate::siemens::expression::Expression;
use crate::siemens::flat::drilling::{Doubts, Drilling};
use crate::siemens::flat::modes::{Frames, Modes};
use crate::siemens::flat::structure::Unit;
use crate::siemens::values::{Value, Variable, Variables, whole};
use crate::text::source::SourceFile;

/// Limit of nested program calls (840D sl: 18 levels).
pub(super) const MOST_LEVELS: usize = 18;
/// Error that ends the run.
pub(super) type Fault = ProgramError;

/// A section that is run again.
#[derive(Debug, Clone)]
pub(super) struct Section {
    pub from: usize,
    /// Position after the last line.
    pub end: usize,
    pub left: u32,
    /// Line at which the calling program continues.
    pub behind: usize,
}

/// A program that runs.
#[derive(Debug, Default)]
pub(super) struct Level {
    pub unit: usize,
    pub line: usize,
    /// Last values of FOR by lines.
    pub limits: BTreeMap<usize, f64>,
    pub sections: Vec<Section>,
    /// Variables of the program that called it, and what is given back to them.
    pub caller: BTreeMap<Vec<u8>, Variable>,
    pub back: Vec<(Vec<u8>, Vec<u8>, Vec<f64>)>,
    /// Remaining repetitions.
    pub again: u32,
    /// Codes and frame in force at its call.
    pub modes: Modes,
    pub frames: Frames,
}

impl Level {
    /// The line that runs.
    pub(super) fn at(&self) -> BlockId {
        BlockId {
            file: self.unit,
            block: self.line,
        }
    }

    pub(super) fn of(unit: usize) -> Self {
        Self {
            unit,
            ..Self::default()
        }
    }
}

/// A program that is run.
#[derive(Default)]
pub(super) struct Runner<'r> {
    pub files: &'r [SourceFile],
    /// Units in the order of the files.
    pub units: &'r [Unit],
    pub names: BTreeMap<Vec<u8>, usize>,
    pub levels: Vec<Level>,
    pub variables: Variables,
    pub written: Written,
    pub modes: Modes,
    pub frames: Frames,
    pub feed: Option<f64>,
    /// MCALL of a cycle in force.
    pub drilling: Option<Drilling>,
    /// MCALL of a subprogram in force: its place, and how many programs deep it stands.
    pub modal_call: Option<(BlockId, usize)>,
    pub doubts: Doubts,
    pub slash_blocks: SlashBlocks,
}

impl<'r> Runner<'r> {
    pub(super) fn new(
        files: &'r [SourceFile],
        units: &'r [Unit],
        names: BTreeMap<Vec<u8>, usize>,
        main: usize,
        options: &ReadOptions,
    ) -> Self {
        Self {
            slash_blocks: options.slash_blocks,
            variables: Variables::of(options),
            written: files.get(main).map_or_else(Written::default, Written::new),
            files,
            units,
            names,
            levels: vec![Level::of(main)],
            ..Self::default()
        }
    }

    pub(super) fn file(&self) -> &'r SourceFile {
        let unit = self.levels.last().map_or(0, |level| level.unit);
        &self.files[unit]
    }

    /// The words of the line that runs.
    pub(super) fn span(&self) -> Range<usize> {
        let line = self
            .levels
            .last()
            .and_then(|level| self.units[level.unit].lines.get(level.line));
        line.map_or(0..0, |line| line.block.span.clone())
    }

    pub(super) fn fault(
        &self,
        span: &Range<usize>,
        reason: impl Into<String>,
        remedy: &str,
    ) -> Fault {
        ProgramError::at(self.file(), span.clone(), reason, remedy)
    }

    /// Number of runs of a subprogram or a section, P: SINUMERIK 840D sl, Programming Manual, Fundamentals, "Subprogram repetitions (P)": 1 to 9999.
    pub(super) fn runs(&self, span: &Range<usize>, value: &Expression) -> Result<u32, Fault> {
        let count = self.number(value)?;
        let runs = whole(count).filter(|runs| (1..=9999).contains(runs));
        runs.ok_or_else(|| {
            let reason =
                format!("it is to run {count} times, and that is no whole number from 1 to 9999");
            self.fault(span, reason, "write P from 1 to 9999")
        })
    }

    pub(super) fn number(&self, value: &Expression) -> Result<f64, Fault> {
        let found = self.variables.number(self.file().bytes(), value);
        found.map_err(|why| {
            self.fault(
                &self.span(),
                why,
                "give it a value in the program, or state it (--set NAME=VALUE)",
            )
        })
    }

    /// Goes to a line, or back where a section ends before it.
    pub(super) fn arrive(&mut self, mut next: usize, jumped: bool) {
        let Some(level) = self.levels.last_mut() else {
            return;
        };
        while let Some(section) = level.sections.last_mut() {
            let inside = (section.from..section.end).contains(&next);
            if inside {
                break;
            }
            if next != section.end && jumped {
                // A jump out of it: it is not run again.
                level.sections.pop();
                continue;
            }
            if section.left > 0 {
                section.left -= 1;
                next = section.from;
                break;
            }
            next = section.behind;
            level.sections.pop();
        }
        self.written.goes_back(level.at(), next);
        level.line = next;
    }

    /// Gives a variable a value.
    pub(super) fn set(
        &mut self,
        name: &Range<usize>,
        indices: &[Expression],
        value: Value,
    ) -> Result<(), Fault> {
        let places: Result<Vec<f64>, Fault> =
            indices.iter().map(|index| self.number(index)).collect();
        let places = places?;
        let name = self.file().part(name);
        let done = self.variables.set(name, &places, value);
        done.map_err(|why| self.fault(&self.span(), why, "declare it by DEF"))
    }

    /// Assigns a value.
    pub(super) fn assign(
        &mut self,
        name: &Range<usize>,
        indices: &[Expression],
        value: &Expression,
    ) -> Result<(), Fault> {
        let value = self.variables.value(self.file().bytes(), value);
        let value = value.map_err(|why| {
            self.fault(
                &self.span(),
                why,
                "give it a value in the program, or state it (--set NAME=VALUE)",
            )
        })?;
        self.set(name, indices, value)
    }

    /// Checks that the call depth allows another call.
    pub(super) fn may_call(&self) -> Result<(), Fault> {
        match self.levels.len() >= MOST_LEVELS {
            true => Err(self.fault(
                &self.span(),
                "more than 18 programs call one another",
                "a control has no more levels: check what calls itself",
            )),
            false => Ok(()),
        }
    }

    /// True if a word assigns a value to a variable.
    pub(super) fn is_assignment(&self, name: &Range<usize>, what: &What) -> bool {
        let text = self.file().part(name);
        let indexed = matches!(what, What::Value { indices, .. } if !indices.is_empty());
        matches!(what, What::Value { .. })
            && self.variables.knows(text)
            && (!text.eq_ignore_ascii_case(b"R") || indexed)
    }

    /// Writes a line, and where it is from.
    pub(super) fn write_line(&mut self, text: &[u8]) {
        let level = self.levels.last();
        let (file, line) = level.map_or((0, 0), |level| (level.unit, level.line + 1));
        self.written.line(text.trim_ascii_end(), file, line);
    }
}
