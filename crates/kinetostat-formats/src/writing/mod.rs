//! The writer of all languages: which bytes change, by the sites that the readers found.
//!
//! It takes a program and pieces, gives files; what only a language knows it asks of its [`syntax::Syntax`].
//!
//! A further language is a room beside `rapid`: a reader that fills [`crate::model`] (motions, their sites, declarations), a
//! `Syntax`, a table of statements, a variant of `Language`, and one arm each in `document.rs`. Nothing here changes.

pub(crate) mod divided;
mod ends;
pub(crate) mod motions;
pub(crate) mod piece;
pub(crate) mod syntax;
