//! Motions of robots' programs of which it is not known where the tool is: by joint values, or to places that are computed.

use kinetostat_formats::{Motion, Target};

use crate::job::robot::read_program::RobotRead;
use crate::verify::cut_lines::{CutLines, Left};
use crate::verify::other_word::{FaultKind, OtherWord};

/// Where the program makes more of these than the original, the first one that the original does not make behind the same cut;
/// `cut_lines` are lines of the program verified and of the original.
pub(crate) fn unseen_motions(
    original: &RobotRead<'_>,
    verified: &RobotRead<'_>,
    cut_lines: &[[usize; 2]],
) -> Option<OtherWord> {
    // Of loops that are written one round after the other, lines are no order: their number tells.
    if lines(verified).count() <= lines(original).count() {
        return None;
    }
    let cuts = CutLines::of(cut_lines);
    let mut left = Left::of(lines(original).map(|line| cuts.before(line)));
    let line = lines(verified).find(|line| !left.take(&cuts.before_own(*line)))?;
    let text = format!(
        "the motion at line {line} goes by joint values or to a place that is not known, and the original makes none there"
    );
    let fault = Some(FaultKind::Course);
    Some(OtherWord::new("motion", fault, [Some(line), None], text))
}

/// Lines of these motions, in their order.
fn lines(read: &RobotRead<'_>) -> impl Iterator<Item = usize> {
    let unseen = |motion: &&Motion| !matches!(motion.target, Target::Pose(_));
    let motions = read.program.motions.iter().filter(unseen);
    motions.filter(|m| m.file == read.path.file).map(|m| m.line)
}
