//! Places along a path, or along a written program, at which errors are evaluated.

mod of_load;
pub(crate) mod of_path;
pub(crate) mod of_written;
mod programmed;
pub(crate) mod site;
