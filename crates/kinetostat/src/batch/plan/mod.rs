//! A chain compiled for the kernels: elementary motions with constants folded, springs inverted.
//!
//! Takes a chain, gives a list of steps, or the reason why no kernel takes it ([`crate::batch::NoKernel`]).
//!
//! ```text
//! g(x) = R_1 M_1(x_1) R_2 M_2(x_2) ...: rigid offsets between two motions become one                     [R 3.1]
//! ```

pub(crate) mod compile;
pub(crate) mod steps;
