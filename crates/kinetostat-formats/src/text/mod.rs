//! Text of programs as bytes: files and their lines, replaced ranges, numbers printed as they were.
//!
//! It knows no language. Files are bytes, not UTF-8: controllers write Latin-1 and worse.

use std::fmt;

pub(crate) mod number;
pub(crate) mod source;

/// Most characters of an identifier; a language may have a limit of its own.
pub(crate) const LONGEST_NAME: usize = 64;

/// An identifier: letters of any case are the same.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Name {
    bytes: [u8; LONGEST_NAME],
    length: u8,
}

impl Name {
    /// Name from the bytes of a word; `None` if it is too long for an identifier.
    pub(crate) fn of(word: &[u8]) -> Option<Self> {
        let mut bytes = [0; LONGEST_NAME];
        bytes.get_mut(..word.len())?.copy_from_slice(word);
        bytes.make_ascii_uppercase();
        Some(Self {
            bytes,
            length: word.len() as u8,
        })
    }

    /// No letters.
    pub(crate) fn empty() -> Self {
        Self {
            bytes: [0; LONGEST_NAME],
            length: 0,
        }
    }

    /// Letters in capitals.
    pub(crate) fn letters(&self) -> &[u8] {
        &self.bytes[..usize::from(self.length)]
    }

    /// True if the name is this word in capitals.
    pub(crate) fn is(&self, capitals: &str) -> bool {
        self.letters() == capitals.as_bytes()
    }
}

impl fmt::Debug for Name {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", String::from_utf8_lossy(self.letters()))
    }
}
