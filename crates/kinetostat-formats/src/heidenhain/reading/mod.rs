//! Conversion of the blocks of a file to motions.
//!
//! The [`reader`] goes through the blocks in the order in which they run; [`statements`] looks at the word a block begins with:
//! the unit, the tool and the pole ([`settings`]), cycles and datum shifts ([`cycles`]), path blocks ([`path_block`]), rotary axes ([`turned_axes`]), tilted planes ([`tilted`]) and where
//! they go ([`ways`]). Corners that are rounded ([`corners`], [`rounded`]) wait for the line behind them. Motions are made in [`motions`]; what the walk knows stands in [`walker`], what it gives in [`found`].

pub(crate) mod corners;
pub(crate) mod cycles;
pub(crate) mod found;
pub(crate) mod motions;
pub(crate) mod path_block;
pub(crate) mod reader;
pub(crate) mod rounded;
pub(crate) mod settings;
pub(crate) mod statements;
pub(crate) mod tilted;
pub(crate) mod turned_axes;
pub(crate) mod walker;
pub(crate) mod ways;
