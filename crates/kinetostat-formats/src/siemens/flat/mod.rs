//! Programs with jumps, loops, calls and drilling cycles: run once, and written flat.
//!
//! [`structure`] reads the control flow of a file, [`run`] follows it, [`print`] writes the blocks with numbers in place of
//! expressions, [`drilling`] the blocks of drilling cycles.

mod calls;
mod drilling;
mod expand;
mod modes;
mod print;
mod run;
mod structure;

pub use expand::{expand_siemens, expand_within};
