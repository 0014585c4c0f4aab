//! Statements of a program.

use std::ops::Range;

use crate::expanding::expression::tree::{Expression, Parameter};

/// A line that was read.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct SourceLine {
    /// Bytes of the file, without the line ending.
    pub span: Range<usize>,
    pub block_delete: bool,
    /// Bytes before the words, where / has a number behind it (Fanuc).
    pub skip_number: Option<usize>,
    /// The N word, where it is a whole number: a label of GOTO.
    pub label: Option<u32>,
    pub statement: Statement,
}

/// Kind of a statement.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Statement {
    /// Plain words and comments only: run as it stands.
    Plain,
    /// Words with expressions, and assignments, in the order of the line.
    Block(Vec<Piece>),
    /// An O word with a keyword.
    Structure(OLabel, Structure),
    /// `O1000` alone: the beginning of a program or of a subprogram that M98 calls.
    ProgramNumber(u32),
    /// `IF [..] GOTO n`, or `GOTO n` with no condition.
    Goto(Option<Expression>, Expression),
    /// `IF [..] THEN #1 = ..`.
    Then(Expression, Parameter, Expression),
    /// `WHILE [..] DO m`; `DO m` with no condition.
    While(Option<Expression>, u32),
    /// `END m`.
    End(u32),
}

/// A part of a block.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Piece {
    /// Plain words, comments and blanks, carried as they stand; bytes of the line.
    Text(Range<usize>),
    /// A letter whose number is an expression; bytes of the line.
    Word(u8, Expression, Range<usize>),
    /// `#1 = ...`; takes effect behind the block.
    Assignment(Parameter, Expression),
}

/// Label of an O word.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum OLabel {
    Name(String),
    /// A number, or an expression that says it.
    Number(Expression),
}

/// The keyword behind an O word.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Structure {
    Sub,
    EndSub(Option<Expression>),
    Return(Option<Expression>),
    Call(Vec<Expression>),
    If(Expression),
    ElseIf(Expression),
    Else,
    EndIf,
    While(Expression),
    EndWhile,
    Do,
    Repeat(Expression),
    EndRepeat,
    Break,
    Continue,
}
