//! Tests of the dynamics: one binary, its subjects as modules.
#![allow(clippy::unwrap_used, missing_docs)]

mod arms;
mod beams;
mod common;
mod platforms;
mod responses;
