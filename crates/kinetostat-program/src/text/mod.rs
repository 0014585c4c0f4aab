//! A program as text: bytes, lines, tokens, words.
//!
//! Takes bytes; gives lines and words with their places, or refuses what cannot be followed at all. Knows no meaning of a
//! word.

pub(crate) mod after_end;
pub(crate) mod lex;
pub(crate) mod library;
pub(crate) mod line;
pub(crate) mod program;
pub(crate) mod syntax;
