//! A quantity along the path: lists by move, values between places, and how fast they may change.
//!
//! Knows moves and shares of their length; takes values at places; knows neither forces nor machines.

pub(crate) mod by_move;
pub(crate) mod limited;
