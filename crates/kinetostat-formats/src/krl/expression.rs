//! Expressions of KRL, and values in braces: `{X 1.0,Y 2.0,S 2,T 35}`.

use std::ops::Range;

use crate::interpreter::expression::{Argument, Expression, Operator};
use crate::interpreter::reading::{self, Grammar};
use crate::interpreter::token::{Kind, TokenFile};
use crate::text::Name;

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

/// Members and the tokens of their values.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Aggregate {
    members: Vec<(Name, Range<usize>)>,
}

/// The members of a value in braces; none where it is none.
pub(crate) fn aggregate_of(file: &TokenFile<'_>, tokens: &Range<usize>) -> Option<Aggregate> {
    if tokens.len() < 2 || !file.is(tokens.start, b'{') || !file.is(tokens.end - 1, b'}') {
        return None;
    }
    let inside = tokens.start + 1..tokens.end - 1;
    let typed = file.is(inside.start + 1, b':');
    let mut at = inside.start + 2 * usize::from(typed);
    let mut members = Vec::with_capacity(14);
    while at < inside.end {
        let end = file.find(at..inside.end, b',').unwrap_or(inside.end);
        let name = file.name(at)?;
        let is_text = file.is(at + 1, b'[') && file.is(at + 2, b']');
        let value = at + 1 + 2 * usize::from(is_text)..end;
        // Without a blank between them another number could grow into the name; digits in quotation marks are no name.
        let touches = file.span(&value).start == file.span(&(at..value.start)).end;
        if value.is_empty() || (touches && file.tokens[value.start].kind != Kind::Bits) {
            return None;
        }
        members.push((name, value));
        at = end + 1;
    }
    Some(Aggregate { members })
}

impl Aggregate {
    /// The value of a member.
    pub(crate) fn member(&self, capitals: &str) -> Option<&Range<usize>> {
        let found = self.members.iter().find(|(name, _)| name.is(capitals));
        found.map(|(_, value)| value)
    }

    /// A member that is a number.
    pub(crate) fn number(&self, file: &TokenFile<'_>, capitals: &str) -> Option<f64> {
        number_of(file, self.member(capitals)?)
    }
}

/// A number with its sign, or digits of base 2 or 16.
pub(crate) fn number_of(file: &TokenFile<'_>, tokens: &Range<usize>) -> Option<f64> {
    let signed = usize::from(
        tokens.len() == 2 && (file.is(tokens.start, b'-') || file.is(tokens.start, b'+')),
    );
    if tokens.len() != 1 + signed {
        return None;
    }
    let at = tokens.start + signed;
    let value = match file.tokens.get(at)?.kind {
        Kind::Number => std::str::from_utf8(file.word(at)).ok()?.parse().ok()?,
        Kind::Bits => file.bits(at)?,
        _ => return None,
    };
    let value = match signed == 1 && file.is(tokens.start, b'-') {
        true => -value,
        false => value,
    };
    value.is_finite().then_some(value)
}

/// `[3]`, or nothing, which is 0; none for all else.
pub(crate) fn literal_index(file: &TokenFile<'_>, tokens: Range<usize>) -> Option<u32> {
    if tokens.is_empty() {
        return Some(0);
    }
    let is_number = tokens.len() == 3 && file.tokens[tokens.start + 1].kind == Kind::Number;
    let closed = file.is(tokens.start, b'[') && file.is(tokens.end - 1, b']');
    let text = std::str::from_utf8(file.word(tokens.start + 1)).ok()?;
    (is_number && closed).then(|| text.parse().ok())?
}

/// A name, or an element of an array, and the tokens it is written with. An index that is no literal number is none.
pub(crate) fn place_of(file: &TokenFile<'_>, at: usize, end: usize) -> (Range<usize>, Option<u32>) {
    if !file.is(at + 1, b'[') || at + 1 >= end {
        return (at..at + 1, Some(0));
    }
    let close = file.find(at + 2..end, b']').map_or(end, |close| close + 1);
    (at..close, literal_index(file, at + 1..close))
}
