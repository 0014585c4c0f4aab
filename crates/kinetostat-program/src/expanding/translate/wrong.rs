//! Errors of the translation of words to moves.

/// Reason and remedy.
pub(crate) type Wrong = (String, &'static str);
