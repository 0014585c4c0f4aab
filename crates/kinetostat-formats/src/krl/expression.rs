//! Expressions of KRL.

use std::ops::Range;

use crate::interpreter::expression::{Argument, Expression, Operator};
use crate::interpreter::reading::{self, Grammar};
use crate::interpreter::token::TokenFile;

/// Source: KUKA System Software 8.x, Operating and Programming Instructions for System Integrators, Priority of operators. It binds AND
/// more strongly than `==`, which few programs mean: where both stand without brackets, nothing is read.
pub(super) const GRAMMAR: Grammar = Grammar {
    operators: &[
        ("OR", Operator::Or, 0),
        ("EXOR", Operator::Xor, 1),
        ("AND", Operator::And, 2),
        ("==", Operator::Equal, 3),
        ("<>", Operator::Unequal, 3),
        ("<=", Operator::LessOrEqual, 3),
        (">=", Operator::GreaterOrEqual, 3),
        ("<", Operator::Less, 3),
        (">", Operator::Greater, 3),
        ("+", Operator::Plus, 4),
        ("-", Operator::Minus, 4),
        ("*", Operator::Times, 5),
        ("/", Operator::Over, 5),
        (":", Operator::Behind, 6),
    ],
    not: 7,
    sign: 7,
    index: [b'[', b']'],
    list: None,
    has_members: true,
    names_arguments: false,
    counts_from_one: true,
    truths: ["FALSE", "TRUE"],
    aggregate: None,
    separates_comparisons: true,
};

/// The expression that tokens are.
pub(crate) fn expression_of(file: &TokenFile<'_>, tokens: Range<usize>) -> Expression {
    reading::expression_of(&GRAMMAR, file, tokens)
}

/// The arguments of a call between two tokens.
pub(crate) fn arguments_of(file: &TokenFile<'_>, tokens: Range<usize>) -> Vec<Argument> {
    reading::arguments_of(&GRAMMAR, file, tokens)
}
