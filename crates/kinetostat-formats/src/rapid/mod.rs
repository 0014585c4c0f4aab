//! ABB RAPID: modules read together, and what the writer must know of the language.

pub(crate) mod reader;
pub(crate) mod table;
pub(crate) mod write;
