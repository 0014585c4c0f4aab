//! Check that a program has motions that could need a correction.

use kinetostat_program::{Knowledge, Move, MoveKind, Path};

use crate::task::NoMotion;

/// Reason for which the program has no motion that could need a correction; `None` if it has some.
pub(crate) fn no_motion(path: &Path) -> Option<NoMotion> {
    if path.moves.is_empty() {
        return Some(NoMotion::NoMoves);
    }
    if path.moves.iter().any(|m| counts(m, path.stated)) {
        return None;
    }
    Some(if path.stated.contains(&false) {
        NoMotion::UnknownPlace
    } else if path.moves.iter().any(|m| m.kind == MoveKind::Feed) {
        NoMotion::NoLength
    } else {
        NoMotion::NoFeed
    })
}

/// True if the move could be corrected: a rapid from an unknown place only if every axis is stated.
fn counts(motion: &Move, stated: [bool; 3]) -> bool {
    match motion.known {
        Knowledge::Whole => {
            motion.has_length() || motion.kind == MoveKind::Feed && motion.turns_in_place()
        }
        Knowledge::End => motion.kind == MoveKind::Feed || stated == [true; 3],
        Knowledge::Nothing => false,
    }
}
