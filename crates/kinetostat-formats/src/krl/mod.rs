//! KUKA KRL: programs and data lists read together, and what the writer must know of the language.
//!
//! From lines of tokens ([`lex`]) to blocks ([`parser`]) and names ([`names`]), and to a run ([`state`], [`dialect`]): expressions
//! ([`expression`], [`position`], [`aggregate`]), statements ([`instructions`]), what is in force ([`settings`], [`bas`], [`with_list`], [`turning`],
//! [`moving_settings`], [`frames`], [`role`], [`system_frames`]), and motions ([`motion`], [`ends`], [`steps`], [`kept`], [`behind_ends`],
//! [`speed_place`]). [`loads`] reads what tools weigh, [`folds`] compares what the pendant shows with what runs, and [`writing`] writes.
//!
//! Source: KUKA, Expert Programming KR C2 / KR C3 (KSS 5.x), and KUKA System Software 8.x, Operating and Programming
//! Instructions for System Integrators.

pub(crate) mod aggregate;
mod bas;
pub(crate) mod behind_ends;
mod dialect;
mod ends;
mod expression;
pub(crate) mod folds;
mod frames;
mod instructions;
pub(crate) mod kept;
pub(crate) mod language;
pub(crate) mod lex;
pub(crate) mod loads;
mod motion;
pub(crate) mod moving_settings;
mod names;
pub(crate) mod parser;
pub(crate) mod position;
pub(crate) mod reader;
pub(crate) mod role;
mod settings;
pub(crate) mod speed_place;
mod state;
pub(crate) mod steps;
pub(crate) mod system_frames;
pub(crate) mod table;
pub(crate) mod turning;
mod with_list;
pub(crate) mod writing;
