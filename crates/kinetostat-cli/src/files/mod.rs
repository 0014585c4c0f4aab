//! Files: those that a command reads, with words for what can be wrong with them, and those that it
//! writes, all of them or none.

pub(crate) mod hash;
pub(crate) mod input;
pub(crate) mod journal;
pub(crate) mod origin;
pub(crate) mod output;
pub(crate) mod paths;
