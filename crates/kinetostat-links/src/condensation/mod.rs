//! From a matrix of many degrees of freedom to the stiffness of one interface \[Guyan1965\].
//!
//! Takes a superelement, the places of its nodes and two interfaces; gives 6 x 6 numbers, or says what is free.

pub(crate) mod condense;
pub(crate) mod envelope;
pub(crate) mod free_test;
