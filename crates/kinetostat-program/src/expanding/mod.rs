//! Programs with subprograms, variables and cycles, run once and written flat.
//!
//! Takes the bytes of a program, its library of subprograms and what a machine knows (reference points, diameters of tools);
//! gives a program of plain blocks, each with the line that it came from, and its path. Codes that can move the tool and are
//! not followed are refused by line. The words are those of LinuxCNC and, where they differ in form, of Fanuc.

mod coordinates;
pub(crate) mod expand;
pub(crate) mod expanded;
mod expression;
mod flat;
mod number;
pub(crate) mod options;
mod radius;
pub(crate) mod run;
mod source;
mod source_lines;
mod translate;
