//! Numbers of a text, printed again as the text printed them, and lists of lines in words.

use std::ops::Range;

/// A number as it stands in a file.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct NumberText {
    /// Byte range of the number; with the preceding blanks if the file has columns of fixed width.
    pub span: Range<usize>,
    /// Value of the number.
    pub value: f64,
}

/// Prints a number with so many decimals; a zero has no sign.
pub(crate) fn fixed(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    let is_zero = !text.bytes().any(|byte| (b'1'..=b'9').contains(&byte));
    match text.strip_prefix('-') {
        Some(positive) if is_zero => positive.to_owned(),
        _ => text,
    }
}

/// Prints a number with at most so many decimals, and no trailing zeros.
pub(crate) fn short(value: f64, decimals: usize) -> String {
    let text = fixed(value, decimals);
    match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
        false => text,
    }
}

/// Width policy of a number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Width {
    /// Width as needed.
    Free,
    /// Original width if the number fits: columns stay aligned.
    Kept,
}

/// Digits behind the point of a printed number.
fn decimals(text: &[u8]) -> usize {
    let is_exponent = |byte: &u8| matches!(byte, b'e' | b'E');
    let end = text.iter().position(is_exponent).unwrap_or(text.len());
    let point = text.iter().position(|byte| *byte == b'.');
    match (point, end == text.len()) {
        (Some(point), true) => text[point + 1..]
            .iter()
            .filter(|b| b.is_ascii_digit())
            .count(),
        _ => 0,
    }
}

/// Limit of the printed decimals: a double has no more in mm.
const MOST_DECIMALS: usize = 12;

/// The value as the text would print it: with as many decimals as it had, but at least so many; with its plus sign and
/// without the zero before the point if it had none. A value that prints as the old one keeps the old text, byte for byte.
#[must_use]
pub fn printed(
    original: &[u8],
    old: f64,
    value: f64,
    least_decimals: usize,
    width: Width,
) -> Vec<u8> {
    let digits = decimals(original).max(least_decimals).min(MOST_DECIMALS);
    let mut text = fixed(value, digits);
    if text == fixed(old, digits) {
        return original.to_vec();
    }
    let body = original.trim_ascii_start();
    if body.starts_with(b"+") && !text.starts_with('-') {
        text.insert(0, '+');
    }
    let unsigned = body.strip_prefix(b"-").or(body.strip_prefix(b"+"));
    if unsigned.unwrap_or(body).starts_with(b".") {
        text = match text.strip_prefix("-0.") {
            Some(rest) => format!("-.{rest}"),
            None if text.starts_with("0.") => text[1..].to_owned(),
            None => text,
        };
    }
    let wide = match width {
        Width::Free => 0,
        // What is printed has no wider columns.
        Width::Kept => original.len().min(usize::from(u16::MAX)),
    };
    format!("{text:>wide$}").into_bytes()
}

/// The values of numbers, where there are some.
pub(crate) fn values_of(numbers: &[Option<NumberText>]) -> Vec<Option<f64>> {
    let numbers = numbers.iter();
    numbers.map(|number| Some(number.as_ref()?.value)).collect()
}

/// Lines are named up to so many.
const MOST_NAMED: usize = 20;

/// Lines in words, those that follow one another as one.
pub(crate) fn in_words(lines: &[usize]) -> String {
    let mut ranges: Vec<[usize; 2]> = Vec::new();
    for line in lines {
        match ranges.last_mut() {
            Some([_, to]) if *to + 1 == *line => *to = *line,
            _ => ranges.push([*line, *line]),
        }
    }
    let named = ranges.iter().take(MOST_NAMED);
    let named: Vec<String> = named
        .map(|[from, to]| match to - from {
            0 => from.to_string(),
            1 => format!("{from}, {to}"),
            _ => format!("{from} to {to}"),
        })
        .collect();
    let rest: usize = ranges
        .iter()
        .skip(MOST_NAMED)
        .map(|[from, to]| to - from + 1)
        .sum();
    let more = match (rest, lines.last()) {
        (1.., Some(last)) => format!(" and {rest} more, the last {last}"),
        _ => String::new(),
    };
    let word = match lines.len() {
        1 => "line",
        _ => "lines",
    };
    format!("{word} {}{more}", named.join(", "))
}
