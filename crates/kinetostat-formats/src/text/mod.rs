//! Text of programs as bytes: files and their lines, replaced ranges, numbers printed as they were.
//!
//! It knows no language. Files are bytes, not UTF-8: controllers write Latin-1 and worse.

pub(crate) mod name;
pub(crate) mod number;
pub(crate) mod source;
