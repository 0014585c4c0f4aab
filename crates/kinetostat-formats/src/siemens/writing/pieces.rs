//! The pieces of a motion: its own block, and further ones behind it.

use nalgebra::Vector3;

use crate::siemens::place::{AxisText, LETTERS, Place, digits_of, without};
use crate::siemens::state::Code;
use crate::siemens::writing::writer::{Reason, Writer};
use crate::writing::piece::Piece;

impl Writer<'_> {
    pub(crate) fn pieces(&mut self, pieces: &[&Piece]) -> Result<(), Reason> {
        let [first, further @ ..] = pieces else {
            return Ok(());
        };
        self.turns(pieces)?;
        let written = self.written;
        let becomes_straight =
            written.code.is_arc() && (first.via_mm.is_none() || !further.is_empty());
        let code = match becomes_straight {
            true => Code::Line,
            false => written.code,
        };
        if becomes_straight {
            let via = written.via.iter().flatten().map(|word| word.word.clone());
            for word in written.arc_words.iter().cloned().chain(via) {
                let word = without(self.file.bytes(), &word, written.words_at);
                self.edits.replace(word, "");
            }
        }
        self.code(code);
        let anchor = self.anchor();
        let mut added = String::new();
        let off = written.frame.rotation.inverse() * self.held.off;
        let mut place = Place {
            file: self.file,
            written,
            least: digits_of(self.options, written.unit_mm),
            off: off.into(),
        };
        let end = self.in_frame(first.position_mm);
        for (axis, wanted) in end.iter().enumerate() {
            place.axis(axis, *wanted, self.edits, &mut added);
        }
        if let (Some(via), false) = (first.via_mm, becomes_straight) {
            let via = self.in_frame(via);
            for (axis, wanted) in via.iter().enumerate() {
                place.via(axis, *wanted, self.edits, &mut added);
            }
        }
        self.held.off = written.frame.rotation * Vector3::from(place.off);
        self.direction(first, &mut added);
        self.insert(anchor, &added);
        self.feed(first.speed_factor)?;
        if !further.is_empty() {
            let text = self.further(code, further)?;
            self.edits.replace(written.line.end..written.line.end, text);
        }
        Ok(())
    }

    /// The blocks of further pieces, each behind a line ending.
    fn further(&mut self, code: Code, pieces: &[&Piece]) -> Result<Vec<u8>, Reason> {
        let written = self.written;
        let mut text = Vec::new();
        let least = digits_of(self.options, written.unit_mm);
        for (index, piece) in pieces.iter().enumerate() {
            let mut line = code.word().to_owned();
            let end = self.in_frame(piece.position_mm);
            let mut off = [0.0; 3];
            for axis in 0..3 {
                let number = format!("{:.least$}", end[axis] / written.unit_mm);
                let number = AxisText::plain(number);
                let value = number.value * written.unit_mm;
                off[axis] = value - written.end[axis].unwrap_or(value);
                let letter = LETTERS[axis];
                line += &match written.steps {
                    true => format!(" {letter}=AC({})", number.text),
                    false => format!(" {letter}{}", number.text),
                };
            }
            self.held.off = written.frame.rotation * Vector3::from(off);
            self.direction_of(piece, &mut line);
            if let Some(feed) = self.feed_text(piece.speed_factor)? {
                line += &format!(" {feed}");
            }
            if index + 1 == pieces.len() {
                for word in &written.at_end {
                    line += &format!(" {}", String::from_utf8_lossy(self.file.part(word)));
                    let word = without(self.file.bytes(), word, written.words_at);
                    self.edits.replace(word, "");
                }
            }
            text.extend_from_slice(self.file.line_ending());
            text.extend_from_slice(line.as_bytes());
        }
        Ok(text)
    }
}
