//! Faults that the reader of TOML finds, as data.
//!
//! The library `toml` and the readers that serde derives say a fault in words only. This module is the one place where
//! these words are read; the tests of this crate hold them against errors of the library itself, so that a version of it
//! that says them otherwise is noticed.

use std::ops::Range;

/// A fault that the reader of TOML found.
///
/// ```
/// use std::collections::BTreeMap;
/// use kinetostat_diagnostic::{TomlFault, TomlFaultKind};
///
/// let error = toml::from_str::<BTreeMap<String, u8>>("teeth = 2\ndepth = \"deep\"\n").unwrap_err();
/// let fault = TomlFault::of(&error);
/// assert_eq!(fault.span, 18..24);
/// let (found, expected) = ("the text \"deep\"".to_owned(), "a whole number".to_owned());
/// assert_eq!(fault.kind, TomlFaultKind::Mismatch { found, expected });
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TomlFault {
    /// Place in the text, bytes.
    pub span: Range<usize>,
    /// The words of the library, in one line.
    pub message: String,
    /// Kind of the fault.
    pub kind: TomlFaultKind,
}

/// Kind of a [`TomlFault`].
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum TomlFaultKind {
    /// The table has no such key.
    UnknownKey {
        /// The key.
        given: String,
        /// Keys that the table may have.
        known: Vec<String>,
    },
    /// No such word may stand here.
    UnknownWord {
        /// The word.
        given: String,
        /// Words that may.
        known: Vec<String>,
    },
    /// The table lacks this key.
    MissingKey(String),
    /// A list has more or fewer values than its type.
    Length {
        /// Number of values that are needed.
        needed: usize,
        /// Number of values that are there.
        given: usize,
    },
    /// A value, or a sign of the text, is not of the kind that is needed here. Both are named as a person would.
    Mismatch {
        /// The value or sign that is there.
        found: String,
        /// The kind that is needed.
        expected: String,
    },
    /// The table has the key already.
    DuplicateKey,
    /// Something stands behind a value that should end its line.
    LineGoesOn,
    /// Another fault; its message says which.
    Other,
}

impl TomlFault {
    /// The fault behind an error of the library.
    #[must_use]
    pub fn of(error: &toml::de::Error) -> Self {
        let message = error.message().lines().collect::<Vec<_>>().join(", ");
        Self {
            span: error.span().unwrap_or_default(),
            kind: kind(&message),
            message,
        }
    }
}

/// Message of a reader that counts the values of a list; [`TomlFault::of`] understands it.
///
/// ```
/// assert_eq!(kinetostat_diagnostic::wrong_length(3, 4), "3 values are needed, 4 are given");
/// ```
#[must_use]
pub fn wrong_length(needed: usize, given: usize) -> String {
    format!("{needed}{NEEDED}{given}{GIVEN}")
}

const NEEDED: &str = " values are needed, ";
const GIVEN: &str = " are given";

fn kind(message: &str) -> TomlFaultKind {
    if let Some((given, known)) = unknown(message, "unknown field `") {
        return TomlFaultKind::UnknownKey { given, known };
    }
    if let Some((given, known)) = unknown(message, "unknown variant `") {
        return TomlFaultKind::UnknownWord { given, known };
    }
    if let Some(rest) = message.strip_prefix("missing field `") {
        return TomlFaultKind::MissingKey(rest.trim_end_matches('`').to_owned());
    }
    if let Some([needed, given]) = length(message) {
        return TomlFaultKind::Length { needed, given };
    }
    match message.split_once(", expected ") {
        _ if message == "duplicate key" => TomlFaultKind::DuplicateKey,
        _ if message == "wanted string or table" => TomlFaultKind::Mismatch {
            found: "another value".to_owned(),
            expected: "a text in quotes, or a table".to_owned(),
        },
        Some((_, needed)) if needed.starts_with("newline") => TomlFaultKind::LineGoesOn,
        Some((found, needed)) => TomlFaultKind::Mismatch {
            found: found_in_words(found),
            expected: expected_in_words(needed),
        },
        None => TomlFaultKind::Other,
    }
}

/// The name that is not known, and those that are.
fn unknown(message: &str, start: &str) -> Option<(String, Vec<String>)> {
    let (given, rest) = message.strip_prefix(start)?.split_once("`, ")?;
    let known = rest.split('`').skip(1).step_by(2).map(str::to_owned);
    Some((given.to_owned(), known.collect()))
}

/// Needed and given number of values, of our own message or of that of serde.
fn length(message: &str) -> Option<[usize; 2]> {
    let own = || message.strip_suffix(GIVEN)?.split_once(NEEDED);
    let of_serde = || {
        let (given, needed) = message
            .strip_prefix("invalid length ")?
            .split_once(", expected ")?;
        Some((needed.rsplit(' ').next()?, given))
    };
    let (needed, given) = own().or_else(of_serde)?;
    Some([needed.parse().ok()?, given.parse().ok()?])
}

/// A value as serde names it, and as a person does.
const VALUES: [(&str, &str); 6] = [
    ("floating point ", "the number "),
    ("integer ", "the number "),
    ("boolean ", "the word "),
    ("string ", "the text "),
    ("sequence", "a list"),
    ("map", "a table"),
];

fn found_in_words(found: &str) -> String {
    let bare = found.strip_prefix("invalid type: ");
    let bare = bare.or_else(|| found.strip_prefix("invalid value: "));
    let Some(value) = bare else {
        return found.to_owned();
    };
    let mut known = VALUES.iter();
    let named = known.find_map(|(of_serde, ours)| Some((ours, value.strip_prefix(of_serde)?)));
    named.map_or_else(|| value.to_owned(), |(ours, rest)| format!("{ours}{rest}"))
}

fn expected_in_words(expected: &str) -> String {
    if let Some(count) = expected.strip_prefix("an array of length ") {
        return format!("a list of {count}");
    }
    let word = match expected {
        "usize" | "u128" | "u64" | "u32" | "u16" | "u8" | "i128" | "i64" | "i32" | "i16" | "i8" => {
            "a whole number"
        }
        "f64" | "f32" | "finite f64" | "finite f32" => "a number",
        "a sequence" => "a list",
        "a string" => "a text in quotes",
        "a boolean" => "true or false",
        "a map" => "a table { key = value, ... }",
        _ if expected.starts_with("struct ") => "a table { key = value, ... }",
        other => other,
    };
    word.to_owned()
}
