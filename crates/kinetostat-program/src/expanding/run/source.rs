//! The files of a program: its own, and those of subprograms that it calls.

use std::collections::BTreeMap;

use crate::expanding::expression::Expression;
use crate::expanding::run::frame::Label;
use crate::expanding::source::{Fault, OLabel, SourceLine, Statement, Structure, lines};

/// Source of the files of subprograms: this crate reads none.
pub trait Subprograms {
    /// The bytes of the file `name` with one of the endings that programs have; `None` if there is none.
    fn find(&self, name: &str) -> Option<Vec<u8>>;
}

/// No files but the program itself.
#[derive(Debug, Clone, Copy, Default)]
pub struct NoSubprograms;

impl Subprograms for NoSubprograms {
    fn find(&self, _: &str) -> Option<Vec<u8>> {
        None
    }
}

/// A file that was read.
#[derive(Debug)]
pub(crate) struct Source {
    pub name: String,
    pub bytes: Vec<u8>,
    pub lines: Vec<SourceLine>,
    pub faults: Vec<Fault>,
    /// Lines of `O.. sub`.
    pub subs: BTreeMap<Label, usize>,
    /// Lines of bare program numbers.
    pub programs: BTreeMap<u32, usize>,
}

impl Source {
    pub fn new(name: String, bytes: Vec<u8>) -> Self {
        let (lines, faults) = lines(&bytes);
        let (mut subs, mut programs) = (BTreeMap::new(), BTreeMap::new());
        for (index, line) in lines.iter().enumerate() {
            match &line.statement {
                Statement::Structure(label, Structure::Sub) => {
                    if let Some(label) = constant(label) {
                        subs.entry(label).or_insert(index);
                    }
                }
                Statement::ProgramNumber(number) => {
                    programs.entry(*number).or_insert(index);
                }
                _ => {}
            }
        }
        Self {
            name,
            bytes,
            lines,
            faults,
            subs,
            programs,
        }
    }

    /// The line of the tape mark behind blocks.
    pub fn closing_mark(&self) -> Option<usize> {
        let texts = (0..self.lines.len()).map(|index| self.text(index).trim_ascii());
        let written = texts.enumerate().filter(|(_, text)| !text.is_empty());
        let mut without_comments =
            written.filter(|(_, text)| !text.starts_with(b"(") && !text.starts_with(b";"));
        // The first line with words, or the opening mark.
        without_comments.next()?;
        let (index, _) = without_comments.find(|(_, text)| *text == b"%")?;
        Some(index)
    }

    /// End of the program that begins at a line: the number of the next program.
    pub fn end_of_program(&self, first: usize) -> usize {
        let says_nothing = |index: usize| {
            let text = self.text(index).trim_ascii();
            text.is_empty() || matches!(text[0], b'%' | b'(' | b';')
        };
        let starts = self.programs.values().copied();
        let mut others =
            starts.filter(|start| *start > first && !(first..*start).all(says_nothing));
        let end = others.next().unwrap_or(self.lines.len());
        others.fold(end, usize::min)
    }

    /// The text of a line.
    pub fn text(&self, index: usize) -> &[u8] {
        &self.bytes[self.lines[index].span.clone()]
    }
}

/// A label that needs no values.
pub(crate) fn constant(label: &OLabel) -> Option<Label> {
    match label {
        OLabel::Name(name) => Some(Label::Name(name.clone())),
        OLabel::Number(Expression::Number(number)) => {
            let is_whole = number.fract() == 0.0 && (0.0..1e9).contains(number);
            is_whole.then_some(Label::Number(*number as u32))
        }
        OLabel::Number(_) => None,
    }
}
