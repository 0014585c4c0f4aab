//! The writer of all languages: which bytes change, by the sites that the readers found.
//!
//! It takes a program and pieces, gives files; what only a language knows it asks of its [`syntax::Syntax`].

pub(crate) mod declared;
pub(crate) mod literal;
pub(crate) mod motions;
pub(crate) mod piece;
pub(crate) mod syntax;
