//! Pieces of another program as those of a written one, with the orientation that it commands.

use kinetostat_program::{Accounting, Corrected, MoveKind, Path};
use nalgebra::UnitQuaternion;

use crate::verify::followed::Followed;

/// The other program as one that was written from the original.
pub(crate) fn as_written(
    original: &Path,
    (other, bytes): (&Path, &[u8]),
    followed: Vec<Followed>,
) -> Corrected {
    let states = |path: &Path| path.moves.iter().any(|motion| motion.tool_turn.is_some());
    let turns = states(original) && states(other);
    let (mut orientations, mut rotary_deg) = (Vec::new(), Vec::new());
    if turns {
        for Followed {
            other_end, piece, ..
        } in &followed
        {
            let (index, share) = *other_end;
            let turn = other.moves[index].tool_turn.as_ref();
            // A move that does not state how the tool stands leaves it to what the original says there.
            let of_original = || original.moves[piece.move_index].orientation(piece.share_to);
            let stands = turn.map(|turn| turn.at(share)).or_else(of_original);
            orientations.push(stands.unwrap_or_else(UnitQuaternion::identity));
            let rotary = turn.and_then(|turn| turn.rotary.as_ref());
            rotary_deg.push(rotary.map_or_else(Vec::new, |rotary| rotary.angles_deg(share)));
        }
    }
    let feed = other.moves.iter().filter(|m| m.kind == MoveKind::Feed);
    let accounting = Accounting {
        blocks_out: feed.count(),
        bytes_out: bytes.len(),
        pieces: followed.len(),
        ..Accounting::default()
    };
    Corrected {
        bytes: bytes.to_vec(),
        pieces: followed.into_iter().map(|f| f.piece).collect(),
        beside: Vec::new(),
        orientations,
        rotary_deg,
        accounting,
        writer: None,
    }
}
