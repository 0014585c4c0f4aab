//! A place in the workspace, from options: a position with an orientation, or joint values.

pub(crate) mod arguments;
pub(crate) mod joints;
pub(crate) mod orientation;
pub(crate) mod query;
pub(crate) mod reachable;
