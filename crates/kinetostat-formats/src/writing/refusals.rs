//! Reasons why a motion cannot be replaced by its pieces, and requirements on pieces.

use crate::writing::piece::Piece;

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
