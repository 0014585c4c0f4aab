//! Pieces of another program as those of a written one, with the orientation that it commands.

use kinetostat::number::larger;
use kinetostat_program::{Accounting, Corrected, MoveKind, Path, Piece};
use nalgebra::UnitQuaternion;

use crate::verify::followed::Followed;

/// The other program as one that was written from the original; steps that go backwards by more than `backward_mm` are counted.
pub(crate) fn as_written(
    original: &Path,
    (other, bytes): (&Path, &[u8]),
    followed: Vec<Followed>,
    backward_mm: f64,
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
    let mut accounting = Accounting {
        blocks_out: feed.count(),
        bytes_out: bytes.len(),
        pieces: followed.len(),
        ..Accounting::default()
    };
    let pieces: Vec<Piece> = followed.into_iter().map(|f| f.piece).collect();
    note_steps(&mut accounting, original, &pieces, backward_mm);
    Corrected {
        bytes: bytes.to_vec(),
        pieces,
        beside: Vec::new(),
        orientations,
        rotary_deg,
        accounting,
        writer: None,
    }
}

/// Steps at corners and where a rapid ends, and how far they go against the direction of motion.
fn note_steps(accounting: &mut Accounting, original: &Path, pieces: &[Piece], backward_mm: f64) {
    let place = |piece: &Piece| piece.turn.map(|turn| (piece.move_index, turn.to_share));
    for step in pieces.chunk_by(|a, b| place(a) == place(b)) {
        let (first, last) = (&step[0], &step[step.len() - 1]);
        let Some(turn) = first.turn else { continue };
        let way = last.commanded_to - first.commanded_from;
        let a = &mut *accounting;
        let is_entry = turn.is_entry(original);
        let (count, longest) = match is_entry {
            true => (&mut a.entry_steps, &mut a.largest_entry_step_mm),
            false => (&mut a.corner_steps, &mut a.largest_corner_step_mm),
        };
        *count += 1;
        *longest = larger(*longest, way.norm());
        let before = original.moves[turn.from_move].tangent(turn.from_share);
        let directions = original.moves[first.move_index].tangent(turn.to_share);
        let directions = directions.into_iter().chain(before.filter(|_| !is_entry));
        let backward = directions.fold(0.0, |most, along| larger(most, -way.dot(&along)));
        a.backward_steps += usize::from(backward > backward_mm);
        a.largest_backward_mm = larger(a.largest_backward_mm, backward);
    }
}
