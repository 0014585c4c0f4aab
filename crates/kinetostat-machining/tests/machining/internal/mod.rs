//! Parts of the crate that its interface does not show, each by itself.

mod correction;
mod limited;
mod limits;
mod load;
mod merged_warnings;
mod refused;
