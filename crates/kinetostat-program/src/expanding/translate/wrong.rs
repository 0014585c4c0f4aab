//! Why words have no moves.

/// What is wrong, and what to do.
pub(crate) type Wrong = (String, &'static str);
