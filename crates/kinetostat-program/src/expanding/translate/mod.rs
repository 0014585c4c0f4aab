//! Words that a controller makes into moves of its own, written as plain moves: polar words, canned cycles.
//!
//! Takes a block of plain words and where the tool is; gives the plain blocks in its place. The motions are those of LinuxCNC
//! (`docs/src/gcode/g-code.adoc`, "Canned Cycles", "Polar Coordinates").

pub(crate) mod block;
pub(crate) mod cycle;
pub(crate) mod holes;
pub(crate) mod spline;
pub(crate) mod turns;
