//! Every number of chapters 2 to 7 of the COROUSSO report L1.1, computed again through the public
//! interface and set beside its print.
//!
//! Nothing computed is stored: each run builds the models and solves them. What the report prints is
//! stored as it is printed. A number agrees if the printed digits are the rounding of the computed
//! one; where they differ, the note says why.

mod entry;

pub use entry::{Entry, Item, Status, is_rounding};

/// Why an entry could not be computed.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReproduceError {
    /// The core refused or did not converge.
    #[error("{id}: {source}")]
    Core {
        /// Which entry.
        id: &'static str,
        /// Why.
        source: kinetostat::Error,
    },
}

/// The ids, in the order of the report.
pub const IDS: [&str; 0] = [];
