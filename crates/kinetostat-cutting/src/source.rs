//! The text of a file that is read, and errors with the line of what they are about.

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

/// Where the TOML reader stopped, and its message in one line.
pub(crate) fn described(error: &toml::de::Error) -> (usize, String) {
    let byte = error.span().map_or(0, |span| span.start);
    (byte, error.message().lines().collect::<Vec<_>>().join(", "))
}
