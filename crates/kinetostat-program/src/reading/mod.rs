//! From words to the path: modes, codes, arcs, tools.
//!
//! Takes a program and what it does not say about itself; gives its path, or refuses a block with its line, the reason and
//! what to do.

pub(crate) mod arc;
pub(crate) mod beside;
pub(crate) mod block;
pub(crate) mod dialect;
pub(crate) mod directions;
pub(crate) mod extra;
pub(crate) mod faults;
pub(crate) mod interpreting;
pub(crate) mod machine;
pub(crate) mod modes;
pub(crate) mod moment;
pub(crate) mod options;
pub(crate) mod places;
pub(crate) mod repeated;
pub(crate) mod rotary;
pub(crate) mod spindle;
pub(crate) mod state;
pub(crate) mod tools;
