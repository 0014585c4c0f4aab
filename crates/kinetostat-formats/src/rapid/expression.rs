//! Expressions of RAPID, and the arguments of an instruction.

use std::ops::Range;

use crate::interpreter::expression::{Argument, Expression, Operator};
use crate::interpreter::reading::{self, Grammar};
use crate::interpreter::token::TokenFile;
use crate::text::name::Name;

/// Source: ABB, Technical reference manual - RAPID kernel, Priority between operators.
pub(super) const GRAMMAR: Grammar = Grammar {
    operators: &[
        ("OR", Operator::Or, 0),
        ("XOR", Operator::Xor, 0),
        ("AND", Operator::And, 1),
        ("<>", Operator::Unequal, 2),
        ("<=", Operator::LessOrEqual, 2),
        (">=", Operator::GreaterOrEqual, 2),
        ("<", Operator::Less, 2),
        (">", Operator::Greater, 2),
        ("=", Operator::Equal, 2),
        ("+", Operator::Plus, 3),
        ("-", Operator::Minus, 3),
        ("DIV", Operator::WholeQuotient, 4),
        ("MOD", Operator::Remainder, 4),
        ("*", Operator::Times, 4),
        ("/", Operator::Over, 4),
    ],
    not: 1,
    sign: 5,
    index: [b'{', b'}'],
    list: Some([b'[', b']']),
    has_members: false,
    names_arguments: false,
    counts_from_one: true,
    truths: ["FALSE", "TRUE"],
    aggregate: None,
    separates_comparisons: false,
};

/// The expression that tokens are.
pub(crate) fn expression_of(file: &TokenFile<'_>, tokens: Range<usize>) -> Expression {
    reading::expression_of(&GRAMMAR, file, tokens)
}

/// The arguments of a call between two tokens.
pub(crate) fn arguments_of(file: &TokenFile<'_>, tokens: Range<usize>) -> Vec<Argument> {
    reading::arguments_of(&GRAMMAR, file, tokens)
}

/// The arguments of one instruction.
pub(crate) struct Arguments {
    /// Arguments without a backslash.
    pub ordered: Vec<Expression>,
    /// Optional arguments, with a backslash.
    pub options: Vec<(Name, Option<Expression>)>,
}

impl Arguments {
    /// Arguments in the tokens after an instruction's name.
    pub(crate) fn of(file: &TokenFile<'_>, tokens: Range<usize>) -> Self {
        let mut all = Self {
            ordered: Vec::with_capacity(6),
            options: Vec::new(),
        };
        for Argument { option, value } in arguments_of(file, tokens) {
            match (option, value) {
                (Some(name), value) => all.options.push((name, value)),
                (None, Some(value)) => all.ordered.push(value),
                (None, None) => {}
            }
        }
        all
    }

    /// An option by its name in capitals; what it is given, if anything.
    pub(crate) fn option(&self, capitals: &str) -> Option<Option<&Expression>> {
        let found = self.options.iter().find(|(name, _)| name.is(capitals));
        found.map(|(_, value)| value.as_ref())
    }
}
