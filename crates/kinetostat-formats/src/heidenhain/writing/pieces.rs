//! The pieces of a motion: blocks before it, and the one that it becomes.

use nalgebra::Vector3;

use crate::heidenhain::reading::found::Way;
use crate::heidenhain::words::words_of;
use crate::heidenhain::writing::words::{Part, When, functions_of};
use crate::heidenhain::writing::writer::{ABOUT_CENTRE, Reason, SAME_MM, Writer};
use crate::model::motion::Motion;
use crate::model::target::PoseTarget;
use crate::writing::motions::FARTHEST_MM;
use crate::writing::piece::Piece;

impl Writer<'_> {
    pub(crate) fn pieces(
        &mut self,
        motion: &Motion,
        way: &Way,
        last: &Piece,
        before: &[&Piece],
    ) -> Result<(), Reason> {
        let end = motion.target.pose().ok_or((
            "the motion has no place that could be corrected".to_owned(),
            "leave its pieces out",
        ))?;
        for piece in before.iter().copied().chain([last]) {
            can_be_written(piece, end, way)?;
        }
        let file = &self.program.files[motion.file];
        let words = words_of(file.bytes(), &motion.span);
        let kinds = functions_of(&words);
        if !before.is_empty()
            && let Some((_, number)) = kinds.iter().find(|(kind, _)| *kind == When::Unknown)
        {
            return Err((
                format!(
                    "M{number} stands beside a motion that is divided, and when it acts is not known"
                ),
                "write it in a block of its own",
            ));
        }
        let off = way.datum.step(&self.off);
        let mut place = [0, 1, 2].map(|axis| way.start[axis].map(|at| at + off[axis]));
        let mut inserted = Vec::new();
        for (index, piece) in before.iter().enumerate() {
            let part = match index {
                0 => Part::First,
                _ => Part::Middle,
            };
            let edits = self.block(motion, way, &words, (piece, part), &mut place);
            let text = edits.applied_to_part(file.bytes(), &motion.span);
            let text = text.ok_or_else(|| {
                (
                    "its words overlap".to_owned(),
                    "write the block as the control shows it",
                )
            })?;
            // What stands before the block, number and blanks, stands before its pieces.
            inserted.extend_from_slice(file.part(&(way.block.lines.start..motion.span.start)));
            inserted.extend(text);
            inserted.extend_from_slice(file.line_ending());
        }
        let part = match before.is_empty() {
            true => Part::Only,
            false => Part::Last,
        };
        let edits = self.block(motion, way, &words, (last, part), &mut place);
        let [x, y, z] =
            [0, 1, 2].map(|axis| place[axis].zip(way.end[axis]).map_or(0.0, |(a, b)| a - b));
        let off = way.datum.preset(&Vector3::new(x, y, z)) - way.datum.shift_mm;
        self.off = match off.amax() <= SAME_MM {
            true => Vector3::zeros(),
            false => off,
        };
        let own = &mut self.edits[motion.file];
        if !inserted.is_empty() {
            let at = way.block.lines.start;
            own.replace(at..at, inserted);
            self.added[motion.file] = true;
        }
        own.append(edits);
        Ok(())
    }
}

/// Whether the writer can say a piece.
fn can_be_written(piece: &Piece, end: &PoseTarget, way: &Way) -> Result<(), Reason> {
    let near = piece
        .position_mm
        .iter()
        .all(|value| value.abs() < FARTHEST_MM);
    if !(near && piece.speed_factor.is_finite() && piece.speed_factor > 0.0) {
        return Err((
            "a piece has no finite place or speed, or one farther than 1 km".to_owned(),
            "mend the correction",
        ));
    }
    let z = Vector3::z();
    let turned = piece
        .orientation
        .map(|to| (to * z).angle(&(end.orientation * z)));
    if turned.is_some_and(|angle| angle.is_nan() || angle > 1e-9) {
        return Err((
            "the tool's axis is not corrected in these programs".to_owned(),
            "correct places alone",
        ));
    }
    if piece.via_mm.is_some() {
        return Err((ABOUT_CENTRE.to_owned(), "give it straight pieces"));
    }
    if piece.speed_factor != 1.0 && way.feed.is_none() {
        return Err((
            "its speed cannot be changed: it is not known from the text".to_owned(),
            "state F as a number, or keep it",
        ));
    }
    Ok(())
}
