//! KUKA KRL: programs and data lists read together, and what the writer must know of the language.
//!
//! From lines of tokens ([`lex`]) to blocks ([`parser`], [`tree`]), to names and what they are worth ([`symbols`], [`usage`],
//! [`aggregate`], [`values`], [`frames`], [`role`], [`assigned_frames`], [`system_frames`]), to what is in force ([`state`], [`settings`], [`turning`], [`moving_settings`], [`touched`]),
//! to motions ([`motion`], [`targets`], [`steps`], [`kept`], [`behind_ends`], [`speed_place`], [`with_list`]) in the order in which they run ([`walking`],
//! [`resolve`]). [`loads`] reads what tools weigh, [`folds`] compares what the pendant shows with what runs, and [`writing`] writes.
//!
//! Source: KUKA, Expert Programming KR C2 / KR C3 (KSS 5.x), and KUKA System Software 8.x, Operating and Programming
//! Instructions for System Integrators.

pub(crate) mod aggregate;
pub(crate) mod assigned_frames;
pub(crate) mod behind_ends;
pub(crate) mod folds;
pub(crate) mod frames;
pub(crate) mod kept;
pub(crate) mod lex;
pub(crate) mod loads;
pub(crate) mod motion;
pub(crate) mod moving_settings;
pub(crate) mod parser;
pub(crate) mod reader;
pub(crate) mod resolve;
pub(crate) mod role;
pub(crate) mod settings;
pub(crate) mod speed_place;
pub(crate) mod state;
pub(crate) mod steps;
pub(crate) mod symbols;
pub(crate) mod system_frames;
pub(crate) mod table;
pub(crate) mod targets;
pub(crate) mod touched;
pub(crate) mod tree;
pub(crate) mod turning;
pub(crate) mod usage;
pub(crate) mod values;
pub(crate) mod walking;
pub(crate) mod with_list;
pub(crate) mod writing;
