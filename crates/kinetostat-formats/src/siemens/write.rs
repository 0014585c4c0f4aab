//! The writer of SINUMERIK programs.
//!
//! The first piece of a motion stands in its own block, further ones in blocks of their own behind it, without numbers: the
//! control needs none, and jumps only to those that are there. What acts at the end of a block (M0, M30, G9) goes to the last
//! one. An arc that is corrected becomes circles through places (CIP), which may lean, or straight. G codes, feeds and places that are modal are stated again where what is
//! written differs from what the next block counts on.

use std::collections::BTreeMap;

use nalgebra::{Point3, Vector3};

use crate::error::WriteError;
use crate::model::motion::{Motion, MotionKind};
use crate::model::orientation::OrientationText;
use crate::model::program::RobotProgram;
use crate::model::site::TargetSite;
use crate::options::{CutterCompensation, ReadOptions, UnknownTargets, WriteOptions};
use crate::siemens::place::{AxisText, LETTERS, Place, VIA, digits_of, without};
use crate::siemens::scan::scan;
use crate::siemens::state::Code;
use crate::siemens::walker::Written;
use crate::text::edits::Edits;
use crate::text::source::SourceFile;
use crate::writing::motions::{check_lines, check_pieces};
use crate::writing::piece::Piece;

/// Most bytes of a block.
pub(crate) const LONGEST_BLOCK: usize = 512;

/// Why a motion cannot be written, and what to do.
type Reason = (&'static str, &'static str);

/// Least change of a place or a direction that counts, mm and rad.
const SAME: f64 = 1e-9;

/// Directions as written are the same below this, rad: their last digit.
const SAME_WRITTEN: f64 = 2e-7;

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
            unknown_targets: UnknownTargets::LeftAsWritten,
            cutter_compensation: CutterCompensation::CentrePath,
            ..ReadOptions::default()
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

/// What the written program holds otherwise than the one that was read, behind the last block.
#[derive(Debug, Clone, Default)]
struct Held {
    /// From where the tool was to where it is, in the part's axes, mm.
    off: Vector3<f64>,
    /// Codes, feeds and directions that are in force instead.
    code: Option<Code>,
    feed: Option<f64>,
    direction: Option<Vector3<f64>>,
}

struct Writer<'w> {
    file: &'w SourceFile,
    motion: &'w Motion,
    written: &'w Written,
    options: &'w WriteOptions,
    edits: &'w mut Edits,
    held: &'w mut Held,
}

impl Writer<'_> {
    fn motion(&mut self, pieces: &[&Piece]) -> Result<(), Reason> {
        let written = self.written;
        if written.code_stated {
            self.held.code = None;
        }
        if written.feed_stated {
            self.held.feed = None;
        }
        let Some(end) = self.motion.target.pose() else {
            if !pieces.is_empty() {
                return Err((
                    "the motion has no pose that could be corrected",
                    "leave its pieces out",
                ));
            }
            self.left();
            return Ok(());
        };
        check_pieces(pieces)?;
        if !pieces.is_empty() {
            return self.pieces(pieces);
        }
        let displaced = self.held.off.norm() > SAME;
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
        match displaced || !keeps_direction {
            true => self.pieces(&[&own]),
            false => {
                self.code(written.code);
                self.feed(1.0)?;
                Ok(())
            }
        }
    }

    /// A motion that stays as it is written.
    fn left(&mut self) {
        let written = self.written;
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
        self.code(written.code);
        // A feed that is not known cannot be another one.
        let _ = self.feed(1.0);
    }

    fn pieces(&mut self, pieces: &[&Piece]) -> Result<(), Reason> {
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
        self.direction(first, &mut added);
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

    fn in_frame(&self, place: Vector3<f64>) -> Vector3<f64> {
        (self.written.frame.inverse() * Point3::from(place)).coords
    }

    /// Behind which words that are missing go.
    fn anchor(&self) -> usize {
        let written = self.written;
        let axes = written.axes.iter().flatten().map(|word| word.word.end);
        let code = written.code_word.iter().map(|word| word.end);
        axes.max().or(code.max()).unwrap_or(written.words_at)
    }

    /// Puts words at a place where words begin or end.
    fn insert(&mut self, at: usize, words: &str) {
        let words = words.trim();
        if words.is_empty() {
            return;
        }
        let text = match at == self.written.words_at {
            true => format!("{words} "),
            false => format!(" {words}"),
        };
        self.edits.replace(at..at, text);
    }

    /// States a code of motion where another one would be in force.
    fn code(&mut self, wanted: Code) {
        let written = self.written;
        let stated = &written.code_word;
        let in_force = match stated {
            Some(_) => written.code,
            None => self.held.code.unwrap_or(written.code),
        };
        if in_force != wanted {
            match stated {
                Some(word) => {
                    let long = self.file.part(word).get(1) == Some(&b'0') && word.len() == 3;
                    let text = match long {
                        true => wanted.word().replace('G', "G0"),
                        false => wanted.word().to_owned(),
                    };
                    self.edits.replace(word.clone(), text);
                }
                None => {
                    let at = written.words_at;
                    self.edits.replace(at..at, format!("{} ", wanted.word()));
                }
            }
        }
        self.held.code = (wanted != written.code).then_some(wanted);
    }

    /// The feed that a piece needs, if it is not in force; it is then.
    fn feed_text(&mut self, factor: f64) -> Result<Option<String>, Reason> {
        let (Some(feed), false) = (&self.written.feed, self.written.code == Code::Rapid) else {
            return match factor == 1.0 || self.written.code == Code::Rapid {
                true => Ok(None),
                false => Err(NO_SPEED),
            };
        };
        if factor != 1.0 && self.motion.speed.mm_per_s.is_none() {
            return Err(NO_SPEED);
        }
        let wanted = feed.value * factor;
        let in_force = self.held.feed.unwrap_or(feed.value);
        if wanted == in_force {
            return Ok(None);
        }
        self.held.feed = (factor != 1.0).then_some(wanted);
        if factor == 1.0 {
            let text = feed.text.clone();
            return Ok(Some(text));
        }
        let number = format!("{wanted:.4}");
        let number = number.trim_end_matches('0').trim_end_matches('.');
        Ok(Some(format!("F{number}")))
    }

    /// States the feed of the own block where another one would be in force.
    fn feed(&mut self, factor: f64) -> Result<(), Reason> {
        if let Some((word, _)) = &self.written.feed_word {
            self.held.feed = None;
            if let Some(text) = self.feed_text(factor)? {
                self.edits.replace(word.clone(), text);
            }
        } else if let Some(text) = self.feed_text(factor)? {
            let at = self.anchor();
            self.insert(at, &text);
        }
        Ok(())
    }

    /// The direction that the text states, in the part's axes.
    fn stated_direction(&self) -> Option<Vector3<f64>> {
        let by_axis = matches!(&self.motion.site.target, TargetSite::Literal(text) if text.convention == OrientationText::Axis);
        let pose = self.motion.target.pose().filter(|_| by_axis)?;
        Some(pose.orientation * Vector3::z())
    }

    fn turns(&self, pieces: &[&Piece]) -> Result<(), Reason> {
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
    fn direction(&mut self, piece: &Piece, added: &mut String) {
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
    fn direction_of(&mut self, piece: &Piece, added: &mut String) {
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

const NO_SPEED: Reason = (
    "its speed cannot be changed: it is not known from the text",
    "state the feed by G94 and F, or keep it",
);
