//! Cutter radius compensation (G40, G41, G42, G41.1, G42.1): the contour of a program becomes the way of the tool's centre.
//!
//! Takes blocks of plain words, one by one, and the diameters of tools; gives the plain blocks of the tool's centre line. The
//! rules (which corner is one, where the tool enters, what is an error) are those of LinuxCNC 2.9, `docs/src/gcode/tool-compensation.adoc`
//! and its interpreter; what it refuses is refused, and so is what would cut into the contour or hang on the last digit of its
//! arithmetic. Like LinuxCNC it looks at neighbouring blocks only: a contour that meets itself further on is not seen.
//!
//! - `geometry`: the plane's geometry, corners and meeting points, no state;
//! - `contour`: a contour and the tool beside it; `follow` leads it along by its entry, straight moves and arcs;
//! - `pending`: motions as blocks of the flat program; the last one, whose end the next corner may still move, and what came behind it;
//! - `words`, `cutter`: which words a block may have, which radius they mean, and the contour that begins;
//! - `stage`: on, off, and between G40 and the next move, by `blocks`.

mod blocks;
pub(crate) mod contour;
mod cutter;
mod follow;
pub(crate) mod geometry;
pub(crate) mod pending;
pub(crate) mod stage;
pub(crate) mod words;
