//! What holds the end of a chain or a machine, and what acts on it: shared by `curve` and
//! `equilibria`.

pub(crate) mod chain;
