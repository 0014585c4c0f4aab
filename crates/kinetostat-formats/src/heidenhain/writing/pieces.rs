//! The pieces of a motion: blocks before it, and the one that it becomes.

use nalgebra::Vector3;

use crate::heidenhain::ends::Shape;
use crate::heidenhain::reading::walker::Way;
use crate::heidenhain::words::{Word, words_of};
use crate::heidenhain::writing::angles::share_of;
use crate::heidenhain::writing::centre::Block;
use crate::heidenhain::writing::words::{
    Part, PlacedPiece, Stated, When, functions_of, number_text, parsed, with_blanks, word_text,
    write_functions,
};
use crate::heidenhain::writing::writer::{ABOUT_CENTRE, Reason, SAME_MM, Writer};
use crate::model::motion::Motion;
use crate::text::source::Edits;
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

impl Writer<'_> {
    /// The changes of a block that make it a piece; from a place in the programmed axes, which is that of the piece's end then.
    pub(crate) fn block(
        &mut self,
        motion: &Motion,
        way: &Way,
        words: &[Word],
        placed: PlacedPiece<'_>,
        place: &mut [Option<f64>; 3],
    ) -> Edits {
        let PlacedPiece { piece, part, share } = placed;
        let file = &self.program.files[motion.file];
        let mut edits = Edits::default();
        let wanted = way.datum.programmed(&piece.position_mm);
        let started = *place;
        let stated = Stated::of(words);
        let straight = way.shape == Shape::Straight;
        let (decimals, half) = (self.decimals(way), self.half_mm(way));
        let mut ends = wanted;
        let mut behind = words[0].span.end;
        let mut new_words = String::new();
        for axis in 0..3 {
            let word = stated.word[axis].map(|at| &words[at]);
            let value = wanted[axis] / way.unit_mm;
            // A step from where the block began ends where it did.
            let begins = started[axis].zip(way.start[axis]);
            let ends_alike = way.end[axis].is_some_and(|end| (end - wanted[axis]).abs() <= half);
            let is_step = straight && word.is_some() && !stated.absolute[axis];
            if let (true, true, Part::Only, Some((now, then))) = (is_step, ends_alike, part, begins)
                && (now - then).abs() <= SAME_MM
            {
                ends[axis] = way.end[axis].unwrap_or(wanted[axis]);
                behind = word.map_or(behind, |word| word.span.end);
                continue;
            }
            match (word, straight && stated.absolute[axis]) {
                (Some(word), true) => {
                    if let Some(number) = word.number() {
                        let text = number_text(file, number, value, decimals);
                        ends[axis] = parsed(&text).unwrap_or(value) * way.unit_mm;
                        if text != file.part(&number.span) {
                            edits.replace(number.span.clone(), text);
                        }
                    }
                    behind = word.span.end;
                }
                (word, _) => {
                    let same = started[axis].is_some_and(|at| (at - wanted[axis]).abs() <= half);
                    // Arcs and polar blocks state X and Y, for the eye.
                    let stays = same && word.is_none() && (straight || axis == way.plane.0);
                    let text = match stays {
                        true => String::new(),
                        false => word_text(axis, value, decimals, self.signs[motion.file]),
                    };
                    match stays {
                        true => ends[axis] = started[axis].unwrap_or(wanted[axis]),
                        false => {
                            let digits = text.get(1..).unwrap_or_default();
                            ends[axis] = parsed(digits.as_bytes()).unwrap_or(value) * way.unit_mm;
                        }
                    }
                    match (word, straight) {
                        (Some(word), true) => {
                            edits.replace(word.span.clone(), text);
                            behind = word.span.end;
                        }
                        (_, true) if !text.is_empty() => {
                            edits.replace(behind..behind, format!(" {text}"));
                        }
                        (_, false) if !text.is_empty() => {
                            new_words.push(' ');
                            new_words.push_str(&text);
                        }
                        _ => {}
                    }
                }
            }
        }
        let angles = self.write_angles(motion, way, words, piece, &mut edits);
        match straight {
            true if !angles.is_empty() => edits.replace(behind..behind, angles),
            _ => new_words.push_str(&angles),
        }
        let stood = self.write_tool_axis(motion, way, words, piece, &mut edits);
        let keyword = match stood.is_some() {
            true => "LN",
            false => "L",
        };
        if let Some(stood) = stood {
            match straight {
                true => edits.replace(behind..behind, stood),
                false => new_words.push_str(&stood),
            }
            if straight && words[0].is("L") {
                edits.replace(words[0].span.clone(), keyword);
            }
        }
        if part != Part::Only && part != Part::Last {
            let share = share_of(way, &wanted, share);
            self.write_normal(motion, way, words, share, &mut edits);
        }
        if !straight {
            edits.replace(words[0].span.clone(), keyword);
            edits.replace(behind..behind, new_words);
            for at in &stated.places {
                edits.replace(with_blanks(words, *at), "");
            }
            if matches!(way.shape, Shape::Polar { .. }) {
                self.polar_broken = true;
            }
        }
        write_functions(words, part, &mut edits);
        self.write_feed(way, words, piece.speed_factor, &mut edits);
        *place = [Some(ends.x), Some(ends.y), Some(ends.z)];
        edits
    }
}
