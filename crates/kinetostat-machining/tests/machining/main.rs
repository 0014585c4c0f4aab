//! What a run of a program on a machine must satisfy: one module per claim.
//!
//! One binary instead of many, because linking dominates the time of a test run.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "a failing test may panic"
)]

mod again;
mod arm_way;
mod configurations;
mod cut_forces;
mod envelope;
mod fitted_arcs;
mod five_axes;
mod force_band;
mod free_turn;
mod frequencies;
mod internal;
mod joints;
mod load;
mod map;
mod measured_forces;
mod orientation_follows;
mod parts;
mod ramp_lengths;
mod ramps;
mod robot_programs;
mod runs;
mod sampled_models;
mod springs;
mod thinning;
mod tools;
mod turned_axes;
mod turns_in_place;
mod turns_of_load;
mod weight;
