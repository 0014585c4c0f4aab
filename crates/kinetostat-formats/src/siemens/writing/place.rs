use std::ops::Range;

use nalgebra::Vector3;

use crate::model::orientation::OrientationText;
use crate::model::site::TargetSite;
use crate::options::WriteOptions;
use crate::siemens::state::Coordinate;
use crate::siemens::walker::Written;
use crate::siemens::writing::writer::{Reason, SAME, Writer};
use crate::text::number::{Width, printed, short};
use crate::text::source::{Edits, SourceFile};
use crate::writing::piece::Piece;

/// Names of the axes.
pub(crate) const LETTERS: [char; 3] = ['X', 'Y', 'Z'];

/// Names of the point on a CIP.
pub(crate) const VIA: [&str; 3] = ["I1", "J1", "K1"];

/// Minimum decimals of positions in a unit of so many mm: as fine in inches as in mm.
pub(crate) fn digits_of(options: &WriteOptions, unit_mm: f64) -> usize {
    match unit_mm == 1.0 {
        true => options.position_decimals,
        false => options.position_decimals + 2,
    }
}

/// A number of a flat program, with up to nine decimals: far below a nanometre, in inches and behind many steps, too.
pub(crate) fn number_text(value: f64) -> String {
    short(value, 9)
}

/// A number as it is written, and what it says.
pub(crate) struct AxisText {
    pub text: String,
    pub value: f64,
}

impl AxisText {
    /// Axis text of a printed number; a zero has no sign.
    pub(crate) fn plain(text: String) -> Self {
        let value: f64 = text.parse().unwrap_or_default();
        let text = match value == 0.0 {
            true => text.trim_start_matches('-').to_owned(),
            false => text,
        };
        Self { text, value }
    }
}

/// A word with a blank before it, so that both are taken out.
pub(crate) fn without(bytes: &[u8], word: &Range<usize>, words_at: usize) -> Range<usize> {
    let blank = word.start > words_at
        && word.start.checked_sub(1).and_then(|at| bytes.get(at)) == Some(&b' ');
    word.start - usize::from(blank)..word.end
}

/// The place that a block ends at.
pub(crate) struct Place<'p> {
    pub file: &'p SourceFile,
    pub written: &'p Written,
    pub least: usize,
    /// Tool offset from the input at the start, and then at the end; in the frame's axes, mm.
    pub off: [f64; 3],
    /// Axes that were stated since their last word in the program.
    pub stated: [bool; 3],
}

impl Place<'_> {
    /// Writes the end along an axis: in its word, or in a further one where it is not reached without.
    pub(crate) fn axis(
        &mut self,
        axis: usize,
        wanted_mm: f64,
        edits: &mut Edits,
        added: &mut String,
    ) {
        let unit = self.written.unit_mm;
        let old = self.written.end[axis].unwrap_or(wanted_mm);
        let (least, letter) = (self.least, LETTERS[axis]);
        let half_mm = 0.5 * 0.1_f64.powi(least as i32) * unit;
        let Some(word) = &self.written.axes[axis] else {
            let is = old + self.off[axis];
            // An undisplaced position keeps the program's value to the last bit.
            if (wanted_mm - is).abs() > half_mm {
                let number = AxisText::plain(format!("{:.least$}", wanted_mm / unit));
                added.push_str(&match self.written.steps {
                    true => format!(" {letter}=AC({})", number.text),
                    false => format!(" {letter}{}", number.text),
                });
                self.off[axis] = number.value * unit - old;
                self.stated[axis] = true;
            }
            return;
        };
        let is_elsewhere = self.written.counts_behind_frame(axis, self.stated[axis]);
        self.stated[axis] = false;
        let off = match is_elsewhere {
            true => f64::INFINITY,
            false => self.off[axis],
        };
        let value = self.put(word, old, wanted_mm, off, edits);
        self.off[axis] = value - old;
    }

    /// Writes the point on a CIP along an axis.
    pub(crate) fn via(
        &mut self,
        axis: usize,
        wanted_mm: f64,
        edits: &mut Edits,
        added: &mut String,
    ) {
        let unit = self.written.unit_mm;
        let (least, name) = (self.least, VIA[axis]);
        match &self.written.via[axis] {
            Some(word) => {
                let start = self.written.start[axis].unwrap_or_default();
                let old = match word.step {
                    true => start + word.mm,
                    false => word.mm,
                };
                // A step from a start that may be displaced is written as a place.
                let off = match word.step {
                    true => f64::INFINITY,
                    false => 0.0,
                };
                self.put(word, old, wanted_mm, off, edits);
            }
            None => {
                let number = AxisText::plain(format!("{:.least$}", wanted_mm / unit));
                added.push_str(&format!(" {name}=AC({})", number.text));
            }
        }
    }

    /// Puts a place in a word; where the tool is then along it, mm.
    fn put(
        &self,
        word: &Coordinate,
        old_mm: f64,
        wanted_mm: f64,
        off_mm: f64,
        edits: &mut Edits,
    ) -> f64 {
        let (file, unit, least) = (self.file, self.written.unit_mm, self.least);
        let (old, wanted) = (old_mm / unit, wanted_mm / unit);
        if word.literal && !word.step {
            let original = file.part(&word.number);
            let text = printed(original, word.written, wanted, least, Width::Free);
            if text == original {
                return old_mm;
            }
            let value: Option<f64> = std::str::from_utf8(&text)
                .ok()
                .and_then(|t| t.trim().parse().ok());
            edits.replace(word.number.clone(), text);
            return value.map_or(wanted_mm, |value| value * unit);
        }
        let number = AxisText::plain(format!("{wanted:.least$}"));
        let same = AxisText::plain(format!("{old:.least$}")).value == number.value;
        if same && (!word.step || off_mm == 0.0) {
            return old_mm;
        }
        let name = file.part(&(word.word.start..word.whole.start));
        let name = String::from_utf8_lossy(name);
        let name = name.trim_end().trim_end_matches('=').trim_end();
        let text = match word.step || word.wrapped {
            true => format!("{name}=AC({})", number.text),
            false => format!("{name}={}", number.text),
        };
        edits.replace(word.word.clone(), text);
        number.value * unit
    }
}

/// Directions as written are the same below this, rad: their last digit.
const SAME_WRITTEN: f64 = 2e-7;

impl Writer<'_> {
    /// The direction that the text states, in the part's axes.
    fn stated_direction(&self) -> Option<Vector3<f64>> {
        let by_axis = matches!(&self.motion.site.target, TargetSite::Literal(text) if text.convention == OrientationText::Axis);
        let pose = self.motion.target.pose().filter(|_| by_axis)?;
        Some(pose.orientation * Vector3::z())
    }

    pub(crate) fn turns(&self, pieces: &[&Piece]) -> Result<(), Reason> {
        let pose = self.motion.target.pose();
        let axis = pose.map(|pose| pose.orientation * Vector3::z());
        let turns = |piece: &&Piece| {
            let wanted = piece.orientation.map(|turn| turn * Vector3::z());
            wanted
                .zip(axis)
                .is_some_and(|(to, from)| to.angle(&from) > SAME)
        };
        match self.stated_direction().is_none() && pieces.iter().any(turns) {
            true => Err((
                "the end states no direction of the tool that could be corrected",
                "let the CAM system write directions (A3, B3, C3), or correct its place alone",
            )),
            false => Ok(()),
        }
    }

    /// Words of the direction of the first piece.
    pub(crate) fn direction(&mut self, piece: &Piece, added: &mut String) {
        let Some(own) = self.stated_direction() else {
            return;
        };
        let words = &self.written.direction_words;
        if !words.is_empty() {
            self.held.direction = None;
            let wanted = piece.orientation.map(|turn| turn * Vector3::z());
            if wanted.is_none_or(|wanted| wanted.angle(&own) <= SAME) {
                return;
            }
            for word in words {
                let word = without(self.file.bytes(), word, self.written.words_at);
                self.edits.replace(word, "");
            }
        }
        self.direction_of(piece, added);
    }

    /// Words of a direction that is not in force; it is then.
    pub(crate) fn direction_of(&mut self, piece: &Piece, added: &mut String) {
        let Some(own) = self.stated_direction() else {
            return;
        };
        let wanted = piece.orientation.map_or(own, |turn| turn * Vector3::z());
        let in_force = self.held.direction.unwrap_or(own);
        if wanted.angle(&in_force) <= SAME_WRITTEN {
            return;
        }
        let digits = self.options.quaternion_decimals;
        let inner = self.written.frame.rotation.inverse() * wanted;
        for (letter, value) in ["A3", "B3", "C3"].iter().zip(inner.iter()) {
            added.push_str(&format!(" {letter}={value:.digits$}"));
        }
        self.held.direction = (wanted.angle(&own) > SAME).then_some(wanted);
    }
}
