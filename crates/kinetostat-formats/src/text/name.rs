//! Identifiers: letters of any case are the same, 64 at most; a language may have a limit of its own.

use std::fmt;

/// Most characters of an identifier.
pub(crate) const LONGEST: usize = 64;

/// An identifier as RAPID compares it.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Name {
    bytes: [u8; LONGEST],
    length: u8,
}

impl Name {
    /// Name from the bytes of a word; `None` if it is too long for an identifier.
    pub(crate) fn of(word: &[u8]) -> Option<Self> {
        let mut bytes = [0; LONGEST];
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
            bytes: [0; LONGEST],
            length: 0,
        }
    }

    /// In capitals.
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
