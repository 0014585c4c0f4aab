//! Reads bytes into a document that follows the schema, with messages that name line and remedy.
//!
//! Takes a path or a text; gives a document, or problems with their places in the text. Knows the words of the format
//! and nothing of mechanics.

pub(crate) mod check;
pub(crate) mod edit;
pub(crate) mod hints;
pub(crate) mod source;
