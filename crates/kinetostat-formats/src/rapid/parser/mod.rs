//! From tokens to modules, routines and statements. What is wrong is noted, and the parser goes on.

mod cursor;
mod declarations;
pub(crate) mod modules;
mod statements;
