//! Pieces that replace a motion, as the caller requests them.

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
    /// End position: mm, in the axes of the motion's work object.
    pub position_mm: Vector3<f64>,
    /// Tool orientation at the end, in the same axes; `None` keeps that of the motion's end.
    pub orientation: Option<UnitQuaternion<f64>>,
    /// Auxiliary point of a circular piece between its start and its end, mm; without it the piece is straight. Several circular pieces of a motion
    /// are supported in RAPID, KRL, FANUC TP and SINUMERIK programs.
    pub via_mm: Option<Vector3<f64>>,
    /// Positions of the rotary axes of a machine at the end, deg, in the order of [`crate::ReadOptions::rotary_axes`], if the program states their
    /// angles (SINUMERIK, Heidenhain); `None` keeps those of the motion's end.
    pub rotary_deg: Option<Vec<f64>>,
    /// A place of the axis of the arc on which a piece of an arc goes there, mm: in the sense of that arc, about an axis of the same
    /// direction, by less than a turn, with an even rise. Of Heidenhain programs; without it the piece is straight.
    pub centre_mm: Option<Vector3<f64>>,
    /// Tool orientation at the auxiliary point; `None` keeps that of the motion.
    pub via_orientation: Option<UnitQuaternion<f64>>,
    /// Fraction of the motion's path covered at the end of the piece, from 0 to 1: external axes that move with the motion are interpolated by it.
    /// `None`: by the lengths of the straight lines from piece to piece.
    pub share: Option<f64>,
    /// Factor on the written speed.
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
