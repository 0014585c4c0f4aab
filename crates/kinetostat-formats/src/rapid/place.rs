//! Where the tool is, as far as the text says it.

use crate::calls::Holds;

/// Where the tool is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Place {
    /// Where it was as the routine was called.
    Entry,
    /// At the end of a motion.
    Motion(usize),
    /// Not known from the text.
    Unknown,
}

impl Holds for Place {
    const UNKNOWN: Self = Self::Unknown;

    fn merged(self, other: Self) -> Self {
        match self == other {
            true => self,
            false => Self::Unknown,
        }
    }

    fn in_call(self, at: Self) -> Self {
        match self {
            Self::Entry => at,
            place => place,
        }
    }
}
