//! KUKA KRL: programs and data lists read together, and what the writer must know of the language.
//!
//! From lines of tokens and FOLDs ([`lex`]) to blocks ([`parser`]) and names ([`reader`]), and to a run ([`state`], [`dialect`]):
//! expressions ([`expression`], [`position`]), statements ([`instructions`]), what is in force ([`settings`], [`frames`]),
//! and motions ([`motion`], [`ends`], [`behind_ends`]). [`writing`] writes.
//!
//! Source: KUKA, Expert Programming KR C2 / KR C3 (KSS 5.x), and KUKA System Software 8.x, Operating and Programming
//! Instructions for System Integrators.

pub(crate) mod behind_ends;
mod dialect;
mod ends;
mod expression;
pub(crate) mod frames;
mod instructions;
pub(crate) mod language;
pub(crate) mod lex;
mod motion;
pub(crate) mod parser;
pub(crate) mod position;
pub(crate) mod reader;
mod settings;
mod state;
pub(crate) mod table;
pub(crate) mod writing;
