//! The angles of rotary axes at the end of a written block.
//!
//! The pieces of a block share its turns out. What is rounded in one piece is made up for in the next.

use crate::axis_count::{EndWord, turns_below};
use crate::heidenhain::path_words::RotaryWord;
use crate::heidenhain::reading::found::Way;
use crate::heidenhain::words::Word;
use crate::heidenhain::writing::words::{Stated, number_text, parsed, stands};
use crate::heidenhain::writing::writer::Writer;
use crate::model::motion::Motion;
use crate::model::stated_axes::AxesStated;
use crate::text::edits::Edits;
use crate::writing::piece::Piece;

/// Limit of the decimals of an angle on the control.
const MOST_DECIMALS: usize = 4;

/// Angles nearer than this are one, deg.
const SAME_DEG: f64 = 1e-9;

fn angles_of(way: &Way) -> Option<[&[f64]; 2]> {
    match &way.axes {
        Some(AxesStated::Angles { start, end }) => Some([start, end]),
        _ => None,
    }
}

impl Writer<'_> {
    fn angle_decimals(&self) -> usize {
        self.options.angle_decimals.min(MOST_DECIMALS)
    }

    /// Half of the last digit of an angle, deg.
    fn half_deg(&self) -> f64 {
        0.5 * 0.1_f64.powi(self.angle_decimals() as i32) * (1.0 + 1e-6)
    }

    /// True if the rotary axes are at the program's angles within the written digits.
    pub(crate) fn angles_stand(&self) -> bool {
        let half = self.half_deg();
        self.turned_deg.iter().all(|turned| turned.abs() <= half)
    }

    /// A motion begins: where its axes stand then, deg.
    pub(crate) fn begin_angles(&mut self, way: &Way) {
        let Some([start, _]) = angles_of(way) else {
            self.angles_now.clear();
            return;
        };
        self.turned_deg.resize(start.len(), 0.0);
        let both = start.iter().zip(&self.turned_deg);
        self.angles_now = both.map(|(start, turned)| start + turned).collect();
    }

    /// Ends a motion: stores the deviation of the rotary axes from the program, deg.
    pub(crate) fn end_angles(&mut self, way: &Way) {
        let Some([_, end]) = angles_of(way) else {
            return;
        };
        let both = self.angles_now.iter().zip(end);
        let turned = both.map(|(now, end)| now - end);
        // A residue of rounding is zero.
        let clean = |turned: f64| match turned.abs() < SAME_DEG {
            true => 0.0,
            false => turned,
        };
        self.turned_deg = turned.map(clean).collect();
    }

    /// Writes the angles of a piece in the words of a block; the words that are needed where it has none.
    pub(crate) fn write_angles(
        &mut self,
        motion: &Motion,
        way: &Way,
        words: &[Word],
        piece: &Piece,
        edits: &mut Edits,
    ) -> String {
        let mut added = String::new();
        let Some([_, end]) = angles_of(way) else {
            return added;
        };
        let stated = piece.rotary_deg.as_deref();
        let wanted = stated.filter(|all| all.len() == end.len()).unwrap_or(end);
        let file = &self.program.files[motion.file];
        let own = Stated::of(words).rotary;
        let digits = self.angle_decimals();
        for axis in 0..end.len() {
            let letter = self.program.rotary.letters[axis];
            let (to, now) = (wanted[axis], self.angles_now[axis]);
            let word = own.iter().find(|word| char::from(word.letter) == letter);
            let number = word.and_then(|word| words[word.at].number().map(|n| (word, n)));
            // The shorter way goes to angles of one turn.
            let reference = match (number, way.shorter) {
                (Some((RotaryWord { step: true, .. }, _)), _) => now,
                (_, true) => turns_below(to),
                (_, false) => 0.0,
            };
            let shown = self.shown.get(axis).copied().unwrap_or_default();
            let is_step = matches!(number, Some((RotaryWord { step: true, .. }, _)));
            let by_step = !is_step
                && !way.shorter
                && shown.way_of_counting().word_of_end(now, to, digits) != EndWord::Angle;
            let signs = self.signs[motion.file];
            if by_step && (number.is_some() || (to - now).abs() > self.half_deg()) {
                let text = stands(&format!("I{letter}"), to - now, digits, signs);
                self.angles_now[axis] = now + parsed(&text.as_bytes()[2..]).unwrap_or(to - now);
                match number {
                    Some((word, _)) => edits.replace(words[word.at].span.clone(), text),
                    None => added += &format!(" {text}"),
                }
                continue;
            }
            let value = to - reference;
            let Some((word, number)) = number else {
                if (to - now).abs() > self.half_deg() {
                    let text = stands(&letter.to_string(), value, digits, signs);
                    let value = parsed(&text.as_bytes()[1..]).unwrap_or(value);
                    self.angles_now[axis] = reference + value;
                    added += &format!(" {text}");
                }
                continue;
            };
            let off = match way.shorter && !word.step {
                // Whole turns are none there.
                true => (value - number.value + 180.0).rem_euclid(360.0) - 180.0,
                false => value - number.value,
            };
            if off.abs() < SAME_DEG {
                self.angles_now[axis] = to - off;
                continue;
            }
            let text = number_text(file, number, value, digits);
            self.angles_now[axis] = reference + parsed(&text).unwrap_or(value);
            if text != file.part(&number.span) {
                edits.replace(number.span.clone(), text);
            }
        }
        added
    }

    /// In a block that stays as it is written, axes with absolute words come to where the program has them.
    pub(crate) fn angles_left(&mut self, words: &[Word]) {
        for word in Stated::of(words).rotary.iter().filter(|word| !word.step) {
            let mut letters = self.program.rotary.letters.iter();
            let place = letters.position(|letter| *letter == char::from(word.letter));
            if let Some(turned) = place.and_then(|place| self.turned_deg.get_mut(place)) {
                *turned = 0.0;
            }
        }
    }
}
