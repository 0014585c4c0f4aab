//! What this crate's own tests reach inside it, in `tests/links/internal`. It is no part of the interface and changes
//! without a word.

pub use crate::condensation::envelope::{Factor, NoFactor};
