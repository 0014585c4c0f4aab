//! Whether a program has any motion on which a correction could be needed.

use kinetostat_program::{Knowledge, Move, MoveKind, Path};

use crate::task::NoMotion;

/// Why the program has no motion on which a correction could be needed; none if it has some.
pub(crate) fn no_motion(path: &Path) -> Option<NoMotion> {
    if path.moves.is_empty() {
        return Some(NoMotion::NoMoves);
    }
    if path.moves.iter().any(counts) {
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

/// A rapid from an unknown place only positions the tool; of a feed from there the end is cut.
fn counts(motion: &Move) -> bool {
    match motion.known {
        Knowledge::Whole => motion.has_length(),
        Knowledge::End => motion.kind == MoveKind::Feed,
        Knowledge::Nothing => false,
    }
}
