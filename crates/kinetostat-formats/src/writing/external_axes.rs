//! External axes of a motion that is divided: each piece takes them along as far as it goes.

use crate::error::WriteError;
use crate::model::external::AxisWay;
use crate::model::motion::Motion;
use crate::model::program::RobotProgram;
use crate::model::site::PoseText;
use crate::writing::piece::Piece;

/// Positions of the external axes at a piece's end, by their order; unmoved axes are left out.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct AxesOfPiece {
    /// Positions at the end of the piece.
    pub end: Vec<Option<f64>>,
    /// Halfway between its ends.
    pub halfway: Vec<Option<f64>>,
}

/// The external axes of the pieces of a motion; why they cannot be shared out.
pub(crate) fn shared_axes(
    program: &RobotProgram,
    motion: &Motion,
    ways: &[AxisWay],
    text: Option<&PoseText>,
    pieces: &[&Piece],
) -> Result<Vec<AxesOfPiece>, WriteError> {
    let mut axes = vec![AxesOfPiece::default(); pieces.len()];
    if pieces.len() < 2 || ways.is_empty() {
        return Ok(axes);
    }
    let refused = |way: &AxisWay, reason: &str, remedy: &str| WriteError::Motion {
        file: program.files[motion.file].name().to_owned(),
        line: motion.line,
        reason: format!(
            "{} {reason}",
            program.language.name_of_external_axis(way.axis)
        ),
        remedy: remedy.to_owned(),
    };
    let shares = shares_of(program, motion, pieces);
    for way in ways {
        let is_written = |text: &PoseText| text.external.get(way.axis).is_some_and(Option::is_some);
        if !text.is_some_and(is_written) {
            return Err(refused(
                way,
                "moves with it, and would make all of its way in the first of the pieces into which it is divided",
                "move external axes where the tool is in air, with a joint motion or one at rapid speed, or write the motion in short steps of both",
            ));
        }
        let Some(start) = way.start else {
            return Err(refused(
                way,
                "may move with it, and where that axis is as the motion begins is not known from the text: its way cannot be shared out over the pieces into which the motion is divided",
                "state the axis in the motion before, too",
            ));
        };
        let Some(shares) = &shares else {
            return Err(refused(
                way,
                "moves with it, and how much of the way each of its pieces is, is not known",
                "state the share of every piece",
            ));
        };
        let mut before = 0.0;
        for (own, share) in axes.iter_mut().zip(shares) {
            let put = |list: &mut Vec<Option<f64>>, share: f64| {
                list.resize(list.len().max(way.axis + 1), None);
                list[way.axis] = Some(way.at(start, share));
            };
            put(&mut own.end, *share);
            put(&mut own.halfway, f64::midpoint(before, *share));
            before = *share;
        }
        // The last piece ends as the text says.
        if let Some(last) = axes.last_mut() {
            last.end.clear();
        }
    }
    Ok(axes)
}

/// Fraction of the path covered at the end of each piece; `None` if unknown.
fn shares_of(program: &RobotProgram, motion: &Motion, pieces: &[&Piece]) -> Option<Vec<f64>> {
    let stated: Option<Vec<f64>> = pieces.iter().map(|piece| piece.share).collect();
    if let Some(stated) = stated {
        let is_share = |share: &f64| (0.0..=1.0).contains(share);
        return (stated.iter().all(is_share) && stated.is_sorted()).then_some(stated);
    }
    let before = program.motions.get(motion.follows?)?;
    let same = before.tool == motion.tool && before.work_object == motion.work_object;
    let mut last = before.target.pose().filter(|_| same)?.position_mm;
    let mut length = 0.0;
    let lengths: Vec<f64> = (pieces.iter())
        .map(|piece| {
            length += (piece.position_mm - last).norm();
            last = piece.position_mm;
            length
        })
        .collect();
    (length > 0.0 && length.is_finite()).then(|| lengths.iter().map(|at| at / length).collect())
}
