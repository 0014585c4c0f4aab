//! What holds the end of a chain or a machine, and what acts on it: shared by `curve` and
//! `equilibria`.

pub(crate) mod answering;
pub(crate) mod arguments;
pub(crate) mod chain;
pub(crate) mod coordinates;
pub(crate) mod holding;
pub(crate) mod loads;
pub(crate) mod machine;
pub(crate) mod moves;
pub(crate) mod table;
