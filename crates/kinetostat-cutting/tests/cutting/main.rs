//! Tests of the cutting forces: closed forms, reference values, plain summation written apart.

#![allow(clippy::unwrap_used, reason = "a failing test may panic")]

mod corrections;
mod drilling;
mod fitting;
mod material;
mod measured_conditioning;
mod measured_matching;
mod milling_invariants;
mod milling_plain;
mod milling_reference;
mod noise;
mod plain;
mod spindle;
mod stock_engagement;
mod stock_inputs;
mod stock_paths;
mod stock_round;
mod stock_support;
mod stock_swept;
mod stock_through;
mod stock_volume;
mod thickness;
mod tool_tables;
mod turning;
