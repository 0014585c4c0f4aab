//! What reading, correcting and writing a robot program must keep: one room per language, one module per subject.
//!
//! One binary instead of many, because linking dominates the time of a test run.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "a failing test may panic"
)]

mod all_faults;
mod apt;
mod axes_alone;
mod axes_on_circles;
mod axis_angles;
mod axis_counts;
mod chance;
mod circles;
mod closed_circles;
mod conformance;
mod corners;
mod correcting;
mod directions_evenly;
mod external_axes;
mod fields;
mod harness;
mod heidenhain;
mod krl;
mod ls;
mod making;
mod numbers;
mod orientations;
mod outside_calls;
mod paths;
mod points_of_paths;
mod poses;
mod rapid;
mod real_files;
mod refused_runs;
mod refusing;
mod run_statements;
mod siemens;
mod starts_alone;
mod turned_work_objects;
mod turns_in_place;
mod urscript;
mod val3;
