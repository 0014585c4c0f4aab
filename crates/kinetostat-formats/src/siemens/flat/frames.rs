//! The programmable frame in force, as the statements that make it.

use std::rc::Rc;

use crate::siemens::flat::modes::Modes;

/// Words that put a frame in place of all before, or back to none.
const INSTEAD: [&[u8]; 4] = [b"TRANS", b"ROT", b"SCALE", b"MIRROR"];
/// Words that add to the frame in force.
const FURTHER: [&[u8]; 4] = [b"ATRANS", b"AROT", b"ASCALE", b"AMIRROR"];

/// Whether a word in capitals states a programmable frame.
pub(super) fn is_frame(word: &[u8]) -> bool {
    INSTEAD.contains(&word) || FURTHER.contains(&word)
}

/// A statement of a frame, with numbers in place of its expressions, and the codes that its values are read with.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Statement {
    pub text: Vec<u8>,
    pub modes: Modes,
    pub instead: bool,
}

/// The statements that make the programmable frame in force.
#[derive(Debug, Clone, Default)]
pub(super) struct Frames(Rc<Vec<Statement>>);

impl Frames {
    /// Adds the words of a block that states a frame, as they were written.
    pub(super) fn state(&mut self, word: &[u8], text: &[u8], modes: Modes) {
        let instead = INSTEAD.contains(&word);
        if instead {
            *self = Self::default();
        }
        let statement = Statement {
            text: text.to_vec(),
            modes,
            instead,
        };
        // Copied where a program that called still holds the frame of its call.
        Rc::make_mut(&mut self.0).push(statement);
    }

    /// Whether two are the same statements.
    pub(super) fn is(&self, other: &Self) -> bool {
        Rc::ptr_eq(&self.0, &other.0) || self.0 == other.0
    }

    /// In their order.
    pub(super) fn statements(&self) -> &[Statement] {
        &self.0
    }
}
