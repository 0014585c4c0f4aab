//! The writer of Heidenhain conversational programs; motions without pieces state what they took over from a block that is another one.
//!
//! What a block does not say stays as it was: where one block is corrected, those behind it must say again what they took over.
//! So all motions are gone through in their order, with the place and the feed that the written blocks leave behind. A piece
//! of a motion is a block before it, with its feed and radius compensation; functions that act at the beginning of the block go to the
//! first piece, those that act at the end stay. Arcs that change become arcs about centres of their own (`CC` and `C`, or `CP` where
//! they rise), or `L` blocks, polar blocks become `L` blocks. If a file that numbers
//! its blocks gets further ones, all are numbered again.

use std::collections::BTreeMap;

use nalgebra::{Vector2, Vector3};

use crate::error::WriteError;
use crate::heidenhain::arcs::Plane;
use crate::heidenhain::blocks::numbered_again;
use crate::heidenhain::ends::Shape;
use crate::heidenhain::path_words::FeedWord;
use crate::heidenhain::reading::reader::interpret;
use crate::heidenhain::reading::walker::{Found, Way};
use crate::heidenhain::words::{Word, decimals, words_of};
use crate::heidenhain::writing::words::{Stated, word_text};
use crate::heidenhain::writing::writer::{OwnPole, Reason, Writer};
use crate::model::motion::Motion;
use crate::model::program::RobotProgram;
use crate::options::{ReadOptions, WriteOptions};
use crate::text::source::{Edits, SourceFile};
use crate::writing::motions::check_lines;
use crate::writing::piece::Piece;

/// The files of a program with pieces in place of its motions.
pub(crate) fn write_heidenhain(
    program: &RobotProgram,
    pieces: &[Piece],
    options: &WriteOptions,
) -> Result<Vec<(String, Vec<u8>)>, WriteError> {
    let files = program.files.iter();
    if pieces.is_empty() {
        let same = files.map(|file| (file.name().to_owned(), file.bytes().to_vec()));
        return Ok(same.collect());
    }
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
    let reading = ReadOptions {
        rotary_axes: program.rotary.letters.clone(),
        slash_blocks: program.slash_blocks,
        ..ReadOptions::default().as_written()
    };
    let Found { ways, shown, .. } = interpret(&program.files, &reading);
    let mut writer = Writer {
        program,
        shown,
        options,
        edits: files.map(|_| Edits::default()).collect(),
        signs: program.files.iter().map(has_signs).collect(),
        added: vec![false; program.files.len()],
        off: Vector3::zeros(),
        feed: None,
        polar_broken: false,
        pole: None,
        axis: None,
        turned_deg: Vec::new(),
        angles_now: Vec::new(),
        off_at: Vec::with_capacity(program.motions.len()),
        changed: Vec::with_capacity(program.motions.len()),
        file: 0,
    };
    for (index, motion) in program.motions.iter().enumerate() {
        let own = of_motion.get(&index).map_or(&[][..], Vec::as_slice);
        let way = ways
            .get(index)
            .filter(|way| way.block.text.start <= motion.span.start);
        let way = way.ok_or_else(|| WriteError::Overlap {
            file: program.files[motion.file].name().to_owned(),
        })?;
        let written = writer.motion(motion, way, own);
        written.map_err(|(reason, remedy)| WriteError::Motion {
            file: program.files[motion.file].name().to_owned(),
            line: motion.line,
            reason,
            remedy: remedy.to_owned(),
        })?;
    }
    let Writer { edits, added, .. } = writer;
    let mut written = Vec::with_capacity(program.files.len());
    for ((file, edits), added) in program.files.iter().zip(edits).zip(added) {
        let overlap = || WriteError::Overlap {
            file: file.name().to_owned(),
        };
        let mut bytes = edits.applied_to(file.bytes()).ok_or_else(overlap)?;
        if added {
            bytes = numbered_again(&bytes).ok_or_else(overlap)?;
        }
        check_lines(file, &bytes, options)?;
        written.push((file.name().to_owned(), bytes));
    }
    Ok(written)
}

/// True if a file writes signs before positive coordinates: its first coordinate shows it.
fn has_signs(file: &SourceFile) -> bool {
    let bytes = file.bytes();
    let letters = bytes
        .windows(2)
        .filter(|pair| matches!(pair[0], b'X' | b'Y' | b'Z'));
    let mut found = letters.filter_map(|pair| match pair[1] {
        b'+' => Some(true),
        b'0'..=b'9' => Some(false),
        _ => None,
    });
    found.next().unwrap_or(true)
}

impl Writer<'_> {
    fn motion(&mut self, motion: &Motion, way: &Way, pieces: &[&Piece]) -> Result<(), Reason> {
        if motion.file != self.file {
            self.file = motion.file;
            self.off = Vector3::zeros();
            self.feed = None;
            self.polar_broken = false;
            self.pole = None;
            self.axis = None;
            self.turned_deg.clear();
        }
        self.changed
            .push(!pieces.is_empty() || self.off != Vector3::zeros());
        let result = match pieces.split_last() {
            None => self.kept(motion, way),
            Some((last, before)) => self.pieces(motion, way, last, before),
        };
        self.off_at.push(self.off != Vector3::zeros());
        result
    }
}

/// An arc from another start.
const BEGINS_ELSEWHERE: (&str, &str) = (
    "the arc begins at a place that changes, and is then none about its written centre",
    "divide it into straight pieces, too, or keep its start",
);

/// Blocks that are arcs.
const ARCS: [&str; 5] = ["C", "CP", "CR", "CT", "CTP"];

/// A digit that was not worth stating again bends no arc, in halves of it.
const NOT_WORTH: f64 = 1.01;

impl Writer<'_> {
    /// A motion without pieces: it goes on from where the block before leaves the tool.
    pub(crate) fn kept(&mut self, motion: &Motion, way: &Way) -> Result<(), Reason> {
        let file = &self.program.files[motion.file];
        let words = words_of(file.bytes(), &motion.span);
        let stated = Stated::of(&words);
        let off = self.off;
        self.restore_pole(motion, way);
        if stated.directs {
            self.axis = None;
        }
        if way.shape == Shape::Unknown {
            self.angles_left(&words);
            return self.unknown(motion, way, &words, &stated);
        }
        let pole_off = self.pole_is_off(way);
        let whole = match way.shape {
            Shape::Straight => true,
            Shape::Polar { whole } => (whole || !self.polar_broken) && !pole_off,
            Shape::Arc | Shape::Tangential => !pole_off,
            Shape::Unknown => true,
        };
        let before = motion.follows.and_then(|from| self.changed.get(from));
        if way.shape == Shape::Tangential && before == Some(&true) {
            return Err((
                "the arc begins in the direction of the block before it, which changes".to_owned(),
                "divide it into straight pieces, too, or write it with CC and C",
            ));
        }
        let stands = self.axis.is_none() && self.angles_stand();
        let needs_feed = self.feed.is_some() && stated.feed == FeedWord::None && way.feed.is_some();
        if stands {
            self.angles_left(&words);
        }
        if off == Vector3::zeros() && whole && stands && !needs_feed {
            if matches!(
                stated.feed,
                FeedWord::Number(..) | FeedWord::Auto | FeedWord::Other
            ) {
                self.feed = None;
            }
            return Ok(());
        }
        if off == Vector3::zeros() && whole && stands {
            // The feed alone.
            let mut edits = Edits::default();
            self.write_feed(way, &words, 1.0, &mut edits);
            self.edits[motion.file].append(edits);
            return Ok(());
        }
        if matches!(way.shape, Shape::Arc | Shape::Tangential) {
            if !stands {
                return Err((
                    "the direction of the tool is corrected up to here, and an arc does not state it"
                        .to_owned(),
                    "correct places alone (leave out --correct pose), or write the arc as lines",
                ));
            }
            if off.amax() <= NOT_WORTH * self.half_mm(way) && !pole_off {
                self.stated_again(way, &stated);
                return Ok(());
            }
            return Err((BEGINS_ELSEWHERE.0.to_owned(), BEGINS_ELSEWHERE.1));
        }
        let Some(end) = motion.target.pose() else {
            return Ok(());
        };
        let piece = Piece::to(0, end.position_mm);
        self.pieces(motion, way, &piece, &[])
    }

    /// True if the pole in force was set from a tool position that is corrected now.
    fn pole_is_off(&self, way: &Way) -> bool {
        way.pole_from
            .is_some_and(|from| self.off_at.get(from) == Some(&true))
    }

    /// A block that stays as it is written. What is known of its end, and what it takes over, it states.
    pub(crate) fn unknown(
        &mut self,
        motion: &Motion,
        way: &Way,
        words: &[Word],
        stated: &Stated,
    ) -> Result<(), Reason> {
        let off = way.datum.step(&self.off);
        // Only the offset in the plane changes an arc; the height may be unknown.
        let begins_off = way.plane.flat(&off).amax() > NOT_WORTH * self.half_mm(way);
        let is_arc = words
            .first()
            .is_some_and(|word| ARCS.iter().any(|name| word.is(name)));
        if is_arc && begins_off || way.pole.used && self.pole_is_off(way) {
            return Err((BEGINS_ELSEWHERE.0.to_owned(), BEGINS_ELSEWHERE.1));
        }
        let taken_over = |axis: usize| {
            let word = stated.word[axis].is_some();
            let end = way.end[axis].filter(|_| !stated.absolute[axis] && off[axis] != 0.0);
            // A step ends elsewhere, too.
            end.map(|end| (axis, end, word))
        };
        let again: Vec<(usize, f64, bool)> = (0..3).filter_map(taken_over).collect();
        self.stated_again(way, stated);
        if again.is_empty() {
            return Ok(());
        }
        let is_line = words
            .first()
            .is_some_and(|word| word.is("L") || word.is("LN"));
        if !is_line {
            return Err((
                "it goes on from a place that changes, and its own end is not known".to_owned(),
                "write the program flat first (--expand), or leave the block before as it is",
            ));
        }
        let mut off = way.datum.step(&self.off);
        let own = &mut self.edits[motion.file];
        for (axis, end, is_stated) in again {
            let text = word_text(
                axis,
                end / way.unit_mm,
                decimals(way.unit_mm),
                self.signs[motion.file],
            );
            match stated.word[axis].filter(|_| is_stated) {
                Some(at) => own.replace(words[at].span.clone(), text),
                None => {
                    let at = words[0].span.end;
                    own.replace(at..at, format!(" {text}"));
                }
            }
            off[axis] = 0.0;
        }
        self.off = way.datum.preset(&off) - way.datum.shift_mm;
        Ok(())
    }
}

/// Poles nearer than this are one, mm.
const SAME_POLE_MM: f64 = 1e-9;

/// Limit of the decimals of a pole that is stated again.
const MOST_DIGITS: usize = 7;

impl Writer<'_> {
    /// Puts a pole of its own in force; whether a CC block is needed for it.
    pub(crate) fn own_pole(&mut self, way: &Way, at: Vector2<f64>) -> bool {
        let in_force = match self.pole.filter(|own| way.pole.whole <= own.count) {
            Some(own) if own.count == way.pole.count => Some((own.plane, own.at)),
            Some(_) => None,
            None => {
                (way.pole.at.filter(|_| way.pole_from.is_none())).map(|pole| (pole.plane, pole.at))
            }
        };
        let is_same = |(plane, pole): (Plane, Vector2<f64>)| {
            plane == way.plane && (pole - at).norm() < SAME_POLE_MM
        };
        if in_force.is_some_and(is_same) {
            return false;
        }
        self.pole = Some(OwnPole {
            plane: way.plane,
            at,
            count: way.pole.count,
        });
        // After CC no last polar radius exists.
        self.polar_broken = true;
        true
    }

    /// States the pole again that a block counts from, where another one is in force.
    pub(crate) fn restore_pole(&mut self, motion: &Motion, way: &Way) {
        let Some(own) = self.pole else {
            return;
        };
        if way.pole.whole > own.count {
            self.pole = None;
            return;
        }
        let Some(pole) = way.pole.at.filter(|_| way.pole.used) else {
            return;
        };
        self.pole = None;
        let file = &self.program.files[motion.file];
        let signs = self.signs[motion.file];
        let text = [0, 1].map(|axis| {
            let value = pole.at[axis] / way.unit_mm;
            let is_exact = |digits: &usize| {
                let fine = 10.0_f64.powi(*digits as i32);
                ((value * fine).round() / fine - value).abs() < SAME_POLE_MM
            };
            let digits = (0..MOST_DIGITS).find(is_exact);
            let axis = pole.plane.axes()[axis];
            word_text(axis, value, digits.unwrap_or(MOST_DIGITS), signs)
        });
        let mut inserted = file
            .part(&(way.block.lines.start..motion.span.start))
            .to_vec();
        inserted.extend_from_slice(format!("CC {} {}", text[0], text[1]).as_bytes());
        inserted.extend_from_slice(file.line_ending());
        let at = way.block.lines.start;
        self.edits[motion.file].replace(at..at, inserted);
        self.added[motion.file] = true;
    }
}
