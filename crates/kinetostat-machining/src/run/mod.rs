//! A run over a program: deflections along it, the compensated program, and the proof from the written bytes.
//!
//! Takes a [`Task`](crate::Task); gives a [`Run`](crate::Run). In the order of events: a first look, corrections written
//! and read again, every place solved, blocks divided again where the tool is off, the result.

pub(crate) mod compensate;
pub(crate) mod conclude;
pub(crate) mod cutting;
pub(crate) mod first_look;
pub(crate) mod joints;
pub(crate) mod largest_change;
pub(crate) mod merged;
pub(crate) mod merged_warnings;
pub(crate) mod movable;
pub(crate) mod other_load;
pub(crate) mod places;
pub(crate) mod points;
pub(crate) mod preparation;
pub(crate) mod sites;
pub(crate) mod summary;
pub(crate) mod tolerance;
pub(crate) mod way_out;
pub(crate) mod whole_turns;
