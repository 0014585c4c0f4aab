//! Tests that measure what the issue asks for: `cargo xtask figures` runs those whose path has the word.

mod beams;
mod broken;
mod calculix;
mod displacements;
mod sections;
mod superelements;
