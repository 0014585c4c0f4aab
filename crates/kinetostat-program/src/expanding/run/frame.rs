//! Where a program is while it runs: a frame for the program, one more for every subprogram that is open.

use std::collections::BTreeMap;

use crate::expanding::run::modal::Context;

/// Numbered parameters that are a subprogram's own: 1 to 30.
pub(crate) const LOCAL: usize = 30;

/// A label, its value known.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Label {
    Name(String),
    Number(u32),
}

/// A loop that is open.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Loop {
    pub label: Label,
    /// Index of the line that opened it.
    pub line: usize,
    pub kind: LoopKind,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum LoopKind {
    While,
    /// `do`, whose `while` stands at its end.
    Do,
    /// How many times more.
    Repeat(u32),
}

/// What a subprogram goes back to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Opened {
    /// The program itself.
    Program,
    /// `O.. call`: values of its own.
    Call,
    /// M98: the caller's values; how many times more.
    Repeated(u32),
}

/// An open program or subprogram.
#[derive(Debug, Clone)]
pub(crate) struct Frame {
    pub file: usize,
    /// Index of the line that is run next.
    pub next: usize,
    /// Index of its first line.
    pub first: usize,
    pub opened: Opened,
    /// Parameters 1 to 30.
    pub numbered: [f64; LOCAL],
    pub named: BTreeMap<String, f64>,
    pub loops: Vec<Loop>,
    /// Modes that M70 or M73 have saved.
    pub context: Option<Context>,
}

impl Frame {
    /// A frame that begins at a line of a file.
    pub fn new(file: usize, first: usize, opened: Opened) -> Self {
        Self {
            file,
            next: first,
            first,
            opened,
            numbered: [0.0; LOCAL],
            named: BTreeMap::new(),
            loops: Vec::new(),
            context: None,
        }
    }
}
