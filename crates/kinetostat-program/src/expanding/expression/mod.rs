//! Expressions of macros: `[#1 * SIN[30] + #<depth>]`.
//!
//! Takes the bytes of a line; gives trees, and their values with the parameters of the moment. Operators, their order
//! (`**`; `* / MOD`; `+ -`; comparisons; `AND OR XOR`; each from left to right) and functions are those of LinuxCNC
//! (`docs/src/gcode/overview.adoc`, "Expressions", "Binary Operators", "Functions"), which has all of Fanuc's.

pub(crate) mod evaluate;
pub(crate) mod parse;
pub(crate) mod tree;
