//! From lines to routines and data. Blocks are kept on a list, not on the stack of calls: any depth is safe.

mod blocks;
pub(crate) mod cursor;
pub(crate) mod routines;
