//! The text of a file that is read, errors with the line of what they are about, and names that people spell in many ways.

use serde_spanned::Spanned;

use crate::error::{CutError, CutErrorKind};

/// A file's name and text, for errors with their line.
pub(crate) struct Source<'t> {
    pub(crate) file: &'t str,
    pub(crate) text: &'t str,
}

impl Source<'_> {
    pub(crate) fn line(&self, byte: usize) -> usize {
        let before = self.text.as_bytes().get(..byte).unwrap_or_default();
        1 + before.iter().filter(|b| **b == b'\n').count()
    }

    pub(crate) fn error(
        &self,
        byte: usize,
        quantity: &str,
        found: String,
        expected: String,
    ) -> CutError {
        CutError::new(CutErrorKind::File, quantity, found, expected)
            .at(self.file, Some(self.line(byte)))
    }

    /// An error with the place of the value that it is about.
    pub(crate) fn placed<T>(&self, value: &Spanned<T>) -> impl Fn(CutError) -> CutError {
        let line = self.line(value.span().start);
        move |error| error.at(self.file, Some(line))
    }
}

/// Position of a TOML error, and its message in one line, without names of Rust types.
pub(crate) fn described(error: &toml::de::Error) -> (usize, String) {
    let byte = error.span().map_or(0, |span| span.start);
    let message = error.message().lines().collect::<Vec<_>>().join(", ");
    (byte, in_words(&message))
}

/// Found and expected value in a message of [`described`]; `None` if it names neither.
pub(crate) fn found_and_expected(message: &str) -> Option<(String, String)> {
    let (found, expected) = message.split_once(", expected ")?;
    Some((found.to_owned(), expected.to_owned()))
}

/// Whole numbers and others, as the reader calls them.
const WHOLE: [&str; 10] = [
    "usize", "u128", "u64", "u32", "u16", "u8", "i64", "i32", "i16", "i8",
];
const REAL: [&str; 4] = ["finite f32", "finite f64", "f32", "f64"];

fn in_words(message: &str) -> String {
    let mut words = message
        .replace("invalid type: ", "")
        .replace("invalid value: ", "")
        .replace("floating point `", "the number `")
        .replace("integer `", "the number `")
        .replace("boolean `", "the word `")
        .replace("string \"", "the text \"")
        .replace("sequence, expected", "a list, expected")
        .replace("map, expected", "a table, expected")
        .replace("expected a sequence", "expected a list")
        .replace("expected a map", "expected a table")
        .replace("expected a string", "expected a text in quotes")
        .replace("expected a boolean", "expected true or false")
        .replace("expected an array of length ", "expected a list of ")
        .replace("wanted string or table", "expected a table");
    if let Some(rest) = words.strip_prefix("invalid length ") {
        words = format!("a list of {rest}");
    }
    if let Some((before, _)) = words.split_once("expected struct ") {
        words = format!("{before}expected a table");
    }
    for (names, word) in [(&WHOLE[..], "a whole number"), (&REAL[..], "a number")] {
        for name in names {
            words = words.replace(&format!("expected {name}"), &format!("expected {word}"));
        }
    }
    words
}

/// A name without what does not matter: case, spaces, hyphens, dots and other signs.
pub(crate) fn bare(name: &str) -> String {
    name.chars()
        .filter(|sign| sign.is_alphanumeric())
        .flat_map(char::to_lowercase)
        .collect()
}

/// The closest of some names, best first, at most `most`; only those that could be a typing mistake.
pub(crate) fn nearest<'n>(
    given: &str,
    known: impl IntoIterator<Item = &'n str>,
    most: usize,
) -> Vec<&'n str> {
    let wanted = bare(given);
    let length = wanted.chars().count();
    // Long names cannot be typing mistakes, and the comparison costs the product of the lengths.
    if length > 60 {
        return Vec::new();
    }
    let mut found: Vec<(usize, &str)> = known
        .into_iter()
        .filter_map(|name| {
            let other = bare(name);
            let longest = other.chars().count().max(length);
            let distance = strsim::damerau_levenshtein(&wanted, &other);
            (distance <= (longest / 3).max(1) && distance < longest).then_some((distance, name))
        })
        .collect();
    found.sort_by_key(|(distance, _)| *distance);
    found.truncate(most);
    found.into_iter().map(|(_, name)| name).collect()
}
