//! Conversion of the blocks of a file to motions.
//!
//! The [`reader`] goes through the blocks in the order in which they run; [`statements`] looks at the word a block begins with:
//! the unit, the tool, the pole, cycles and datum shifts ([`settings`]), path blocks, rotary axes and tilted planes ([`tilted`])
//! and where they go ([`ways`]). Corners that are rounded ([`corners`]) wait for the line behind them. Motions are made in [`motions`];
//! what the walk knows and gives stands in [`walker`].

pub(crate) mod corners;
pub(crate) mod motions;
pub(crate) mod reader;
pub(crate) mod settings;
pub(crate) mod statements;
pub(crate) mod tilted;
pub(crate) mod walker;
pub(crate) mod ways;
