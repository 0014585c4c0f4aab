//! Tests of on-line compensation: one binary, its subjects as modules.
#![allow(clippy::unwrap_used, missing_docs)]

mod common;
mod statics;
