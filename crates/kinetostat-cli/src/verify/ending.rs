//! Position of the tool after the last cut.

use kinetostat_program::{Move, MoveKind, Path};

use crate::verify::other_word::{FaultKind, OtherWord};

/// Distance from the end of the last cut at which a tool has left it, mm, beside the shift by corrections.
const NEAR_MM: f64 = 1.0;

/// A move at feed from a place that the program states to another one.
pub(crate) fn is_cut(m: &Move) -> bool {
    m.is_known_feed() && m.has_length()
}

/// A program that leaves the tool where the last cut ends, where the original leaves it by a rapid; `shift_mm` is how far corrections
/// may shift that end.
pub(crate) fn ends_in_cut(original: &Path, verified: &Path, shift_mm: f64) -> Option<OtherWord> {
    let last = original.moves.iter().rposition(is_cut)?;
    let mut behind = original.moves[last + 1..].iter();
    let rapid = behind.find(|m| m.kind == MoveKind::Rapid)?;
    let own = verified.moves.last().filter(|m| is_cut(m))?;
    let off_mm = (own.end - original.moves[last].end).norm();
    (off_mm <= NEAR_MM + shift_mm).then(|| {
        let text = format!(
            "the last move, at line {}, leaves the tool where it cuts, and the original leaves that place by a rapid (line {} there)",
            own.line, rapid.line
        );
        let lines = [Some(own.line), Some(rapid.line)];
        OtherWord::new("retract", Some(FaultKind::Course), lines, text)
    })
}
