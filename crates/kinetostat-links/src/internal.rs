//! Internals for this crate's own tests, in `tests/links/internal`. They are no part of the interface and may change
//! without notice.

pub use crate::condensation::envelope::{Factor, NoFactor};
