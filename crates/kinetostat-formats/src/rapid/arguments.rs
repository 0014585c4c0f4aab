//! The arguments of an instruction: those in order, and by which options each is followed.

use std::ops::Range;

use crate::interpreter::expression::{Argument, Expression};
use crate::interpreter::token::TokenFile;
use crate::rapid::expression::arguments_of;
use crate::text::name::Name;

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
