//! Programs that repeat, jump, count or drill by cycles: run once and written flat.
//!
//! From the files ([`program`]), the expressions of Q parameters ([`expression`]) and the blocks of drilling cycles ([`drill`]) to the run ([`run`]).

pub(crate) mod drill;
pub(crate) mod expression;
pub(crate) mod program;
pub(crate) mod run;
