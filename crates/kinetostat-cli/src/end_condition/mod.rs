//! End condition and loads of a chain or a machine: the common part of `curve` and `equilibria`.
//!
//! It takes their options and a place and gives the chain or the machine with its end condition, the names of its
//! coordinates, and the steps from the options to the files ([`answering`]).

pub(crate) mod answering;
pub(crate) mod arguments;
pub(crate) mod chain;
pub(crate) mod coordinates;
pub(crate) mod holding;
pub(crate) mod loads;
pub(crate) mod machine;
pub(crate) mod moves;
pub(crate) mod subject;
