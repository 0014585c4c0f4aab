//! Model files: what they say, what is refused, and the machines of the library: one module per subject.
//!
//! One binary instead of many, because linking dominates the time of a test run.

mod bad_models;
mod controller;
mod damping;
mod deviations;
mod error_pairs;
mod format;
mod identical;
mod internal;
mod library;
mod link_matrices;
mod loads_and_links;
mod many_loaded;
mod many_postures;
mod orientations;
mod parameters;
mod presets;
mod sections;
