//! Milling cutters: shape of the envelope, teeth, helix, run-out.
//!
//! Knows geometry alone; takes what a catalogue states; gives points of the meridian with the normal of the
//! envelope. `shared/theory/cutting.md`, "Frame and angles".

mod cutter;
mod meridian;

pub use cutter::{RunOut, Shape, Tool};
pub(crate) use meridian::{Meridian, Piece};
