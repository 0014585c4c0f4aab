//! A chain compiled for the kernels: elementary motions with constants folded, springs inverted.
//!
//! Takes a chain, gives a list of steps, or the reason why no kernel walks it ([`crate::batch::NoKernel`]).

pub(crate) mod compile;
pub(crate) mod steps;
