//! Tests of on-line compensation: one binary, its subjects as modules.
#![allow(clippy::unwrap_used, missing_docs)]

mod common;
mod critical_gain;
mod limits;
mod loops;
mod states;
mod statics;

/// Counts allocations in sections that may not have any.
#[global_allocator]
static ALLOCATOR: assert_no_alloc::AllocDisabler = assert_no_alloc::AllocDisabler;
