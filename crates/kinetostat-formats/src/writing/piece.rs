//! What the caller wants a motion to become.

use nalgebra::{UnitQuaternion, Vector3};

/// One piece of a motion. Motions without pieces stay as they are; of several pieces the last is at the motion's end.
///
/// ```
/// use kinetostat_formats::Piece;
/// use nalgebra::Vector3;
///
/// let piece = Piece::to(7, Vector3::new(100.0, 0.0, 0.02));
/// assert_eq!((piece.motion, piece.speed_factor), (7, 1.0));
/// ```
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Piece {
    /// An index of [`crate::RobotProgram::motions`].
    pub motion: usize,
    /// Where it ends: mm, in the axes of the motion's work object.
    pub position_mm: Vector3<f64>,
    /// How the tool stands there, in the same axes; none for that of the motion's end.
    pub orientation: Option<UnitQuaternion<f64>>,
    /// Where a piece of a circular motion that is a circle itself passes between its start and its end, mm; without it the piece
    /// is straight. Of several pieces RAPID, KRL, FANUC TP and SINUMERIK programs have circles.
    pub via_mm: Option<Vector3<f64>>,
    /// Where rotary axes of a machine stand there, deg, in the order of [`crate::ReadOptions::rotary_axes`], where the program states
    /// their angles (SINUMERIK, Heidenhain); none for those of the motion's end.
    pub rotary_deg: Option<Vec<f64>>,
    /// A place of the axis of the arc on which a piece of an arc goes there, mm: in the sense of that arc, about an axis of the same
    /// direction, by less than a turn, with an even rise. Of Heidenhain programs; without it the piece is straight.
    pub centre_mm: Option<Vector3<f64>>,
    /// How the tool stands there; none for what the motion states there.
    pub via_orientation: Option<UnitQuaternion<f64>>,
    /// How much of the way of its motion lies behind it at its end, from 0 to 1: external axes that move with the motion are shared
    /// out by it, evenly. None: by the lengths of the straight lines from piece to piece.
    pub share: Option<f64>,
    /// By what the written speed is multiplied.
    pub speed_factor: f64,
}

impl Piece {
    /// The end of a motion at another place, all else as written.
    #[must_use]
    pub fn to(motion: usize, position_mm: Vector3<f64>) -> Self {
        Self {
            motion,
            position_mm,
            speed_factor: 1.0,
            ..Self::default()
        }
    }
}
