//! The writer of Heidenhain conversational programs.
//!
//! What a block does not say stays as it was: where one block is corrected, those behind it must say again what they took over.
//! So all motions are gone through in their order, with the place and the feed that the written blocks leave behind. A piece
//! of a motion is a block before it, with its feed and radius compensation; functions that act at the beginning of the block go to the
//! first piece, those that act at the end stay. Arcs and polar blocks that change become `L` blocks. If a file that numbers
//! its blocks gets further ones, all are numbered again.

use std::collections::BTreeMap;

use nalgebra::Vector3;

use crate::error::WriteError;
use crate::heidenhain::ends::Shape;
use crate::heidenhain::numbering::numbered_again;
use crate::heidenhain::path_words::FeedWord;
use crate::heidenhain::reader::{Way, interpret};
use crate::heidenhain::words::{Word, words_of};
use crate::heidenhain::write_words::{
    Part, Stated, When, feed_text, functions_of, number_text, parsed, with_blanks, word_text,
    write_functions,
};
use crate::model::motion::Motion;
use crate::model::program::RobotProgram;
use crate::options::{CutterCompensation, ReadOptions, UnknownTargets, WriteOptions};
use crate::text::edits::Edits;
use crate::text::source::SourceFile;
use crate::writing::motions::{FARTHEST_MM, check_lines};
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
        unknown_targets: UnknownTargets::LeftAsWritten,
        cutter_compensation: CutterCompensation::CentrePath,
        ..ReadOptions::default()
    };
    let ways = interpret(&program.files, &reading).ways;
    let mut writer = Writer {
        program,
        options,
        edits: files.map(|_| Edits::default()).collect(),
        signs: program.files.iter().map(has_signs).collect(),
        added: vec![false; program.files.len()],
        off: Vector3::zeros(),
        feed: None,
        polar_broken: false,
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

/// Whether a file writes signs before positive coordinates: the first coordinate says it.
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

/// Why a motion cannot be written, and what to do.
type Reason = (String, &'static str);

struct Writer<'w> {
    program: &'w RobotProgram,
    options: &'w WriteOptions,
    edits: Vec<Edits>,
    /// Whether positive numbers have their sign, by file.
    signs: Vec<bool>,
    /// Whether blocks were added, by file.
    added: Vec<bool>,
    /// Where the written blocks leave the tool, from where the input does; in the preset's axes, mm.
    off: Vector3<f64>,
    /// The feed that the written blocks leave behind, where it is another one.
    feed: Option<f64>,
    /// A polar block was written by X and Y: those behind it have no last radius.
    polar_broken: bool,
    /// Whether the written blocks are elsewhere at the end of each motion.
    off_at: Vec<bool>,
    /// Whether each motion is another one.
    changed: Vec<bool>,
    file: usize,
}

/// Least difference of places that counts, mm.
const SAME_MM: f64 = 1e-9;

const ABOUT_CENTRE: &str = "an arc with other ends is none about its written centre";

impl Writer<'_> {
    fn motion(&mut self, motion: &Motion, way: &Way, pieces: &[&Piece]) -> Result<(), Reason> {
        if motion.file != self.file {
            self.file = motion.file;
            self.off = Vector3::zeros();
            self.feed = None;
            self.polar_broken = false;
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

    /// A motion without pieces: it goes on from where the block before leaves the tool.
    fn kept(&mut self, motion: &Motion, way: &Way) -> Result<(), Reason> {
        let file = &self.program.files[motion.file];
        let words = words_of(file.bytes(), &motion.span);
        let stated = Stated::of(&words);
        let off = self.off;
        if way.shape == Shape::Unknown {
            return self.unknown(motion, way, &words, &stated);
        }
        let pole_off = way
            .pole_from
            .is_some_and(|from| self.off_at.get(from) == Some(&true));
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
        let needs_feed = self.feed.is_some() && stated.feed == FeedWord::None && way.feed.is_some();
        if off == Vector3::zeros() && whole && !needs_feed {
            if matches!(
                stated.feed,
                FeedWord::Number(..) | FeedWord::Auto | FeedWord::Other
            ) {
                self.feed = None;
            }
            return Ok(());
        }
        if off == Vector3::zeros() && whole {
            // The feed alone.
            let mut edits = Edits::default();
            self.write_feed(way, &words, 1.0, &mut edits);
            self.edits[motion.file].append(edits);
            return Ok(());
        }
        if matches!(way.shape, Shape::Arc | Shape::Tangential) {
            // A digit that was not worth stating again bends no arc.
            if off.amax() <= 1.01 * self.half_mm(way) && !pole_off {
                self.stated_again(way, &stated);
                return Ok(());
            }
            return Err((
                "the arc begins at a place that changes, and is then none about its written centre"
                    .to_owned(),
                "divide it into straight pieces, too, or keep its start",
            ));
        }
        let Some(end) = motion.target.pose() else {
            return Ok(());
        };
        let piece = Piece::to(0, end.position_mm);
        self.pieces(motion, way, &piece, &[])
    }

    /// Half of the last digit, mm.
    fn half_mm(&self, way: &Way) -> f64 {
        0.5 * 10.0_f64.powi(-(self.decimals(way) as i32)) * way.unit_mm
    }

    fn decimals(&self, way: &Way) -> usize {
        match way.unit_mm == 1.0 {
            true => self.options.position_decimals.min(4),
            // As fine in inches. The control takes no more digits.
            false => (self.options.position_decimals + 2).min(5),
        }
    }

    /// Axes that a block states as it did are where they were.
    fn stated_again(&mut self, way: &Way, stated: &Stated) {
        let mut off = way.datum.step(&self.off);
        for axis in 0..3 {
            if stated.absolute[axis] {
                off[axis] = 0.0;
            }
        }
        self.off = way.datum.preset(&off) - way.datum.shift_mm;
    }

    /// A block that stays as it is written. What is known of its end, and what it takes over, it states.
    fn unknown(
        &mut self,
        motion: &Motion,
        way: &Way,
        words: &[Word],
        stated: &Stated,
    ) -> Result<(), Reason> {
        let off = way.datum.step(&self.off);
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
                match way.unit_mm == 1.0 {
                    true => 4,
                    false => 5,
                },
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

    fn pieces(
        &mut self,
        motion: &Motion,
        way: &Way,
        last: &Piece,
        before: &[&Piece],
    ) -> Result<(), Reason> {
        let end = motion.target.pose().ok_or((
            "the motion has no place that could be corrected".to_owned(),
            "leave its pieces out",
        ))?;
        for piece in before.iter().copied().chain([last]) {
            let near = piece
                .position_mm
                .iter()
                .all(|value| value.abs() < FARTHEST_MM);
            if !(near && piece.speed_factor.is_finite() && piece.speed_factor > 0.0) {
                return Err((
                    "a piece has no finite place or speed, or one farther than 1 km".to_owned(),
                    "mend the correction",
                ));
            }
            let z = Vector3::z();
            let turned = piece
                .orientation
                .map(|to| (to * z).angle(&(end.orientation * z)));
            if turned.is_some_and(|angle| angle.is_nan() || angle > 1e-9) {
                return Err((
                    "the tool's axis is not corrected in these programs".to_owned(),
                    "correct places alone",
                ));
            }
            if piece.via_mm.is_some() {
                return Err((ABOUT_CENTRE.to_owned(), "give it straight pieces"));
            }
            if piece.speed_factor != 1.0 && way.feed.is_none() {
                return Err((
                    "its speed cannot be changed: it is not known from the text".to_owned(),
                    "state F as a number, or keep it",
                ));
            }
        }
        let file = &self.program.files[motion.file];
        let words = words_of(file.bytes(), &motion.span);
        let kinds = functions_of(&words);
        if !before.is_empty()
            && let Some((_, number)) = kinds.iter().find(|(kind, _)| *kind == When::Unknown)
        {
            return Err((
                format!(
                    "M{number} stands beside a motion that is divided, and when it acts is not known"
                ),
                "write it in a block of its own",
            ));
        }
        let off = way.datum.step(&self.off);
        let mut place = [0, 1, 2].map(|axis| way.start[axis].map(|at| at + off[axis]));
        let mut inserted = Vec::new();
        for (index, piece) in before.iter().enumerate() {
            let part = match index {
                0 => Part::First,
                _ => Part::Middle,
            };
            let edits = self.block(motion, way, &words, (piece, part), &mut place);
            let text = edits.applied_to_part(file.bytes(), &motion.span);
            let text = text.ok_or_else(|| {
                (
                    "its words overlap".to_owned(),
                    "write the block as the control shows it",
                )
            })?;
            // What stands before the block, number and blanks, stands before its pieces.
            inserted.extend_from_slice(file.part(&(way.block.lines.start..motion.span.start)));
            inserted.extend(text);
            inserted.extend_from_slice(file.line_ending());
        }
        let part = match before.is_empty() {
            true => Part::Only,
            false => Part::Last,
        };
        let edits = self.block(motion, way, &words, (last, part), &mut place);
        let [x, y, z] =
            [0, 1, 2].map(|axis| place[axis].zip(way.end[axis]).map_or(0.0, |(a, b)| a - b));
        let off = way.datum.preset(&Vector3::new(x, y, z)) - way.datum.shift_mm;
        self.off = match off.amax() <= SAME_MM {
            true => Vector3::zeros(),
            false => off,
        };
        let own = &mut self.edits[motion.file];
        if !inserted.is_empty() {
            let at = way.block.lines.start;
            own.replace(at..at, inserted);
            self.added[motion.file] = true;
        }
        own.append(edits);
        Ok(())
    }

    /// The changes of a block that make it a piece; from a place in the programmed axes, which is that of the piece's end then.
    fn block(
        &mut self,
        motion: &Motion,
        way: &Way,
        words: &[Word],
        (piece, part): (&Piece, Part),
        place: &mut [Option<f64>; 3],
    ) -> Edits {
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
                    let stays = same && word.is_none() && (straight || axis == 2);
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
        if !straight {
            edits.replace(words[0].span.clone(), "L");
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

    /// The feed of a piece, where it is not the one in force.
    fn write_feed(&mut self, way: &Way, words: &[Word], factor: f64, edits: &mut Edits) {
        let stated = Stated::of(words).feed;
        let Some(own) = way.feed else {
            if matches!(stated, FeedWord::Auto | FeedWord::Other) {
                self.feed = None;
            }
            return;
        };
        let wanted = own * factor;
        let changed = (factor - 1.0).abs() > 1e-12;
        match stated {
            FeedWord::Number(at, _) => {
                if let (true, Some(number)) = (changed, words[at].number()) {
                    edits.replace(number.span.clone(), feed_text(wanted));
                }
                self.feed = changed.then_some(wanted);
            }
            FeedWord::Max | FeedWord::Other => {}
            FeedWord::Auto | FeedWord::None => {
                let in_force = match stated {
                    FeedWord::Auto => own,
                    _ => self.feed.unwrap_or(own),
                };
                if in_force == wanted {
                    if stated == FeedWord::Auto {
                        self.feed = None;
                    }
                    return;
                }
                let text = format!("F{}", feed_text(wanted));
                let auto = words.iter().find(|word| word.is("FAUTO"));
                let f = words.iter().position(|word| word.is("F"));
                match (auto, f) {
                    (Some(word), _) => edits.replace(word.span.clone(), text),
                    (None, Some(at)) => {
                        let end = words.get(at + 1).map_or(words[at].span.end, |w| w.span.end);
                        edits.replace(words[at].span.start..end, text);
                    }
                    (None, None) => {
                        // Before the functions.
                        let first = words.iter().position(|word| word.is("M"));
                        let behind = first.unwrap_or(words.len()).saturating_sub(1);
                        let at = words[behind].span.end;
                        edits.replace(at..at, format!(" {text}"));
                    }
                }
                self.feed = changed.then_some(wanted);
            }
        }
    }
}
