//! The angles of rotary axes as the text states them.
//!
//! The pieces of a block share its turns out: each states its angle in the way of the block's own word, and one without a word
//! states it where it is another one than stands. What is rounded in one piece is made up for in the next.

use crate::siemens::block::How;
use crate::siemens::state::Coordinate;
use crate::siemens::writing::writer::Writer;
use crate::text::number::{Width, printed};
use crate::writing::piece::Piece;

/// Half of the last digit of an angle, deg.
fn half_deg(decimals: usize) -> f64 {
    0.5 * 0.1_f64.powi(i32::try_from(decimals).unwrap_or(9)) * (1.0 + 1e-6)
}

/// Angles nearer than this are one, deg.
const SAME_DEG: f64 = 1e-9;

/// The number of a word, and the angle that it says.
struct AngleText {
    text: String,
    reached_deg: f64,
}

impl Writer<'_> {
    fn word_of(&self, axis: usize) -> Option<(&Coordinate, How)> {
        let mut words = self.written.rotary.0.iter();
        words.find_map(|(place, word, how)| (*place == axis).then_some((word, *how)))
    }

    fn wound(&self, axis: usize) -> f64 {
        self.written.rotary.1.get(axis).copied().unwrap_or(0.0)
    }

    /// The number with which a word turns an axis from where it stands to an angle.
    fn angle_text(
        &self,
        axis: usize,
        (word, how): (&Coordinate, How),
        from: f64,
        to: f64,
    ) -> AngleText {
        let digits = self.options.angle_decimals;
        let wound = self.wound(axis);
        let (reference, value) = match (word.step, how) {
            (true, _) => (from, to - from),
            (false, How::Rotary) => {
                let one_turn = (to - wound).rem_euclid(360.0);
                (to - one_turn, one_turn)
            }
            (false, _) => (wound, to - wound),
        };
        let own = self.file.part(&word.number);
        let text = match (value - word.written).abs() < SAME_DEG {
            true => own.to_vec(),
            false if word.literal => printed(own, word.written, value, digits, Width::Free),
            false => format!("{value:.digits$}").into_bytes(),
        };
        let text = String::from_utf8_lossy(&text).into_owned();
        let value: f64 = match (value - word.written).abs() < SAME_DEG {
            true => word.written,
            false => text.trim().parse().unwrap_or(value),
        };
        AngleText {
            // Of one turn: 360 is 0.
            text: match how == How::Rotary && value >= 360.0 {
                true => "0".to_owned(),
                false => text,
            },
            reached_deg: reference + value,
        }
    }

    /// The angles at the end of a piece.
    fn wanted_deg(&self, piece: &Piece) -> Option<Vec<f64>> {
        let [_, end] = self.angles?;
        let stated = piece.rotary_deg.as_ref();
        Some(
            stated
                .filter(|all| all.len() == end.len())
                .cloned()
                .unwrap_or_else(|| end.to_vec()),
        )
    }

    /// A word of an axis that the block has none of.
    fn further_word(&self, axis: usize, from: f64, to: f64) -> Option<(String, f64)> {
        let digits = self.options.angle_decimals;
        if (to - from).abs() <= half_deg(digits) {
            return None;
        }
        let letter = self.letters.get(axis)?;
        let text = format!("{:.digits$}", to - self.wound(axis));
        let reached = text.parse::<f64>().unwrap_or(to) + self.wound(axis);
        let word = match self.written.steps {
            true => format!(" {letter}=AC({text})"),
            false => format!(" {letter}{text}"),
        };
        Some((word, reached))
    }

    /// Words of angles in the own block, of which the first piece is made.
    pub(crate) fn angles_of_own(&mut self, piece: &Piece, added: &mut String) {
        let (Some([start, end]), Some(wanted)) = (self.angles, self.wanted_deg(piece)) else {
            return;
        };
        self.held.turned_deg.resize(end.len(), 0.0);
        for axis in 0..end.len() {
            let from = start[axis] + self.held.turned_deg[axis];
            let reached = match self.word_of(axis) {
                Some((word, how)) => {
                    let span = word.number.clone();
                    let made = self.angle_text(axis, (word, how), from, wanted[axis]);
                    if made.text.as_bytes() != self.file.part(&span) {
                        self.edits.replace(span, made.text);
                    }
                    made.reached_deg
                }
                None => match self.further_word(axis, from, wanted[axis]) {
                    Some((word, reached)) => {
                        added.push_str(&word);
                        reached
                    }
                    None => from,
                },
            };
            self.hold(axis, reached - end[axis]);
        }
    }

    /// Words of angles in a further block.
    pub(crate) fn angles_of_further(&mut self, piece: &Piece, line: &mut String) {
        let (Some([_, end]), Some(wanted)) = (self.angles, self.wanted_deg(piece)) else {
            return;
        };
        for axis in 0..end.len() {
            let from = end[axis] + self.held.turned_deg[axis];
            let found = match self.word_of(axis) {
                Some((word, how)) if (wanted[axis] - from).abs() > SAME_DEG => {
                    let made = self.angle_text(axis, (word, how), from, wanted[axis]);
                    let part = |from: usize, to: usize| {
                        String::from_utf8_lossy(self.file.part(&(from..to))).into_owned()
                    };
                    let before = part(word.word.start, word.number.start);
                    let behind = part(word.number.end, word.word.end);
                    Some((format!(" {before}{}{behind}", made.text), made.reached_deg))
                }
                Some(_) => None,
                None => self.further_word(axis, from, wanted[axis]),
            };
            if let Some((word, reached)) = found {
                line.push_str(&word);
                self.hold(axis, reached - end[axis]);
            }
        }
    }

    /// What the arithmetic leaves of the program's own angle is none.
    fn hold(&mut self, axis: usize, turned: f64) {
        self.held.turned_deg[axis] = match turned.abs() < SAME_DEG {
            true => 0.0,
            false => turned,
        };
    }

    /// Whether the axes stand where the program has them, as far as angles are written.
    pub(crate) fn angles_stand(&self) -> bool {
        let half = half_deg(self.options.angle_decimals);
        self.held
            .turned_deg
            .iter()
            .all(|turned| turned.abs() <= half)
    }

    /// In a motion that stays as it is written, axes with absolute words come to where the program has them.
    pub(crate) fn angles_left(&mut self) {
        for (axis, word, _) in &self.written.rotary.0 {
            if let Some(turned) = self.held.turned_deg.get_mut(*axis).filter(|_| !word.step) {
                *turned = 0.0;
            }
        }
    }
}
