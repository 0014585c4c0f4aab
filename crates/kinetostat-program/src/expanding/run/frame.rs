//! Call stack of a running program: a frame for the program, one more for every open subprogram.

use std::collections::BTreeMap;

use crate::expanding::Dialect;
use crate::expanding::run::modal::Context;

/// Numbered parameters that are a subprogram's own: 1 to 30.
pub(crate) const LOCAL: usize = 30;

/// Fanuc's local parameters: 1 to 33.
const LOCAL_OF_FANUC: usize = 33;

/// Numbered parameters of an open subprogram.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Locals {
    values: [f64; LOCAL_OF_FANUC],
    /// Bit n: number n has been given.
    given: u64,
    /// Whose rules they follow. Fanuc: a number that was not given is vacant, `#1 EQ #0`.
    pub rules: Dialect,
}

impl Locals {
    pub fn new(rules: Dialect) -> Self {
        Self {
            values: [0.0; LOCAL_OF_FANUC],
            given: 0,
            rules,
        }
    }

    /// True if a number is that of a local parameter.
    pub fn has(&self, number: u32) -> bool {
        let most = match self.rules {
            Dialect::LinuxCnc | Dialect::Undecided => LOCAL,
            Dialect::Fanuc => LOCAL_OF_FANUC,
        };
        (1..=most).contains(&(number as usize))
    }

    /// The value of one of them, 0 where none was given.
    pub fn value(&self, number: u32) -> f64 {
        self.values[number as usize - 1]
    }

    pub fn is_vacant(&self, number: u32) -> bool {
        self.given & (1 << number) == 0
    }

    pub fn set(&mut self, number: u32, value: f64) {
        self.values[number as usize - 1] = value;
        self.given |= 1 << number;
    }

    pub fn vacate(&mut self, number: u32) {
        self.values[number as usize - 1] = 0.0;
        self.given &= !(1 << number);
    }
}

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
    /// Remaining repeats.
    Repeat(u32),
}

/// Kind of the call that opened a frame.
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
    /// Parameters 1 to 30, or 33.
    pub numbered: Locals,
    /// Arguments of the G65 that called it: each repeat begins with these.
    pub arguments: Option<Locals>,
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
            numbered: Locals::new(Dialect::LinuxCnc),
            arguments: None,
            named: BTreeMap::new(),
            loops: Vec::new(),
            context: None,
        }
    }
}
