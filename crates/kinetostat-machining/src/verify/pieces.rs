//! Pieces of another program as those of a written one, with the orientation that it commands.

use kinetostat::number::larger;
use kinetostat_program::{Accounting, Corrected, MoveKind, Path};
use nalgebra::UnitQuaternion;

use crate::verify::follow::Followed;

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
        for Followed { other_end, .. } in &followed {
            let (index, share) = *other_end;
            let turn = other.moves[index].tool_turn.as_ref();
            orientations.push(turn.map_or_else(UnitQuaternion::identity, |turn| turn.at(share)));
            let rotary = turn.and_then(|turn| turn.rotary.as_ref());
            rotary_deg.push(rotary.map_or_else(Vec::new, |rotary| rotary.angles_deg(share)));
        }
    }
    let feed = other.moves.iter().filter(|m| m.kind == MoveKind::Feed);
    let largest = |step: bool| {
        let steps = followed.iter().map(|f| &f.piece).filter(|p| p.corner_step);
        let entry = |turn: kinetostat_program::Turn| turn.is_entry(original);
        let of_kind = steps.filter(move |p| p.turn.is_some_and(entry) == step);
        of_kind.map(|p| (p.commanded_to - p.commanded_from).norm())
    };
    let accounting = Accounting {
        blocks_out: feed.count(),
        bytes_out: bytes.len(),
        pieces: followed.len(),
        corner_steps: largest(false).count(),
        largest_corner_step_mm: largest(false).fold(0.0, larger),
        entry_steps: largest(true).count(),
        largest_entry_step_mm: largest(true).fold(0.0, larger),
        ..Accounting::default()
    };
    Corrected {
        bytes: bytes.to_vec(),
        pieces: followed.into_iter().map(|f| f.piece).collect(),
        beside: Vec::new(),
        orientations,
        rotary_deg,
        accounting,
    }
}
