//! The numbers of the report, computed again, beside those of independent programs: one module per part of it.
//!
//! One binary instead of many, because linking dominates the time of a test run.

mod chapters_2_to_5;
mod internal;
mod orthoglide;
mod registry;
