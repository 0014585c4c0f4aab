//! What a file holds: routines, declarations and statements, by lines and ranges of tokens.

use std::ops::Range;

use crate::text::name::Name;

/// A declared name.
#[derive(Debug, Clone)]
pub(crate) struct DatumNode {
    pub type_name: Name,
    pub name: Name,
    /// Token of its name.
    pub name_at: usize,
    /// The whole statement.
    pub tokens: Range<usize>,
    /// Of its first value.
    pub initial: Option<Range<usize>>,
    /// It is the only name of its statement.
    pub alone: bool,
    pub is_global: bool,
}

/// An assignment between declarations: an element of an array, or a system's datum.
#[derive(Debug, Clone)]
pub(crate) struct Preset {
    pub name: Name,
    /// A literal index; 0 for none.
    pub index: u32,
    pub tokens: Range<usize>,
    pub value: Range<usize>,
}

/// A parameter of a routine.
#[derive(Debug, Clone)]
pub(crate) struct Parameter {
    pub name: Name,
    /// Whether the routine may change what is given: all that is not `:IN`.
    pub changes: bool,
}

/// A routine.
#[derive(Debug, Clone)]
pub(crate) struct Routine {
    pub is_global: bool,
    pub name: Name,
    pub name_at: usize,
    pub parameters: Vec<Parameter>,
    pub data: Vec<DatumNode>,
    pub body: Vec<Statement>,
    /// It has a GOTO: its order is not that of its lines.
    pub jumps: bool,
}

/// What a file holds.
#[derive(Debug, Clone, Default)]
pub(crate) struct Content {
    pub data: Vec<DatumNode>,
    pub presets: Vec<Preset>,
    pub routines: Vec<Routine>,
    /// The name behind DEFDAT.
    pub list: Option<Name>,
}

/// How often the block of a loop runs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Least {
    Never,
    Once,
}

/// A statement of a routine; lines are indices of the lines of its file.
#[derive(Debug, Clone)]
pub(crate) enum Statement {
    Simple(usize),
    Branches {
        header: usize,
        /// One of the blocks runs.
        complete: bool,
        blocks: Vec<Vec<Statement>>,
    },
    Loop {
        header: usize,
        least: Least,
        block: Vec<Statement>,
    },
    Label,
    /// RETURN and GOTO.
    Leaves(usize),
    Exit,
}
