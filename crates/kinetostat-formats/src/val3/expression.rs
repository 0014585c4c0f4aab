//! Tokens and expressions of VAL3, and the values of data as their XML states them.

use std::ops::Range;

use crate::interpreter::expression::{Expression, Node, Operator};
use crate::interpreter::lexing::{equals, number};
use crate::interpreter::reading::{self, Grammar};
use crate::interpreter::token::{Kind, Token, TokenFile};
use crate::text::Name;

/// Source: Staubli, VAL3 Reference Manual, Operators.
pub(super) const GRAMMAR: Grammar = Grammar {
    operators: &[
        ("or", Operator::Or, 0),
        ("xor", Operator::Xor, 1),
        ("and", Operator::And, 2),
        ("==", Operator::Equal, 3),
        ("!=", Operator::Unequal, 3),
        ("<=", Operator::LessOrEqual, 4),
        (">=", Operator::GreaterOrEqual, 4),
        ("<", Operator::Less, 4),
        (">", Operator::Greater, 4),
        ("+", Operator::Plus, 5),
        ("-", Operator::Minus, 5),
        ("*", Operator::Times, 6),
        ("/", Operator::Over, 6),
        ("%", Operator::Remainder, 6),
    ],
    not: 7,
    sign: 7,
    index: [b'[', b']'],
    list: Some([b'{', b'}']),
    has_members: false,
    names_arguments: false,
    counts_from_one: false,
    truths: ["false", "true"],
    aggregate: None,
    separates_comparisons: false,
};

/// Numbers of a transformation, and of joints.
pub(super) const PARTS: [[&str; 6]; 2] = [
    ["X", "Y", "Z", "RX", "RY", "RZ"],
    ["J1", "J2", "J3", "J4", "J5", "J6"],
];

/// Limit of the elements of an array.
const MOST_ELEMENTS: usize = 100_000;

/// The expression that tokens are; tokens of a datum in XML are its value.
pub(super) fn expression_of(file: &TokenFile<'_>, tokens: Range<usize>) -> Expression {
    match file.is(tokens.start, b'<') {
        true => datum(file, tokens),
        false => reading::expression_of(&GRAMMAR, file, tokens),
    }
}

/// Attributes of a value: names with the tokens of what they say.
type Attributes = Vec<(Name, usize)>;

/// A datum: its value, or a list of those of its elements. An element that is not there has the value with which the controller begins.
fn datum(file: &TokenFile<'_>, tokens: Range<usize>) -> Expression {
    let is_bracket = |at: &usize| file.is(*at, b'<');
    let begins: Vec<usize> = (tokens.start + 1..tokens.end).filter(is_bracket).collect();
    let attributes = |from: usize, end: usize| -> Attributes {
        let pairs = (from..end.saturating_sub(1)).step_by(2);
        pairs
            .filter_map(|at| Some((file.name(at)?, at + 1)))
            .collect()
    };
    let whole = |at: usize| {
        file.word(at)
            .escape_ascii()
            .to_string()
            .parse::<usize>()
            .ok()
    };
    let head_end = begins.first().map_or(tokens.end - 1, |first| *first);
    let head = attributes(tokens.start + 3, head_end);
    let size = head
        .first()
        .map_or(Some(begins.len().clamp(1, MOST_ELEMENTS)), |(_, at)| {
            whole(*at)
        });
    let Some(type_name) = file.name(tokens.start + 2) else {
        return unreadable(tokens);
    };
    let Some(size) = size.filter(|size| (1..=MOST_ELEMENTS).contains(size)) else {
        return unreadable(tokens);
    };
    let mut elements = vec![value(file, &type_name, tokens.start, Vec::new()); size];
    for (number, begin) in begins.iter().enumerate() {
        let end = begins.get(number + 1).map_or(tokens.end - 1, |next| *next);
        let all = attributes(begin + 1, end);
        let key = all
            .iter()
            .find(|(name, _)| name.is("KEY") || name.is("INDEX"));
        let place = key.map_or(Some(number), |(_, at)| whole(*at));
        match place.and_then(|place| elements.get_mut(place)) {
            Some(element) => *element = value(file, &type_name, *begin, all),
            None => return unreadable(tokens),
        }
    }
    match (elements.len(), elements.pop()) {
        (1, Some(only)) => only,
        (_, Some(last)) => {
            elements.push(last);
            let node = Node::List(elements);
            Expression { node, tokens }
        }
        (_, None) => unreadable(tokens),
    }
}

fn unreadable(tokens: Range<usize>) -> Expression {
    let node = Node::Unreadable;
    Expression { node, tokens }
}

/// True for types of which the XML states the values.
pub(super) fn has_values(type_name: &Name) -> bool {
    let letters = type_name.letters();
    let kinds = ["NUM", "BOOL", "STRING", "TRSF", "MDESC", "FRAME", "TOOL"];
    kinds.iter().any(|kind| type_name.is(kind))
        || letters.starts_with(b"POINT")
        || letters.starts_with(b"JOINT")
}

/// The value of attributes; `begin` is the bracket before them, which stands for numbers that are left out.
fn value(file: &TokenFile<'_>, type_name: &Name, begin: usize, mut all: Attributes) -> Expression {
    let left_out = |node: Node| Expression {
        node,
        tokens: begin..begin + 1,
    };
    let of = |(_, at): &(Name, usize)| {
        let node = match file.tokens[*at].kind {
            Kind::Number => reading::expression_of(&GRAMMAR, file, *at..*at + 1).node,
            _ => Node::Text,
        };
        Expression {
            node,
            tokens: *at..*at + 1,
        }
    };
    let find = |name: &str| all.iter().find(|(own, _)| own.is(name));
    let numbers = |names: [&str; 6]| {
        let number = |name: &str| find(name).map_or_else(|| left_out(Node::Number(0.0)), of);
        left_out(Node::List(names.map(number).to_vec()))
    };
    let first = find("VALUE");
    match type_name.letters() {
        b"NUM" => return first.map_or_else(|| left_out(Node::Number(0.0)), of),
        b"BOOL" => {
            return left_out(Node::Truth(
                first.is_some_and(|(_, at)| file.word(*at) == b"true"),
            ));
        }
        b"STRING" => return first.map_or_else(|| left_out(Node::Unreadable), of),
        b"TRSF" => return numbers(PARTS[0]),
        [b'J', ..] => return numbers(PARTS[1]),
        _ => {}
    }
    let mut members: Vec<(Name, Expression)> = all.iter().map(|own| (own.0, of(own))).collect();
    if !type_name.is("MDESC") {
        members.extend(Name::of(b"TRSF").map(|name| (name, numbers(PARTS[0]))));
    }
    for (name, _) in &mut members {
        let stated = [("TMAX", "TVEL"), ("RMAX", "RVEL")]
            .into_iter()
            .find(|(own, _)| name.is(own));
        *name = stated
            .and_then(|(_, own)| Name::of(own.as_bytes()))
            .unwrap_or(*name);
    }
    let is_key_first = all.first().is_some_and(|(name, _)| name.is("KEY"));
    all.drain(..usize::from(is_key_first));
    let tokens = match (all.first(), all.last()) {
        (Some((_, first)), Some((_, last))) => first - 1..last + 1,
        _ => begin..begin + 1,
    };
    Expression {
        node: Node::Members(members),
        tokens,
    }
}

/// Bytes of entities and what they stand for, where the text is not in CDATA.
const ENTITIES: [(&[u8], u8); 5] = [
    (b"&lt;", b'<'),
    (b"&gt;", b'>'),
    (b"&amp;", b'&'),
    (b"&quot;", b'"'),
    (b"&apos;", b'\''),
];

/// Adds the tokens of program text; `is_escaped` where `<` and its kin stand as entities. A byte that begins nothing known is a token of
/// its own, and the parser says what is wrong.
pub(super) fn add_tokens(
    bytes: &[u8],
    span: &Range<usize>,
    is_escaped: bool,
    tokens: &mut Vec<Token>,
) {
    let mut at = span.start;
    while at < span.end {
        let rest = &bytes[at..span.end];
        let entity = ENTITIES
            .iter()
            .find(|(text, _)| is_escaped && rest.starts_with(text));
        let (first, width) = entity.map_or((rest[0], 1), |(text, byte)| (*byte, text.len()));
        let count = |is: fn(&u8) -> bool| rest.iter().take_while(|byte| is(byte)).count();
        let (kind, length) = match first {
            b' ' | b'\t' | b'\r' | b'\n' => {
                at += 1;
                continue;
            }
            b'/' if rest.starts_with(b"//") => {
                at += count(|byte| *byte != b'\n');
                continue;
            }
            b'"' => text(rest, &rest[..width]),
            b'0'..=b'9' => (Kind::Number, number(rest)),
            b'.' if rest.get(1).is_some_and(u8::is_ascii_digit) => (Kind::Number, number(rest)),
            _ if is_letter(first) => (Kind::Word, word(rest)),
            b'=' => (equals(tokens, at, rest), 1),
            byte => (Kind::Symbol(byte), width),
        };
        tokens.push(Token::new(kind, &(at..at + length)));
        at += length;
    }
}

fn is_letter(byte: u8) -> bool {
    byte.is_ascii_alphabetic() || byte == b'_' || byte >= 0x80
}

fn is_part(byte: &u8) -> bool {
    is_letter(*byte) || byte.is_ascii_digit()
}

/// An identifier; that of a library's program has a colon.
fn word(rest: &[u8]) -> usize {
    let mut end = 0;
    loop {
        end += rest[end..].iter().take_while(|byte| is_part(byte)).count();
        match rest.get(end..) {
            Some([b':', next, ..]) if is_letter(*next) => end += 1,
            _ => return end,
        }
    }
}

/// Reads a text up to its closing mark on the line.
fn text(rest: &[u8], mark: &[u8]) -> (Kind, usize) {
    let line = rest.iter().take_while(|byte| **byte != b'\n').count();
    let mut at = mark.len();
    while at < line {
        if rest[at..line].starts_with(mark) {
            return (Kind::Text, at + mark.len());
        }
        at += if rest[at] == b'\\' { 2 } else { 1 };
    }
    (Kind::OpenText, line)
}
