//! Modules, routines, declarations and statements of a file, by ranges of tokens, and the ways on behind a statement.

use std::ops::Range;

use crate::interpreter::value::Datum;
use crate::text::Name;

/// Mutability of a datum.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Change {
    Constant,
    Persistent,
    Variable,
}

/// Visibility of a name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Sight {
    Everywhere,
    Module,
}

/// A declaration.
#[derive(Debug, Clone)]
pub(crate) struct DatumNode {
    pub change: Change,
    pub sight: Sight,
    pub type_name: Name,
    pub name: Name,
    /// Token of its name.
    pub name_at: usize,
    /// The whole statement with its semicolon.
    pub tokens: Range<usize>,
    /// Tokens of the initial value.
    pub initial: Option<Range<usize>>,
    /// Tokens of the array dimensions, in brackets.
    pub dimensions: Option<Range<usize>>,
    /// True where its statement declares no other name.
    pub is_alone: bool,
}

/// The first value of an element of an array, in a statement of its own (`BASE_DATA[1]={X 0}`); index 0 is the whole of what the system
/// declares.
#[derive(Debug, Clone)]
pub(crate) struct Preset {
    pub name: Name,
    pub name_at: usize,
    pub index: usize,
    pub tokens: Range<usize>,
    pub value: Range<usize>,
}

/// A parameter of a routine.
#[derive(Debug, Clone)]
pub(crate) struct Parameter {
    pub name: Name,
    /// True if the routine may change its argument (INOUT, VAR, PERS).
    pub changes: bool,
    /// Named by an option of the call.
    pub is_optional: bool,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum RoutineKind {
    Procedure,
    Function,
    /// Routine that runs in parallel or as an interrupt.
    Trap,
    /// A procedure that is no program of its own: in another one, or with arguments.
    Inner,
}

/// A routine.
#[derive(Debug, Clone)]
pub(crate) struct Routine {
    pub kind: RoutineKind,
    pub sight: Sight,
    pub name: Name,
    pub name_at: usize,
    pub parameters: Vec<Parameter>,
    pub data: Vec<DatumNode>,
    pub body: Vec<Statement>,
    /// ERROR, UNDO and BACKWARD.
    pub handlers: Vec<Statement>,
    /// Tokens from LOCAL, PROC, FUNC or TRAP to the end of the routine.
    pub whole: Range<usize>,
    /// Statements before the handlers.
    pub statements: Range<usize>,
}

impl Routine {
    /// Sees the tokens of all statements, conditions and headers.
    pub(crate) fn each_part(&self, see: &mut dyn FnMut(&Range<usize>)) {
        for statement in self.body.iter().chain(&self.handlers) {
            statement.each_part(see);
        }
    }
}

/// A module of a file.
#[derive(Debug, Clone, Default)]
pub(crate) struct Module {
    pub data: Vec<DatumNode>,
    pub routines: Vec<Routine>,
}

/// Execution rule of the blocks of a branch.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Choice {
    /// Exactly one block runs.
    OneOfAll,
    /// At most one block runs.
    AtMostOne,
    /// One statement behind `IF condition`, without THEN.
    Compact,
}

/// Repetition rule of a loop.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum LoopKind {
    /// A variable counts (`FOR`).
    Counting,
    /// While the condition of its header holds.
    While,
    /// Loop with its condition at the end: at least one pass.
    Until,
    /// Endless loop: only a statement in it leaves it.
    Endless,
}

/// A statement of a routine.
#[derive(Debug, Clone)]
pub(crate) enum Statement {
    Assignment {
        tokens: Range<usize>,
        /// Token of `:=`.
        assign: usize,
    },
    /// An instruction or the call of a procedure, with its semicolon.
    Call { tokens: Range<usize> },
    Branches {
        /// Conditions of IF and each ELSEIF; selector of TEST, and the values of each CASE.
        conditions: Vec<Range<usize>>,
        choice: Choice,
        blocks: Vec<Vec<Statement>>,
        /// Tokens from IF or TEST to its end.
        whole: Range<usize>,
    },
    Loop {
        kind: LoopKind,
        /// Tokens of the counter, or of the condition.
        header: Range<usize>,
        block: Vec<Statement>,
        /// Tokens from FOR or WHILE to its end.
        whole: Range<usize>,
    },
    /// `name:`, the token of the name.
    Label { at: usize },
    /// RETURN, EXIT, RAISE, RETRY, TRYNEXT, GOTO: what follows does not run.
    Leaves { tokens: Range<usize> },
}

impl Statement {
    /// The tokens of the statement, or of its first part.
    pub(crate) fn tokens(&self) -> Option<Range<usize>> {
        let mut found = None;
        self.each_part(&mut |tokens| found = found.take().or_else(|| Some(tokens.clone())));
        found
    }

    /// Sees the statement and those in it.
    pub(crate) fn each(&self, see: &mut dyn FnMut(&Self)) {
        see(self);
        let blocks = match self {
            Self::Branches { blocks, .. } => blocks.as_slice(),
            Self::Loop { block, .. } => std::slice::from_ref(block),
            _ => &[],
        };
        for statement in blocks.iter().flatten() {
            statement.each(see);
        }
    }

    /// Sees the tokens of the statement, or of its conditions and of the statements in it.
    pub(crate) fn each_part(&self, see: &mut dyn FnMut(&Range<usize>)) {
        match self {
            Self::Assignment { tokens, .. } | Self::Call { tokens } | Self::Leaves { tokens } => {
                see(tokens);
            }
            Self::Branches {
                conditions, blocks, ..
            } => {
                conditions.iter().for_each(&mut *see);
                for statement in blocks.iter().flatten() {
                    statement.each_part(see);
                }
            }
            Self::Loop { header, block, .. } => {
                see(header);
                for statement in block {
                    statement.each_part(see);
                }
            }
            Self::Label { .. } => {}
        }
    }
}

/// Continuation of a run after a statement.
pub(crate) enum Flow {
    Next,
    /// Return to the caller, with the value of a function.
    Returns(Option<Datum>),
    /// Jump to a label of an enclosing block.
    To(Name, Range<usize>),
    /// Leaves the innermost loop.
    Breaks,
    /// Next pass of the innermost loop.
    Continues,
    /// End of the program.
    Ends,
}

/// A statement that leaves its block.
pub(crate) enum Leave {
    /// Jump to a label.
    Jump(Name),
    /// Return from the routine, with the tokens of a value.
    Returns(Option<Range<usize>>),
    /// Exit from the innermost loop.
    Breaks,
    /// Next pass of the innermost loop.
    Continues,
    /// The program ends.
    Ends,
}

/// A loop that counts, by tokens.
pub(crate) struct Counting {
    pub variable: Range<usize>,
    pub from: Range<usize>,
    pub to: Range<usize>,
    pub step: Option<Range<usize>>,
}
