//! Force of the cut per depth and displacement of the tool, tooth by tooth.
//!
//! Takes teeth, engagement, helix and coefficients; gives the directional matrix [D 8] over the turn of the spindle, smooth
//! piece by piece. Straight or helical edges of a cylinder, even pitch, a force that is linear in the chip.

mod coefficients;
mod milling;
mod piece;
mod process;

pub use coefficients::{Coefficients, Linearised};
pub use milling::{Arc, Milled, MillingCut};
pub(crate) use piece::Piece;
pub use process::{Cut, TurningCut};
pub(crate) use process::{checked_depth, checked_speed};
