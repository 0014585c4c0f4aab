//! Fields of corrections: what is asked at a place of the path and what is answered, and a field from a table.

pub(crate) mod map;
pub(crate) mod request;
