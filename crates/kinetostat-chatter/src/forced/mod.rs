//! Forced vibration: teeth that come and go shake the tool, and what it does at the moment a tooth makes the wall is left on it.
//!
//! `force` is a periodic force by its harmonics; `vibration` what a tool does under it; `steady` the force of a cut with
//! regeneration. Source: `dynamics.md` section 9.

mod force;
mod steady;
mod vibration;

pub use force::PeriodicForce;
pub use steady::SteadyCut;
pub use vibration::{Vibration, VibrationHarmonic};
