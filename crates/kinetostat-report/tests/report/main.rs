//! The report of a run, its pictures and plots: one module per part.
//!
//! One binary instead of many, because linking dominates the time of a test run.

mod common;
mod drawing;
mod report;
mod turns;
mod vibration;
