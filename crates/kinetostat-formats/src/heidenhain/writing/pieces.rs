//! The pieces of a motion: blocks before it, and the one that it becomes.

use nalgebra::Vector3;

use crate::heidenhain::reading::found::Way;
use crate::heidenhain::words::{Word, words_of};
use crate::heidenhain::writing::arc::Block;
use crate::heidenhain::writing::words::{Part, PlacedPiece, When, functions_of};
use crate::heidenhain::writing::writer::{ABOUT_CENTRE, Reason, SAME_MM, Writer};
use crate::model::motion::Motion;
use crate::writing::piece::{ABSURD, Piece, is_finite};

impl Writer<'_> {
    pub(crate) fn pieces(
        &mut self,
        motion: &Motion,
        way: &Way,
        last: &Piece,
        before: &[&Piece],
    ) -> Result<(), Reason> {
        if motion.target.pose().is_none() {
            return Err((
                "the motion has no place that could be corrected".to_owned(),
                "write its place as numbers",
            ));
        }
        for piece in before.iter().copied().chain([last]) {
            can_be_written(piece, way)?;
            Self::can_stand(motion, piece, way)?;
            if piece.centre_mm.is_some() && !self.stands_already(motion, piece) {
                return Err((
                    "the direction of the tool is corrected up to here, and an arc does not state it"
                        .to_owned(),
                    "correct places alone (leave out --correct pose), or write the arc as lines",
                ));
            }
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
        self.begin_angles(way);
        let off = way.datum.step(&self.off);
        let mut place = [0, 1, 2].map(|axis| way.start[axis].map(|at| at + off[axis]));
        let mut inserted = Vec::new();
        for (index, piece) in before.iter().enumerate() {
            let part = match index {
                0 => Part::First,
                _ => Part::Middle,
            };
            let share = (index + 1) as f64 / (before.len() + 1) as f64;
            let placed = PlacedPiece { piece, part, share };
            let Block { before, edits } = self.as_block(motion, way, &words, placed, &mut place)?;
            inserted.extend(self.line_before(motion, way, before));
            let text = edits.applied_to_part(file.bytes(), &motion.span);
            let text = text.ok_or_else(|| {
                (
                    "its words overlap".to_owned(),
                    "write the block as the control shows it",
                )
            })?;
            // Number and blanks before the block are repeated before its pieces.
            inserted.extend_from_slice(file.part(&(way.block.lines.start..motion.span.start)));
            inserted.extend(text);
            inserted.extend_from_slice(file.line_ending());
        }
        let part = match before.is_empty() {
            true => Part::Only,
            false => Part::Last,
        };
        let placed = PlacedPiece {
            piece: last,
            part,
            share: 1.0,
        };
        let Block { before, edits } = self.as_block(motion, way, &words, placed, &mut place)?;
        inserted.extend(self.line_before(motion, way, before));
        self.end_angles(way);
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

impl Writer<'_> {
    /// A piece as a block: an arc, or straight.
    fn as_block(
        &mut self,
        motion: &Motion,
        way: &Way,
        words: &[Word],
        placed: PlacedPiece<'_>,
        place: &mut [Option<f64>; 3],
    ) -> Result<Block, Reason> {
        if placed.piece.centre_mm.is_none() {
            return Ok(Block {
                before: None,
                edits: self.block(motion, way, words, placed, place),
            });
        }
        let arc = self.arc_block(motion, way, words, placed, place);
        arc.ok_or_else(|| {
            (
                "its corrected arc has no centre in the range and the digits of the control"
                    .to_owned(),
                "let arcs be written as lines (--arcs lines)",
            )
        })
    }

    /// A line before a block, with what stands before that: number and blanks.
    fn line_before(&self, motion: &Motion, way: &Way, text: Option<String>) -> Vec<u8> {
        let Some(text) = text else {
            return Vec::new();
        };
        let file = &self.program.files[motion.file];
        let head = file.part(&(way.block.lines.start..motion.span.start));
        [head, text.as_bytes(), file.line_ending()].concat()
    }
}

/// Checks that the writer can express a piece.
fn can_be_written(piece: &Piece, way: &Way) -> Result<(), Reason> {
    if !is_finite(piece) {
        return Err((ABSURD.0.to_owned(), ABSURD.1));
    }
    let centred = piece
        .centre_mm
        .is_none_or(|centre| centre.iter().all(|value| value.abs() < FARTHEST_CENTRE_MM));
    if !centred || piece.centre_mm.is_some() && way.turns == 0.0 {
        return Err((
            "a piece goes about a centre, and its motion is no arc, or the centre is no place"
                .to_owned(),
            "make it straight",
        ));
    }
    if piece.via_mm.is_some() {
        return Err((
            ABOUT_CENTRE.to_owned(),
            "give it a centre, or make it straight",
        ));
    }
    if piece.speed_factor != 1.0 && way.feed.is_none() {
        return Err((
            "its speed cannot be changed: it is not known from the text".to_owned(),
            "state F as a number, or keep it",
        ));
    }
    Ok(())
}

/// Farther than any centre of an arc that is written, mm.
const FARTHEST_CENTRE_MM: f64 = 1e7;
