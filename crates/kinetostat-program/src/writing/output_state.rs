//! What the controller that runs the output holds at a line, and the next piece to be written.

use nalgebra::Vector3;

use crate::path::moves::{Feed, Motion, Move, MoveKind};
use crate::path::position_offset::PositionOffset;
use crate::writing::jump::Turn;

/// What the controller that runs the output holds at a line.
#[derive(Debug, Clone, Default)]
pub(crate) struct OutputState {
    /// Where the tool is commanded to be, as written, in mm, part frame.
    pub position: Vector3<f64>,
    /// The same before rounding.
    pub target: Vector3<f64>,
    pub offset: PositionOffset,
    pub feed: Option<Feed>,
    pub motion: Option<Motion>,
    /// The feed of the piece written last was held to its largest.
    pub feed_limited: bool,
}

/// One piece to be written.
#[derive(Debug, Clone, Copy)]
pub(crate) struct OutputMove {
    pub share_from: f64,
    pub share_to: f64,
    /// Where to go, before rounding, in mm.
    pub target: Vector3<f64>,
    /// Rotation vector by which the tool is turned there from the orientation of the program, part axes, rad.
    pub tilt: Vector3<f64>,
    pub corner_step: bool,
    pub turn: Option<Turn>,
    pub corrected: bool,
}

/// The motion word that a piece of this move needs.
pub(crate) fn motion_of(motion: &Move) -> Motion {
    match motion.kind {
        MoveKind::Rapid => Motion::Rapid,
        MoveKind::Feed => Motion::Feed,
    }
}
