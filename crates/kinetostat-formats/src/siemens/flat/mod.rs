//! Programs with jumps, loops, calls and drilling cycles: run once, and written flat.
//!
//! [`structure`] reads the control flow of a file ([`statements`]), [`run`] follows it, [`mod@print`] writes the blocks with numbers in place of
//! expressions, [`holes`] the blocks of drilling cycles ([`doubts`] name what of them is not certain), [`corners`] those of rounded and broken corners, [`saved`] what comes back behind a subprogram with SAVE.

mod calls;
mod corners;
mod doubts;
mod drilling;
mod expand;
mod frames;
mod holes;
mod modes;
mod names;
mod numbers;
mod print;
mod run;
mod runner;
mod saved;
mod statements;
mod structure;
pub(crate) mod unresolved;

pub(crate) use expand::run_or_refused;
pub use expand::{expand_siemens, expand_within};
