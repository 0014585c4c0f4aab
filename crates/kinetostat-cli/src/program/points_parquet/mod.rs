//! The table of points as a Parquet file: the columns and digits of the CSV, every point, units and meanings in the metadata.
//!
//! There is one way into the file, cells of a row as the CSV has them: a run gives them point by point, a run in parts
//! from the rows that it has kept.

#[cfg(feature = "parquet")]
mod file;

use std::path::Path;

use kinetostat_diagnostic::ErrorCode;

use crate::ui::failure::{Answer, Failing, Failure};
#[cfg(not(feature = "parquet"))]
use {
    crate::program::points_table::Listing,
    kinetostat_machining::{PointResult, RunInputs},
    std::io::Read,
};

#[cfg(feature = "parquet")]
pub(crate) use file::{from_csv, table};

/// A table of points is a Parquet file where its name ends so.
pub(crate) fn is_named(path: &Path) -> bool {
    path.extension()
        .is_some_and(|ending| ending.eq_ignore_ascii_case("parquet"))
}

/// Refuses a Parquet file that this build cannot write, before the long work begins.
pub(crate) fn refuse_without_parquet(path: Option<&Path>) -> Answer<()> {
    match path.is_some_and(is_named) && !cfg!(feature = "parquet") {
        true => Err(none()),
        false => Ok(()),
    }
}

fn none() -> Failure {
    ErrorCode::NotBuiltIn
        .failure("this program was built without Parquet: name a table of points that ends in .csv")
}

#[cfg(not(feature = "parquet"))]
pub(crate) fn table(
    _: &RunInputs,
    _: &[PointResult],
    _: &Listing,
    _: impl FnMut(&[u8]) -> Answer<()>,
) -> Answer<()> {
    Err(none())
}

#[cfg(not(feature = "parquet"))]
pub(crate) fn from_csv(
    _: &RunInputs,
    _: impl Read,
    _: impl FnMut(&[u8]) -> Answer<()>,
) -> Answer<()> {
    Err(none())
}
