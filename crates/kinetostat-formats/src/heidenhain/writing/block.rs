//! A block that becomes a piece of its motion.

use crate::heidenhain::ends::Shape;
use crate::heidenhain::reading::found::Way;
use crate::heidenhain::words::Word;
use crate::heidenhain::writing::direction::share_of;
use crate::heidenhain::writing::words::{
    Part, PlacedPiece, Stated, number_text, parsed, with_blanks, word_text, write_functions,
};
use crate::heidenhain::writing::writer::{SAME_MM, Writer};
use crate::model::motion::Motion;
use crate::text::edits::Edits;

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
