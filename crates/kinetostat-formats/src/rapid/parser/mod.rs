//! Parser from tokens to modules, routines and statements. It notes errors and continues.

mod cursor;
pub(crate) mod modules;
mod statements;
