//! How much a file may hold.

/// Most bytes of a file.
pub(crate) const MOST_BYTES: usize = 10_000_000;
/// Most tools of a file.
pub(crate) const MOST_TOOLS: usize = 10_000;
