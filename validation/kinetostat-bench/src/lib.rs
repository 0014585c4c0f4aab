//! Timed task: many postures of a machine from a model file, solved again and again.
//!
//! A [`Task`] is used by `cargo xtask bench-vs-numpy` through Python (feature `python`), so that numpy and this project run
//! in one process, and by the tables of the program `table`.

pub mod figure;
pub mod machines;
pub mod sample;
mod task;

#[cfg(feature = "python")]
mod python;

pub use task::{Answers, BenchQuantity, Places, Results, Task};
