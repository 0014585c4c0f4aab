//! The text of a file that is read, errors with the line of what they are about, and names that people spell in many ways.

use kinetostat_diagnostic::{TomlFault, TomlFaultKind};
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

/// Names of a text in TOML and of its entries, for faults of the reader.
pub(crate) struct Subject {
    /// One entry of it.
    pub(crate) entry: &'static str,
    /// The whole of it.
    pub(crate) whole: &'static str,
    /// Its form in words.
    pub(crate) form: &'static str,
}

impl Source<'_> {
    /// A fault that the reader of TOML found; for a name that is not known, with the nearest one.
    pub(crate) fn toml_fault(&self, error: &toml::de::Error, subject: &Subject) -> CutError {
        let fault = TomlFault::of(error);
        let said = |quantity: &str, found: String, expected: String| {
            self.error(fault.span.start, quantity, found, expected)
        };
        match fault.kind {
            TomlFaultKind::UnknownKey { given, known }
            | TomlFaultKind::UnknownWord { given, known } => {
                let key = format!("key of a {}", subject.entry);
                let found = format!("`{given}` is not known here");
                match nearest_key(&given, &known) {
                    Some(near) => {
                        let near = format!("`{near}`");
                        CutError::suggesting(CutErrorKind::File, key, found, &[&near])
                            .at(self.file, Some(self.line(fault.span.start)))
                    }
                    None => said(&key, found, format!("one of {}", known.join(", "))),
                }
            }
            TomlFaultKind::MissingKey(key) => {
                let expected = format!("a line `{key} = ...` in this table");
                said(subject.entry, format!("no `{key}`"), expected)
            }
            TomlFaultKind::Length { needed, given } => {
                let [found, expected] = [given, needed].map(|count| format!("a list of {count}"));
                said(subject.whole, found, expected)
            }
            TomlFaultKind::Mismatch { found, expected } => said(subject.whole, found, expected),
            _ => said(subject.whole, fault.message, subject.form.to_owned()),
        }
    }
}

/// The nearest of some keys, if it is close enough to be a typing mistake; a key without its unit is meant to be the one
/// with it.
fn nearest_key<'k>(given: &str, known: &'k [String]) -> Option<&'k str> {
    let stem = format!("{given}_");
    let mut keys = known.iter().map(String::as_str);
    let with_unit = keys.clone().find(|key| key.starts_with(&stem));
    with_unit.or_else(|| nearest(given, keys.by_ref(), 1).pop())
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
