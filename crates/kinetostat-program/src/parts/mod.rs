//! Programs longer than memory: read, written and checked part by part.
//!
//! A [`Survey`](crate::Survey) goes over the text once and notes what only the whole tells, and where parts begin. [`Parts`](crate::Parts) then reads each of them
//! by itself, in any order: lines of its own, with some motions on either side that say how these begin and end. Each is a [`Program`](crate::Program) and a
//! [`Path`](crate::Path) as that of a short program, with the lines that it has in the whole one. [`WrittenSoFar`](crate::WrittenSoFar) is where the
//! written program stands between two of them, and [`PartsInOrder`](crate::PartsInOrder) has them worked on side by side, so that all that is written,
//! put together, is one program.

pub(crate) mod beginnings;
pub(crate) mod in_order;
pub(crate) mod survey;
pub(crate) mod windows;

/// Length of the parts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PartLength {
    /// Lines that are a part's own.
    pub own: usize,
    /// Motions on either side that say how these begin and end, with the lines between.
    pub beside: usize,
}

impl Default for PartLength {
    /// 4 000 lines, and 256 motions on either side. It is the same everywhere: which bytes are written must not depend on a machine's
    /// memory.
    fn default() -> Self {
        Self {
            own: 4_000,
            beside: 256,
        }
    }
}
