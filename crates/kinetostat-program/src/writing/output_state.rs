//! Modal state of the controller that runs the output, the next piece to be written, and its arc as the controller reads it.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use crate::path::curve::Arc;
use crate::path::moves::{Feed, Motion, Move, MoveKind, PositionOffset};
use crate::writing::node::Turn;

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

/// Share of a sweep at which the tool is when a part of the path is done, see [`WrittenArc::slip`].
pub(crate) fn slipped(slip: &[f64; 2], part: f64) -> f64 {
    part + part * (1.0 - part) * (slip[0] + slip[1] * (1.0 - 2.0 * part))
}

/// An arc of the written program about an axis of the part, with the ends of its [`Piece`](crate::Piece).
///
/// ```
/// use kinetostat_program::*;
/// use nalgebra::Vector3;
///
/// let program = Program::read("G21 G90 G17\nG0 X10 Y0 Z0\nG3 X0 Y10 I-10 J0 F600\nM2\n")?;
/// let path = interpret(&program, &ReadOptions::default())?;
/// // The part is made 0.2 % larger: a quarter of a circle of 10.02 mm.
/// let larger = |request: &Request| Ok(request.position_mm * 2e-3);
/// let mut writing = WriteOptions::default();
/// writing.header = None;
/// let written = write_corrected(&program, &path, &larger, &writing, &Unwatched)?;
/// let piece = &written.pieces.iter().find(|piece| piece.arc.is_some()).unwrap();
/// let arc = piece.arc.unwrap();
/// let curve = arc.between(&piece.commanded_from, &piece.commanded_to);
/// assert_eq!((arc.axes(), curve.start_radius, arc.turned(1.0)), ([0, 1, 2], 10.02, 1.0));
/// assert!((piece.commanded(&path.moves[1], 0.5).norm() - 10.02).abs() < 1e-4);
/// assert!((piece.length_mm(&path.moves[1]) - 15.739).abs() < 1e-3);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct WrittenArc {
    /// Axis about which it turns: 2 in the plane of X and Y (G17), 1 in that of Z and X (G18), 0 in that of Y and Z (G19).
    pub normal: usize,
    /// Centre in the plane, part frame, in mm, along the first two of [`WrittenArc::axes`].
    pub centre_mm: [f64; 2],
    /// Angle from its start to its end, in rad, positive counter-clockwise (G3).
    pub sweep_rad: f64,
    /// The corrected place at a part `u` of the piece's stretch of the path belongs to the share
    /// `u + u (1 - u) (slip[0] + slip[1] (1 - 2 u))` of the sweep: where the correction varies along the path, equal ways on the
    /// path are not quite equal ways of the tool.
    pub slip: [f64; 2],
}

impl WrittenArc {
    /// Axes of the plane and of its normal, right-handed (0 X, 1 Y, 2 Z).
    #[must_use]
    pub fn axes(&self) -> [usize; 3] {
        [
            (self.normal + 1) % 3,
            (self.normal + 2) % 3,
            self.normal % 3,
        ]
    }

    /// Share of the sweep at which the tool is when a part of the piece's stretch of the path is done.
    #[must_use]
    pub fn turned(&self, part: f64) -> f64 {
        slipped(&self.slip, part)
    }

    /// Curve between two ends; radius and height change linearly with the angle.
    #[must_use]
    pub fn between(&self, from: &Vector3<f64>, to: &Vector3<f64>) -> Arc {
        let unit = |axis: usize| Vector3::ith(axis, 1.0);
        let [first, second, normal] = self.axes();
        let out = |point: &Vector3<f64>| {
            [
                point[first] - self.centre_mm[0],
                point[second] - self.centre_mm[1],
            ]
        };
        let (start, end) = (out(from), out(to));
        Arc {
            centre: unit(first) * self.centre_mm[0]
                + unit(second) * self.centre_mm[1]
                + unit(normal) * from[normal],
            first: unit(first),
            second: unit(second),
            axis: unit(normal),
            start_angle: start[1].atan2(start[0]),
            sweep: self.sweep_rad,
            start_radius: start[0].hypot(start[1]),
            end_radius: end[0].hypot(end[1]),
            rise: to[normal] - from[normal],
        }
    }
}
