//! Places along a path, or along a written program, at which errors are evaluated.

pub(crate) mod of_path;
pub(crate) mod of_written;
pub(crate) mod site;
