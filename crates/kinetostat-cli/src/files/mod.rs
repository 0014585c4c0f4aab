//! Files: those that a command reads, with words for what can be wrong with them, and those that it
//! writes, all of them or none.

pub(crate) mod hash;
pub(crate) mod input_files;
pub(crate) mod journal;
pub(crate) mod origin;
pub(crate) mod outputs;
pub(crate) mod paths;
