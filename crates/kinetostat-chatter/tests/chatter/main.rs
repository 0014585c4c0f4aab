//! Tests of this crate, one binary.
#![allow(clippy::unwrap_used)]

mod arm;
mod coupling;
mod exact;
mod fitted;
mod forced;
mod support;
mod universal;
mod zeroth;
