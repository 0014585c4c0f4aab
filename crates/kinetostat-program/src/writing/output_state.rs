//! Modal state of the controller that runs the output, and the next piece to be written.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use crate::path::moves::{Feed, Motion, Move, MoveKind};
use crate::path::position_offset::PositionOffset;
use crate::writing::jump::Turn;
use crate::writing::written_arc::WrittenArc;

/// Modal state, at a line, of the controller that runs the output.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct OutputState {
    /// Commanded tool position, as written, in mm, part frame.
    pub position: Vector3<f64>,
    /// Commanded tool position before rounding.
    pub target: Vector3<f64>,
    pub offset: PositionOffset,
    pub feed: Option<Feed>,
    pub motion: Option<Motion>,
    /// The feed of the piece written last was held to its largest.
    pub feed_limited: bool,
    /// The piece written last, where it is an arc that was fitted.
    pub arc: Option<WrittenArc>,
    /// Correction of the rotary axes, deg, in their order; empty if there never was one.
    pub turned_deg: Vec<f64>,
}

/// An arc that was fitted to a corrected curve, before rounding.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct FittedArc {
    /// Centre in the plane of the arc that it stands for, mm.
    pub centre_mm: [f64; 2],
    pub radius_mm: f64,
    pub sweep_rad: f64,
    /// See [`crate::WrittenArc::slip`].
    pub slip: [f64; 2],
    /// Largest correction of the places between its ends, mm.
    pub largest_correction_mm: f64,
}

/// A circle through a place, before rounding.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct FittedCircle {
    /// A place between its ends, mm.
    pub via_mm: Vector3<f64>,
    /// See [`crate::WrittenArc::slip`].
    pub slip: [f64; 2],
    pub length_mm: f64,
    /// Largest correction of the places between its ends, mm.
    pub largest_correction_mm: f64,
}

/// One piece to be written.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct OutputMove {
    pub share_from: f64,
    pub share_to: f64,
    /// Target before rounding, in mm.
    pub target: Vector3<f64>,
    /// Rotation vector by which the tool is turned there from the orientation of the program, part axes, rad.
    pub tilt: Vector3<f64>,
    pub corner_step: bool,
    pub turn: Option<Turn>,
    /// An arc about this centre, before rounding; straight without.
    pub arc: Option<FittedArc>,
    /// A circle through a place; straight, or an arc, without.
    pub circle: Option<FittedCircle>,
    pub corrected: bool,
}

impl OutputMove {
    /// Difference between equal ways on the path and on an arc or a circle, see [`crate::WrittenArc::slip`].
    pub fn slip(&self) -> Option<[f64; 2]> {
        let circle = self.circle.map(|circle| circle.slip);
        circle.or(self.arc.map(|arc| arc.slip))
    }

    /// A move in one straight piece.
    pub fn whole(target: Vector3<f64>, tilt: Vector3<f64>, corrected: bool) -> Self {
        Self {
            share_to: 1.0,
            target,
            tilt,
            corrected,
            ..Self::default()
        }
    }

    /// Largest correction between the ends of an arc or a circle, mm.
    pub fn largest_inside_mm(&self) -> f64 {
        let circle = self.circle.map(|circle| circle.largest_correction_mm);
        let arc = self.arc.map(|arc| arc.largest_correction_mm);
        circle.or(arc).unwrap_or(0.0)
    }
}

/// The motion word that a piece of this move needs.
pub(crate) fn motion_of(motion: &Move) -> Motion {
    match motion.kind {
        MoveKind::Rapid => Motion::Rapid,
        MoveKind::Feed => Motion::Feed,
    }
}
