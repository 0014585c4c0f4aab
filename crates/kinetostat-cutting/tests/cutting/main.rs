//! Tests of cutting forces, a module for each room.

#![allow(clippy::unwrap_used, reason = "a failing test may panic")]

mod fitting;
mod material;
