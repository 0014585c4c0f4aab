//! The pieces of a motion: its own block, and further ones behind it.

use nalgebra::Vector3;

use crate::siemens::place::{AxisText, LETTERS, Place, VIA, digits_of, without};
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
        let code = self.code_of(first);
        if written.code.is_arc() {
            // The point of a CIP becomes another one, or goes.
            let via = written.via.iter().flatten().map(|word| word.word.clone());
            let via = via.filter(|_| code == Code::Line);
            let centre = written.arc_words.iter().cloned();
            for word in centre.filter(|_| code != written.code).chain(via) {
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
            stated: self.held.stated,
        };
        let end = self.in_frame(first.position_mm);
        for (axis, wanted) in end.iter().enumerate() {
            place.axis(axis, *wanted, self.edits, &mut added);
        }
        if let (Some(via), Code::Through) = (first.via_mm, code) {
            let via = self.in_frame(via);
            for (axis, wanted) in via.iter().enumerate() {
                place.via(axis, *wanted, self.edits, &mut added);
            }
        }
        self.held.off = written.frame.rotation * Vector3::from(place.off);
        self.held.stated = place.stated;
        self.direction(first, &mut added);
        self.angles_of_own(first, &mut added);
        self.insert(anchor, &added);
        self.feed(first.speed_factor)?;
        if !further.is_empty() {
            let text = self.further(further)?;
            self.edits.replace(written.line.end..written.line.end, text);
        }
        Ok(())
    }

    /// The code of a piece: that of an arc with a place between its ends is CIP, whose circle may lean.
    fn code_of(&self, piece: &Piece) -> Code {
        match (self.written.code, piece.via_mm) {
            (code, None) if code.is_arc() => Code::Line,
            (code, Some(_)) if code.is_arc() => Code::Through,
            (code, _) => code,
        }
    }

    /// The blocks of further pieces, each behind a line ending.
    fn further(&mut self, pieces: &[&Piece]) -> Result<Vec<u8>, Reason> {
        let written = self.written;
        let mut text = Vec::new();
        let least = digits_of(self.options, written.unit_mm);
        for (index, piece) in pieces.iter().enumerate() {
            let code = self.code_of(piece);
            self.held.code = (code != written.code).then_some(code);
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
            if let (Some(via), Code::Through) = (piece.via_mm, code) {
                let via = self.in_frame(via);
                for (name, value) in VIA.iter().zip(via.iter()) {
                    let number = AxisText::plain(format!("{:.least$}", value / written.unit_mm));
                    line += &match written.steps {
                        true => format!(" {name}=AC({})", number.text),
                        false => format!(" {name}={}", number.text),
                    };
                }
            }
            self.held.off = written.frame.rotation * Vector3::from(off);
            self.held.stated = [true; 3];
            self.direction_of(piece, &mut line);
            self.angles_of_further(piece, &mut line);
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
