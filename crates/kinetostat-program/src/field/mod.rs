//! Fields of corrections: queries at places of the path and their answers, and a field from a table.

pub(crate) mod correction;
pub(crate) mod map;
pub(crate) mod request;
