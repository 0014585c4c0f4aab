//! The statements of a file: a word, its arguments behind a slash, over several lines where `$` ends one.

use std::ops::Range;

use crate::text::number::NumberText;
use crate::text::source::{beginning, next_line};

/// A statement.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Statement {
    /// First word of the statement, as written.
    pub word: Range<usize>,
    /// Text after the slash or comma; may be empty.
    pub arguments: Range<usize>,
    /// Text from the word to the last argument.
    pub span: Range<usize>,
    /// Whole lines of the statement, with the last line end.
    pub lines: Range<usize>,
    /// A slash stands behind the word.
    pub slash: bool,
    /// `NAME = ...`: geometry and numbers.
    pub assigns: bool,
}

/// Words whose arguments are text for people: never parsed.
const TEXTS: [&[u8]; 9] = [
    b"PARTNO", b"PPRINT", b"TPRINT", b"INSERT", b"REMARK", b"TITLES", b"LETTER", b"MACHIN",
    b"DISPLY",
];

/// The statements of a file in their order; comments and empty lines are none. Comments of Creo (`$$->`) go on in further lines, as its statements do.
pub(crate) fn statements_of(bytes: &[u8]) -> Vec<Statement> {
    let mut statements = Vec::with_capacity(bytes.len() / 24);
    let mut at = beginning(bytes);
    while at < bytes.len() {
        let first = at;
        let mut next = next_line(bytes, at);
        let is_creo = bytes[at..next].trim_ascii_start().starts_with(b"$$->");
        if is_creo {
            // A statement of Creo that is a comment to others: it goes on where `$` ends its line.
            while next < bytes.len() && bytes[at..next].trim_ascii_end().ends_with(b"$") {
                at = next;
                next = next_line(bytes, at);
            }
            at = next;
            continue;
        }
        let Some(start) = (at..next).find(|at| !bytes[*at].is_ascii_whitespace()) else {
            at = next;
            continue;
        };
        let length = word_length(&bytes[start..next]);
        let word = start..start + length;
        let is_text = TEXTS
            .iter()
            .any(|text| bytes[word.clone()].eq_ignore_ascii_case(text));
        let mut end = start + bytes[start..next].trim_ascii_end().len();
        if !is_text {
            let mut from = start;
            loop {
                let (until, goes_on) = content(bytes, from..next);
                end = until;
                if !goes_on || next >= bytes.len() {
                    break;
                }
                from = next;
                next = next_line(bytes, next);
            }
        }
        at = next;
        if end <= start {
            continue;
        }
        let behind = (word.end..end).find(|at| !bytes[*at].is_ascii_whitespace());
        let sign = behind.map(|at| bytes[at]);
        let arguments = match (behind, sign) {
            (Some(at), Some(b'/' | b',')) => at + 1..end,
            (Some(at), _) => at..end,
            (None, _) => end..end,
        };
        statements.push(Statement {
            slash: sign == Some(b'/'),
            assigns: sign == Some(b'=') && !is_text,
            word,
            arguments,
            span: start..end,
            lines: first..next,
        });
    }
    statements
}

/// `TOOL PATH` is one word.
fn word_length(line: &[u8]) -> usize {
    let is_part = |byte: &&u8| byte.is_ascii_alphanumeric() || matches!(byte, b'_' | b'-');
    let length = line.iter().take_while(is_part).count();
    match line
        .get(..9)
        .is_some_and(|start| start.eq_ignore_ascii_case(b"TOOL PATH"))
    {
        true => 9,
        false => length,
    }
}

/// End of a line's content before its comment, and true if the statement continues on the next line.
fn content(bytes: &[u8], line: Range<usize>) -> (usize, bool) {
    let mut quoted = false;
    for at in line.clone() {
        match bytes[at] {
            b'\'' => quoted = !quoted,
            b'$' if !quoted => {
                let goes_on = bytes.get(at + 1) != Some(&b'$');
                let said = line.start + bytes[line.start..at].trim_ascii_end().len();
                return (said, goes_on);
            }
            _ => {}
        }
    }
    (line.start + bytes[line].trim_ascii_end().len(), false)
}

/// An argument.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Argument {
    Number(NumberText),
    /// Anything else, without the blanks around it.
    Word(Range<usize>),
}

impl Argument {
    /// Number of the argument, if it is one.
    pub(crate) fn number(&self) -> Option<&NumberText> {
        match self {
            Self::Number(number) => Some(number),
            Self::Word(_) => None,
        }
    }
}

/// The arguments in a part of a file.
pub(crate) fn arguments_of(bytes: &[u8], part: &Range<usize>) -> Vec<Argument> {
    let mut found = Vec::new();
    let mut from = part.start;
    while from < part.end {
        let comma = bytes[from..part.end].iter().position(|byte| *byte == b',');
        let end = comma.map_or(part.end, |comma| from + comma);
        found.push(argument(bytes, from..end));
        from = end + 1;
    }
    found
}

fn argument(bytes: &[u8], field: Range<usize>) -> Argument {
    // The line end of a continued statement is a blank with what stands behind `$`.
    let is_blank = |at: &usize| bytes[*at].is_ascii_whitespace() || bytes[*at] == b'$';
    let start = field.clone().find(|at| !is_blank(at)).unwrap_or(field.end);
    let end = (start..field.end).rev().find(|at| !is_blank(at));
    let end = end.map_or(start, |at| at + 1);
    let text = &bytes[start..end];
    let is_number = text
        .iter()
        .all(|byte| byte.is_ascii_digit() || b"+-.eE".contains(byte))
        && text.iter().any(u8::is_ascii_digit);
    let value: Option<f64> = match is_number {
        true => std::str::from_utf8(text)
            .ok()
            .and_then(|text| text.parse().ok()),
        false => None,
    };
    match value.filter(|value| value.is_finite()) {
        Some(value) => {
            // Columns stay: with the blanks before it but the first.
            let blanks = bytes[field.start..start].iter().rev();
            let blanks = blanks.take_while(|byte| **byte == b' ').count();
            let span = start - blanks.saturating_sub(1)..end;
            Argument::Number(NumberText { span, value })
        }
        None => Argument::Word(start..end),
    }
}

/// All arguments as numbers; none where one is not.
pub(crate) fn all_numbers(arguments: &[Argument]) -> Option<Vec<NumberText>> {
    let numbers = arguments.iter().map(|argument| argument.number().cloned());
    numbers.collect()
}
