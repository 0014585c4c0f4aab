//! Programs with jumps, loops, calls and drilling cycles: run once, and written flat.
//!
//! [`structure`] reads the control flow of a file ([`statements`]), [`run`] follows it, [`mod@print`] writes the blocks with numbers in place of
//! expressions, [`holes`] the blocks of drilling cycles (a note names what of them is not certain) and those of rows and circles of holes,
//! [`corners`] those of rounded and broken corners.

mod calls;
mod corners;
mod drilling;
mod holes;
mod modes;
mod print;
mod run;
mod runner;
mod statements;
mod structure;

pub(crate) use run::run_or_refused;
pub use run::{expand_siemens, expand_within};
