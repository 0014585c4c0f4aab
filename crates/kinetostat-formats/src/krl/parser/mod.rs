//! From lines to routines and data. Blocks are kept on a list, not on the stack of calls: any depth is safe.

pub(crate) mod blocks;
pub(crate) mod routines;
