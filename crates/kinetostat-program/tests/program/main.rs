//! What reading, correcting and writing a program must keep: one module per subject.
//!
//! One binary instead of many, because linking dominates the time of a test run.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "a failing test may panic"
)]

mod arcs;
mod broken_rotary;
mod code_programs;
mod codes;
mod directions;
mod divided_blocks;
mod expanding;
mod expanding_radius;
mod fault_lists;
mod feet;
mod fewest_arcs;
mod fitted_arcs;
mod internal;
mod long_blocks;
mod map;
mod nc_files;
mod parts;
mod poles;
mod properties;
mod real_programs;
mod refusal_kinds;
mod refusals;
mod rotary;
mod rotary_findings;
mod sampled;
mod sampled_maps;
mod short_blocks;
mod spindle;
mod steady_moves;
mod support;
mod tool_turns;
mod tools;
mod turns_in_place;
mod unknown_places;
mod word_order;
mod writing;
