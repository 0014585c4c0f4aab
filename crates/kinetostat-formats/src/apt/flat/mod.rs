//! Drilling cycles (`CYCLE`) written as plain motions: what a cycle says ([`cycle`]), and the file with its holes ([`expand`]).

pub(crate) mod cycle;
pub(crate) mod expand;
