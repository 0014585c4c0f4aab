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

/// Reason and remedy of a motion that cannot be written.
pub(crate) type Reason = (&'static str, &'static str);

pub(super) const NO_END: Reason = (
    "the motion has no pose that could be corrected",
    "write its target as numbers in one place of the program",
);

pub(super) const NO_VIA: Reason = (
    "through which place its circle goes is not known from the text",
    "write that place as numbers",
);

pub(super) const NO_JOINTS: Reason = (
    "no joint values next to those of the row give the corrected pose",
    "keep away from singular postures and from the end of the reach",
);

pub(super) const NO_NAME: Reason = (
    "no name or number is free for a further pose",
    "give fewer pieces, or divide the program",
);

/// Runs of one statement that need different corrections, where the program can be written flat and where it cannot.
pub(super) const REPEATED: Reason = (
    "the statement runs several times, and needs another correction each time",
    "run the program once and go on with its flat form (--expand, [expand] in a job)",
);
pub(super) const REPEATED_FOR_GOOD: Reason = (
    REPEATED.0,
    "write the statement once for each of its runs, without the loop or the routine around it",
);

/// Corrections of two runs of one statement that are the same, mm and rad: less than the last digit that is written.
pub(super) const SAME_MM: f64 = 1e-4;
pub(super) const SAME_RAD: f64 = 1e-7;

/// Farther than any robot reaches, mm.
const FARTHEST_MM: f64 = 1e6;

/// A piece whose numbers no program can have.
pub(crate) const ABSURD: Reason = (
    "a piece has no finite place, orientation or speed, no finite angle of an axis or share, or a place farther than 1 km",
    "mend the correction",
);

/// True where all numbers of a piece are finite and within range.
pub(crate) fn is_finite(piece: &Piece) -> bool {
    let via = piece.via_mm.unwrap_or_default();
    let turns = piece.orientation.iter().chain(&piece.via_orientation);
    let mut numbers = turns
        .flat_map(|turn| turn.coords.iter())
        .chain(piece.rotary_deg.iter().flatten())
        .chain(&piece.share);
    let mut places = piece.position_mm.iter().chain(via.iter());
    places.all(|value| value.abs() < FARTHEST_MM)
        && numbers.all(|value| value.is_finite())
        && piece.speed_factor.is_finite()
        && piece.speed_factor > 0.0
}

/// Checks that pieces have numbers and no centres.
pub(crate) fn check_pieces(pieces: &[&Piece]) -> Result<(), Reason> {
    if pieces.iter().any(|piece| piece.centre_mm.is_some()) {
        return Err((
            "a piece goes about a centre, and only Heidenhain programs are written so",
            "give it a place between its ends, or make it straight",
        ));
    }
    match pieces.iter().all(|piece| is_finite(piece)) {
        true => Ok(()),
        false => Err(ABSURD),
    }
}
