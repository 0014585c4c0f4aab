//! ABB RAPID: modules read together, and what the writer must know of the language.
//!
//! From tokens ([`lex`]) to blocks ([`parser`]) and names ([`names`]), and to a run ([`state`], [`dialect`]): expressions
//! ([`expression`], [`functions`], [`predefined`], [`literals`]), motions ([`instructions`], [`arguments`], [`motion`], [`targets`], [`frames`]), the
//! modal state of turning ([`turning`]). [`loads`] reads what tools weigh, [`write`] writes.
//!
//! Source: ABB, Technical reference manual - RAPID kernel, and - RAPID Instructions, Functions and Data types (3HAC050917).

pub(crate) mod arguments;
mod dialect;
pub(crate) mod expression;
mod functions;
mod instructions;
pub(crate) mod language;
pub(crate) mod lex;
pub(crate) mod literals;
pub(crate) mod loads;
mod motion;
pub(crate) mod parser;
pub(crate) mod reader;
mod state;
pub(crate) mod table;
mod targets;
pub(crate) mod write;
