//! Whether a program has any motion on which a correction could be needed.

use kinetostat_program::{Knowledge, Move, MoveKind, Path};

use crate::task::NoMotion;

/// Why the program has no motion on which a correction could be needed; none if it has some.
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

/// Where a move from an unknown place ends counts, of a rapid only where every axis is stated.
fn counts(motion: &Move, stated: [bool; 3]) -> bool {
    match motion.known {
        Knowledge::Whole => {
            motion.has_length() || motion.kind == MoveKind::Feed && motion.turns_in_place()
        }
        Knowledge::End => motion.kind == MoveKind::Feed || stated == [true; 3],
        Knowledge::Nothing => false,
    }
}
