//! ABB RAPID: modules read together, and what the writer must know of the language.
//!
//! From tokens ([`lex`]) to blocks ([`parser`], [`tree`]), to names and what they are worth ([`symbols`], [`usage`],
//! [`literals`], [`frames`]), to motions ([`motion`], [`targets`]) in the order in which they run ([`walk`], [`walker`],
//! [`instructions`], [`place`], [`labels`], [`jumps`]), with what is in force there ([`turning`], [`modes`]).
//!
//! Source: ABB, Technical reference manual - RAPID kernel, and - RAPID Instructions, Functions and Data types (3HAC050917).

pub(crate) mod arguments;
mod assigned_speeds;
mod constants;
pub(crate) mod expression;
pub(crate) mod frames;
mod functions;
mod held_speeds;
mod instructions;
pub(crate) mod jumps;
pub(crate) mod labels;
pub(crate) mod lex;
pub(crate) mod literals;
pub(crate) mod loads;
mod modes;
pub(crate) mod motion;
pub(crate) mod parser;
mod place;
pub(crate) mod reader;
pub(crate) mod symbols;
pub(crate) mod table;
pub(crate) mod targets;
pub(crate) mod tree;
pub(crate) mod turning;
pub(crate) mod usage;
pub(crate) mod walk;
mod walker;
pub(crate) mod write;
