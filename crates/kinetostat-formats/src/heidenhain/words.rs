//! The words of a block: letters with a number, a sign, a Q parameter or a text; the resolution of lengths.

use std::ops::Range;

use crate::text::Name;
use crate::text::number::{NumberText, short};

/// Value after the letters of a word.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Value {
    None,
    /// `DR+`.
    Sign(f64),
    Number(NumberText),
    /// `+Q5`: its place, its sign, its name.
    Parameter {
        span: Range<usize>,
        sign: f64,
        name: Range<usize>,
    },
    /// Text between quotes.
    Text(Range<usize>),
}

/// A word.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Word {
    /// Letters and value.
    pub span: Range<usize>,
    /// Letters in capitals; empty for a number alone.
    pub letters: Name,
    pub value: Value,
}

impl Word {
    pub(crate) fn is(&self, capitals: &str) -> bool {
        self.letters.is(capitals)
    }

    /// Number of the word, if any.
    pub(crate) fn number(&self) -> Option<&NumberText> {
        match &self.value {
            Value::Number(number) => Some(number),
            _ => None,
        }
    }

    pub(crate) fn value(&self) -> Option<f64> {
        self.number().map(|number| number.value)
    }

    /// Number of the word if it is a small integer.
    pub(crate) fn whole(&self) -> Option<u32> {
        let value = self.value()?;
        (value.fract() == 0.0 && (0.0..1e6).contains(&value)).then_some(value as u32)
    }
}

/// Reason and remedy of a number with an exponent.
pub(crate) const EXPONENT: (&str, &str) = (
    "a number with an exponent, which the control does not read",
    "write the number out: X+100.5",
);

/// The `e20` of a number `1e20` among the words of a block that names no program.
pub(crate) fn exponent(words: &[Word]) -> Option<&Word> {
    if words.iter().any(|word| word.is("PGM")) {
        return None;
    }
    let pair = words.windows(2).find(|pair| {
        pair[1].is("E") && pair[0].number().is_some() && pair[0].span.end == pair[1].span.start
    })?;
    Some(&pair[1])
}

/// Larger than any length, feed or angle of a program.
const LARGEST: f64 = 1e9;

/// Letters longer than this are no word of the language: they are cut.
const LONGEST: usize = 32;

/// The words of a part of a file. Comments hold none.
pub(crate) fn words_of(bytes: &[u8], text: &Range<usize>) -> Vec<Word> {
    let mut words = Vec::new();
    let mut at = text.start;
    // Comments and headings, over all their lines.
    if bytes
        .get(at)
        .is_some_and(|byte| matches!(byte, b'*' | b';'))
    {
        return words;
    }
    while at < text.end {
        match bytes[at] {
            b';' => {
                let line = bytes[at..text.end].iter().position(|byte| *byte == b'\n');
                at = line.map_or(text.end, |line| at + line + 1);
            }
            byte if byte.is_ascii_whitespace() || byte == b'~' => at += 1,
            _ => {
                let word = word(bytes, at, text.end);
                at = word.span.end.max(at + 1);
                words.push(word);
            }
        }
    }
    words
}

fn word(bytes: &[u8], start: usize, end: usize) -> Word {
    let letters = bytes[start..end]
        .iter()
        .take_while(|byte| byte.is_ascii_alphabetic() || **byte == b'_')
        .count();
    let mut behind = start + letters.min(LONGEST);
    // `XQ1` and `FQ52` are X and F with a parameter.
    let is_digit = |at: usize| at < end && bytes[at].is_ascii_digit();
    if is_digit(behind) {
        for name in [&b"QL"[..], b"QR", b"QS", b"Q"] {
            let part = &bytes[start..behind];
            if part.len() > name.len() && part[part.len() - name.len()..].eq_ignore_ascii_case(name)
            {
                behind -= name.len();
                break;
            }
        }
    }
    let name = |part: &[u8]| Name::of(part).unwrap_or_else(Name::empty);
    let own = &bytes[start..behind];
    let turns = own.eq_ignore_ascii_case(b"DR");
    let (value, until) = value(bytes, behind, end, turns);
    if value == Value::None && own.is_empty() {
        return Word {
            span: start..start + 1,
            letters: name(&bytes[start..start + 1]),
            value,
        };
    }
    Word {
        span: start..until,
        letters: name(own),
        value,
    }
}

/// The value at a place behind letters, and where it ends.
fn value(bytes: &[u8], from: usize, end: usize, sign_alone: bool) -> (Value, usize) {
    let blanks = |at: usize| {
        let count = bytes[at..end]
            .iter()
            .take_while(|byte| matches!(byte, b' ' | b'\t'))
            .count();
        at + count
    };
    let start = blanks(from);
    let sign = match bytes[start..end].first() {
        Some(b'+') => Some(1.0),
        Some(b'-') => Some(-1.0),
        Some(b'"') => {
            let text = &bytes[start + 1..end];
            let length = text.iter().position(|byte| matches!(byte, b'"' | b'\n'));
            let length = length.unwrap_or(text.len());
            let close = (start + 1 + length + 1).min(end);
            return (Value::Text(start + 1..start + 1 + length), close);
        }
        _ => None,
    };
    if let (true, Some(sign)) = (sign_alone, sign) {
        return (Value::Sign(sign), start + 1);
    }
    let body = match sign {
        Some(_) => blanks(start + 1),
        None => start,
    };
    let count = bytes[body..end]
        .iter()
        .take_while(|byte| byte.is_ascii_digit() || matches!(byte, b'.' | b','))
        .count();
    let digits = &bytes[body..body + count];
    if digits.iter().any(u8::is_ascii_digit) {
        let text: String = digits
            .iter()
            .map(|byte| match byte {
                b',' => '.',
                other => char::from(*other),
            })
            .collect();
        // Larger values are no numbers of a program.
        if let Some(size) = text.parse::<f64>().ok().filter(|size| *size < LARGEST) {
            let value = sign.unwrap_or(1.0) * size;
            let span = start..body + count;
            return (Value::Number(NumberText { span, value }), body + count);
        }
    }
    let parameter = parameter_at(bytes, body, end);
    match (parameter, sign) {
        (Some(name), _) => {
            let until = name.end;
            let span = start..until;
            let sign = sign.unwrap_or(1.0);
            (Value::Parameter { span, sign, name }, until)
        }
        (None, Some(sign)) => (Value::Sign(sign), start + 1),
        (None, None) => (Value::None, from),
    }
}

/// The name of a parameter that begins at a place: `Q12`, `QL3`, `QR4`.
pub(crate) fn parameter_at(bytes: &[u8], at: usize, end: usize) -> Option<Range<usize>> {
    let part = &bytes[at.min(end)..end];
    if !part.first()?.eq_ignore_ascii_case(&b'Q') {
        return None;
    }
    let letters = match part.get(1)?.to_ascii_uppercase() {
        b'L' | b'R' | b'S' => 2,
        _ => 1,
    };
    let digits = part[letters.min(part.len())..]
        .iter()
        .take_while(|byte| byte.is_ascii_digit())
        .count();
    (digits > 0).then_some(at..at + letters + digits)
}

/// Decimals of a length in a unit of so many mm: 4 in mm, 5 in inches. The control takes no more.
pub(crate) fn decimals(unit_mm: f64) -> usize {
    match unit_mm == 1.0 {
        true => 4,
        false => 5,
    }
}

/// A length with its sign, as finely as the control resolves it.
pub(crate) fn length(value: f64, unit_mm: f64) -> String {
    let text = short(value, decimals(unit_mm));
    match text.starts_with('-') {
        true => text,
        false => format!("+{text}"),
    }
}
