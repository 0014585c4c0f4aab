//! ABB RAPID: modules read together, and what the writer must know of the language.
//!
//! From tokens ([`lex`]) to blocks ([`parser`], [`tree`]), and to a run ([`run`]): its order ([`control`], [`passing`]), its data
//! ([`storage`], [`evaluate`], [`functions`], [`predefined`]), its motions ([`instructions`], [`motion`], [`targets`], [`frames`]) and the
//! modal state of turning ([`turning`]).
//!
//! Source: ABB, Technical reference manual - RAPID kernel, and - RAPID Instructions, Functions and Data types (3HAC050917).

pub(crate) mod arguments;
mod control;
mod evaluate;
pub(crate) mod expression;
pub(crate) mod flat;
mod frames;
mod functions;
mod instructions;
pub(crate) mod lex;
pub(crate) mod literals;
pub(crate) mod loads;
mod motion;
pub(crate) mod parser;
mod passing;
mod predefined;
pub(crate) mod reader;
mod run;
mod storage;
pub(crate) mod symbols;
pub(crate) mod table;
mod targets;
pub(crate) mod tree;
mod turning;
pub(crate) mod write;
