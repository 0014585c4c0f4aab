//! One place in the workspace, as options name it: a position with an orientation, or joint values.
//!
//! It takes a model and the options of a place and gives the machine with its tool, commanded for that place
//! ([`query`]), with what is to be said of the place.

pub(crate) mod arguments;
pub(crate) mod joints;
pub(crate) mod orientation;
pub(crate) mod query;
