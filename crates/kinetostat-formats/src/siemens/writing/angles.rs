//! The angles of rotary axes as the text states them.
//!
//! The pieces of a block share its turns out: each states its angle in the way of the block's own word, and one without a word
//! states it where it is another one than stands. What is rounded in one piece is made up for in the next.

use crate::siemens::block::How;
use crate::siemens::state::Coordinate;
use crate::siemens::writing::writer::Writer;
use crate::text::number::{Width, printed};
use crate::turned_axis::{AxisCount, EndWord, turns_below};
use crate::writing::piece::Piece;

/// Half of the last digit of an angle, deg.
fn half_deg(decimals: usize) -> f64 {
    0.5 * 0.1_f64.powi(i32::try_from(decimals).unwrap_or(9)) * (1.0 + 1e-6)
}

/// Angles nearer than this are one, deg.
const SAME_DEG: f64 = 1e-9;

/// A turn that is nearer than this to none, to half a turn of DC, or to a whole one of ACP and ACN goes another way round where its ends
/// are rounded, deg: by the writer, or by a control that counts in thousandths of a degree.
const NEAR_DEG: f64 = 0.01;

/// The number of a word, and the angle that it says.
struct AngleText {
    text: String,
    reached_deg: f64,
}

/// Form of the end of a turn in a given sense (ACP, ACN), chosen so that rounding makes neither a full turn of it, nor nothing of a full turn.
fn end_of_way_round(turn: f64) -> EndWord {
    match turn {
        // Both are right: the shorter way, and the step.
        small if small < NEAR_DEG => EndWord::Shorter,
        whole if whole > 360.0 - NEAR_DEG => EndWord::Step,
        _ => EndWord::Angle,
    }
}

impl Writer<'_> {
    fn word_of(&self, axis: usize) -> Option<(&Coordinate, How)> {
        let mut words = self.written.rotary.iter();
        words.find_map(|(place, word, how)| (*place == axis).then_some((word, *how)))
    }

    /// Whole turns that an axis does not show at an angle, deg.
    fn wound_at(&self, axis: usize, to: f64) -> f64 {
        let shown = self.shown.get(axis).copied().unwrap_or_default();
        match shown.way_of_counting() {
            AxisCount::OneTurn => turns_below(to),
            AxisCount::On | AxisCount::Open => 0.0,
        }
    }

    /// Turn of an axis by an absolute word, from its position to an angle.
    fn end_word(&self, axis: usize, from: f64, to: f64) -> EndWord {
        let shown = self.shown.get(axis).copied().unwrap_or_default();
        let (count, digits) = (shown.way_of_counting(), self.options.angle_decimals);
        let end_word = count.word_of_end(from, to, digits);
        // An angle that is rounded to 360, or is all but 0 from below, is none of such an axis.
        let value = to - self.wound_at(axis, to);
        let is_none = value < -SAME_DEG || value > 360.0 - half_deg(digits);
        match (end_word, count) {
            (EndWord::Angle, AxisCount::OneTurn) if is_none && (to - from).abs() < 179.0 => {
                EndWord::Shorter
            }
            (EndWord::Angle, AxisCount::OneTurn) if is_none => EndWord::Step,
            _ => end_word,
        }
    }

    /// The word of an axis that turns it from where it stands to an angle, and that angle, where the block's own word would say
    /// something else: across 0 and 360 deg, or where ACP and ACN would go round.
    fn word_instead(
        &self,
        axis: usize,
        word: &Coordinate,
        how: How,
        from: f64,
        to: f64,
    ) -> Option<(String, f64)> {
        if word.step {
            return None;
        }
        let end_word = match how {
            How::Rotary => {
                let before = self.file.part(&(word.whole.start..word.number.start));
                let shape = before.to_ascii_uppercase();
                let turn = self.angle_text(axis, word, how, from, to).reached_deg - from;
                match (shape.starts_with(b"ACP"), shape.starts_with(b"ACN")) {
                    (true, _) => end_of_way_round(turn),
                    (_, true) => end_of_way_round(-turn),
                    _ if turn.abs() > 180.0 - NEAR_DEG => EndWord::Step,
                    _ => EndWord::Angle,
                }
            }
            _ => self.end_word(axis, from, to),
        };
        match end_word {
            EndWord::Angle => None,
            other => self.written_end(axis, other, from, to),
        }
    }

    /// A word that ends at an angle by the shorter way or by a step, and the angle that it reaches.
    fn written_end(
        &self,
        axis: usize,
        end_word: EndWord,
        from: f64,
        to: f64,
    ) -> Option<(String, f64)> {
        let (letter, digits) = (self.letters.get(axis)?, self.options.angle_decimals);
        if let EndWord::Step = end_word {
            let text = format!("{:.digits$}", to - from);
            let by: f64 = text.parse().unwrap_or(to - from);
            return Some((format!("{letter}=IC({text})"), from + by));
        }
        let one_turn = match to - turns_below(to) {
            // Rounding residue of the arithmetic.
            least if least < 0.0 => 0.0,
            one_turn => one_turn,
        };
        let text = format!("{one_turn:.digits$}");
        let value: f64 = text.parse().unwrap_or(one_turn);
        // Modulo axis: 360 is 0.
        let text = match value >= 360.0 {
            true => "0".to_owned(),
            false => text,
        };
        Some((format!("{letter}=DC({text})"), to - one_turn + value))
    }

    /// The number with which a word turns an axis from where it stands to an angle.
    fn angle_text(
        &self,
        axis: usize,
        word: &Coordinate,
        how: How,
        from: f64,
        to: f64,
    ) -> AngleText {
        let digits = self.options.angle_decimals;
        let wound = self.wound_at(axis, to);
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
            // Modulo axis: 360 is 0.
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
        let end_word = self.end_word(axis, from, to);
        if end_word != EndWord::Angle {
            let (word, reached) = self.written_end(axis, end_word, from, to)?;
            return Some((format!(" {word}"), reached));
        }
        let (letter, wound) = (self.letters.get(axis)?, self.wound_at(axis, to));
        let text = format!("{:.digits$}", to - wound);
        let reached = text.parse::<f64>().unwrap_or(to) + wound;
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
                    let instead = self.word_instead(axis, word, how, from, wanted[axis]);
                    if let Some((text, reached)) = instead {
                        self.edits.replace(word.word.clone(), text);
                        self.hold(axis, reached - end[axis]);
                        continue;
                    }
                    let span = word.number.clone();
                    let made = self.angle_text(axis, word, how, from, wanted[axis]);
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
                    let instead = self.word_instead(axis, word, how, from, wanted[axis]);
                    if let Some((text, reached)) = instead {
                        line.push_str(&format!(" {text}"));
                        self.hold(axis, reached - end[axis]);
                        continue;
                    }
                    let made = self.angle_text(axis, word, how, from, wanted[axis]);
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

    /// Stores the correction of an axis; a residue of rounding is stored as zero.
    fn hold(&mut self, axis: usize, turned: f64) {
        self.held.turned_deg[axis] = match turned.abs() < SAME_DEG {
            true => 0.0,
            false => turned,
        };
    }

    /// True if the axes are at the program's angles within the written digits.
    pub(crate) fn angles_stand(&self) -> bool {
        let half = half_deg(self.options.angle_decimals);
        self.held
            .turned_deg
            .iter()
            .all(|turned| turned.abs() <= half)
    }

    /// In a motion that stays as it is written, axes with absolute words come to where the program has them. What is rounded at its
    /// start must not change which way round they go.
    pub(crate) fn angles_left(&mut self) {
        for (axis, word, how) in &self.written.rotary {
            let off = self.held.turned_deg.get(*axis).copied().unwrap_or_default();
            let (Some([start, end]), true) = (self.angles, off != 0.0 && *how == How::Rotary)
            else {
                continue;
            };
            let (from, to) = (start[*axis] + off, end[*axis]);
            if let Some((text, _)) = self.word_instead(*axis, word, *how, from, to) {
                self.edits.replace(word.word.clone(), text);
            }
        }
        for (axis, word, _) in &self.written.rotary {
            if let Some(turned) = self.held.turned_deg.get_mut(*axis).filter(|_| !word.step) {
                *turned = 0.0;
            }
        }
    }
}
