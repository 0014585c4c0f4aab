//! Text files of bounded size, and the numbers that engineering programs write into them.

use std::fs::File;
use std::io::{ErrorKind, Read};
use std::path::Path;

use crate::error::{Error, LinkErrorKind, Result};

/// Largest file that is read, bytes.
pub const MOST_BYTES: u64 = 64 << 20;

/// A text file with the name that messages give it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Text {
    name: String,
    body: String,
}

impl Text {
    /// Reads a file of at most [`MOST_BYTES`] in UTF-8 (or ASCII).
    ///
    /// # Errors
    ///
    /// The file cannot be read, is too large, is binary or holds nothing.
    pub fn read(path: &Path) -> Result<Self> {
        let name = path.display().to_string();
        if path.is_dir() {
            return Err(Error::new(
                LinkErrorKind::File,
                &name,
                "this is a directory",
                "name a file in it",
            ));
        }
        let unread = |error: &std::io::Error| match error.kind() {
            ErrorKind::NotFound => Error::new(
                LinkErrorKind::File,
                &name,
                "the file does not exist",
                "check the path",
            ),
            ErrorKind::PermissionDenied => Error::new(
                LinkErrorKind::File,
                &name,
                "the file may not be read",
                "ask for the right to read it",
            ),
            _ => Error::new(
                LinkErrorKind::File,
                &name,
                format!("the file cannot be read: {error}"),
                "check the path",
            ),
        };
        let file = File::open(path).map_err(|e| unread(&e))?;
        // The size that the system tells is checked first: nothing of a huge file is read.
        let size = file.metadata().map_or(0, |m| m.len());
        if size > MOST_BYTES {
            return Err(too_large(&name));
        }
        let mut bytes = Vec::new();
        file.take(MOST_BYTES + 1)
            .read_to_end(&mut bytes)
            .map_err(|e| unread(&e))?;
        Self::new(name, bytes)
    }

    /// The text of bytes that were read elsewhere.
    ///
    /// # Errors
    ///
    /// As [`Text::read`].
    pub fn new(name: impl Into<String>, bytes: impl Into<Vec<u8>>) -> Result<Self> {
        let (name, bytes) = (name.into(), bytes.into());
        if bytes.len() as u64 > MOST_BYTES {
            return Err(too_large(&name));
        }
        if bytes.starts_with(&[0xff, 0xfe]) || bytes.starts_with(&[0xfe, 0xff]) {
            return Err(Error::new(
                LinkErrorKind::File,
                name,
                "the file is written in UTF-16",
                "save it as UTF-8",
            ));
        }
        if bytes.contains(&0) {
            return Err(Error::new(
                LinkErrorKind::File,
                name,
                "this is a binary file",
                "let the program write text (DMIG in a punch file, .mtx, .sti, .dat, CSV, JSON)",
            ));
        }
        let body = String::from_utf8(bytes).map_err(|error| {
            let at = error.utf8_error().valid_up_to();
            let line = 1 + error.as_bytes()[..at]
                .iter()
                .filter(|b| **b == b'\n')
                .count();
            Error::new(
                LinkErrorKind::File,
                &name,
                "this is not UTF-8 text",
                "save the file as UTF-8",
            )
            .at(line)
        })?;
        let body = body
            .strip_prefix('\u{feff}')
            .map_or(body.clone(), str::to_owned);
        if body.trim().is_empty() {
            return Err(Error::new(
                LinkErrorKind::File,
                name,
                "the file is empty",
                "export it again",
            ));
        }
        Ok(Self { name, body })
    }

    /// Name that messages give the file.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The whole text.
    #[must_use]
    pub fn body(&self) -> &str {
        &self.body
    }

    /// Lines with their numbers from 1.
    pub(crate) fn lines(&self) -> impl Iterator<Item = (usize, &str)> {
        self.body.lines().enumerate().map(|(i, l)| (i + 1, l))
    }

    pub(crate) fn fault(&self, message: impl Into<String>, help: impl Into<String>) -> Error {
        Error::new(LinkErrorKind::File, &self.name, message, help)
    }

    /// A finite number of a field.
    pub(crate) fn number(&self, line: usize, what: &str, field: &str) -> Result<f64> {
        number(field).ok_or_else(|| {
            self.fault(
                format!("{what} is '{}', which is no finite number", short(field)),
                "write a number such as 1.5, 1.5e3 or 1.5+3",
            )
            .at(line)
        })
    }

    /// A whole number from `least` to `most`.
    pub(crate) fn whole(
        &self,
        line: usize,
        what: &str,
        field: &str,
        least: u64,
        most: u64,
    ) -> Result<u64> {
        field
            .trim()
            .parse::<u64>()
            .ok()
            .filter(|n| (least..=most).contains(n))
            .ok_or_else(|| {
                self.fault(
                    format!("{what} is '{}'", short(field)),
                    format!("a whole number from {least} to {most} is needed"),
                )
                .at(line)
            })
    }
}

fn too_large(name: &str) -> Error {
    Error::new(
        LinkErrorKind::File,
        name,
        format!("the file is larger than {} MB", MOST_BYTES >> 20),
        "export the interface only: a superelement of its nodes, or the displacements of its nodes",
    )
}

/// The beginning of a field, for a message.
pub(crate) fn short(field: &str) -> String {
    let field = field.trim();
    match field.char_indices().nth(40) {
        Some((at, _)) => format!("{}...", &field[..at]),
        None => field.to_owned(),
    }
}

/// A finite number as Fortran, Nastran and C write it: `1.5`, `1.5e3`, `1.5D+03`, `1.5+3`.
#[must_use]
pub fn number(field: &str) -> Option<f64> {
    let field = field.trim();
    let mut plain = String::with_capacity(field.len() + 1);
    let mut exponent = false;
    for (i, c) in field.char_indices() {
        match c {
            '0'..='9' | '.' => plain.push(c),
            'e' | 'E' | 'd' | 'D' if i > 0 && !exponent => {
                exponent = true;
                plain.push('e');
            }
            '+' | '-' => {
                let before = plain.chars().next_back();
                // Nastran leaves the letter of the exponent out.
                if before.is_some_and(|b| b.is_ascii_digit() || b == '.') {
                    if exponent {
                        return None;
                    }
                    exponent = true;
                    plain.push('e');
                }
                plain.push(c);
            }
            _ => return None,
        }
    }
    plain.parse().ok().filter(|x: &f64| x.is_finite())
}

/// Fields of a line: separated by semicolon, tab or comma, whichever comes first in that order.
pub(crate) fn fields(line: &str) -> Vec<&str> {
    let line = line.split('#').next().unwrap_or_default();
    let by = [';', '\t', ','].into_iter().find(|c| line.contains(*c));
    by.map_or_else(
        || line.split_whitespace().collect(),
        |c| {
            line.split(c)
                .map(|f| f.trim().trim_matches('"').trim())
                .collect()
        },
    )
}
