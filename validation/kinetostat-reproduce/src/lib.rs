//! Every number of chapters 2 to 7 of the COROUSSO report L1.1, computed again through the public
//! interface and set beside its print.
//!
//! Nothing computed is stored: each run builds the models and solves them. Numbers of the report are stored as they
//! are printed. A number agrees if the printed digits are the rounding of the computed one; where they differ, the
//! note says why.
//!
//! [`IDS`] lists what there is; [`one`] computes one entry, [`all`] all of them; [`html`] makes a page
//! of them.

mod chapter_2;
mod chapter_3;
mod chapter_4;
mod chapter_5;
mod entry;
#[doc(hidden)]
pub mod internal;
mod orthoglide;
mod page;
mod registry;
mod shared;

pub use entry::{Entry, Item, Status, is_rounding};
pub use page::html::html;
pub use registry::{IDS, all, one};

/// Numbers and plots of an entry; the registry knows its id and title.
#[derive(Clone, Debug, Default)]
pub(crate) struct Contents {
    pub(crate) items: Vec<Item>,
    pub(crate) plots: Vec<kinetostat_report::Plot>,
}

impl Contents {
    /// Numbers without a plot.
    pub(crate) fn of(items: Vec<Item>) -> Self {
        let plots = Vec::new();
        Self { items, plots }
    }
}

/// Error inside an entry.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Cause {
    /// The core refused or did not converge.
    #[error(transparent)]
    Core(#[from] kinetostat::Error),
    /// A preset could not be read.
    #[error(transparent)]
    Model(#[from] kinetostat_model::ModelError),
    /// A material, a tool or a cut was refused.
    #[error(transparent)]
    Cutting(Box<kinetostat_cutting::CutError>),
    /// An equilibrium, a point or a factor that the entry is about was not found.
    #[error("{0} was not found")]
    Missing(String),
}

impl From<kinetostat_cutting::CutError> for Cause {
    fn from(error: kinetostat_cutting::CutError) -> Self {
        Self::Cutting(Box::new(error))
    }
}

/// Error of the reproduction.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReproduceError {
    /// The page could not be filled; a fault of this crate, never of the numbers.
    #[error("the page could not be filled: {0}")]
    Page(#[from] minijinja::Error),
    /// There is no such entry.
    #[error("there is no entry '{0}'")]
    Unknown(String),
    /// The computation of an entry failed.
    #[error("{id}: {cause}")]
    Failed {
        /// Identifier of the entry.
        id: &'static str,
        /// Cause of the failure.
        cause: Cause,
    },
}
