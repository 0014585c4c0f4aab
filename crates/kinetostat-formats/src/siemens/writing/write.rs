//! The writer of SINUMERIK programs: the pieces of a motion are its own block, and further ones behind it.
//!
//! The first piece of a motion stands in its own block, further ones in blocks of their own behind it, without numbers: the
//! control needs none, and jumps only to those that are there. What acts at the end of a block (M0, M30, G9) goes to the last
//! one. An arc that is corrected becomes circles through places (CIP), which may lean, or straight. G codes, feeds and places
//! that are modal are stated again where what is
//! written differs from what the next block counts on.

use std::collections::BTreeMap;

use nalgebra::Vector3;

use crate::error::WriteError;
use crate::model::motion::MotionKind;
use crate::model::program::{AxesStated, RobotProgram};
use crate::options::{ReadOptions, WriteOptions};
use crate::siemens::reader::scan;
use crate::siemens::state::Code;
use crate::siemens::writing::place::{AxisText, LETTERS, Place, VIA, digits_of, without};
use crate::siemens::writing::writer::{Held, Reason, SAME, Writer};
use crate::text::source::Edits;
use crate::writing::motions::check_lines;
use crate::writing::piece::{Piece, check_pieces};

/// Limit of the bytes of a block.
const LONGEST_BLOCK: usize = 512;

/// The files of a program with pieces in place of its motions.
pub(crate) fn write_siemens(
    program: &RobotProgram,
    pieces: &[Piece],
    options: &WriteOptions,
) -> Result<Vec<(String, Vec<u8>)>, WriteError> {
    let mut of_motion: BTreeMap<usize, Vec<&Piece>> = BTreeMap::new();
    for piece in pieces {
        if piece.motion >= program.motions.len() {
            return Err(WriteError::NoSuchMotion {
                motion: piece.motion,
                motions: program.motions.len(),
            });
        }
        of_motion.entry(piece.motion).or_default().push(piece);
    }
    let overlap = |file: usize| WriteError::Overlap {
        file: program
            .files
            .get(file)
            .map_or("", |file| file.name())
            .to_owned(),
    };
    let mut edits: Vec<Edits> = program.files.iter().map(|_| Edits::default()).collect();
    if !pieces.is_empty() {
        let reading = ReadOptions {
            rotary_axes: program.rotary.letters.clone(),
            slash_blocks: program.slash_blocks,
            ..ReadOptions::default().as_written()
        };
        let found = scan(&program.files, &reading);
        if found.written.len() != program.motions.len() {
            return Err(overlap(0));
        }
        let mut held = Held::default();
        let mut file = None;
        for (index, (motion, written)) in program.motions.iter().zip(&found.written).enumerate() {
            if file.replace(motion.file) != Some(motion.file) {
                held = Held::default();
            }
            let source = &program.files[motion.file];
            let mut writer = Writer {
                letters: &program.rotary.letters,
                angles: match program.rotary.motions.get(&index) {
                    Some(AxesStated::Angles { start, end }) => Some([start, end]),
                    _ => None,
                },
                shown: &found.shown,
                file: source,
                motion,
                written,
                options,
                edits: &mut edits[motion.file],
                held: &mut held,
            };
            let pieces = of_motion.get(&index).map_or(&[][..], Vec::as_slice);
            writer
                .motion(pieces)
                .map_err(|(reason, remedy)| WriteError::Motion {
                    file: source.name().to_owned(),
                    line: motion.line,
                    reason: reason.to_owned(),
                    remedy: remedy.to_owned(),
                })?;
        }
    }
    let limits = WriteOptions {
        max_line_bytes: Some(
            options
                .max_line_bytes
                .map_or(LONGEST_BLOCK, |most| most.min(LONGEST_BLOCK)),
        ),
        ..options.clone()
    };
    (edits.into_iter().enumerate())
        .map(|(index, edits)| {
            let file = &program.files[index];
            let bytes = edits.applied_to(file.bytes());
            let bytes = bytes.ok_or_else(|| overlap(index))?;
            check_lines(file, &bytes, &limits)?;
            Ok((file.name().to_owned(), bytes))
        })
        .collect()
}

impl Writer<'_> {
    fn motion(&mut self, pieces: &[&Piece]) -> Result<(), Reason> {
        let written = self.written;
        if written.stated.code {
            self.held.code = None;
        }
        if written.stated.feed {
            self.held.feed = None;
        }
        let Some(end) = self.motion.target.pose() else {
            if !pieces.is_empty() {
                return Err((
                    "the motion has no pose that could be corrected",
                    "write its place as numbers",
                ));
            }
            self.left();
            return Ok(());
        };
        check_pieces(pieces)?;
        if !pieces.is_empty() {
            return self.pieces(pieces);
        }
        let is_elsewhere = |axis: usize| written.counts_behind_frame(axis, self.held.stated[axis]);
        let displaced = self.held.off.norm() > SAME || (0..3).any(is_elsewhere);
        let is_arc = matches!(self.motion.kind, MotionKind::Arc { .. });
        // The last digit of the place before: controls take arcs that are off by more.
        let last_digit = 0.1_f64.powi(self.options.position_decimals as i32);
        if displaced && is_arc && self.held.off.norm() <= last_digit {
            self.left();
            return Ok(());
        }
        if displaced && is_arc {
            return Err((
                "the arc begins at a place that changes, and is then none about its written centre",
                "divide it into straight pieces, too, or keep its start",
            ));
        }
        let mut own = Piece::to(0, end.position_mm);
        if let MotionKind::Circular { via } = &self.motion.kind {
            own.via_mm = via.pose().map(|via| via.position_mm);
        }
        let keeps_direction = self.held.direction.is_none();
        let keeps_angles = self.angles_stand();
        match displaced || !keeps_direction || !keeps_angles {
            true => self.pieces(&[&own]),
            false => {
                self.keep_stated();
                self.angles_left();
                self.code(written.code);
                self.feed(1.0)?;
                Ok(())
            }
        }
    }

    /// Steps of axes that a motion has words of count from these.
    fn keep_stated(&mut self) {
        for (stated, word) in self.held.stated.iter_mut().zip(&self.written.axes) {
            *stated &= word.is_none();
        }
    }

    /// A motion that stays as it is written.
    fn left(&mut self) {
        let written = self.written;
        self.keep_stated();
        let mut off = written.frame.rotation.inverse() * self.held.off;
        for axis in 0..3 {
            let reset = written.axes[axis]
                .as_ref()
                .is_some_and(|word| written.machine || !word.step);
            if reset {
                off[axis] = 0.0;
            }
        }
        self.held.off = written.frame.rotation * off;
        if !written.direction_words.is_empty() {
            self.held.direction = None;
        }
        self.angles_left();
        self.code(written.code);
        // A feed that is not known cannot be another one.
        let _ = self.feed(1.0);
    }

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
