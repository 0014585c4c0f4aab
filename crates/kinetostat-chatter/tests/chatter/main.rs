//! Tests of this crate, one binary.
#![allow(clippy::unwrap_used)]

mod arm;
mod continued;
mod coupled_damping;
mod coupling;
mod diagram;
mod exact;
mod fitted;
mod forced;
mod semi_discretisation;
mod support;
mod swinging;
mod traps;
mod universal;
mod universal_text;
mod zeroth;
