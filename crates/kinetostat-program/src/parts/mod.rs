//! Programs longer than memory: read, written and checked part by part.
//!
//! A [`Survey`] goes over the text once and notes what only the whole tells, and where parts begin. [`Parts`] then reads each of them
//! by itself, in any order: lines of its own, with some motions on either side that say how these begin and end. Each is a [`Program`](crate::Program) and a
//! [`Path`](crate::Path) as that of a short program, with the lines that it has in the whole one. [`WrittenSoFar`] is where the
//! written program stands between two of them, and [`PartsInOrder`] has them worked on side by side, so that all that is written,
//! put together, is one program.

pub(crate) mod beginnings;
pub(crate) mod gcode_part;
pub(crate) mod in_order;
pub(crate) mod length;
pub(crate) mod survey;
pub(crate) mod windows;
pub(crate) mod written_so_far;
