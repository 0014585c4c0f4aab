//! The arguments of a statement: numbers and words between commas.

use std::ops::Range;

use crate::text::number::NumberText;

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
