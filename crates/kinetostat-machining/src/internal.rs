//! What this crate's own tests reach inside it, in `tests/machining/internal`. It is no part of the interface and changes
//! without a word.

use crate::limits::{Limit, apart};

/// A figure beyond a limit as it is stated beside what is allowed.
#[must_use]
pub fn figure_beyond(limit: &Limit, found: f64, allowed: f64) -> String {
    let (found, _) = apart(found, allowed, limit.stated());
    found
}
