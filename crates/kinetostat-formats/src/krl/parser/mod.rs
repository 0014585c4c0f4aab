//! From lines to routines and data. Blocks are kept on a list, not on the stack of calls: any depth is safe.

mod blocks;
pub(crate) mod cursor;
mod declarations;
pub(crate) mod routines;
