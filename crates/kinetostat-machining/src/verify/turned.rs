//! Orientations that another program states otherwise than the original.

use kinetostat_program::{Move, Path};
use nalgebra::UnitQuaternion;

use crate::verify::followed::Followed;
use crate::verify::matched::Turned;

/// Share of a turning move within which a place on it is known.
const PLACED: f64 = 0.1;

/// Largest difference of the commanded orientation from that of the original at its place: the way from one move to the next is not
/// evaluated if both programs turn the tool.
pub(crate) fn turned_most(original: &Path, other: &Path, pieces: &[Followed]) -> Option<Turned> {
    let of_piece = |own: &Followed| {
        let (index, share) = own.other_end;
        let motion = &other.moves[index];
        let of_original = &original.moves[own.piece.move_index];
        let cuts = own.piece.corrected && own.piece.turn.is_none() && motion.is_known_feed();
        let turn = motion.tool_turn.as_ref().filter(|_| cuts)?;
        let wanted = of_original.orientation(own.piece.share_to)?;
        let slack = PLACED * (turn_of(of_original)? + turn_of(motion)?);
        let angle = turn.at(share).angle_to(&wanted) - slack;
        Some(Turned {
            line: motion.line,
            line_of_original: of_original.line,
            angle_deg: angle.max(0.0).to_degrees(),
        })
    };
    let all = pieces.iter().filter_map(of_piece);
    all.max_by(|a, b| a.angle_deg.total_cmp(&b.angle_deg))
}

/// Rotation of the tool in a move, rad.
fn turn_of(motion: &Move) -> Option<f64> {
    let at = |share: f64| -> Option<UnitQuaternion<f64>> { motion.orientation(share) };
    Some(at(0.0)?.angle_to(&at(1.0)?))
}
