//! ABB RAPID: modules read together, and what the writer must know of the language.
//!
//! From tokens and expressions ([`lex`]) to blocks ([`parser`]), and to a run ([`state`], [`dialect`]): values ([`functions`],
//! [`literals`]) and motions ([`instructions`], [`motion`], [`targets`]). [`language`] writes.
//!
//! Source: ABB, Technical reference manual - RAPID kernel, and - RAPID Instructions, Functions and Data types (3HAC050917).

mod dialect;
mod functions;
mod instructions;
pub(crate) mod language;
pub(crate) mod lex;
pub(crate) mod literals;
mod motion;
pub(crate) mod parser;
pub(crate) mod reader;
mod state;
pub(crate) mod table;
mod targets;
