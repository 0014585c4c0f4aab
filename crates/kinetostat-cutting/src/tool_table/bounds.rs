//! Limits of a file's size.

/// Maximum number of bytes of a file.
pub(crate) const MOST_BYTES: usize = 10_000_000;
/// Maximum number of tools of a file.
pub(crate) const MOST_TOOLS: usize = 10_000;
