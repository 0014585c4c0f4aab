//! What is written in KRL: statements of pieces, ends that state what they kept of before, and what FOLDs show of points that have
//! become others.

mod renamed;
mod stated;
mod steps;
pub(crate) mod write;
