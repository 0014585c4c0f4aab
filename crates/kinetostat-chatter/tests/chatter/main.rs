//! Tests of this crate, one binary.
#![allow(clippy::unwrap_used)]

mod arm;
mod exact;
mod support;
mod zeroth;
