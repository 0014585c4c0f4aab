//! A program is run: values of parameters, calls, branches and loops.
//!
//! Takes statements; gives plain blocks to the flat program, one after the other, with the line of each.

pub(crate) mod calls;
pub(crate) mod cycles;
pub(crate) mod frame;
pub(crate) mod loops;
pub(crate) mod macros;
pub(crate) mod modal;
pub(crate) mod offsets;
pub(crate) mod parameters;
pub(crate) mod runner;
pub(crate) mod saves;
pub(crate) mod source;
pub(crate) mod steps;
